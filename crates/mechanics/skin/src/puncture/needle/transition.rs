//! Next states of a guided needle when one of its conditions is violated.

use solver::Change;

use super::{BACKWARD, FACE_END, FACE_START, FORWARD, GuidedNeedle, NORMAL};
use crate::contacts::{OutlinePart, SkinState, TipContact, TipState};
use crate::puncture::system::Chain;

/// Difference below which two fractions of a friction limit count as equal.
const SAME_FRACTION: f64 = 1e-6;

impl Chain {
    /// Moves the needle to its next state after a constraint became active or inactive.
    ///
    /// Returns the constraint that must be satisfied on the outgoing branch; `None` if no next
    /// state exists.
    ///
    /// | Tip before | Event | Tip after |
    /// |---|---|---|
    /// | touches one scale | tip reaches a face of the next one | touches both scales, in a notch |
    /// | touches two scales | one normal force vanishes | touches the other scale alone |
    /// | sticks | `\|T\| = μ N` | slides, forward or backward |
    /// | slides | `ξ` reverses | sticks at its current position |
    /// | slides | tip reaches the end of the face | passes over the corner |
    /// | passes over a corner | force at the slip limit on the next face | slides on this face |
    /// | passes over a corner | force returns to its slip limit | sticks at the end of its face |
    pub(in crate::puncture) fn needle_transition(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        change: Change,
    ) -> Option<usize> {
        let number = change.constraint.checked_sub(needle.contacts)?;
        if number >= needle.tilt_number() {
            return None;
        }
        let (slot, constraint) =
            (number / needle.constraints_per_touch, number % needle.constraints_per_touch);
        let slides = (FORWARD..=BACKWARD).contains(&constraint);
        // A round tip begins and ends sliding like a sharp one. All its other transitions differ.
        if needle.is_round() && !(slides && needle.has_friction()) {
            return self.round_transition(needle, state, change);
        }
        let valid = match (constraint, change.activated) {
            (NORMAL, true) => self.enter_notch(needle, state, slot)?,
            (NORMAL, false) => return self.leave(needle, state, slot),
            (FORWARD | BACKWARD, true) => {
                let anchor = self.touch_xi(state, slot)?;
                needle.slide(state, slot, constraint == FORWARD, anchor);
                self.slide_corner(needle, state, slot, constraint == FORWARD);
                constraint
            }
            (FORWARD | BACKWARD, false) => {
                let anchor = self.touch_xi(state, slot)?;
                state.mode.needle.tip_contacts[slot].as_mut()?.tip_state =
                    TipState::Stick { anchor };
                self.stick_corner(needle, state, slot, constraint == FORWARD);
                constraint
            }
            (FACE_START | FACE_END, _) => {
                // These constraints have no force and never become active.
                state.active[change.constraint] = false;
                self.turn_corner(needle, state, slot, constraint == FACE_END)?
            }
            _ => return None,
        };
        Some(needle.number(slot, valid))
    }

    /// Ends the contact of the tip with a notch if its corner has left the neighbouring face.
    ///
    /// The tip stays at the corner.
    pub(in crate::puncture) fn release_notch(&self, needle: &GuidedNeedle, state: &mut SkinState) {
        let Some([face, _]) = self.notch(state) else { return };
        let top = state.mode.needle.tip_contacts[1 - face];
        if top.is_some_and(|top| !self.is_notched(state, top.scale)) {
            // Release the corner before the tip moves: `notch` needs both tip contacts.
            self.release_corner(state);
            self.move_to(
                needle,
                state,
                1 - face,
                OutlinePart::TopRight,
                TipState::Passing { forward: true },
            );
            self.come_to_rest(needle, state, face);
        }
    }

    /// Makes a sliding tip stick at its current position.
    pub(in crate::puncture) fn stop_tip(&self, needle: &GuidedNeedle, state: &mut SkinState) {
        for slot in (0..needle.slots).filter(|_| needle.has_friction()) {
            let touch = state.mode.needle.tip_contacts[slot];
            let slides = touch.filter(|touch| matches!(touch.tip_state, TipState::Slip { .. }));
            let (Some(touch), Some(anchor)) = (slides, self.touch_xi(state, slot)) else {
                continue;
            };
            needle.end_sliding(state, slot);
            state.mode.needle.tip_contacts[slot] =
                Some(TipContact { tip_state: TipState::Stick { anchor }, ..touch });
        }
        self.share_friction(needle, state);
    }

    /// Distributes friction in a notch in proportion to the limits of tip and corner.
    ///
    /// Only the sum of both friction forces matters while both stick, and the sum does not change.
    fn share_friction(&self, needle: &GuidedNeedle, state: &mut SkinState) {
        let Some([face, corner]) = self.notch(state).filter(|_| needle.has_friction()) else {
            return;
        };
        let sticks = state.mode.needle.tip_contacts[face]
            .is_some_and(|touch| matches!(touch.tip_state, TipState::Stick { .. }));
        if !sticks || !self.contacts.has_friction() {
            return;
        }
        self.contacts.stick_with_tip(state, corner, None);
        let Some(friction) = self.contacts.friction_with_tip(state, corner) else { return };
        let normal_force = needle.normal_force(face);
        let of_tip = needle.friction * state.z[normal_force];
        let sum = state.z[normal_force + 1] + friction.traction;
        let fraction = (sum / (of_tip + friction.limit)).clamp(-1.0, 1.0);
        if fraction.is_finite() {
            state.z[normal_force + 1] = fraction * of_tip;
            self.contacts.stick_with_tip(state, corner, Some(fraction));
        }
    }

    /// Makes the corner of a notch slide with the tip on the face of `slot`.
    fn slide_corner(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        slot: usize,
        forward: bool,
    ) {
        let Some(corner) = self.corner_with_tip(needle, state, slot) else { return };
        // A corner that is still locked keeps the ratio with which the notch formed.
        if self.contacts.friction_with_tip(state, corner).is_none() {
            return;
        }
        // Tip and corner of the left scale slide together along the face of the right scale, so
        // their friction forces on this face have the same sign.
        self.contacts.lock(state, corner, Some(if forward { 1.0 } else { -1.0 }));
    }

    /// Makes the corner of a notch stick together with the tip, after both slid.
    ///
    /// The tip stops on the face in `slot`. A corner below its friction limit stays locked.
    fn stick_corner(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        slot: usize,
        was_forward: bool,
    ) {
        let Some(corner) = self.corner_with_tip(needle, state, slot) else { return };
        let sign = if was_forward { 1.0 } else { -1.0 };
        if sign * self.contacts.mobilised(state, corner) > 1.0 - SAME_FRACTION {
            self.contacts.stick_with_tip(state, corner, None);
        }
    }

    /// Returns the contact of the corner of a notch if the tip has friction on the face in `slot`.
    fn corner_with_tip(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        slot: usize,
    ) -> Option<usize> {
        let notch = self.notch(state).filter(|[face, _]| *face == slot && needle.has_friction());
        notch.map(|[_, corner]| corner)
    }

    /// Returns the slip coordinate `ξ` of the tip contact in a slot.
    fn touch_xi(&self, state: &SkinState, slot: usize) -> Option<f64> {
        let touch = state.mode.needle.tip_contacts[slot]?;
        Some(self.tip_kinematics(&state.z, touch.scale, touch.part)?.xi())
    }

    /// Adds the contact of a sharp tip with a second scale, so that the tip rests in a notch.
    ///
    /// Returns the constraint, within its tip contact, that must hold on the outgoing branch.
    fn enter_notch(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        slot: usize,
    ) -> Option<usize> {
        let other = state.mode.needle.tip_contacts[1 - slot]?;
        let (scale, part) = Self::next_touch(&other)?;
        let anchor = self.tip(&state.z, scale, part)?.xi;
        let is_locked = |scale, part| part == OutlinePart::Top && self.is_notched(state, scale);
        let (new_is_locked, other_is_locked) =
            (is_locked(scale, part), is_locked(other.scale, other.part));
        let tip_state =
            if new_is_locked { TipState::Locked { ratio: 0.0 } } else { needle.resting(anchor) };
        state.mode.needle.tip_contacts[slot] = Some(TipContact { scale, part, tip_state });
        if other_is_locked {
            let normal_force = needle.normal_force(1 - slot);
            let ratio = state.z[normal_force + 1] / state.z[normal_force];
            // A tip without normal force has no friction, so its ratio is 0.
            let ratio = if ratio.is_finite() { ratio } else { 0.0 };
            needle.end_sliding(state, 1 - slot);
            state.mode.needle.tip_contacts[1 - slot] =
                Some(TipContact { tip_state: TipState::Locked { ratio }, ..other });
        }
        if let Some([_, corner]) = self.notch(state).filter(|_| needle.friction > 0.0) {
            // Tip and corner are at the same point of the face, so two stick equations would be
            // redundant. Lock the corner instead. Its force does not change, so the path continues
            // without a jump.
            self.contacts.lock(state, corner, None);
        }
        Some(NORMAL)
    }

    /// Finds the slot of the tip contact on the face of a notch, and the contact of its corner.
    ///
    /// `None` if the tip is not in a notch.
    pub(super) fn notch(&self, state: &SkinState) -> Option<[usize; 2]> {
        let touches = &state.mode.needle.tip_contacts;
        let top = touches.iter().position(|touch| {
            touch.as_ref().is_some_and(|touch| touch.part == OutlinePart::Top && touch.is_locked())
        })?;
        Some([1 - top, self.corner_of_notch(touches[top]?.scale)?])
    }

    /// Opens one of two tip contacts; the contact in the other slot remains.
    ///
    /// Returns the constraint that must hold on the outgoing branch; `None` for a single contact.
    fn leave(&self, needle: &GuidedNeedle, state: &mut SkinState, slot: usize) -> Option<usize> {
        // The only contact of the tip cannot open, because the load must act on a scale.
        state.mode.needle.tip_contacts[1 - slot]?;
        // Release the corner before the contact opens: `notch` needs both tip contacts.
        self.release_corner(state);
        needle.end_sliding(state, slot);
        state.z[needle.normal_force(slot) + 1] = 0.0;
        state.mode.needle.tip_contacts[slot] = None;
        if !state.mode.needle.tip_contacts[1 - slot]?.is_locked() {
            return Some(needle.number(slot, NORMAL));
        }
        self.come_to_rest(needle, state, 1 - slot);
        if needle.friction == 0.0 {
            // The tip slides on the top of the left scale, away from the face of the right scale.
            return Some(needle.number(slot, NORMAL));
        }
        let [normal, tangential] = needle.forces(&state.z, 1 - slot);
        if tangential.abs() < (1.0 - SAME_FRACTION) * needle.friction * normal {
            // The tip sticks at the corner, as it did when the notch formed.
            return Some(needle.number(slot, NORMAL));
        }
        // While the corner stays on the face and the tip at the corner, no gap opens, so the gap
        // cannot determine the outgoing branch. The friction force is at its limit, and its sign
        // selects the slip condition that determines the branch.
        let is_forward = tangential >= 0.0;
        Some(needle.number(1 - slot, if is_forward { FORWARD } else { BACKWARD }))
    }

    /// Releases the friction of the corner of a notch that the tip leaves.
    fn release_corner(&self, state: &mut SkinState) {
        let Some([face, corner]) = self.notch(state) else { return };
        let touch = state.mode.needle.tip_contacts[face];
        let slides = touch.is_some_and(|touch| matches!(touch.tip_state, TipState::Slip { .. }));
        self.contacts.release(state, corner, slides);
    }

    /// Makes a tip that was locked in a notch stick or, without friction, slide freely.
    fn come_to_rest(&self, needle: &GuidedNeedle, state: &mut SkinState, slot: usize) {
        let anchor = self.touch_xi(state, slot);
        if let (Some(touch), Some(anchor)) = (&mut state.mode.needle.tip_contacts[slot], anchor)
            && touch.is_locked()
        {
            touch.tip_state = needle.resting(anchor);
        }
    }

    /// Moves a sharp tip from the end of its face to the corner, or from a corner to a face.
    ///
    /// `onward` is true in the direction from the left to the right foot. Returns the constraint,
    /// within its tip contact, that must hold on the outgoing branch.
    fn turn_corner(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        slot: usize,
        onward: bool,
    ) -> Option<usize> {
        let touch = state.mode.needle.tip_contacts[slot]?;
        let next = touch.part.next(onward)?;
        needle.end_sliding(state, slot);
        let TipState::Passing { forward } = touch.tip_state else {
            self.move_to(needle, state, slot, next, TipState::Passing { forward: onward });
            // The force is at the slip limit on the previous face and must not exceed it.
            return Some(if onward { FACE_START } else { FACE_END });
        };
        let face_length = self.tip(&state.z, touch.scale, next)?.length;
        let anchor = if onward { 0.0 } else { face_length };
        let inward = if onward { FACE_START } else { FACE_END };
        // Without friction the tip slides on both faces, in either direction.
        if needle.friction == 0.0 {
            self.move_to(needle, state, slot, next, needle.resting(anchor));
            return Some(inward);
        }
        if forward == onward {
            let (sign, sliding) = if onward { (1.0, FORWARD) } else { (-1.0, BACKWARD) };
            self.move_to(needle, state, slot, next, TipState::Slip { sign, start: anchor });
            state.active[needle.number(slot, sliding)] = true;
            return Some(inward);
        }
        // The friction force is at its slip limit, so the rate problem decides at this event
        // whether the tip sticks or slips back.
        self.move_to(needle, state, slot, next, TipState::Stick { anchor });
        Some(if onward { BACKWARD } else { FORWARD })
    }

    /// Moves the tip contact in a slot to another outline part of the same scale.
    ///
    /// The force is resolved along the new normal and tangent.
    fn move_to(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        slot: usize,
        part: OutlinePart,
        tip_state: TipState,
    ) {
        let Some(touch) = state.mode.needle.tip_contacts[slot] else { return };
        let seen = |part| self.tip(&state.z, touch.scale, part);
        let (Some(before), Some(after)) = (seen(touch.part), seen(part)) else { return };
        let normal_force = needle.normal_force(slot);
        let force = before.force([state.z[normal_force], state.z[normal_force + 1]]);
        [state.z[normal_force], state.z[normal_force + 1]] = after.parts(force);
        state.mode.needle.tip_contacts[slot] = Some(TipContact { part, tip_state, ..touch });
    }
}

impl GuidedNeedle {
    /// Returns the friction state of a tip at rest: sticking, or without friction free to slide.
    pub(super) fn resting(&self, anchor: f64) -> TipState {
        if self.friction == 0.0 {
            TipState::Slip { sign: 0.0, start: anchor }
        } else {
            TipState::Stick { anchor }
        }
    }

    /// Makes the tip contact in a slot slide, forward or backward, from the coordinate `start`.
    pub(super) fn slide(&self, state: &mut SkinState, slot: usize, forward: bool, start: f64) {
        let (sign, constraint) = if forward { (1.0, FORWARD) } else { (-1.0, BACKWARD) };
        if let Some(touch) = &mut state.mode.needle.tip_contacts[slot] {
            touch.tip_state = TipState::Slip { sign, start };
            state.active[self.number(slot, constraint)] = true;
        }
    }

    /// Resets the slip distances of the tip contact in a slot and makes them inactive.
    pub(super) fn end_sliding(&self, state: &mut SkinState, slot: usize) {
        for constraint in [FORWARD, BACKWARD] {
            state.active[self.number(slot, constraint)] = false;
            state.z[self.normal_force(slot) + 1 + constraint] = 0.0;
        }
    }
}
