//! One-sided derivatives of a value with respect to a parameter.

use results::SlopeSide;

/// Step of finite differences, relative to the size of the parameter.
const STEP: f64 = 1e-6;

/// One-sided derivatives of a value with respect to a parameter; `None` if unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes {
    /// Derivative towards smaller values of the parameter.
    pub left: Option<f64>,
    /// Derivative towards larger values of the parameter.
    pub right: Option<f64>,
}

impl Slopes {
    /// Derivatives that are unknown on both sides.
    pub const UNKNOWN: Self = Self { left: None, right: None };

    /// Derivatives of a constant.
    pub const FLAT: Self = Self { left: Some(0.0), right: Some(0.0) };

    /// Computes one-sided derivatives by finite differences.
    ///
    /// `size` is the size of the parameter. `at` returns the value for a change of the parameter,
    /// extrapolated by the derivatives on one side.
    pub fn between(size: Option<f64>, at: impl Fn(f64, SlopeSide) -> Option<f64>) -> Self {
        // `at` extrapolates measures linearly to both sides, so a central difference is possible.
        // The central difference is exact except for the curvature of the formula of a column.
        let [left, right] = [SlopeSide::Left, SlopeSide::Right].map(|side| {
            let step = STEP * size?;
            Some((at(step, side)? - at(-step, side)?) / (2.0 * step))
        });
        Self { left, right }
    }

    /// Returns the derivatives of the value times `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        Self { left: self.left.map(|x| x * factor), right: self.right.map(|x| x * factor) }
    }

    /// Returns the derivatives of the sum of two values.
    pub fn plus(self, other: Self) -> Self {
        Self {
            left: self.left.zip(other.left).map(|(one, other)| one + other),
            right: self.right.zip(other.right).map(|(one, other)| one + other),
        }
    }

    /// Returns the slope on the side on which the value rises most steeply.
    ///
    /// Returns 0 if the value falls on both sides. If the slope of one side is unknown, the slope
    /// of the other side is returned; `None` if both slopes are unknown.
    pub fn uphill(self) -> Option<f64> {
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        let (gain_left, gain_right) = (-left, right);
        Some(match (gain_left > 0.0, gain_right > 0.0) {
            _ if left == right => left,
            // The parameter is on a ridge, so no change of it increases the value.
            (false, false) => 0.0,
            _ if gain_left > gain_right => left,
            _ => right,
        })
    }

    /// Returns the derivative if both one-sided derivatives agree; `None` at a kink.
    pub fn smooth(self) -> Option<f64> {
        // At the end of a range only one of the derivatives is known, which is returned.
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        // Each side is a separate finite difference, so equal slopes differ by round-off.
        let size = left.abs().max(right.abs());
        ((left - right).abs() <= 1e-6 * size).then_some(left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uphill_returns_the_slope_of_steepest_ascent() {
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
