//! Requirements: bounds on columns.

use text::number::{ROUND_OFF, same};

/// Relation of a value to the limit of a requirement.
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
    /// All relations. `>=` and `<=` come before their prefixes `>` and `<`.
    pub const ALL: [Self; 5] = [Self::AtLeast, Self::AtMost, Self::Equal, Self::Above, Self::Below];

    /// Returns the sign of the relation.
    pub fn sign(self) -> &'static str {
        match self {
            Self::AtLeast => ">=",
            Self::AtMost => "<=",
            Self::Equal => "==",
            Self::Above => ">",
            Self::Below => "<",
        }
    }

    /// Returns 1 if values must be above the limit, −1 if values must be below the limit.
    fn direction(self) -> f64 {
        match self {
            // `margin` does not depend on the direction of an equality.
            Self::AtLeast | Self::Above | Self::Equal => 1.0,
            Self::AtMost | Self::Below => -1.0,
        }
    }
}

/// Requirement: a bound on a column.
///
/// ```
/// use ranking::Requirement;
///
/// let requirement: Requirement = "coverage >= 0.6".parse()?;
/// assert!(requirement.is_met(0.7) && !requirement.is_met(0.5));
/// // Round-off does not violate a requirement.
/// assert!(requirement.is_met(0.6 - 1e-15));
/// # Ok::<(), ranking::InvalidRequirement>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// Column name.
    pub column: String,
    /// Relation of the value to the limit.
    pub relation: Relation,
    /// Limit, in the unit of the column.
    pub limit: f64,
}

impl Requirement {
    /// Returns true if `value` meets the requirement.
    ///
    /// A value that equals the limit up to round-off counts as equal.
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

    /// Returns 1 if values must be above the limit, −1 if values must be below the limit.
    ///
    /// An equality has the direction 1; goals of a search refuse equalities.
    pub fn direction(&self) -> f64 {
        self.relation.direction()
    }

    /// Returns the unit of margins: the magnitude of the limit, or 1 if the limit is 0.
    pub fn size(&self) -> f64 {
        if self.limit == 0.0 { 1.0 } else { self.limit.abs() }
    }

    /// Returns the distance of a value from the limit, relative to [`Self::size`].
    ///
    /// The margin is negative if the requirement is not met.
    pub fn margin(&self, value: f64) -> f64 {
        let margin = self.direction() * (value - self.limit) / self.size();
        match self.relation {
            // A search converges to a margin of 0 up to round-off. Subtract a small number for a
            // strict inequality, so that the search converges beyond the limit.
            Relation::Above | Relation::Below => margin - 10.0 * ROUND_OFF,
            // A value on either side of the limit violates an equality.
            Relation::Equal => -margin.abs(),
            _ => margin,
        }
    }

    /// Returns the derivative of [`Self::margin`] with respect to the value.
    pub fn margin_rate(&self) -> f64 {
        self.direction() / self.size()
    }

    /// Returns the margin of a value, corrected for round-off.
    ///
    /// Unlike [`Self::margin`], this margin is non-negative if and only if the value meets the
    /// requirement. A missing value has the margin −∞.
    pub fn counted_margin(&self, value: Option<f64>) -> f64 {
        let Some(value) = value else { return f64::NEG_INFINITY };
        let margin = self.margin(value);
        if self.is_met(value) { margin.max(0.0) } else { margin.min(-f64::MIN_POSITIVE) }
    }

    /// Returns the shortfall of a value, relative to `size`; 0 if the requirement is met.
    pub(crate) fn shortfall(&self, value: f64, size: f64) -> f64 {
        // Use the absolute distance, because an equality may be missed on either side.
        let missing = (value - self.limit).abs();
        // The shortfall must be positive for a value at the limit of a strict inequality.
        if self.is_met(value) { 0.0 } else { (missing / size).max(f64::MIN_POSITIVE) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn requirement(text: &str) -> Requirement {
        text.parse().expect("a requirement")
    }

    #[test]
    fn relations_accept_values_on_their_side_of_the_limit() {
        for (text, met) in [
            ("a >= 2", [false, true, true]),
            ("a <= 2", [true, true, false]),
            ("a == 2", [false, true, false]),
            ("a > 2", [false, false, true]),
            ("a < 2", [true, false, false]),
        ] {
            assert_eq!([1.0, 2.0, 3.0].map(|value| requirement(text).is_met(value)), met);
        }
    }

    #[test]
    fn margins_are_negative_for_missed_requirements() {
        for (text, margins) in [
            ("a >= 2", [-0.5, 0.0, 0.5]),
            ("a <= 2", [0.5, 0.0, -0.5]),
            ("a == 2", [-0.5, 0.0, -0.5]),
        ] {
            assert_eq!([1.0, 2.0, 3.0].map(|value| requirement(text).margin(value)), margins);
        }
    }

    #[test]
    fn shortfalls_are_relative_and_zero_if_the_requirement_is_met() {
        assert_eq!(requirement("a >= 2").shortfall(1.5, 2.0), 0.25);
        assert_eq!(requirement("a >= 2").shortfall(2.5, 2.0), 0.0);
        assert!(requirement("a > 2").shortfall(2.0, 2.0) > 0.0);
    }
}
