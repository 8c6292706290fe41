//! Creates the errors for invalid entries of a goal file, with the position of the entry.

use std::fmt::Display;

use sweep::{InvalidDefinition, WrongValue, refuse};
use text::toml_source::Location;

/// Returns the error for a value `found` of `key` where `expected` was expected.
pub(super) fn not_accepted(
    location: &Location,
    key: &str,
    found: impl Display,
    expected: impl Into<String>,
) -> InvalidDefinition {
    refuse(location, key, WrongValue::not_accepted(found, expected))
}

/// Returns the error for a `key` that has no effect for this `reason`.
pub(super) fn no_effect(location: &Location, key: &str, reason: &str) -> InvalidDefinition {
    refuse(location, key, WrongValue::NoEffect(reason.to_owned()))
}
