//! Path of a row that grows as contact spreads.
//!
//! Only the scales that contact may reach are unknowns. The scales beyond them form a linear chain,
//! and their displacements follow from the end of the solved row in closed form ([`FarField`]). If
//! contact spreads, the row is extended at the current point of the path.

use std::sync::Arc;

use geometry::OutOfRange;
use solver::{Change, Continuation, Event};
use substrate::{FarField, SubstrateLaw};

use super::Problem;
use super::exterior_motion::Reach;
use super::row_layout::RowLayout;
use super::system::Chain;
use crate::contacts::{SkinPoint, SkinState};

/// Path of the solved part of a row, which is extended when contact may reach its ends.
///
/// ```text
/// next ─► solve the next step ─► beyond an end?  no ─► return it
///                ▲                     │ yes
///                └── extend the row ◄──┘ repeat the step
/// ```
pub(super) struct AdaptiveRowPath<'a> {
    problem: &'a Problem<'a>,
    pub(super) path: Continuation<Chain>,
    /// Largest number of scales of the solved part.
    longest: usize,
    /// False if the row would have to grow beyond `longest`.
    pub(super) is_long_enough: bool,
    /// Extent of contact towards each end at the last returned point.
    reach: [Reach; 2],
    /// All previous rows, the shortest first.
    shorter: Vec<Chain>,
    /// Last point at which the row was extended: the solution of the shorter row.
    ///
    /// It has the unknowns of the longer row, but was not solved again.
    arrived: Option<SkinPoint>,
}

/// Segment of a path between two neighbouring points, both with the unknowns of the current row.
pub(super) struct Segment {
    pub(super) from: Arc<SkinPoint>,
    pub(super) to: SkinPoint,
    /// The point `from` as solved before any extension of the row.
    ///
    /// If the row was extended at this point, `from` is the new solution on the longer row.
    pub(super) unextended: Arc<SkinPoint>,
}

impl<'a> AdaptiveRowPath<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, chain: Chain, longest: usize) -> Self {
        let rest = chain.at_rest();
        let path = Continuation::new(chain, rest, problem.common.solver);
        let (is_long_enough, reach, shorter) = (true, [Reach::Short; 2], Vec::new());
        Self { problem, path, longest, is_long_enough, reach, shorter, arrived: None }
    }

    /// Advances the path and returns its next segment.
    ///
    /// `None` if the path has ended or the row may not grow further.
    ///
    /// # Errors
    /// If the scales of a longer row cannot be built.
    pub(super) fn next(&mut self) -> Result<Option<Segment>, OutOfRange> {
        // Extend the row before the step if contact came near an end in the last step, so that
        // fewer steps have to be repeated.
        let reach = std::mem::replace(&mut self.reach, [Reach::Short; 2]);
        self.lengthen(&self.path.point_shared(), reach)?;
        while self.is_long_enough {
            let from = self.path.point_shared();
            let Some(to) = self.path.next() else { break };
            let reach = self.path.system().reach(&to.state);
            if !reach.contains(&Reach::Beyond) {
                self.reach = reach;
                let unextended = self.arrived.take().map_or_else(|| Arc::clone(&from), Arc::new);
                return Ok(Some(Segment { from, to, unextended }));
            }
            // Scales beyond the end may have touched within the step, so repeat it.
            self.lengthen(&from, reach)?;
        }
        Ok(None)
    }

    /// Continues the path on a longer row if contact is near an end and the row may grow.
    fn lengthen(&mut self, from: &SkinPoint, reach: [Reach; 2]) -> Result<(), OutOfRange> {
        if reach == [Reach::Short; 2] {
            return Ok(());
        }
        let layout = self.path.system().layout;
        let longer = layout.grown(reach, self.longest);
        let longer = self.problem.whole().map_or(longer, |whole| longer.within(whole));
        // A row that must grow but cannot is too short to continue.
        self.is_long_enough = longer != layout;
        if self.is_long_enough {
            let chain = self.problem.part(longer)?;
            let from = chain.extended(self.path.system(), from);
            // If the row grows twice at one point, keep the solution before the first extension.
            let first = self.arrived.take().map(|first| chain.extended(self.path.system(), &first));
            self.arrived = first.or_else(|| Some(from.clone()));
            self.shorter.push(self.path.continue_with(chain, from));
        }
        Ok(())
    }

    /// Converts a point that was returned earlier to the unknowns of the current row.
    ///
    /// The number of unknowns identifies the row of the point, because each row is longer than the
    /// previous one.
    pub(super) fn lengthened(&self, point: &SkinPoint) -> SkinPoint {
        let mut point = point.clone();
        let longer = self.shorter.iter().skip(1).chain([self.path.system()]);
        for (shorter, longer) in self.shorter.iter().zip(longer) {
            if shorter.layout.size() == point.state.z.len() {
                point = longer.extended(shorter, &point);
            }
        }
        point
    }
}

/// Smallest number of scales on each side of the punctured one in an initial row.
const FIRST_SCALES: usize = 4;

/// Constant part of the number of scales that an extension adds to a side.
const GROWTH: usize = 4;

/// Divisor: an extension adds [`GROWTH`] + (scales of the row)/`GROWTH_PART` scales to a side.
const GROWTH_PART: usize = 8;

/// Fraction to which displacements decay over the additional scales of an initial row.
///
/// Rows on a neo-Hookean substrate have such additional scales.
const DECAYED: f64 = 1e-3;

/// Largest number of additional scales on a side of an initial row.
const LONGEST_DECAY: usize = 50;

impl RowLayout {
    /// Chooses the layout of the initial row.
    ///
    /// The substrate couples a scale with `neighbours` scales on each side.
    pub(super) fn first(far: &FarField, neighbours: usize, law: SubstrateLaw) -> Self {
        // With full coupling the far field acts on the last `neighbours` scales at each end.
        let least = FIRST_SCALES.max(neighbours.div_ceil(2));
        let side = match law {
            SubstrateLaw::Linear => least,
            SubstrateLaw::NeoHookean => least + decayed_beyond(far),
        };
        Self { left: side, right: side, ..Self::default() }
    }

    /// Returns the layout with at least `side` scales on each side.
    pub(super) fn at_least(self, side: usize) -> Self {
        Self { left: self.left.max(side), right: self.right.max(side), ..self }
    }

    /// Adds scales on each side that contact is near or has reached, up to `longest` in total.
    pub(super) fn grown(self, reach: [Reach; 2], longest: usize) -> Self {
        // Proportional growth keeps the number of extensions logarithmic in the length.
        let more = GROWTH + self.scales() / GROWTH_PART;
        let room = longest.saturating_sub(self.scales());
        let [left, right] = reach.map(|reach| if reach == Reach::Short { 0 } else { more });
        let right = right.min(room);
        Self { left: self.left + left.min(room - right), right: self.right + right, ..self }
    }

    /// Returns the layout of the scales that belong to this row and to the `other` row.
    pub(super) fn within(self, other: Self) -> Self {
        Self { left: self.left.min(other.left), right: self.right.min(other.right), ..self }
    }
}

/// Counts the scales over which displacements along a row decay to [`DECAYED`].
fn decayed_beyond(far: &FarField) -> usize {
    let along = far.displacements(|_| [1.0, 0.0, 0.0], LONGEST_DECAY);
    let decayed = along.iter().position(|[x, ..]| x.abs() <= DECAYED);
    decayed.map_or(LONGEST_DECAY, |scale| scale + 1)
}

impl Chain {
    /// Converts a path point of a `shorter` row to this row.
    pub(super) fn extended(&self, shorter: &Self, point: &SkinPoint) -> SkinPoint {
        let added = self.layout.left - shorter.layout.left;
        let contacts = [shorter, self].map(|chain| chain.contacts.forces.len());
        let event = point.event.clone().map(|event| match event {
            Event::Changed(changes) => {
                let moved = changes.into_iter().map(|Change { constraint, activated }| {
                    // Needle constraints follow all contact constraints.
                    let constraint = if constraint < contacts[0] {
                        constraint + self.layout.contacts * added
                    } else {
                        constraint - contacts[0] + contacts[1]
                    };
                    Change { constraint, activated }
                });
                Event::Changed(moved.collect())
            }
            other => other,
        });
        let mut state = SkinState::at_rest(self);
        state.z = self.extended_unknowns(shorter, &point.state.z);
        let (of_contacts, of_needle) = point.state.active.split_at(contacts[0]);
        copy_to(&mut state.active, self.layout.contacts * added, of_contacts);
        copy_to(&mut state.active, contacts[1], of_needle);
        let before = self.contacts.contacts_before(added);
        copy_to(&mut state.mode.contacts, before, &point.state.mode.contacts);
        if self.contacts.has_friction() {
            copy_to(&mut state.mode.friction_states, before, &point.state.mode.friction_states);
        }
        state.mode.needle = point.state.mode.needle.clone();
        SkinPoint {
            state,
            arriving: self.extended_unknowns(shorter, &point.arriving),
            leaving: self.extended_unknowns(shorter, &point.leaving),
            event,
        }
    }

    /// Converts unknowns, or a direction, of a `shorter` row to this row.
    fn extended_unknowns(&self, shorter: &Self, z: &[f64]) -> Vec<f64> {
        let mut extended = vec![0.0; self.layout.size()];
        let added = self.layout.left - shorter.layout.left;
        for scale in 0..self.layout.scales() {
            let at = self.layout.scale(scale);
            let scale = scale.cast_signed() - added.cast_signed();
            // Move new scales by the closed form, so that the point stays an equilibrium.
            extended[at..at + 3].copy_from_slice(&shorter.displacement_anywhere(z, scale));
        }
        for force in 0..self.layout.contacts * (shorter.layout.scales() - 1) {
            let longer = self.layout.force(force + self.layout.contacts * added);
            extended[longer] = z[shorter.layout.force(force)];
        }
        let [from, to] = [shorter, self].map(|chain| chain.layout.load());
        copy_to(&mut extended, to, &z[from..=from + self.layout.needle]);
        extended
    }
}

/// Copies `values` to `into`, beginning at index `start`.
fn copy_to<T: Copy>(into: &mut [T], start: usize, values: &[T]) {
    into[start..start + values.len()].copy_from_slice(values);
}
