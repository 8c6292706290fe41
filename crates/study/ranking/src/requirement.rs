//! A requirement: a bound that a column must keep.

use std::fmt;
use std::str::FromStr;

use results::round_off::{ROUND_OFF, same};
use serde::{Serialize, Serializer};
use text::number;

use crate::standard::Standard;

/// How a value is to stand to the limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `>=`
    AtLeast,
    /// `<=`
    AtMost,
    /// `==`
    Equal,
    /// `>`
    Above,
    /// `<`
    Below,
}

impl Relation {
    /// All relations; those of two characters first, because others begin alike.
    pub const ALL: [Self; 5] = [Self::AtLeast, Self::AtMost, Self::Equal, Self::Above, Self::Below];

    /// The sign of the relation.
    pub fn sign(self) -> &'static str {
        match self {
            Self::AtLeast => ">=",
            Self::AtMost => "<=",
            Self::Equal => "==",
            Self::Above => ">",
            Self::Below => "<",
        }
    }

    /// 1 if values are to be above the limit, −1 if they are to be below.
    fn direction(self) -> f64 {
        match self {
            // No search asks for the direction of an equality, which goals refuse.
            Self::AtLeast | Self::Above | Self::Equal => 1.0,
            Self::AtMost | Self::Below => -1.0,
        }
    }
}

/// A requirement: a bound that a column must keep.
///
/// ```
/// use ranking::Requirement;
///
/// let requirement: Requirement = "coverage >= 0.6".parse()?;
/// assert!(requirement.is_met(0.7) && !requirement.is_met(0.5));
/// // Round-off breaks no requirement.
/// assert!(requirement.is_met(0.6 - 1e-15));
/// # Ok::<(), ranking::InvalidRequirement>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// The column.
    pub column: String,
    /// How its values are to stand to the limit.
    pub relation: Relation,
    /// The limit, in the unit of the column.
    pub limit: f64,
}

/// A text that is no requirement.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{found} is not accepted, expected COLUMN OP NUMBER, OP being >=, <=, >, < or ==, e.g. coverage >= 0.6, or a level of a standard: {}",
    Standard::levels()
)]
pub struct InvalidRequirement {
    /// The text.
    pub found: String,
}

impl Requirement {
    /// Whether a value meets the requirement. A value that is the limit but for round-off is the limit.
    pub fn is_met(&self, value: f64) -> bool {
        let is_limit = same(value, self.limit);
        match self.relation {
            Relation::AtLeast => is_limit || value > self.limit,
            Relation::AtMost => is_limit || value < self.limit,
            Relation::Equal => is_limit,
            Relation::Above => !is_limit && value > self.limit,
            Relation::Below => !is_limit && value < self.limit,
        }
    }

    /// 1 if values are to be above the limit, −1 if they are to be below.
    pub fn direction(&self) -> f64 {
        self.relation.direction()
    }

    /// The size that margins are relative to: the limit, or 1 if that is 0.
    pub fn size(&self) -> f64 {
        if self.limit == 0.0 { 1.0 } else { self.limit.abs() }
    }

    /// How far a value is within the limit, relative to its size; below 0 beyond it.
    pub fn margin(&self, value: f64) -> f64 {
        let margin = self.direction() * (value - self.limit) / self.size();
        match self.relation {
            // A search aims a little within a strict limit: what it reaches is the limit itself but for round-off.
            Relation::Above | Relation::Below => margin - 10.0 * ROUND_OFF,
            // Either side of the one value that is asked for is beyond it.
            Relation::Equal => -margin.abs(),
            _ => margin,
        }
    }

    /// How fast [`Self::margin`] grows with the value.
    pub fn margin_rate(&self) -> f64 {
        self.direction() / self.size()
    }

    /// The margin of a value, not below 0 if and only if the value meets the requirement: round-off breaks no limit. No value is as far
    /// beyond it as can be.
    pub fn counted_margin(&self, value: Option<f64>) -> f64 {
        let Some(value) = value else { return f64::NEG_INFINITY };
        let margin = self.margin(value);
        if self.is_met(value) { margin.max(0.0) } else { margin.min(-f64::MIN_POSITIVE) }
    }

    /// How far a value is from meeting the requirement, relative to `size`; 0 if it does.
    pub(crate) fn shortfall(&self, value: f64, size: f64) -> f64 {
        // The distance, not the direction: an equality may be missed on either side.
        let missing = (value - self.limit).abs();
        // A strict bound that is met but for equality is missed by the least there is.
        if self.is_met(value) { 0.0 } else { (missing / size).max(f64::MIN_POSITIVE) }
    }
}

impl FromStr for Requirement {
    type Err = InvalidRequirement;

    fn from_str(text: &str) -> Result<Self, InvalidRequirement> {
        let read = || {
            let cut = |relation: Relation| Some((text.split_once(relation.sign())?, relation));
            let ((column, limit), relation) = Relation::ALL.into_iter().find_map(cut)?;
            // A bound of `inf` or `nan` would be met by all values or by none.
            let limit = limit.trim().parse().ok().filter(|limit: &f64| limit.is_finite())?;
            let column = column.trim().to_owned();
            // Of `coverage => 0.6` the sign `>` leaves a `=` behind in the name.
            let is_name = !column.is_empty() && !column.contains(['<', '>', '=']);
            is_name.then_some(Self { column, relation, limit })
        };
        let level = Standard::requirement(text).map(|(_, requirement)| requirement);
        level.or_else(read).ok_or_else(|| InvalidRequirement { found: text.trim().to_owned() })
    }
}

impl Serialize for Requirement {
    /// As it is written.
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

    fn requirement(text: &str) -> Requirement {
        text.parse().expect("a requirement")
    }

    #[test]
    fn requirements_are_written_as_they_are_read() {
        for text in ["a >= 1", "a <= -2.5", "a == 0", "a > 1e-7", "a < 3"] {
            assert_eq!(requirement(text).to_string(), text);
            assert_eq!(requirement(&text.replace(' ', "")), requirement(text));
        }
        for wrong in ["a", "a = 1", ">= 1", "a >= b", "a >= nan", "a >= ", "a => 1", ""] {
            assert!(wrong.parse::<Requirement>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn each_sign_means_what_it_means() {
        let met = |text: &str| [1.0, 2.0, 3.0].map(|value| requirement(text).is_met(value));
        assert_eq!(met("a >= 2"), [false, true, true]);
        assert_eq!(met("a <= 2"), [true, true, false]);
        assert_eq!(met("a == 2"), [false, true, false]);
        assert_eq!(met("a > 2"), [false, false, true]);
        assert_eq!(met("a < 2"), [true, false, false]);
    }

    #[test]
    fn a_margin_is_below_zero_where_a_requirement_is_missed() {
        let margins = |text: &str| [1.0, 2.0, 3.0].map(|value| requirement(text).margin(value));
        assert_eq!(margins("a >= 2"), [-0.5, 0.0, 0.5]);
        assert_eq!(margins("a <= 2"), [0.5, 0.0, -0.5]);
        assert_eq!(margins("a == 2"), [-0.5, 0.0, -0.5]);
    }

    #[test]
    fn a_shortfall_is_relative_and_zero_where_all_is_well() {
        assert_eq!(requirement("a >= 2").shortfall(1.5, 2.0), 0.25);
        assert_eq!(requirement("a >= 2").shortfall(2.5, 2.0), 0.0);
        assert!(requirement("a > 2").shortfall(2.0, 2.0) > 0.0);
    }
}
