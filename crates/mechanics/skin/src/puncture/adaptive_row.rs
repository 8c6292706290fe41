//! Path of a row that grows as contact spreads.
//!
//! Only the scales within reach of contact are unknowns. Beyond the last of them the row is linear,
//! and its scales follow from the end scale in closed form ([`FarField`]). As contact spreads
//! the row is extended at the current point of the path.

use std::sync::Arc;

use geometry::OutOfRange;
use solver::{Change, Continuation, Event};
use substrate::{FarField, SubstrateLaw};

use super::Problem;
use super::exterior_motion::Reach;
use super::row_layout::RowLayout;
use super::system::Chain;
use crate::contacts::{SkinPoint, SkinState};

/// Path of a part of a row, which is extended when deformation reaches its ends.
///
/// ```text
/// next ─► solve the next step ─► beyond an end?  no ─► return it
///                ▲                     │ yes
///                └── extend the row ◄──┘ repeat the step
/// ```
pub(super) struct AdaptiveRowPath<'a> {
    problem: &'a Problem<'a>,
    pub(super) path: Continuation<Chain>,
    longest: usize,
    /// False if the row had to grow beyond its limit.
    pub(super) is_long_enough: bool,
    /// Proximity of the last yielded point to the ends.
    reach: [Reach; 2],
    /// Shorter rows that the path has left, in order.
    shorter: Vec<Chain>,
    /// Point at which the row was extended, as it was on the shorter row.
    arrived: Option<SkinPoint>,
}

/// Segment of a path, with all its points on the current row.
pub(super) struct Segment {
    pub(super) from: Arc<SkinPoint>,
    pub(super) to: SkinPoint,
    /// First point before any extension of the row.
    ///
    /// After an extension the point is solved again.
    pub(super) left: Arc<SkinPoint>,
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
        // Extend before the step if the last one came near an end; few steps are then repeated.
        let reach = std::mem::replace(&mut self.reach, [Reach::Short; 2]);
        self.lengthen(&self.path.point_shared(), reach)?;
        while self.is_long_enough {
            let from = self.path.point_shared();
            let Some(to) = self.path.next() else { break };
            let reach = self.path.system().reach(&to.state);
            if !reach.contains(&Reach::Beyond) {
                self.reach = reach;
                let left = self.arrived.take().map_or_else(|| Arc::clone(&from), Arc::new);
                return Ok(Some(Segment { from, to, left }));
            }
            // Scales beyond the end may have touched within the step, so repeat it.
            self.lengthen(&from, reach)?;
        }
        Ok(None)
    }

    /// Continues the path on a longer row, if an end is reached and the row may grow.
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
            // A row may grow twice at one point: keep the point at which it grew first.
            let left = self.arrived.take().map(|left| chain.extended(self.path.system(), &left));
            self.arrived = left.or_else(|| Some(from.clone()));
            self.shorter.push(self.path.continue_with(chain, from));
        }
        Ok(())
    }

    /// Extends a yielded point to the current row.
    ///
    /// The size of a point identifies its row, because each row is longer than the previous one.
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

/// Initial number of scales on each side of the punctured one, for an endless row.
const FIRST_SCALES: usize = 4;

/// Smallest growth of a row in scales, and divisor for proportional growth.
const GROWTH: usize = 4;
const GROWTH_PART: usize = 8;

/// Decay of displacements over the additional scales of an initial row of bars.
const DECAYED: f64 = 1e-3;
/// Largest number of additional scales of an initial row of bars.
const LONGEST_DECAY: usize = 50;

impl RowLayout {
    /// Chooses the initial row.
    ///
    /// A scale is coupled with `neighbours` scales on each side.
    pub(super) fn first(far: &FarField, neighbours: usize, law: SubstrateLaw) -> Self {
        // With full coupling the far field acts on as many scales at an end as a scale is coupled
        // with.
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

    /// Adds scales on the sides that are reached, up to the `longest` row.
    pub(super) fn grown(self, reach: [Reach; 2], longest: usize) -> Self {
        // Proportional growth keeps the number of extensions logarithmic in the length.
        let more = GROWTH + self.scales() / GROWTH_PART;
        let room = longest.saturating_sub(self.scales());
        let [left, right] = reach.map(|reach| if reach == Reach::Short { 0 } else { more });
        let right = right.min(room);
        Self { left: self.left + left.min(room - right), right: self.right + right, ..self }
    }

    /// Intersects this row with another.
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
            // Place new scales by the closed form, so that the point stays an equilibrium.
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

fn copy_to<T: Copy>(into: &mut [T], start: usize, values: &[T]) {
    into[start..start + values.len()].copy_from_slice(values);
}
