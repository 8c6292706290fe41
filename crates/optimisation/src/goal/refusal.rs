//! What is refused of a goal, with the place where it is written.

use std::fmt::Display;

use sweep::toml_source::Place;
use sweep::{InvalidDefinition, Problem, WrongValue};

pub(super) fn refuse(place: &Place, key: &str, problem: impl Into<Problem>) -> InvalidDefinition {
    InvalidDefinition::Refused {
        place: place.clone(),
        key: key.to_owned(),
        problem: Box::new(problem.into()),
    }
}

pub(super) fn not_accepted(
    place: &Place,
    key: &str,
    found: impl Display,
    expected: impl Into<String>,
) -> InvalidDefinition {
    let (found, expected) = (found.to_string(), expected.into());
    refuse(place, key, WrongValue::NotAccepted { found, expected })
}

pub(super) fn no_effect(place: &Place, key: &str, reason: &str) -> InvalidDefinition {
    refuse(place, key, WrongValue::NoEffect { reason: reason.to_owned() })
}

/// Errors as one, of which there is at least one.
pub(super) fn several(mut refused: Vec<InvalidDefinition>) -> InvalidDefinition {
    if refused.len() == 1 { refused.swap_remove(0) } else { InvalidDefinition::Several(refused) }
}
