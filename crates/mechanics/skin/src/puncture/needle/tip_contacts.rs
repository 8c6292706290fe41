//! Contacts of the needle tip with the scales of a row.

use contact::{CornerContact, CornerEdge};
use geometry::{Frame, Vec2};
use solver::{Condition, Newton};

use super::outline::{Face, Tip, TipKinematics};
use super::{GuidedNeedle, NORMAL};
use crate::contacts::{Contacts, OutlinePart, SkinState, TipContact};
use crate::puncture::system::Chain;

impl GuidedNeedle {
    /// Returns the needle constraint that ended a path in the state `end`.
    ///
    /// `None` if the path ended for another reason.
    pub(in crate::puncture) fn ended_at(&self, chain: &Chain, end: &SkinState) -> Option<usize> {
        let mut conditions = Vec::new();
        chain.needle_conditions(self, end, &mut conditions);
        let touches = (0..self.slots).map(|slot| self.constraints_per_touch * slot + NORMAL);
        let touches = touches.filter(|&number| chain.meets_tilted(self, end, number));
        let mut ends = self.endings().chain(touches);
        // The condition of this constraint is zero to within the tolerance of Newton's method.
        let ended = ends.find(|&number| conditions[number].abs() < 1e-8);
        ended.map(|number| self.contacts + number)
    }

    /// Returns true if a change of this constraint ends the path.
    ///
    /// The path ends when a touched scale reaches the critical tilt, when the tip first touches a
    /// scale that is already tilted beyond the critical tilt, and when the needle reaches the soft
    /// surface.
    pub(in crate::puncture) fn ends(
        &self,
        chain: &Chain,
        state: &SkinState,
        constraint: usize,
    ) -> bool {
        constraint.checked_sub(self.contacts).is_some_and(|number| {
            self.endings().contains(&number) || chain.meets_tilted(self, state, number)
        })
    }
}

impl Chain {
    /// Returns the state at rest with the needle on the row.
    ///
    /// The rates of the tip forces decide whether the tip sticks or slides at first, and in which
    /// direction.
    pub(in crate::puncture) fn at_rest(&self) -> SkinState {
        let mut rest = SkinState::at_rest(self);
        let Some(needle) = &self.needle else { return rest };
        if needle.is_round() {
            return self.round_at_rest(needle, rest);
        }
        rest.active[needle.number(0, NORMAL)] = true;
        // Scale 0, the punctured one, is part of every row.
        let Some(Tip { xi: anchor, .. }) = self.tip(&rest.z, 0, OutlinePart::Top) else {
            return rest;
        };
        let tip_state = needle.resting(anchor);
        rest.mode.needle.tip_contacts[0] =
            Some(TipContact { scale: 0, part: OutlinePart::Top, tip_state });
        if needle.friction == 0.0 {
            return rest;
        }
        let control = self.controls[0];
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], 0.0);
        // Compute the rates with a sticking tip. If the rates of its forces exceed the friction
        // limit, the tip slides.
        let normal_force = needle.normal_force(0);
        if let Ok(rates) = Newton::new(self).tangent(self, &rest, &condition) {
            let [normal, tangential] = [rates[normal_force], rates[normal_force + 1]];
            if tangential.abs() > needle.friction * normal {
                needle.slide(&mut rest, 0, tangential > 0.0, anchor);
            }
        }
        rest
    }

    /// Computes the position of the tip relative to a part of a scale.
    ///
    /// `None` for a free needle, and for a scale beyond the solved part or the reach of the tip.
    pub(super) fn tip(&self, z: &[f64], scale: i64, part: OutlinePart) -> Option<Tip> {
        let needle = self.needle.as_ref()?;
        let number = self.scale_numbered(scale)?;
        let frame = self.frame_from_punctured(number);
        let face = Face::new(&self.contacts.arrangement.scale(number), part);
        let at = needle.tip - Vec2::new(0.0, z[needle.depth]) - frame.origin;
        let upward = frame.inward(Vec2::y());
        Some(Tip::new(&face, &self.contacts.pose(z, number), frame.inward(at), upward))
    }

    /// Returns the tangent frame of a scale in the frame of the punctured scale.
    pub(in crate::puncture) fn frame_from_punctured(&self, scale: usize) -> Frame {
        let Contacts { arrangement, body, .. } = &self.contacts;
        body.frame(arrangement.position(scale) - arrangement.position(self.layout.left))
    }

    /// Computes the contact of the tip with a part of a scale.
    pub(super) fn tip_kinematics(
        &self,
        z: &[f64],
        scale: i64,
        part: OutlinePart,
    ) -> Option<TipKinematics> {
        let (needle, tip) = (self.needle.as_ref()?, self.tip(z, scale, part)?);
        let shape = self.contacts.arrangement.scale(self.scale_numbered(scale)?);
        let behind = [OutlinePart::Left, OutlinePart::Top].into_iter().filter(|face| *face < part);
        let before = behind.map(|face| Face::new(&shape, face).length).sum();
        Some(TipKinematics::new(tip, needle.radius, before))
    }

    /// Iterates over all tip contacts: slot, discrete state, index of the scale, and kinematics.
    pub(super) fn tip_contacts<'a>(
        &'a self,
        state: &'a SkinState,
    ) -> impl Iterator<Item = (usize, &'a TipContact, usize, TipKinematics)> {
        state.mode.needle.all().filter_map(|(slot, touch)| {
            let kinematics = self.tip_kinematics(&state.z, touch.scale, touch.part)?;
            Some((slot, touch, self.scale_numbered(touch.scale)?, kinematics))
        })
    }

    /// Converts a scale number, counted from the punctured scale, to an index.
    ///
    /// `None` beyond the solved part or the reach of the tip.
    pub(super) fn scale_numbered(&self, scale: i64) -> Option<usize> {
        let number = usize::try_from(self.layout.left as i64 + scale).ok()?;
        let farthest = self.needle.as_ref().map_or(0, GuidedNeedle::farthest);
        // The band of the tangent includes only scales within this distance.
        let is_near = scale.unsigned_abs() as usize <= farthest;
        (number < self.layout.scales() && is_near).then_some(number)
    }

    /// Returns the face of a neighbour that a sharp tip would touch next: scale and outline part.
    pub(super) fn next_touch(touch: &TipContact) -> Option<(i64, OutlinePart)> {
        match touch.part {
            OutlinePart::Left => Some((touch.scale - 1, OutlinePart::Top)),
            OutlinePart::TopLeft => None,
            OutlinePart::Top | OutlinePart::TopRight | OutlinePart::Right => {
                Some((touch.scale + 1, OutlinePart::Left))
            }
        }
    }

    /// Returns true if a constraint is the first contact with a critically tilted scale.
    ///
    /// `number` counts the needle constraints.
    fn meets_tilted(&self, needle: &GuidedNeedle, state: &SkinState, number: usize) -> bool {
        let slot = number / needle.constraints_per_touch;
        if number >= needle.tilt_number()
            || number % needle.constraints_per_touch != NORMAL
            || state.mode.needle.tip_contacts[slot].is_some()
        {
            return false;
        }
        let scale = if needle.is_round() {
            Some(slot as i64 - needle.reach() as i64)
        } else {
            // A sharp tip on one scale can only touch a direct neighbour of this scale as well.
            let other = state.mode.needle.tip_contacts[1 - slot].as_ref();
            other.and_then(Self::next_touch).map(|(scale, _)| scale)
        };
        scale.and_then(|scale| self.scale_numbered(scale)).is_some_and(|scale| {
            let [_, _, rotation] = self.displacement(&state.z, scale);
            rotation.abs() > needle.critical_tilt
        })
    }

    /// Returns true if the top right corner of a scale lies on the left face of the next scale.
    ///
    /// This face then stops the tip at the corner, so the tip does not pass over the corner.
    pub(super) fn is_notched(&self, state: &SkinState, scale: i64) -> bool {
        let contact =
            self.corner_of_notch(scale).and_then(|contact| state.mode.contacts.get(contact));
        contact == Some(&CornerContact::Edge(CornerEdge::TopRightOnLeftEdge))
    }

    /// Returns the number of the contact of the top right corner of a scale with the next scale.
    pub(super) fn corner_of_notch(&self, scale: i64) -> Option<usize> {
        // The upper contact with the direct neighbour is the first contact of a scale.
        self.scale_numbered(scale).map(|left| self.contacts.contacts_before(left))
    }
}
