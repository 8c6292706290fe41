//! Geometry of one design: gap, aspect ratio, slant, base and width.

use geometry::{OutOfRange, Parallelogram, Row};
use substrate::Footprint;

/// Meaning of `L` in `L/t`: the length of the base of a scale, or half this length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// The base is `L` long (`a = L/2`).
    L,
    /// The base is `2L` long (`a = L`).
    TwoL,
}

/// The geometry of one design; lengths are divided by the scale thickness `t`.
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
    /// Returns the half-width `a/t` of a base.
    pub fn half_base(&self) -> f64 {
        match self.base {
            Base::L => self.length / 2.0,
            Base::TwoL => self.length,
        }
    }

    /// Returns the design at `fraction` (0 to 1) between this design and the design `to`.
    ///
    /// Gap, length, slant and width are interpolated linearly; both designs share their `base`.
    pub(crate) fn towards(&self, to: &Self, fraction: f64) -> Self {
        Self {
            gap: self.gap + fraction * (to.gap - self.gap),
            length: self.length + fraction * (to.length - self.length),
            slant_deg: self.slant_deg + fraction * (to.slant_deg - self.slant_deg),
            width: self.width + fraction * (to.width - self.width),
            base: self.base,
        }
    }

    /// Returns the undeformed row; its scales stand upright or lean to the right.
    ///
    /// # Errors
    /// If a length is not positive or the slant is outside `[0°, 90°)`.
    pub fn row(&self) -> Result<Row, OutOfRange> {
        Row::new(Parallelogram::new(self.half_base(), self.slant_deg)?, self.gap)
    }

    /// Returns the undeformed row; its scales may also lean to the left.
    ///
    /// The slant is negative if difference quotients decrease the slant of an upright design.
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
        // Convert lengths from units of `t` to units of the half-width `a` of a base.
        let a = self.half_base();
        Footprint::new(self.gap / a, self.width / a, poisson_ratio)
    }
}
