//! One-sided derivatives of a value.

use results::SlopeSide;

/// Relative parameter step of finite differences of extrapolated table rows.
///
/// The extrapolation is linear.
const STEP: f64 = 1e-6;

/// The derivatives of a value on both sides of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes {
    pub left: Option<f64>,
    pub right: Option<f64>,
}

impl Slopes {
    /// Unknown derivatives.
    pub const UNKNOWN: Self = Self { left: None, right: None };

    /// Derivatives of a constant.
    pub const FLAT: Self = Self { left: Some(0.0), right: Some(0.0) };

    /// Computes one-sided derivatives by finite differences of `at`.
    ///
    /// `size` is the size of the parameter.
    pub fn between(size: Option<f64>, at: impl Fn(f64, SlopeSide) -> Option<f64>) -> Self {
        // Rows are extrapolated linearly, so the only error of a central difference comes from the
        // formula of the column.
        let [left, right] = [SlopeSide::Left, SlopeSide::Right].map(|side| {
            let step = STEP * size?;
            Some((at(step, side)? - at(-step, side)?) / (2.0 * step))
        });
        Self { left, right }
    }

    /// Returns the derivatives of a multiple.
    pub fn scaled(self, factor: f64) -> Self {
        Self { left: self.left.map(|x| x * factor), right: self.right.map(|x| x * factor) }
    }

    /// Returns the derivatives of a sum.
    pub fn plus(self, other: Self) -> Self {
        Self {
            left: self.left.zip(other.left).map(|(one, other)| one + other),
            right: self.right.zip(other.right).map(|(one, other)| one + other),
        }
    }

    /// Returns the slope on the side with the steepest ascent.
    ///
    /// It is 0 if the value falls on both sides. If one side is unknown, it counts as equal to the
    /// other; `None` if both are.
    pub fn uphill(self) -> Option<f64> {
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        let (gain_left, gain_right) = (-left, right);
        Some(match (gain_left > 0.0, gain_right > 0.0) {
            _ if left == right => left,
            // On a ridge no step along this variable gains: the search moves along the others.
            (false, false) => 0.0,
            _ if gain_left > gain_right => left,
            _ => right,
        })
    }

    /// Returns the derivative; `None` at a kink.
    pub fn smooth(self) -> Option<f64> {
        // At the end of a range only one side exists, and is the derivative.
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        // Each side is a separate difference, so equal slopes agree up to rounding.
        let size = left.abs().max(right.abs());
        ((left - right).abs() <= 1e-6 * size).then_some(left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uphill_chooses_the_side_of_steepest_ascent() {
        for (left, right, uphill) in [
            (Some(2.0), Some(2.0), Some(2.0)),
            (Some(1.0), Some(-3.0), Some(0.0)),
            (Some(-1.0), Some(3.0), Some(3.0)),
            (Some(-4.0), Some(3.0), Some(-4.0)),
            (Some(-4.0), Some(-3.0), Some(-4.0)),
            (None, Some(-3.0), Some(-3.0)),
            (None, None, None),
        ] {
            assert_eq!(Slopes { left, right }.uphill(), uphill);
        }
        assert_eq!(Slopes { left: Some(1.0), right: Some(1.1) }.smooth(), None);
        assert_eq!(Slopes { left: Some(1.0), right: Some(1.0) }.smooth(), Some(1.0));
    }
}
