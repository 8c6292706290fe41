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
    /// The corner reaches the end of its edge and stays at the other corner.
    ReachedCorner,
    /// The contact leaves the corner along the edge on which it arrived.
    LeftCorner,
    /// The contact passes the corner and continues as its partner.
    ///
    /// Corner and edge are exchanged. On flush edges the contact at the other end carries all the
    /// force.
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

    /// Classifies the change of a force from the state after the event.
    pub(crate) fn classify(contacts: &Contacts, state: &SkinState, change: solver::Change) -> Self {
        let acts = state.active[change.constraint];
        let (contact, slot) = contacts.contact_of(change.constraint);
        let Some(&force) = Force::ALL.get(slot) else {
            let [sticks, _] = state.mode.friction_states[contact].acting();
            return if sticks { Self::Sticks } else { Self::Slips };
        };
        match (force, change.activated) {
            (Force::Own | Force::Flush, true) => Self::Closed,
            // The remaining partner force takes over the active flag of the contact.
            (Force::Own, false) if acts => Self::HandedOver,
            (Force::Own | Force::Flush, false) => Self::Opened,
            (Force::Partner, true) if acts => Self::ReachedCorner,
            // Between parallel sides no force has to rotate, so the partner carries all force at
            // once.
            (Force::Partner, true) => Self::HandedOver,
            (Force::Partner, false) => Self::LeftCorner,
        }
    }
}
