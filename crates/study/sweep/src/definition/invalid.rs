//! Errors of an invalid definition.

use crate::grid::TooManyDesigns;
use crate::parameter::WrongValue;
use text::toml_source::{Location, SyntaxError};

/// An invalid definition.
///
/// Each message is one line that names the file, the key, the value and the accepted values. If a
/// definition has several errors, all are reported.
#[derive(Debug, thiserror::Error)]
pub enum InvalidDefinition {
    /// The file cannot be read.
    #[error("{file}: cannot be read ({reason}), expected a sweep definition in TOML")]
    Unreadable {
        /// Name of the file.
        file: String,
        /// Reason, e.g. the message of the operating system.
        reason: String,
    },
    /// The file is not TOML.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// Several errors, one line each.
    #[error("{}", lines(.0))]
    Several(Vec<Self>),
    /// A key or a value is invalid.
    #[error("{location}: {key}: {problem}")]
    Refused {
        /// Position of the key.
        location: Location,
        /// The key, dotted.
        key: String,
        /// The problem, and the accepted values.
        problem: Box<Problem>,
    },
}

impl InvalidDefinition {
    /// Returns `errors` as one error, or `Ok` if there are none.
    pub(crate) fn refuse_any(errors: Vec<Self>) -> Result<(), Self> {
        if errors.is_empty() { Ok(()) } else { Err(Self::several(errors)) }
    }

    /// Combines one or more errors into one error.
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
        /// Value of the key.
        value: String,
        /// Suggested keys.
        hint: String,
    },
    /// A required key is missing.
    #[error("missing, expected {0}")]
    Missing(&'static str),
    /// The value of a parameter is invalid.
    #[error(transparent)]
    Value(#[from] WrongValue),
    /// A range is invalid.
    #[error("{range}: {problem}")]
    Range {
        /// The range as written.
        range: String,
        /// The problem.
        problem: String,
    },
    /// A list contains a value twice.
    #[error("{0} is in the list twice")]
    Twice(String),
    /// A parameter is set in its section and in the grid.
    #[error("{value} conflicts with {other} at {location}; keep one of the two")]
    Contradiction {
        /// Value of the parameter in its section.
        value: String,
        /// The other key.
        other: String,
        /// Position of the other key.
        location: Location,
    },
    /// Two parameters define the same quantity.
    #[error("cannot be combined with {other} at {location}; keep one of the two")]
    Alternative {
        /// The other key.
        other: String,
        /// Position of the other key.
        location: Location,
    },
    /// A pitch is given in addition to a gap and a length.
    #[error(
        "cannot be combined with {other} at {location}: pitch = base + gap; keep two of gap, length and pitch"
    )]
    Pitch {
        /// Key of the gap or the length.
        other: String,
        /// Position of the other key.
        location: Location,
    },
    /// A length in mm, a modulus, a strength or a force gives an invalid ratio.
    #[error("{value} with {beside} makes {key} {found}, expected {expected}")]
    LengthInMm {
        /// The given value.
        value: String,
        /// Keys and values of the other parameters in the ratio.
        beside: String,
        /// Key of the resulting ratio.
        key: &'static str,
        /// Value of the resulting ratio.
        found: String,
        /// Accepted values of the ratio.
        expected: String,
    },
    /// Another key, or a certain value of another key, is required.
    #[error("needs {0} to be set")]
    Needs(String),
    /// The smallest step exceeds another step.
    #[error("{value} must be at most {other}")]
    StepOrder {
        /// Smallest step.
        value: String,
        /// Key and value of the other step, which is smaller than the smallest step.
        other: String,
    },
    /// The grid is too large.
    #[error(transparent)]
    TooManyDesigns(#[from] TooManyDesigns),
}

/// Creates the error for `key` at `location` in the definition.
pub fn refuse(location: &Location, key: &str, problem: impl Into<Problem>) -> InvalidDefinition {
    let (location, key) = (location.clone(), key.to_owned());
    InvalidDefinition::Refused { location, key, problem: Box::new(problem.into()) }
}
