//! Contact energy, and the audit of the final state.

use contact::{CornerContact, Overlap, overlaps};
use geometry::Vec2;

use super::{Contacts, SkinPoint, SkinState};

/// Overlap (over `t`) beyond the contact law that the audit accepts.
///
/// It covers the round-off of the collision query.
const AUDIT_TOLERANCE: f64 = 1e-8;

/// Fraction of an edge by which a foot may exceed its end: round-off of the path.
const OFF_EDGE: f64 = 1e-6;

/// Extrapolation distances beyond the end of a path, in path units.
///
/// Step sizes were reduced to 1e-9 before the path stopped.
const AHEAD: [f64; 4] = [1e-8, 1e-7, 1e-6, 1e-5];

/// Smallest jump of the penetration, over `t`, where a corner passes an edge end.
///
/// The jump occurs within one of the steps [`AHEAD`].
const BEHIND: f64 = 1e-3;

impl Contacts {
    /// Computes the forces of a contact on its left scale, including friction.
    ///
    /// The first acts at the corner or corners, the second at the flush contact.
    pub(super) fn forces_on_left(&self, state: &SkinState, contact: usize) -> [Vec2; 2] {
        let [on_corners, on_flush] = self.normal_forces_on_left(state, contact);
        if self.has_friction() {
            [on_corners + self.traction_on_left(state, contact, on_corners), on_flush]
        } else {
            [on_corners, on_flush]
        }
    }

    /// Computes the normal components of the contact forces.
    ///
    /// The contact law relates them to the approach.
    fn normal_forces_on_left(&self, state: &SkinState, contact: usize) -> [Vec2; 2] {
        let poses = self.pair_poses(&state.z, contact);
        let forces = self.forces_of(&state.z, contact);
        state.mode.contacts[contact].forces_on_left(&self.corners(contact, &poses), forces)
    }

    /// Computes the total normal force of a contact, the argument of the contact law.
    fn force(&self, state: &SkinState, contact: usize) -> f64 {
        match state.mode.contacts[contact] {
            CornerContact::Open => 0.0,
            // The law uses the magnitude of the rotating force at a corner (C5), and the sum of
            // both forces on flush edges (C7).
            _ => self.normal_forces_on_left(state, contact).map(|force| force.norm()).iter().sum(),
        }
    }

    /// Computes the approach of the scales at a contact, over `t`.
    pub(super) fn approach(&self, state: &SkinState, contact: usize) -> f64 {
        self.law.approach(self.force(state, contact)).value
    }

    /// Computes the elastic energy of all contacts.
    pub(crate) fn energy(&self, state: &SkinState) -> f64 {
        (0..state.mode.contacts.len())
            .map(|contact| self.law.energy(self.force(state, contact)))
            .sum()
    }

    /// Returns true if any contact carries force beyond an end of its edge.
    ///
    /// Beyond the end near the partner corner the contact would have left its edge; beyond the
    /// other end the model has no contact to continue with.
    pub(crate) fn off_edge(&self, state: &SkinState) -> bool {
        let contacts = state.mode.contacts.iter().enumerate();
        contacts.into_iter().any(|(contact, mode)| {
            // Coinciding corners are at the end of the edge, where (C5) applies.
            if let CornerContact::Open | CornerContact::Corner(_) = mode {
                return false;
            }
            let [left, right] = self.pair_poses(&state.z, contact);
            let pair = self.pair(Self::pair_of(contact));
            // A foot is a fraction of its edge, from 0 at one end to 1 at the other.
            let feet = mode
                .carrying()
                .into_iter()
                .flatten()
                .map(|edge| pair.gap(edge, &left, &right).foot);
            feet.into_iter().any(|foot| !(-OFF_EDGE..=1.0 + OFF_EDGE).contains(&foot))
        })
    }

    /// Returns true if a corner passes an end of an edge just beyond `point`.
    ///
    /// The corner then faces the edge from behind, and the model has no contact for the edge that
    /// it crossed or for the region below the bases.
    pub(crate) fn passes_an_end(&self, point: &SkinPoint) -> bool {
        let here = self.open_gaps(&point.state);
        AHEAD.iter().any(|&step| {
            let ahead = self.open_gaps(&point.state.moved(step, &point.leaving));
            here.iter().zip(&ahead).any(|(here, ahead)| {
                // A small gap that becomes negative is a closing contact. A wide or missing gap
                // that is strongly negative one step later belongs to a corner that passed the end
                // of an edge.
                ahead.is_some_and(|gap| gap < -BEHIND && here.is_none_or(|here| here > BEHIND))
            })
        })
    }

    /// Returns the gap of each open contact that has a corner in front of an edge.
    fn open_gaps(&self, state: &SkinState) -> Vec<Option<f64>> {
        let mut gaps = vec![None; state.mode.contacts.len()];
        self.for_each(state, |contact, corners| {
            // Closed contacts stay on their edge; `off_edge` checks them.
            let is_open = state.mode.contacts[contact] == CornerContact::Open;
            gaps[contact] = corners.facing().filter(|_| is_open).map(|(_, gap)| gap);
        });
        gaps
    }

    /// Returns the distance in pitches of overlapping scales without a contact.
    ///
    /// `None` for direct neighbours, and if a contact is so soft that a scale is pushed half
    /// through its neighbour: overlaps behind it are then not meaningful.
    pub(crate) fn meeting_beyond(&self, state: &SkinState) -> Option<usize> {
        let scale = self.arrangement.scale(0);
        let half_breadth = scale.half_base() * scale.slant().cos();
        let mut contacts = 0..state.mode.contacts.len();
        let is_soft = contacts.any(|contact| self.approach(state, contact) > half_breadth);
        // Use the largest distance: a contact reach that covers it covers all shorter ones.
        let overlapping = self.overlapping(state, |_| 0.0).into_iter();
        overlapping.max().filter(|&pitches| pitches > self.reach && !is_soft)
    }

    /// Lists the distances in pitches of scales that overlap.
    ///
    /// They overlap by more than their contact approach and the `slack` of their pair.
    pub(crate) fn overlapping(
        &self,
        state: &SkinState,
        slack: impl Fn(usize) -> f64,
    ) -> Vec<usize> {
        let found = overlaps(
            |i| (self.arrangement.scale(i), self.frame_at(i).origin),
            &self.poses(&state.z),
        );
        let mut distances = Vec::new();
        for Overlap { left, right, depth } in found {
            let pitches = right - left;
            // Inverse of the pair numbering in `ends`.
            let pair = self.reach * left + pitches - 1;
            // Scales beyond the reach have no contact, so no overlap is allowed.
            let allowed = if pitches <= self.reach {
                self.pair_approach(state, pair) + slack(pair)
            } else {
                0.0
            };
            if depth > allowed + AUDIT_TOLERANCE {
                distances.push(pitches);
            }
        }
        distances
    }

    /// Returns true if two neighbours overlap by more than their contact approach.
    ///
    /// Only neighbours are checked, because a strip bent to a ring may overlap its other end.
    pub(crate) fn neighbours_interpenetrate(&self, state: &SkinState) -> bool {
        self.pairs(&state.z).any(|(pair, poses)| {
            let allowed = self.pair_approach(state, pair) + AUDIT_TOLERANCE;
            let pair = self.pair(pair);
            overlaps(|i| (pair.scales()[i], i as f64 * pair.offset()), &poses)
                .iter()
                .any(|overlap| overlap.depth > allowed)
        })
    }

    /// Returns the largest approach of the contacts of a pair.
    fn pair_approach(&self, state: &SkinState, pair: usize) -> f64 {
        Self::contacts_of(pair).map(|contact| self.approach(state, contact)).fold(0.0, f64::max)
    }
}
