//! Changes of contact state at events.

use contact::Force;

use super::{Contacts, SkinState};

/// Change of the state of a contact at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactChange {
    /// The contact closes.
    Closed,
    /// The contact opens.
    Opened,
    /// The corner reaches the end of its edge, and both corners then coincide.
    ReachedCorner,
    /// The corner returns to the edge along which it reached the other corner.
    LeftCorner,
    /// The force moves to the partner contact: the other corner on the other edge.
    ///
    /// On flush edges it moves to the contact at the other end of both edges.
    HandedOver,
    /// The contact starts to slip.
    Slips,
    /// The contact stops slipping and sticks.
    Sticks,
}

impl ContactChange {
    /// Returns the short name used in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Closed => "closed",
            Self::Opened => "opened",
            Self::ReachedCorner => "reached corner",
            Self::LeftCorner => "left corner",
            Self::HandedOver => "handed over",
            Self::Slips => "slips",
            Self::Sticks => "sticks",
        }
    }

    /// Classifies the change of a constraint; `state` is the state after the event.
    pub(crate) fn classify(contacts: &Contacts, state: &SkinState, change: solver::Change) -> Self {
        let acts = state.active[change.constraint];
        let (contact, slot) = contacts.contact_of(change.constraint);
        let Some(&force) = Force::ALL.get(slot) else {
            let [sticks, _] = state.mode.friction_states[contact].acting();
            return if sticks { Self::Sticks } else { Self::Slips };
        };
        match (force, change.activated) {
            (Force::Own | Force::Flush, true) => Self::Closed,
            // The own force vanished but its flag is active: the contact continued as its partner,
            // and the partner force became its own force.
            (Force::Own, false) if acts => Self::HandedOver,
            (Force::Own | Force::Flush, false) => Self::Opened,
            (Force::Partner, true) if acts => Self::ReachedCorner,
            // Between parallel sides both normals agree, so the partner takes the whole force at
            // once.
            (Force::Partner, true) => Self::HandedOver,
            (Force::Partner, false) => Self::LeftCorner,
        }
    }
}
