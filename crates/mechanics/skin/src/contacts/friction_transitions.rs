//! Transitions of contacts with friction at events (Q2).
//!
//! This module carries out transitions. The rate problem of the solver (`solver/src/rate_problem.rs`)
//! chooses between stick and slip: it tries transitions until the rates satisfy all constraints.

use contact::{CornerContact, CornerEdge, Force};

use super::friction::{FrictionState, NO_FORCE, SLIP_DISTANCE, STICK_MULTIPLIER};
use super::{Contacts, SkinState};

impl Contacts {
    /// Updates the friction of a pair after a force of `contact` changed sides.
    ///
    /// `before` is the state at the event. `is_back` is true if parting corners return to the
    /// previous edge.
    pub(super) fn update_friction(
        &self,
        state: &mut SkinState,
        before: &SkinState,
        contact: usize,
        is_back: bool,
    ) {
        let pair = [contact, Self::other_contact(contact)];
        // Evaluate ratios before the change, because afterwards the forces are in other unknowns.
        let ratios = pair.map(|contact| self.ratio(before, contact));
        let mut friction_states =
            pair.map(|contact| self.inherited_friction(before, contact, state));
        friction_states[0] = self
            .changed_friction(state, before, contact, ratios[0], is_back)
            .unwrap_or(friction_states[0]);
        if friction_states.iter().all(|friction_state| friction_state.carries_friction())
            && Self::slide_along_one_line(state, contact)
        {
            // The previous carrier stays the carrier, because its anchor is known.
            let shared = usize::from(before.mode.friction_states[contact].carries_friction());
            friction_states[shared] = FrictionState::None;
            if let Some(anchor) =
                self.anchor_of_carrier(state, pair, ratios, friction_states[1 - shared], shared)
            {
                friction_states[1 - shared] = FrictionState::Stick { anchor };
            }
        }
        self.set_friction_of_pair(state, before, pair, ratios, friction_states);
    }

    /// Returns the friction state of a contact that closes, opens, or reaches or leaves a corner.
    ///
    /// `ratio` is `T/Λ` before the change. `None` for other changes, after which the contact keeps
    /// the inherited friction.
    fn changed_friction(
        &self,
        state: &SkinState,
        before: &SkinState,
        contact: usize,
        ratio: f64,
        is_back: bool,
    ) -> Option<FrictionState> {
        if let CornerContact::Corner(_) = state.mode.contacts[contact] {
            return Some(FrictionState::Locked { ratio });
        }
        let Some(edge) = state.mode.contacts[contact].edge() else {
            return Some(FrictionState::None);
        };
        let here = self.slip_coordinate(state, edge, contact);
        match before.mode.contacts[contact] {
            // A corner that continues with the sliding ratio slips on along the next edge.
            CornerContact::Corner(_) if self.is_sliding(ratio) && !is_back => {
                Some(FrictionState::Slip { sign: -ratio.signum(), start: here })
            }
            // A corner that returns, or has a smaller ratio, sticks at the end of its edge. A newly
            // closed contact has not slid yet; the rates decide whether it slips at once.
            CornerContact::Open | CornerContact::Corner(_) => {
                Some(FrictionState::Stick { anchor: here })
            }
            _ => None,
        }
    }

    /// Returns the anchor of a carrier that stops slipping under the friction of both contacts.
    ///
    /// Two contacts that slid in opposite directions have less friction than the limit together.
    /// `None` if the carrier keeps its friction state `carried`.
    fn anchor_of_carrier(
        &self,
        state: &SkinState,
        pair: [usize; 2],
        ratios: [f64; 2],
        carried: FrictionState,
        shared: usize,
    ) -> Option<f64> {
        let normal = pair.map(|contact| self.own_and_flush_force(&state.z, contact));
        let sum = ratios[0] * normal[0] + ratios[1] * normal[1];
        let carrier = pair[1 - shared];
        let edge = state.mode.contacts[carrier].edge()?;
        let slips = matches!(carried, FrictionState::Slip { .. });
        (slips && !self.is_sliding(sum / (normal[0] + normal[1])))
            .then(|| self.slip_coordinate(state, edge, carrier))
    }

    /// Sets the friction states of a pair and the unknowns that belong to them.
    ///
    /// `ratios` are the values of `T/Λ` before the change.
    fn set_friction_of_pair(
        &self,
        state: &mut SkinState,
        before: &SkinState,
        pair: [usize; 2],
        ratios: [f64; 2],
        friction_states: [FrictionState; 2],
    ) {
        // Set both states first: the normal force that bounds a multiplier depends on which contact
        // is shared.
        for (contact, friction_state) in pair.into_iter().zip(friction_states) {
            state.mode.friction_states[contact] = friction_state;
        }
        let multipliers = [0, 1].map(|k| {
            (ratios[k] + self.law.friction()) * self.own_and_flush_force(&state.z, pair[k])
        });
        for (k, (contact, friction_state)) in pair.into_iter().zip(friction_states).enumerate() {
            // The carrier takes over the tangential force of the shared contact, so their sum is
            // continuous.
            let is_carrier = Self::is_shared(&state.mode, pair[1 - k]);
            let shared = if is_carrier { multipliers[1 - k] } else { 0.0 };
            let is_new = before.mode.friction_states[contact] != friction_state;
            self.set_friction(state, contact, multipliers[k] + shared, is_new);
        }
    }

    /// Returns the normal force of a contact on its edge.
    pub(super) fn own_and_flush_force(&self, z: &[f64], contact: usize) -> f64 {
        let forces = self.forces_of(z, contact);
        forces[Force::Own as usize] + forces[Force::Flush as usize]
    }

    /// Returns the friction that a contact inherits, on its edge in the state `now`.
    fn inherited_friction(
        &self,
        before: &SkinState,
        contact: usize,
        now: &SkinState,
    ) -> FrictionState {
        let is_shared = Self::is_shared(&before.mode, contact);
        let from = if is_shared { Self::other_contact(contact) } else { contact };
        let friction_state = before.mode.friction_states[from];
        let Some(edge) = now.mode.contacts[contact].edge() else { return FrictionState::None };
        // On the same edge the anchor, or the start of slip, is unchanged.
        if !is_shared && before.mode.contacts[contact].edge() == Some(edge) {
            return friction_state;
        }
        // On another edge the slip coordinate has another origin.
        let here = self.slip_coordinate(now, edge, contact);
        match friction_state {
            FrictionState::Stick { .. } => FrictionState::Stick { anchor: here },
            FrictionState::Slip { sign, .. } => FrictionState::Slip { sign, start: here },
            other => other,
        }
    }

    /// Returns true if the sides of a pair lie on each other at both contacts.
    fn slide_along_one_line(state: &SkinState, contact: usize) -> bool {
        [contact, Self::other_contact(contact)].into_iter().all(|contact| {
            match state.mode.contacts[contact] {
                // A tip on the top or base of its neighbour slides along that, not along the sides.
                CornerContact::Edge(edge) => {
                    !matches!(edge, CornerEdge::TopRightOnTop | CornerEdge::BottomLeftOnBase)
                }
                _ => false,
            }
        })
    }

    /// Sets active flags and values of the friction unknowns of a contact.
    pub(super) fn set_friction(
        &self,
        state: &mut SkinState,
        contact: usize,
        multiplier: f64,
        is_new: bool,
    ) {
        let [sticks, slips] = state.mode.friction_states[contact].acting();
        let first = self.slots * contact;
        [state.active[first + STICK_MULTIPLIER], state.active[first + SLIP_DISTANCE]] =
            [sticks, slips];
        // While sticking the multiplier is in `[0, 2 μ Λ]`; clamp it against round-off.
        let largest = 2.0 * self.law.friction() * self.normal_force(state, contact);
        // With a tip at the corner the unknown is larger by `μ Λ`.
        let offset = if state.mode.friction_states[contact] == FrictionState::WithTip {
            0.5 * largest
        } else {
            0.0
        };
        state.z[self.unknown(contact, STICK_MULTIPLIER)] =
            if sticks { multiplier.clamp(0.0, largest.max(0.0)) + offset } else { 0.0 };
        // A contact that keeps slipping keeps its slip distance.
        if is_new || !slips {
            state.z[self.unknown(contact, SLIP_DISTANCE)] = 0.0;
        }
    }

    /// Moves a contact to its next friction state where it starts or stops slipping.
    ///
    /// Returns the constraint that must hold on the outgoing branch, or `None` if there
    /// is no such transition.
    ///
    /// | Before | Condition | After |
    /// |---|---|---|
    /// | sticks | `T = −μ Λ` | slips forward |
    /// | sticks | `T = μ Λ` | slips backward |
    /// | slips | `s` reverses | sticks at its current position |
    pub(super) fn change_friction(
        &self,
        state: &mut SkinState,
        contact: usize,
        slot: usize,
        acts: bool,
    ) -> Option<usize> {
        let here = self.slip_coordinate(state, state.mode.contacts[contact].edge()?, contact);
        let has_force = self.normal_force(state, contact) > NO_FORCE;
        let (friction_state, valid) = match (state.mode.friction_states[contact], slot, acts) {
            (FrictionState::Stick { .. }, STICK_MULTIPLIER, false) => {
                (FrictionState::Slip { sign: 1.0, start: here }, SLIP_DISTANCE)
            }
            (FrictionState::Stick { .. }, SLIP_DISTANCE, true) => {
                (FrictionState::Slip { sign: -1.0, start: here }, SLIP_DISTANCE)
            }
            (FrictionState::Slip { sign, .. }, SLIP_DISTANCE, false) => {
                // After forward slip the multiplier is zero, after backward slip it is at its
                // maximum: that limit has to hold after the contact has stopped.
                (
                    FrictionState::Stick { anchor: here },
                    if sign > 0.0 { STICK_MULTIPLIER } else { SLIP_DISTANCE },
                )
            }
            _ => return None,
        };
        // Compute the multiplier that keeps `T` continuous while the mode still holds the old
        // ratio.
        let multiplier =
            (self.ratio(state, contact) + self.law.friction()) * self.normal_force(state, contact);
        state.mode.friction_states[contact] = friction_state;
        self.set_friction(state, contact, multiplier, true);
        // A contact that has just closed must carry a compressive force, whatever its friction
        // state.
        Some(if has_force { valid } else { Force::Own as usize })
    }
}
