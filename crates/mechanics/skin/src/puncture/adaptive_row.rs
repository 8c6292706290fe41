//! A path of a row that grows.
//!
//! Contact reaches some scales of a row. Beyond the last of them the row is linear, and its scales follow those at the end
//! ([`FarField`](substrate::FarField)): they are not solved for. As contact spreads the row grows, at the point of the path where it
//! has to.

use std::sync::Arc;

use geometry::OutOfRange;
use solver::{Change, Event, Path};
use substrate::{FarField, SubstrateLaw};

use super::Problem;
use super::row_exterior::Reach;
use super::system::{Chain, RowLayout};
use crate::contacts::{SkinPoint, SkinState};

/// A path of a part of a row, which grows as far as the deformation reaches.
///
/// ```text
/// next ─► the next step ─► does it reach beyond an end?  no ─► it is yielded
///            ▲                     │ yes
///            └── on a longer row ◄─┘ from the point before
/// ```
pub(super) struct AdaptiveRowPath<'a> {
    problem: &'a Problem<'a>,
    pub(super) path: Path<Chain>,
    longest: usize,
    /// Whether the row was as long as it had to be.
    pub(super) has_room: bool,
    /// How near the point that was yielded last has come to the ends.
    reach: [Reach; 2],
    /// The shorter rows that the path has left, in order.
    shorter: Vec<Chain>,
    /// The point from which the path goes on on a longer row, as the shorter one left it.
    arrived: Option<SkinPoint>,
}

/// A step of a path; all its points are on the row as it is now.
pub(super) struct Segment {
    pub(super) from: Arc<SkinPoint>,
    pub(super) to: SkinPoint,
    /// The first point as the path came to it: after the row has grown there, it is solved for again before the path goes on.
    pub(super) left: Arc<SkinPoint>,
}

impl<'a> AdaptiveRowPath<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, chain: Chain, longest: usize) -> Self {
        let rest = chain.at_rest();
        let path = Path::new(chain, rest, problem.settings);
        let (has_room, reach, shorter) = (true, [Reach::Short; 2], Vec::new());
        Self { problem, path, longest, has_room, reach, shorter, arrived: None }
    }

    /// The next segment of the path, both its ends on the row as it is now; `None` where the path ends, or the row may not grow
    /// any more.
    ///
    /// # Errors
    /// If the scales of a longer row cannot be made.
    pub(super) fn next(&mut self) -> Result<Option<Segment>, OutOfRange> {
        // Before the step, where the last one came near an end: so few steps are taken twice.
        let reach = std::mem::replace(&mut self.reach, [Reach::Short; 2]);
        self.lengthen(&self.path.point_shared(), reach)?;
        while self.has_room {
            let from = self.path.point_shared();
            let Some(to) = self.path.next() else { break };
            let reach = self.path.system().reach(&to.state);
            if !reach.contains(&Reach::Beyond) {
                self.reach = reach;
                let left = self.arrived.take().map_or_else(|| Arc::clone(&from), Arc::new);
                return Ok(Some(Segment { from, to, left }));
            }
            // What lies beyond may have touched within the step: it is taken again.
            self.lengthen(&from, reach)?;
        }
        Ok(None)
    }

    /// Lets the path go on from a point on a longer row, if it reaches an end and there is room.
    fn lengthen(&mut self, from: &SkinPoint, reach: [Reach; 2]) -> Result<(), OutOfRange> {
        if reach == [Reach::Short; 2] {
            return Ok(());
        }
        let layout = self.path.system().layout;
        let longer = layout.grown(reach, self.longest);
        let longer = self.problem.whole().map_or(longer, |whole| longer.within(whole));
        // A row that may not grow although it has to is too short for what follows.
        self.has_room = longer != layout;
        if self.has_room {
            let chain = self.problem.part(longer)?;
            let from = chain.extended(self.path.system(), from);
            // A row may grow twice at one point: what the path left is the first form of it.
            let left = self.arrived.take().map(|left| chain.extended(self.path.system(), &left));
            self.arrived = left.or_else(|| Some(from.clone()));
            self.shorter.push(self.path.go_on(chain, from));
        }
        Ok(())
    }

    /// A point that was yielded, on the row as it is now. A row is known by its size, since each is longer than the one before.
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

/// Scales on each side of the punctured one with which the path of an endless row begins.
const FIRST_SCALES: usize = 4;

/// Scales by which a row grows at least, and as a part of its length.
const GROWTH: usize = 4;
const GROWTH_PART: usize = 8;

/// Part to which displacements decay from the scales that a row of bars begins with, besides those of a row of springs, to its
/// ends.
const DECAYED: f64 = 1e-3;
const LONGEST_DECAY: usize = 50;

impl RowLayout {
    /// The row with which a path begins, in which no scale feels more than `neighbours` on each side.
    pub(super) fn first(far: &FarField, neighbours: usize, law: SubstrateLaw) -> Self {
        // With full coupling what lies beyond acts on as many scales at an end as one feels there.
        let least = FIRST_SCALES.max(neighbours.div_ceil(2));
        let side = match law {
            SubstrateLaw::Linear => least,
            SubstrateLaw::NeoHookean => least + decayed_beyond(far),
        };
        Self { left: side, right: side, ..Self::default() }
    }

    /// At least so many scales on each side.
    pub(super) fn at_least(self, side: usize) -> Self {
        Self { left: self.left.max(side), right: self.right.max(side), ..self }
    }

    /// More scales on the sides that are reached, as far as a row of the `longest` length has room.
    pub(super) fn grown(self, reach: [Reach; 2], longest: usize) -> Self {
        // Growth in proportion to the length keeps the number of rows to its logarithm.
        let more = GROWTH + self.scales() / GROWTH_PART;
        let room = longest.saturating_sub(self.scales());
        let [left, right] = reach.map(|reach| if reach == Reach::Short { 0 } else { more });
        let right = right.min(room);
        Self { left: self.left + left.min(room - right), right: self.right + right, ..self }
    }

    /// What this row and another have in common.
    pub(super) fn within(self, other: Self) -> Self {
        Self { left: self.left.min(other.left), right: self.right.min(other.right), ..self }
    }
}

/// Scales over which displacements along a row decay to a small part.
fn decayed_beyond(far: &FarField) -> usize {
    let along = far.displacements(|_| [1.0, 0.0, 0.0], LONGEST_DECAY);
    let decayed = along.iter().position(|[x, ..]| x.abs() <= DECAYED);
    decayed.map_or(LONGEST_DECAY, |scale| scale + 1)
}

impl Chain {
    /// A point of the path of a `shorter` row, which lies within this one, as a point of this one.
    pub(super) fn extended(&self, shorter: &Self, point: &SkinPoint) -> SkinPoint {
        let added = self.layout.left - shorter.layout.left;
        let contacts = [shorter, self].map(|chain| chain.contacts.forces.len());
        let constraint = |number: usize| {
            // Those of the needle follow those of all contacts.
            if number < contacts[0] {
                number + self.layout.contacts * added
            } else {
                number - contacts[0] + contacts[1]
            }
        };
        let event = point.event.clone().map(|event| match event {
            Event::Changed(changes) => {
                let moved = changes.into_iter().map(|Change { constraint: number, activated }| {
                    Change { constraint: constraint(number), activated }
                });
                Event::Changed(moved.collect())
            }
            other => other,
        });
        let unknowns = |z: &[f64]| self.extended_unknowns(shorter, z);
        let mut state = SkinState::at_rest(self);
        state.z = unknowns(&point.state.z);
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
            arriving: unknowns(&point.arriving),
            leaving: unknowns(&point.leaving),
            event,
        }
    }

    /// Unknowns of a `shorter` row, or a direction, in the unknowns of this one.
    fn extended_unknowns(&self, shorter: &Self, z: &[f64]) -> Vec<f64> {
        let mut extended = vec![0.0; self.layout.size()];
        let added = self.layout.left - shorter.layout.left;
        for scale in 0..self.layout.scales() {
            let at = self.layout.scale(scale);
            let scale = scale.cast_signed() - added.cast_signed();
            // New scales stand where the closed form had them, so the point stays an equilibrium.
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
