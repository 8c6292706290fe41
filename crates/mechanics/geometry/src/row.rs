//! Rows of identical scales at a constant gap.

use crate::{OutOfRange, Parallelogram, coverage};

/// Row of identical scales with the gap `d` at the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    scale: Parallelogram,
    gap: f64,
}

impl Row {
    /// Creates a row of `scale`s with gap `gap` (over `t`) between neighbouring bases.
    ///
    /// # Errors
    /// If the gap is not positive and finite.
    pub fn new(scale: Parallelogram, gap: f64) -> Result<Self, OutOfRange> {
        OutOfRange::unless(gap > 0.0 && gap.is_finite(), "gap", gap, "a positive length")?;
        Ok(Self { scale, gap })
    }

    /// Returns the shape of the scales.
    pub fn scale(&self) -> &Parallelogram {
        &self.scale
    }

    /// Returns the gap `d` between neighbouring bases, over `t`.
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// Returns the pitch `p = 2a + d`, over `t`.
    pub fn pitch(&self) -> f64 {
        2.0 * self.scale.half_base() + self.gap
    }

    /// Returns the coverage `λ = t_s / t` (`docs/theory/model.md`, Eq. G2).
    ///
    /// This is the total length, over the thickness, of the scales to the right of a scale along a
    /// vertical line dropped from its top right corner.
    ///
    /// The coverage is 0 for an exposed substrate, and always below 1.
    pub fn coverage(&self) -> f64 {
        coverage::coverage(self.scale.shift(), 2.0 * self.scale.half_base(), self.pitch())
    }

    /// Returns the one-sided rate of the coverage under changes of the row's lengths.
    ///
    /// The coverage has a kink where the number of crossed scales changes; the rate is the one on
    /// the side to which the change leads.
    pub fn coverage_rate(&self, change: &RowChange) -> f64 {
        let lengths = [self.scale.shift(), 2.0 * self.scale.half_base(), self.pitch()];
        let RowChange { shift, half_base, gap } = *change;
        coverage::coverage_rate(lengths, [shift, 2.0 * half_base, 2.0 * half_base + gap])
    }
}

/// Rates of change of the lengths of a row, over `t`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowChange {
    /// Rate of the shift `S` of the top relative to the base.
    pub shift: f64,
    /// Rate of the half-width `a` of the base.
    pub half_base: f64,
    /// Rate of the gap.
    pub gap: f64,
}
