//! Transitions of contacts with friction at events (Q2).
//!
//! This module changes the friction states. The solver chooses between stick and slip
//! (`solver/src/rate_problem.rs`): it tries transitions until the rates satisfy all constraints.

use contact::{CornerContact, CornerEdge, Force};

use super::friction::{FrictionState, NO_FORCE, SLIP_DISTANCE, STICK_MULTIPLIER};
use super::{Contacts, SkinState};

impl Contacts {
    /// Updates the friction of a pair after a normal force of `contact` began to act or vanished.
    ///
    /// `before` is the state before the transition. `is_back` is true if a corner returns from the
    /// other corner to the edge along which it arrived.
    pub(super) fn update_friction(
        &self,
        state: &mut SkinState,
        before: &SkinState,
        contact: usize,
        is_back: bool,
    ) {
        let pair = [contact, Self::other_contact(contact)];
        // Evaluate ratios in `before`, because the transition moves forces to other unknowns.
        let ratios = pair.map(|contact| self.ratio(before, contact));
        let mut friction_states =
            pair.map(|contact| self.inherited_friction(before, contact, state));
        friction_states[0] = self
            .changed_friction(state, before, contact, ratios[0], is_back)
            .unwrap_or(friction_states[0]);
        if friction_states.iter().all(|friction_state| friction_state.carries_friction())
            && Self::slide_along_one_line(state, contact)
        {
            // A contact that already carried friction remains the carrier, because its anchor is
            // known. The other contact becomes shared.
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

    /// Returns the friction state after a contact closed, opened, or reached or left a corner.
    ///
    /// `ratio` is `T/Λ` before this change. `None` for other changes, after which the contact keeps
    /// its inherited friction state.
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
            // A corner that leaves along the next edge with |T/Λ| = μ continues to slip.
            CornerContact::Corner(_) if self.is_sliding(ratio) && !is_back => {
                Some(FrictionState::Slip { sign: -ratio.signum(), start: here })
            }
            // A corner that returns, or that has a smaller ratio, sticks at the end of its edge. A
            // newly closed contact starts as sticking; the rates decide whether it slips at once.
            CornerContact::Open | CornerContact::Corner(_) => {
                Some(FrictionState::Stick { anchor: here })
            }
            _ => None,
        }
    }

    /// Returns the anchor of a carrier that must stick because it now carries shared friction.
    ///
    /// If both contacts slid in opposite directions, the sum of their friction is below the limit,
    /// so the carrier sticks. `None` if the carrier keeps its friction state `carried`.
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
    /// `before` is the state before the change, and `ratios` are the values of `T/Λ` in it.
    fn set_friction_of_pair(
        &self,
        state: &mut SkinState,
        before: &SkinState,
        pair: [usize; 2],
        ratios: [f64; 2],
        friction_states: [FrictionState; 2],
    ) {
        // Set both friction states before the multipliers: the upper limit of a multiplier depends
        // on which contact is shared.
        for (contact, friction_state) in pair.into_iter().zip(friction_states) {
            state.mode.friction_states[contact] = friction_state;
        }
        let multipliers = [0, 1].map(|k| {
            (ratios[k] + self.law.friction()) * self.own_and_flush_force(&state.z, pair[k])
        });
        for (k, (contact, friction_state)) in pair.into_iter().zip(friction_states).enumerate() {
            // The carrier also takes the tangential force of the shared contact, so that the sum of
            // both forces is continuous.
            let is_carrier = Self::is_shared(&state.mode, pair[1 - k]);
            let shared = if is_carrier { multipliers[1 - k] } else { 0.0 };
            let is_new = before.mode.friction_states[contact] != friction_state;
            self.set_friction(state, contact, multipliers[k] + shared, is_new);
        }
    }

    /// Returns the normal force of a contact: the sum of its own and its flush force.
    pub(super) fn own_and_flush_force(&self, z: &[f64], contact: usize) -> f64 {
        let forces = self.forces_of(z, contact);
        forces[Force::Own as usize] + forces[Force::Flush as usize]
    }

    /// Returns the friction state that a contact keeps across an event.
    ///
    /// Its slip coordinates refer to the edge of the contact in the state `now`, after the event.
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
        // On the same edge, anchors and starts of slip keep their values.
        if !is_shared && before.mode.contacts[contact].edge() == Some(edge) {
            return friction_state;
        }
        // On another edge the slip coordinate has another origin, so use the current position.
        let here = self.slip_coordinate(now, edge, contact);
        match friction_state {
            FrictionState::Stick { .. } => FrictionState::Stick { anchor: here },
            FrictionState::Slip { sign, .. } => FrictionState::Slip { sign, start: here },
            other => other,
        }
    }

    /// Returns true if both contacts of a pair have a corner on a side of the neighbour.
    ///
    /// Both contacts then slide along one line.
    fn slide_along_one_line(state: &SkinState, contact: usize) -> bool {
        [contact, Self::other_contact(contact)].into_iter().all(|contact| {
            match state.mode.contacts[contact] {
                // A tip on the top or base of the neighbour does not slide along the sides.
                CornerContact::Edge(edge) => {
                    !matches!(edge, CornerEdge::TopRightOnTop | CornerEdge::BottomLeftOnBase)
                }
                _ => false,
            }
        })
    }

    /// Sets active flags and values of the friction unknowns of a contact from its friction state.
    ///
    /// `multiplier` is `T + μ Λ`, and `is_new` is true if the friction state has changed.
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
        // The multiplier of a sticking contact lies between 0 and `2 μ Λ`; clamping removes
        // round-off.
        let largest = 2.0 * self.law.friction() * self.normal_force(state, contact);
        // With a tip at the corner the unknown is `T + 2 μ Λ`, larger by `μ Λ`.
        let offset = if state.mode.friction_states[contact] == FrictionState::WithTip {
            0.5 * largest
        } else {
            0.0
        };
        state.z[self.unknown(contact, STICK_MULTIPLIER)] =
            if sticks { multiplier.clamp(0.0, largest.max(0.0)) + offset } else { 0.0 };
        // Reset the slip distance unless the contact continues to slip.
        if is_new || !slips {
            state.z[self.unknown(contact, SLIP_DISTANCE)] = 0.0;
        }
    }

    /// Moves a contact to its next friction state when it starts or stops slipping.
    ///
    /// `slot` is the friction constraint that becomes active or inactive (`acts`). Returns the
    /// constraint of the contact that the outgoing branch must satisfy, or `None` if there is no
    /// such transition.
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
                // After forward slip the multiplier is at its lower limit, zero. After backward
                // slip it is at its upper limit. The outgoing branch must not violate this limit.
                (
                    FrictionState::Stick { anchor: here },
                    if sign > 0.0 { STICK_MULTIPLIER } else { SLIP_DISTANCE },
                )
            }
            _ => return None,
        };
        // Before changing the friction state, compute the multiplier that keeps `T` continuous.
        let multiplier =
            (self.ratio(state, contact) + self.law.friction()) * self.normal_force(state, contact);
        state.mode.friction_states[contact] = friction_state;
        self.set_friction(state, contact, multiplier, true);
        // If the contact has just closed, the outgoing branch must have a compressive force in any
        // friction state.
        Some(if has_force { valid } else { Force::Own as usize })
    }
}
