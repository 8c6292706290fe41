//! Contact forces and energy, and the audit of the final state for overlaps.

use contact::{CornerContact, Overlap, overlaps};
use geometry::Vec2;

use super::{Contacts, SkinPoint, SkinState};

/// Overlap in units of `t` that the audit accepts in addition to the approach of the contact law.
///
/// It covers the round-off in the computation of overlaps.
const AUDIT_TOLERANCE: f64 = 1e-8;

/// Distance by which a contact may lie beyond an end of its edge, divided by the edge length.
///
/// The distance permits round-off.
const OFF_EDGE: f64 = 1e-6;

/// Multiples of the path direction at which states beyond the end of a path are checked.
///
/// The solver reduced its steps to 1e-9 before the path stopped.
const AHEAD: [f64; 4] = [1e-8, 1e-7, 1e-6, 1e-5];

/// Gap in units of `t` that distinguishes a corner passing an edge end from a closing contact.
///
/// If a corner passes the end of an edge, its gap jumps below `−GAP_JUMP` within one of the steps
/// [`AHEAD`].
const GAP_JUMP: f64 = 1e-3;

impl Contacts {
    /// Computes the two forces of a contact on its left scale, including friction.
    ///
    /// The first force acts at the touching corner, the second at the flush contact, if any.
    pub(super) fn forces_on_left(&self, state: &SkinState, contact: usize) -> [Vec2; 2] {
        let [on_corners, on_flush] = self.normal_forces_on_left(state, contact);
        if self.has_friction() {
            [on_corners + self.traction_on_left(state, contact, on_corners), on_flush]
        } else {
            [on_corners, on_flush]
        }
    }

    /// Computes the forces of [`Self::forces_on_left`] without friction.
    fn normal_forces_on_left(&self, state: &SkinState, contact: usize) -> [Vec2; 2] {
        let poses = self.pair_poses(&state.z, contact);
        let forces = self.forces_of(&state.z, contact);
        state.mode.contacts[contact].forces_on_left(&self.corners(contact, &poses), forces)
    }

    /// Computes the normal force of a contact that enters the contact law.
    fn force(&self, state: &SkinState, contact: usize) -> f64 {
        match state.mode.contacts[contact] {
            CornerContact::Open => 0.0,
            // At a corner the law uses the magnitude of the resultant (C5), on flush edges the sum
            // of both forces (C7).
            _ => self.normal_forces_on_left(state, contact).map(|force| force.norm()).iter().sum(),
        }
    }

    /// Computes the approach `δ` of the two scales at a contact, in units of `t`.
    pub(super) fn approach(&self, state: &SkinState, contact: usize) -> f64 {
        self.law.approach(self.force(state, contact)).value
    }

    /// Computes the elastic energy of all contacts.
    pub(crate) fn energy(&self, state: &SkinState) -> f64 {
        (0..state.mode.contacts.len())
            .map(|contact| self.law.energy(self.force(state, contact)))
            .sum()
    }

    /// Returns true if any closed contact lies beyond an end of its edge.
    ///
    /// Beyond the end near the partner corner the contact should have changed its state. Beyond the
    /// other end the model has no contact.
    pub(crate) fn off_edge(&self, state: &SkinState) -> bool {
        let contacts = state.mode.contacts.iter().enumerate();
        contacts.into_iter().any(|(contact, mode)| {
            // Coinciding corners lie at the end of the edge by definition (C5).
            if let CornerContact::Open | CornerContact::Corner(_) = mode {
                return false;
            }
            let [left, right] = self.pair_poses(&state.z, contact);
            let pair = self.pair(Self::pair_of(contact));
            // `foot` is the position along an edge, from 0 at one end to 1 at the other end.
            let feet = mode
                .carrying()
                .into_iter()
                .flatten()
                .map(|edge| pair.gap(edge, &left, &right).foot);
            feet.into_iter().any(|foot| !(-OFF_EDGE..=1.0 + OFF_EDGE).contains(&foot))
        })
    }

    /// Returns true if the path leads an open corner past an end of an edge just beyond `point`.
    ///
    /// Behind the edge the corner lies inside the other scale or below the bases, and the model has
    /// no contact for these positions.
    pub(crate) fn passes_an_end(&self, point: &SkinPoint) -> bool {
        let here = self.open_gaps(&point.state);
        AHEAD.iter().any(|&step| {
            let ahead = self.open_gaps(&point.state.moved(step, &point.leaving));
            here.iter().zip(&ahead).any(|(here, ahead)| {
                // If a small gap becomes negative, the contact closes. If a wide or undefined gap
                // is strongly negative one step later, the corner has passed the end of an edge.
                ahead.is_some_and(|gap| gap < -GAP_JUMP && here.is_none_or(|here| here > GAP_JUMP))
            })
        })
    }

    /// Returns the gap of each contact; `None` if it is closed or no corner faces an edge.
    fn open_gaps(&self, state: &SkinState) -> Vec<Option<f64>> {
        let mut gaps = vec![None; state.mode.contacts.len()];
        self.for_each(state, |contact, corners| {
            // `off_edge` checks closed contacts.
            let is_open = state.mode.contacts[contact] == CornerContact::Open;
            gaps[contact] = corners.facing().filter(|_| is_open).map(|(_, gap)| gap);
        });
        gaps
    }

    /// Returns the largest distance, in pitches, of overlapping scales beyond the contact reach.
    ///
    /// `None` if no scales beyond the reach overlap. Also `None` if a contact is so soft that a
    /// scale is pushed half through its neighbour, because overlaps of scales farther away are then
    /// not meaningful.
    pub(crate) fn overlapping_beyond_reach(&self, state: &SkinState) -> Option<usize> {
        let scale = self.arrangement.scale(0);
        let half_breadth = scale.half_base() * scale.slant().cos();
        let mut contacts = 0..state.mode.contacts.len();
        let is_soft = contacts.any(|contact| self.approach(state, contact) > half_breadth);
        // A contact reach equal to the largest distance covers all shorter distances.
        let overlapping = self.overlapping(state, |_| 0.0).into_iter();
        overlapping.max().filter(|&pitches| pitches > self.reach && !is_soft)
    }

    /// Lists the distances, in pitches, of all pairs of scales with an inadmissible overlap.
    ///
    /// An overlap is inadmissible if it is deeper than the approach of the contacts of the pair
    /// plus `slack(pair)`.
    pub(crate) fn overlapping(
        &self,
        state: &SkinState,
        slack: impl Fn(usize) -> f64,
    ) -> Vec<usize> {
        let overlaps = overlaps(
            |i| (self.arrangement.scale(i), self.frame_at(i).origin),
            &self.poses(&state.z),
        );
        let mut distances = Vec::new();
        for Overlap { left, right, depth } in overlaps {
            let pitches = right - left;
            // Number of the pair; this inverts `ends`.
            let pair = self.reach * left + pitches - 1;
            // Scales beyond the reach have no contact, so they must not overlap.
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

    /// Returns true if two neighbours overlap by more than the approach of their contacts.
    ///
    /// Checks neighbours only, because the two ends of a strip bent to a ring may overlap.
    pub(crate) fn neighbours_interpenetrate(&self, state: &SkinState) -> bool {
        self.pairs(&state.z).any(|(pair, poses)| {
            let allowed = self.pair_approach(state, pair) + AUDIT_TOLERANCE;
            let pair = self.pair(pair);
            overlaps(|i| (pair.scales()[i], i as f64 * pair.offset()), &poses)
                .iter()
                .any(|overlap| overlap.depth > allowed)
        })
    }

    /// Returns the larger approach of the two contacts of a pair, in units of `t`.
    fn pair_approach(&self, state: &SkinState, pair: usize) -> f64 {
        Self::contacts_of(pair).map(|contact| self.approach(state, contact)).fold(0.0, f64::max)
    }
}
