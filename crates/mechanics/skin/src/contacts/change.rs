//! Changes of contacts at events.

use contact::Force;

use super::{Contacts, SkinState};

/// A change of a contact at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactChange {
    /// The contact closes.
    Closed,
    /// The contact opens.
    Opened,
    /// The corner reaches the end of its edge and stays at the other corner.
    ReachedCorner,
    /// The contact leaves the corner on the edge on which it came.
    LeftCorner,
    /// The contact passes the corner as its partner, the corners having changed their parts; or the contact at the other
    /// end of flush edges carries alone.
    HandedOver,
    /// The contact begins to slip.
    Slips,
    /// The contact ceases to slip, and sticks.
    Sticks,
}

impl ContactChange {
    /// Short name, as in tables.
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

    /// The change of a contact of which a force has changed sides, from the state after the event.
    pub(crate) fn classify(contacts: &Contacts, state: &SkinState, change: solver::Change) -> Self {
        let acts = state.active[change.constraint];
        let (contact, slot) = contacts.contact_of(change.constraint);
        let Some(&force) = Force::ALL.get(slot) else {
            let [sticks, _] = state.mode.friction_states[contact].acting();
            return if sticks { Self::Sticks } else { Self::Slips };
        };
        match (force, change.activated) {
            (Force::Own | Force::Flush, true) => Self::Closed,
            // The force that stays takes over the flag of the own one.
            (Force::Own, false) if acts => Self::HandedOver,
            (Force::Own | Force::Flush, false) => Self::Opened,
            (Force::Partner, true) if acts => Self::ReachedCorner,
            // Between parallel sides no force has to turn: the partner carries alone at once.
            (Force::Partner, true) => Self::HandedOver,
            (Force::Partner, false) => Self::LeftCorner,
        }
    }
}
