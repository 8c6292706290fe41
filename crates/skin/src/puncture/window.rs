//! The part of an endless row that is solved for.

use contact::CornerContact;
use geometry::{Corner, Vec2};
use solver::{Change, Event};

use super::system::{Chain, Layout};
use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, PAIR_FORCES, Point, State};

/// Scales on each side of the punctured one with which a path begins.
pub(super) const FIRST_SCALES: usize = 4;

/// Scales by which a row grows at least, and the part of its length.
const GROWTH: usize = 4;
const GROWTH_PART: usize = 8;

/// Where the chain goes on unlike the far field, an end that has moved by more than this (over `t`; radians) is reached.
pub(super) const STILL: f64 = 1e-6;

/// Part of the clearance at rest by which the displacement of an end may close the next gap before the row grows.
const EARLY: f64 = 0.5;

/// How near the deformation has come to an end of the row that is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Reach {
    /// Nothing beyond the end can touch.
    Short,
    /// The scales beyond the end may touch soon.
    Near,
    /// The scales beyond the end may touch here already.
    Beyond,
}

impl Chain {
    /// How near the deformation has come to the left and to the right end.
    pub(super) fn reach(&self, state: &State) -> [Reach; 2] {
        let last = self.layout.scales() - 1;
        let mut touching = Contacts::touching(state);
        let touching = [touching.next(), touching.last()];
        [(0, touching[0]), (last, touching[1].or(touching[0]))].map(|(end, touches)| {
            let share = self.share_of_clearance(self.displacement(&state.z, end));
            match () {
                () if share >= 1.0 => Reach::Beyond,
                () if share >= EARLY || touches == Some(true) => Reach::Near,
                () => Reach::Short,
            }
        })
    }

    /// The part of the clearance beyond an end that its displacement can close at most; and where nothing better is known
    /// what is more than still.
    fn share_of_clearance(&self, displacement: [f64; 3]) -> f64 {
        let [x, y, rotation] = displacement.map(f64::abs);
        match (self.contacts.arrangement(), self.far_field()) {
            (Arrangement::Even(row), Some(far)) => {
                let scale = row.scale();
                let reach = |corner| -> f64 { Vec2::norm(&scale.corner(corner)) };
                let arm = reach(Corner::TopRight).max(reach(Corner::TopLeft));
                // The next scale follows or, in rotations, goes the other way.
                let own = x + y + arm * rotation;
                let next = far.decay[0] * x + far.decay[1] * y + arm * far.decay[2].abs() * rotation;
                (own + next) / (row.gap() * scale.slant().cos())
            }
            _ => x.max(y).max(rotation) / STILL,
        }
    }

    /// A vector of the unknowns of a shorter row, or a direction, in the unknowns of this one: the scales that it has more
    /// follow the end of the shorter one.
    fn extended(&self, shorter: &Chain, z: &[f64]) -> Vec<f64> {
        let mut extended = vec![0.0; self.layout.size()];
        let added = self.layout.left - shorter.layout.left;
        for i in 0..self.layout.scales() {
            let at = self.layout.scale(i);
            let displacement = shorter.displacement_anywhere(z, i.cast_signed() - added.cast_signed());
            extended[at..at + 3].copy_from_slice(&displacement);
        }
        for force in 0..PAIR_FORCES * (shorter.layout.scales() - 1) {
            let of_longer = self.layout.force(force + PAIR_FORCES * added);
            extended[of_longer] = z[shorter.layout.force(force)];
        }
        extended[self.layout.load()] = z[shorter.layout.load()];
        extended
    }

    /// A point of the path of a shorter row as a point of this one.
    pub(super) fn extended_point(&self, shorter: &Chain, point: &Point) -> Point {
        let pairs = self.layout.scales() - 1;
        let levels = point.state.mode.len() / (shorter.layout.scales() - 1).max(1);
        let added = self.layout.left - shorter.layout.left;
        let active = moved(&point.state.active, PAIR_FORCES * added, PAIR_FORCES * pairs, false);
        let mode = moved(&point.state.mode, levels * added, levels * pairs, CornerContact::Open);
        let event = point.event.as_ref().map(|event| match event {
            Event::Changed(changes) => Event::Changed(
                changes
                    .iter()
                    .map(|change| Change { constraint: change.constraint + PAIR_FORCES * added, ..*change })
                    .collect(),
            ),
            other => other.clone(),
        });
        Point {
            state: State { z: self.extended(shorter, &point.state.z), active, mode },
            arriving: self.extended(shorter, &point.arriving),
            leaving: self.extended(shorter, &point.leaving),
            event,
        }
    }
}

/// A list of `length`, with `values` from `start` on and `other` elsewhere.
fn moved<T: Clone>(values: &[T], start: usize, length: usize, other: T) -> Vec<T> {
    let mut moved = vec![other; length];
    moved[start..start + values.len()].clone_from_slice(values);
    moved
}

impl Layout {
    /// More scales on the sides that are reached, as far as a row of the `longest` length has room.
    pub(super) fn grown(self, reach: [Reach; 2], longest: usize) -> Self {
        let more = GROWTH + self.scales() / GROWTH_PART;
        let room = longest.saturating_sub(self.scales());
        let [left, right] = reach.map(|reach| if reach == Reach::Short { 0 } else { more });
        let right = right.min(room);
        Self { left: self.left + left.min(room - right), right: self.right + right }
    }
}
