//! The mode of a skin: what contacts and needle do.

use contact::CornerContact;

use super::friction::FrictionState;
use crate::puncture::NeedleMode;

/// The mode of a skin: the state of every contact, its friction, and that of a guided needle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SkinMode {
    pub(crate) contacts: Vec<CornerContact>,
    /// How each contact rubs; nothing without friction.
    pub(crate) friction_states: Vec<FrictionState>,
    pub(crate) needle: NeedleMode,
}

impl SkinMode {
    /// Whether contacts do and rub alike in two modes.
    pub(crate) fn is_same_form(&self, other: &Self) -> bool {
        let friction_states = self.friction_states.iter().zip(&other.friction_states);
        self.contacts == other.contacts
            && self.needle == other.needle
            && friction_states.into_iter().all(|(one, other)| one.is_same_form(*other))
    }
}
