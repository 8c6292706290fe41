//! Energy of the contacts, and the audit of a final state.

use contact::{CornerContact, Overlap, overlaps};
use geometry::Vec2;

use super::{Contacts, SkinPoint, SkinState};

/// Overlap (over `t`) by which the audit may differ from the contact law: round-off of the
/// collision query.
const AUDIT_TOLERANCE: f64 = 1e-8;

/// Part of an edge by which a foot may lie beyond its end: round-off of the path.
const OFF_EDGE: f64 = 1e-6;

/// How far ahead a path that has ended is looked at, in units of it: steps were cut down to 1e-9 before it ended.
const AHEAD: [f64; 4] = [1e-8, 1e-7, 1e-6, 1e-5];

/// A corner farther behind an edge than this (over `t`) has not come there within such a step: its gap has jumped.
const BEHIND: f64 = 1e-3;

impl Contacts {
    /// Forces of a contact on the left scale of its pair, with their friction: of its corners, and of its flush contact.
    pub(super) fn forces_on_left(&self, state: &SkinState, contact: usize) -> [Vec2; 2] {
        let [on_corners, on_flush] = self.normal_forces_on_left(state, contact);
        if self.has_friction() {
            [on_corners + self.traction_on_left(state, contact, on_corners), on_flush]
        } else {
            [on_corners, on_flush]
        }
    }

    /// The parts of these forces along the normals, for which the law holds.
    fn normal_forces_on_left(&self, state: &SkinState, contact: usize) -> [Vec2; 2] {
        let poses = self.pair_poses(&state.z, contact);
        let forces = self.forces_of(&state.z, contact);
        state.mode.contacts[contact].forces_on_left(&self.corners(contact, &poses), forces)
    }

    /// Sum of the forces of a contact, for which the law holds.
    fn force(&self, state: &SkinState, contact: usize) -> f64 {
        match state.mode.contacts[contact] {
            CornerContact::Open => 0.0,
            // The law holds for the size of the force that turns at a corner (C5), and for the sum
            // of the two forces of flush edges (C7).
            _ => self.normal_forces_on_left(state, contact).map(|force| force.norm()).iter().sum(),
        }
    }

    /// Approach of the scales at a contact, over `t`.
    pub(super) fn approach(&self, state: &SkinState, contact: usize) -> f64 {
        self.law.approach(self.force(state, contact)).value
    }

    /// Elastic energy of all contacts.
    pub(crate) fn energy(&self, state: &SkinState) -> f64 {
        let energy = |contact| self.law.energy(self.force(state, contact));
        (0..state.mode.contacts.len()).map(energy).sum()
    }

    /// Whether any contact carries beyond an end of its edge: at the end where the corners meet it would not be on its
    /// edge any more, and at the other one the model has no contact to go on with.
    pub(crate) fn off_edge(&self, state: &SkinState) -> bool {
        let contacts = state.mode.contacts.iter().enumerate();
        contacts.into_iter().any(|(contact, mode)| {
            // Corners that are together stand at the end of the edge, where (C5) goes on.
            if let CornerContact::Open | CornerContact::Corner(_) = mode {
                return false;
            }
            let [left, right] = self.pair_poses(&state.z, contact);
            let pair = self.pair(Self::pair_of(contact));
            // A foot is a part of its edge, from 0 at the one end to 1 at the other.
            let feet = mode
                .carrying()
                .into_iter()
                .flatten()
                .map(|edge| pair.gap(edge, &left, &right).foot);
            feet.into_iter().any(|foot| !(-OFF_EDGE..=1.0 + OFF_EDGE).contains(&foot))
        })
    }

    /// Whether a corner passes round the end of an edge as the path goes on from `point`: it comes to face the edge from behind, and
    /// the model has no contact for the edge that it went through, or for what lies below the bases.
    pub(crate) fn passes_an_end(&self, point: &SkinPoint) -> bool {
        let facing = |state: &SkinState| {
            let mut gaps = vec![None; state.mode.contacts.len()];
            self.for_each(state, |contact, corners| {
                // A closed contact keeps to its edge: `off_edge` looks at it.
                let is_open = state.mode.contacts[contact] == CornerContact::Open;
                gaps[contact] = corners.facing().filter(|_| is_open).map(|(_, gap)| gap);
            });
            gaps
        };
        let here = facing(&point.state);
        AHEAD.iter().any(|&step| {
            let ahead = facing(&point.state.moved(step, &point.leaving));
            let comes_from_behind = |(here, ahead): (&Option<f64>, &Option<f64>)| {
                // A small gap that goes below zero is a contact that closes. A wide or absent one
                // that is far below zero a step later belongs to a corner that came round the end.
                ahead.is_some_and(|gap| gap < -BEHIND && here.is_none_or(|here| here > BEHIND))
            };
            here.iter().zip(&ahead).any(comes_from_behind)
        })
    }

    /// How many pitches apart scales are that have come into each other without a contact; `None` of neighbours, and where a
    /// contact is so soft that a scale is pushed half through its neighbour: what it meets behind it is not to be trusted either.
    pub(crate) fn meeting_beyond(&self, state: &SkinState) -> Option<usize> {
        let scale = self.arrangement.scale(0);
        let half_breadth = scale.half_base() * scale.slant().cos();
        let mut contacts = 0..state.mode.contacts.len();
        let is_soft = contacts.any(|contact| self.approach(state, contact) > half_breadth);
        // The farthest counts: contacts that reach it reach all that are nearer.
        self.overlapping(state).max().filter(|&pitches| pitches > self.reach && !is_soft)
    }

    /// How many pitches apart scales are that overlap by more than the approach of their contacts, of each two.
    pub(crate) fn overlapping(&self, state: &SkinState) -> impl Iterator<Item = usize> {
        let standing = |i| (self.arrangement.scale(i), self.arrangement.place(i));
        let found = overlaps(standing, &self.poses(&state.z));
        found.into_iter().filter_map(|Overlap { left, right, depth }| {
            let pitches = right - left;
            // The numbering of pairs is that of `ends`, read backwards.
            let pair = self.reach * left + pitches - 1;
            // Scales beyond the reach have no contact that would let them approach.
            let allowed = if pitches <= self.reach { self.pair_approach(state, pair) } else { 0.0 };
            (depth > allowed + AUDIT_TOLERANCE).then_some(pitches)
        })
    }

    /// Whether any two neighbours overlap by more than the approach of their contacts. A strip that is bent to a ring
    /// may meet its own other end.
    pub(crate) fn neighbours_interpenetrate(&self, state: &SkinState) -> bool {
        self.pairs(&state.z).any(|(pair, poses)| {
            let allowed = self.pair_approach(state, pair) + AUDIT_TOLERANCE;
            let pair = self.pair(pair);
            let standing = |i: usize| (pair.scales()[i], i as f64 * pair.pitch());
            overlaps(standing, &poses).iter().any(|overlap| overlap.depth > allowed)
        })
    }

    /// The largest approach of the contacts of a pair.
    fn pair_approach(&self, state: &SkinState, pair: usize) -> f64 {
        Self::contacts_of(pair).map(|contact| self.approach(state, contact)).fold(0.0, f64::max)
    }
}
