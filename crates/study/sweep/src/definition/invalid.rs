//! Errors of a definition that cannot run.

use crate::grid::TooManyDesigns;
use crate::parameter::WrongValue;
use text::toml_source::{Place, SyntaxError};

/// A definition that cannot run. Each message is one line that names the file, the key, the value
/// and what would be right; of a definition that has several errors, all are told.
#[derive(Debug, thiserror::Error)]
pub enum InvalidDefinition {
    /// The file cannot be read.
    #[error("{file}: cannot be read ({reason}), expected a sweep definition in TOML")]
    Unreadable {
        /// Name of the file.
        file: String,
        /// The message of the system.
        reason: String,
    },
    /// The file is no TOML.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// Several things are not right: one line for each.
    #[error("{}", lines(.0))]
    Several(Vec<Self>),
    /// A key or a value is not right.
    #[error("{place}: {key}: {problem}")]
    Refused {
        /// Place of the key.
        place: Place,
        /// The key, dotted.
        key: String,
        /// The problem, and what would be right.
        problem: Box<Problem>,
    },
}

impl InvalidDefinition {
    /// Nothing if there are no `errors`; a single one stays as it is.
    pub(crate) fn refuse_any(errors: Vec<Self>) -> Result<(), Self> {
        if errors.is_empty() { Ok(()) } else { Err(Self::several(errors)) }
    }

    /// Errors as one, of which there is at least one.
    pub fn several(mut errors: Vec<Self>) -> Self {
        if errors.len() == 1 { errors.swap_remove(0) } else { Self::Several(errors) }
    }
}

fn lines(errors: &[InvalidDefinition]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// A problem with a key.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// There is no such key.
    #[error("unknown key (its value is {value}), {hint}")]
    Unknown {
        /// The value that the key is set to.
        value: String,
        /// The key that may be meant.
        hint: String,
    },
    /// A required key is missing.
    #[error("missing, expected {0}")]
    Missing(&'static str),
    /// The value of a parameter.
    #[error(transparent)]
    Value(#[from] WrongValue),
    /// A range that cannot be walked.
    #[error("{range}: {problem}")]
    Range {
        /// The range as written.
        range: String,
        /// The problem.
        problem: String,
    },
    /// A value stands in a list twice.
    #[error("{0} is in the list twice")]
    Twice(String),
    /// A parameter is set in its section and in the grid.
    #[error("{value} conflicts with {other} at {place}; keep one of the two")]
    Contradiction {
        /// The value that the parameter is set to here.
        value: String,
        /// The other key.
        other: String,
        /// Place of the other key.
        place: Place,
    },
    /// Two parameters that say the same in two ways.
    #[error("cannot be combined with {other} at {place}; keep one of the two")]
    Alternative {
        /// The other key.
        other: String,
        /// Where that stands.
        place: Place,
    },
    /// A pitch besides a gap and a length.
    #[error(
        "cannot be combined with {other} at {place}: the pitch is base and gap; keep two of gap, length and pitch"
    )]
    Pitch {
        /// One of the other keys.
        other: String,
        /// Where that stands.
        place: Place,
    },
    /// A length in mm that no skin of that thickness has, or a modulus of the scales below that of what they lie on.
    #[error("{value} with {beside} makes {key} {found}, expected {expected}")]
    LengthInMm {
        /// What is given.
        value: String,
        /// The keys and values beside it.
        beside: String,
        /// The parameter that follows.
        key: &'static str,
        /// Its value.
        found: String,
        /// The values that would be right.
        expected: String,
    },
    /// A deviation in a unit that only another key gives.
    #[error("needs {0} to be set")]
    Needs(String),
    /// Steps that no path can follow.
    #[error("{value} must be at most {other}")]
    StepOrder {
        /// The smallest step.
        value: String,
        /// A step that must not be smaller, with its value.
        other: String,
    },
    /// The grid is too large.
    #[error(transparent)]
    TooManyDesigns(#[from] TooManyDesigns),
}

/// A key refused, with the place where it is written.
pub fn refuse(place: &Place, key: &str, problem: impl Into<Problem>) -> InvalidDefinition {
    let (place, key) = (place.clone(), key.to_owned());
    InvalidDefinition::Refused { place, key, problem: Box::new(problem.into()) }
}
