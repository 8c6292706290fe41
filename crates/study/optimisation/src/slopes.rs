//! One-sided derivatives of a value.

use results::SlopeSide;

/// Step of the differences along extrapolated rows, relative to the size of the parameter.
const STEP: f64 = 1e-6;

/// The derivatives of a value on both sides of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes {
    pub left: Option<f64>,
    pub right: Option<f64>,
}

impl Slopes {
    /// No derivative is known.
    pub const UNKNOWN: Self = Self { left: None, right: None };

    /// The value stays as it is.
    pub const FLAT: Self = Self { left: Some(0.0), right: Some(0.0) };

    /// Those of a value that is known where a parameter of that size differs `by` so much, on each side.
    pub fn between(size: Option<f64>, at: impl Fn(f64, SlopeSide) -> Option<f64>) -> Self {
        // Rows are extrapolated along straight lines: a central difference has the rounding of a column's formula alone.
        let on = |side| {
            let step = STEP * size?;
            Some((at(step, side)? - at(-step, side)?) / (2.0 * step))
        };
        Self { left: on(SlopeSide::Left), right: on(SlopeSide::Right) }
    }

    /// The derivatives of a multiple.
    pub fn scaled(self, factor: f64) -> Self {
        Self { left: self.left.map(|x| x * factor), right: self.right.map(|x| x * factor) }
    }

    /// The derivatives of a sum.
    pub fn plus(self, other: Self) -> Self {
        let sum = |one: Option<f64>, other: Option<f64>| Some(one? + other?);
        Self { left: sum(self.left, other.left), right: sum(self.right, other.right) }
    }

    /// The slope of the side on which the value rises the most, 0 if it falls on both. Of two sides that are the same, or one that is
    /// missing, the other. `None` if both are.
    pub fn uphill(self) -> Option<f64> {
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        let (gain_left, gain_right) = (-left, right);
        Some(match (gain_left > 0.0, gain_right > 0.0) {
            _ if left == right => left,
            // On a ridge no step along this variable gains: the climb moves along the others.
            (false, false) => 0.0,
            _ if gain_left > gain_right => left,
            _ => right,
        })
    }

    /// The one slope; `None` at a kink.
    pub fn smooth(self) -> Option<f64> {
        // At the end of a range one side alone exists, and is the derivative.
        let (left, right) = (self.left.or(self.right)?, self.right.or(self.left)?);
        // Both sides come from differences of their own, and agree to their rounding alone where there is no kink.
        let size = left.abs().max(right.abs());
        ((left - right).abs() <= 1e-6 * size).then_some(left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_a_kink_the_way_up_counts() {
        let slopes = |left, right| Slopes { left, right };
        assert_eq!(slopes(Some(2.0), Some(2.0)).uphill(), Some(2.0));
        assert_eq!(slopes(Some(1.0), Some(-3.0)).uphill(), Some(0.0));
        assert_eq!(slopes(Some(-1.0), Some(3.0)).uphill(), Some(3.0));
        assert_eq!(slopes(Some(-4.0), Some(3.0)).uphill(), Some(-4.0));
        assert_eq!(slopes(Some(-4.0), Some(-3.0)).uphill(), Some(-4.0));
        assert_eq!(slopes(None, Some(-3.0)).uphill(), Some(-3.0));
        assert_eq!(slopes(None, None).uphill(), None);
        assert_eq!(slopes(Some(1.0), Some(1.1)).smooth(), None);
        assert_eq!(slopes(Some(1.0), Some(1.0)).smooth(), Some(1.0));
    }
}
