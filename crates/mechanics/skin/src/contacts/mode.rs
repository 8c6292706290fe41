//! Discrete state of a row or a strip: contacts, friction and needle.

use contact::CornerContact;

use super::friction::FrictionState;
use super::needle_mode::NeedleMode;

/// Discrete state of all contacts, of their friction, and of a guided needle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SkinMode {
    pub(crate) contacts: Vec<CornerContact>,
    /// Friction state of each contact; empty without friction.
    pub(crate) friction_states: Vec<FrictionState>,
    pub(crate) needle: NeedleMode,
}

impl SkinMode {
    /// Returns true if contacts, friction states and needle of both modes agree.
    ///
    /// Anchors, starts of slip and locked ratios between scales may differ.
    pub(crate) fn is_same_form(&self, other: &Self) -> bool {
        let friction_states = self.friction_states.iter().zip(&other.friction_states);
        self.contacts == other.contacts
            && self.needle == other.needle
            && friction_states.into_iter().all(|(one, other)| one.is_same_form(*other))
    }
}
