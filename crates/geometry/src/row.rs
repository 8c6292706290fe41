//! Identical scales at a constant gap.

use crate::{InvalidGeometry, Parallelogram, coverage};

/// A row of identical scales, separated by the gap `d` at the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    scale: Parallelogram,
    gap: f64,
}

impl Row {
    /// A row of `scale`s with gap `gap` (over `t`) between neighbouring bases.
    ///
    /// # Errors
    /// If the gap is not positive and finite.
    pub fn new(scale: Parallelogram, gap: f64) -> Result<Self, InvalidGeometry> {
        if gap > 0.0 && gap.is_finite() {
            Ok(Self { scale, gap })
        } else {
            Err(InvalidGeometry { quantity: "gap", value: gap, expected: "a positive length" })
        }
    }

    /// The scale of which the row is made.
    pub fn scale(&self) -> &Parallelogram {
        &self.scale
    }

    /// Gap `d` between neighbouring bases, over `t`.
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// Pitch `p = 2a + d`, over `t`.
    pub fn pitch(&self) -> f64 {
        2.0 * self.scale.half_base() + self.gap
    }

    /// Coverage `λ = t_s / t` (`docs/theory.md`, Eq. G2): the total length, over the thickness, that a vertical
    /// line dropped from the top right corner of a scale cuts in the scales to its right.
    ///
    /// 0 (the substrate is exposed) to below 1.
    pub fn coverage(&self) -> f64 {
        coverage::coverage(self.scale.shift(), 2.0 * self.scale.half_base(), self.pitch())
    }
}
