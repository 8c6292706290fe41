//! What contacts that rub do next where something changes (R2).

use contact::{CornerContact, CornerEdge, Force};

use super::friction::{GRIP, NO_FORCE, Rub, WAY};
use super::{Contacts, SkinState};

impl Contacts {
    /// Takes friction along where a force of a contact has changed sides: `before` is the state in which it did. `is_back` tells of corners
    /// that part whether they do so the way they came.
    pub(super) fn carry_friction(
        &self,
        state: &mut SkinState,
        before: &SkinState,
        contact: usize,
        is_back: bool,
    ) {
        let pair = [contact, Self::beside(contact)];
        // All of this is asked of the state before: behind the change forces stand elsewhere.
        let ratios = pair.map(|contact| self.ratio(before, contact));
        let mut rubs = pair.map(|contact| self.own_rub(before, contact, state));
        match (before.mode.contacts[contact], state.mode.contacts[contact].edge()) {
            (_, None) => rubs[0] = Rub::None,
            (CornerContact::Open, Some(edge)) => {
                // What has just closed has not slid: the rates tell whether it slips at once.
                rubs[0] = Rub::Stick { at: self.way(state, edge, contact) };
            }
            (CornerContact::Corner(_), Some(edge)) => {
                let here = self.way(state, edge, contact);
                // A corner that goes on with the ratio of sliding slips on along the next edge. One
                // that goes back, or whose ratio is smaller, sticks at the end of its edge.
                rubs[0] = if self.is_sliding(ratios[0]) && !is_back {
                    Rub::Slip { sign: -ratios[0].signum(), from: here }
                } else {
                    Rub::Stick { at: here }
                };
            }
            _ => {}
        }
        if let CornerContact::Corner(_) = state.mode.contacts[contact] {
            rubs[0] = Rub::Held { ratio: ratios[0] };
        }
        if rubs.iter().all(|rub| rub.is_host()) && Self::slide_along_one_line(state, contact) {
            // The contact that bore friction before goes on bearing it, since its anchor is known.
            let guest = usize::from(before.mode.rubs[contact].is_host());
            rubs[guest] = Rub::None;
        }
        // Both modes are set first: the pressure that bounds a grip depends on who is a guest.
        for (contact, rub) in pair.into_iter().zip(rubs) {
            state.mode.rubs[contact] = rub;
        }
        for (k, (contact, rub)) in pair.into_iter().zip(rubs).enumerate() {
            let share = |k: usize| {
                let forces = self.forces_of(&state.z, pair[k]);
                let normal = forces[Force::Own as usize] + forces[Force::Flush as usize];
                (ratios[k] + self.law.friction()) * normal
            };
            // The host takes over the tangential force of its guest, so that the sum stays.
            let guest = if Self::is_guest(&state.mode, pair[1 - k]) { share(1 - k) } else { 0.0 };
            let is_new = before.mode.rubs[contact] != rub;
            self.set_friction(state, contact, share(k) + guest, is_new);
        }
    }

    /// How a contact rubs by itself, on the edge on which it is in the state `now`.
    fn own_rub(&self, before: &SkinState, contact: usize, now: &SkinState) -> Rub {
        let is_guest = Self::is_guest(&before.mode, contact);
        let from = if is_guest { Self::beside(contact) } else { contact };
        let rub = before.mode.rubs[from];
        let Some(edge) = now.mode.contacts[contact].edge() else { return Rub::None };
        // On the same edge the anchor, or the beginning of the way, stays what it was.
        if !is_guest && before.mode.contacts[contact].edge() == Some(edge) {
            return rub;
        }
        // On another edge the way is counted from elsewhere.
        let here = self.way(now, edge, contact);
        match rub {
            Rub::Stick { .. } => Rub::Stick { at: here },
            Rub::Slip { sign, .. } => Rub::Slip { sign, from: here },
            other => other,
        }
    }

    /// Whether the contacts of a pair are both between its sides, which then lie on each other.
    fn slide_along_one_line(state: &SkinState, contact: usize) -> bool {
        let is_side = |contact: usize| match state.mode.contacts[contact] {
            CornerContact::Edge(edge) => {
                // A tip on the neighbour's top or base slides along that, and not along the sides.
                !matches!(edge, CornerEdge::TopRightOnTop | CornerEdge::BottomLeftOnBase)
            }
            _ => false,
        };
        is_side(contact) && is_side(Self::beside(contact))
    }

    /// Sets what acts of grip and way of a contact.
    pub(super) fn set_friction(
        &self,
        state: &mut SkinState,
        contact: usize,
        grip: f64,
        is_new: bool,
    ) {
        let [sticks, slips] = state.mode.rubs[contact].acting();
        let first = self.slots * contact;
        [state.active[first + GRIP], state.active[first + WAY]] = [sticks, slips];
        // Between 0 and `2 μ Λ` the contact sticks: round-off must not put the grip outside.
        let largest = 2.0 * self.law.friction() * self.pressure(state, contact);
        state.z[self.unknown(contact, GRIP)] =
            if sticks { grip.clamp(0.0, largest.max(0.0)) } else { 0.0 };
        // A contact that slips on keeps its way, which only grows.
        if is_new || !slips {
            state.z[self.unknown(contact, WAY)] = 0.0;
        }
    }

    /// Takes a contact that begins to slip, or ceases to, to its next state. Returns the constraint of the contact whose condition has to
    /// hold as the path goes on, or `None` if there is no such change.
    ///
    /// | Before | Condition | After |
    /// |---|---|---|
    /// | sticks | `T = −μ Λ` | slips forward |
    /// | sticks | `T = μ Λ` | slips backward |
    /// | slips | `s` turns back | sticks where it is |
    pub(super) fn change_friction(
        &self,
        state: &mut SkinState,
        contact: usize,
        slot: usize,
        acts: bool,
    ) -> Option<usize> {
        let here = self.way(state, state.mode.contacts[contact].edge()?, contact);
        let has_force = self.pressure(state, contact) > NO_FORCE;
        let (rub, valid) = match (state.mode.rubs[contact], slot, acts) {
            (Rub::Stick { .. }, GRIP, false) => (Rub::Slip { sign: 1.0, from: here }, WAY),
            (Rub::Stick { .. }, WAY, true) => (Rub::Slip { sign: -1.0, from: here }, WAY),
            (Rub::Slip { sign, .. }, WAY, false) => {
                // What slid forward has no grip left, what slid backward the largest: that limit
                // has to hold where it comes to rest.
                (Rub::Stick { at: here }, if sign > 0.0 { GRIP } else { WAY })
            }
            _ => return None,
        };
        // The grip that keeps `T` is taken while the mode still tells the ratio.
        let grip =
            (self.ratio(state, contact) + self.law.friction()) * self.pressure(state, contact);
        state.mode.rubs[contact] = rub;
        self.set_friction(state, contact, grip, true);
        // A contact that has just closed has to press, however it rubs.
        Some(if has_force { valid } else { Force::Own as usize })
    }
}
