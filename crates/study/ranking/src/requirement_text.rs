//! Requirements as text: a bound, a level of a standard, or a limit of a body part.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};
use text::number;

use crate::pain::PainLimit;
use crate::requirement::{Relation, Requirement};
use crate::standard::Standard;

/// Error: a text is not a requirement.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{found} is not accepted, expected COLUMN OP NUMBER, OP being >=, <=, >, < or ==, e.g. coverage >= 0.6, or a level of a standard: {}, or a limit of a body part: {}",
    Standard::levels(),
    PainLimit::names()
)]
pub struct InvalidRequirement {
    /// The invalid text.
    pub found: String,
}

impl FromStr for Requirement {
    type Err = InvalidRequirement;

    fn from_str(text: &str) -> Result<Self, InvalidRequirement> {
        let level = Standard::requirement(text).map(|(_, requirement)| requirement);
        let level = level.or_else(|| Some(PainLimit::requirement(text)?.1));
        level
            .or_else(|| {
                let ((column, limit), relation) = Relation::ALL
                    .into_iter()
                    .find_map(|relation| Some((text.split_once(relation.sign())?, relation)))?;
                // Refuse the limits `inf` and `nan`, which every value or no value would meet.
                let limit = limit.trim().parse().ok().filter(|limit: &f64| limit.is_finite())?;
                let column = column.trim().to_owned();
                // Refuse a column name with a sign, as in the mistyped `coverage => 0.6`, which is
                // split at `>` and leaves `coverage =`.
                let is_name = !column.is_empty() && !column.contains(['<', '>', '=']);
                is_name.then_some(Self { column, relation, limit })
            })
            .ok_or_else(|| InvalidRequirement { found: text.trim().to_owned() })
    }
}

impl Serialize for Requirement {
    /// Serializes the requirement as text.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.column, self.relation.sign(), number::text(self.limit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requirements_round_trip_through_text() {
        for text in ["a >= 1", "a <= -2.5", "a == 0", "a > 1e-7", "a < 3"] {
            for written in [text, &text.replace(' ', "")] {
                let read = written.parse::<Requirement>().map(|read| read.to_string());
                assert_eq!(read.as_deref(), Ok(text), "{written}");
            }
        }
        for wrong in ["a", "a = 1", ">= 1", "a >= b", "a >= nan", "a >= ", "a => 1", ""] {
            assert!(wrong.parse::<Requirement>().is_err(), "{wrong}");
        }
    }
}
