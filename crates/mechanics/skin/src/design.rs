//! The parameters of one design.

use geometry::{OutOfRange, Parallelogram, Row};
use substrate::Footprint;

/// Meaning of `L` in `L/t`: the base of a scale, or half of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// The base is `L` long (`a = L/2`).
    L,
    /// The base is `2L` long (`a = L`).
    TwoL,
}

/// The geometry of one design, lengths over the scale thickness `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    /// Gap `d/t` between neighbouring bases.
    pub gap: f64,
    /// Aspect ratio `L/t`.
    pub length: f64,
    /// Slant `α` of the scales, degrees.
    pub slant_deg: f64,
    /// Meaning of `L`.
    pub base: Base,
    /// Out-of-plane width `b/t`.
    pub width: f64,
}

impl Design {
    /// Half-width `a/t` of a base.
    pub fn half_base(&self) -> f64 {
        match self.base {
            Base::L => self.length / 2.0,
            Base::TwoL => self.length,
        }
    }

    /// Interpolates linearly to another design with the same meaning of `L`.
    pub(crate) fn towards(&self, to: &Self, fraction: f64) -> Self {
        Self {
            gap: self.gap + fraction * (to.gap - self.gap),
            length: self.length + fraction * (to.length - self.length),
            slant_deg: self.slant_deg + fraction * (to.slant_deg - self.slant_deg),
            width: self.width + fraction * (to.width - self.width),
            base: self.base,
        }
    }

    /// Returns the undeformed row.
    ///
    /// # Errors
    /// If a length is not positive or the slant is outside `[0°, 90°)`.
    pub fn row(&self) -> Result<Row, OutOfRange> {
        Row::new(Parallelogram::new(self.half_base(), self.slant_deg)?, self.gap)
    }

    /// Returns the undeformed row, also for a negative slant.
    ///
    /// Perturbing an upright design gives negative slants.
    ///
    /// # Errors
    /// If a length is not positive or the slant is outside `(−90°, 90°)`.
    pub fn leaning_row(&self) -> Result<Row, OutOfRange> {
        Row::new(Parallelogram::leaning(self.half_base(), self.slant_deg)?, self.gap)
    }

    /// Returns the footprint of the bases on a substrate with this Poisson's ratio.
    ///
    /// # Errors
    /// If a length is not positive or Poisson's ratio is outside `[0, 0.5]`.
    pub fn footprint(&self, poisson_ratio: f64) -> Result<Footprint, OutOfRange> {
        // Footprint lengths are over the half-width of a base, design lengths over `t`.
        let a = self.half_base();
        Footprint::new(self.gap / a, self.width / a, poisson_ratio)
    }
}
