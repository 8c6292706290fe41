//! Parallelogram shape of a single scale, and its corners.

use crate::{OutOfRange, Vec2};

/// Scale: a parallelogram of height 1 (the thickness `t`) that leans to the right.
///
/// ```text
///        TL ────────── TR      y = 1
///        ╱            ╱
///       ╱     α ╱    ╱         α from the vertical
///      BL ───○───── BR         y = 0, node ○ at the midpoint of the base
///        ├ a ┼─ a ─┤
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallelogram {
    half_base: f64,
    slant: f64,
    /// Shift `S = tan α` of the top relative to the base, in units of `t`.
    ///
    /// Stored so that the tangent is not computed again for every corner.
    shift: f64,
}

/// Corner of a scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Left end of the base.
    BottomLeft,
    /// Right end of the base.
    BottomRight,
    /// Right end of the top.
    TopRight,
    /// Left end of the top.
    TopLeft,
}

impl Corner {
    /// All corners, counter-clockwise from the bottom left.
    pub const ALL: [Self; 4] = [Self::BottomLeft, Self::BottomRight, Self::TopRight, Self::TopLeft];
}

impl Parallelogram {
    /// Creates a scale that is upright or leans to the right.
    ///
    /// `half_base` is the half-width `a` of the base in units of `t`; `slant_deg` is in degrees.
    ///
    /// # Errors
    /// If `half_base` is not positive and finite, or the slant lies outside `[0°, 90°)`.
    pub fn new(half_base: f64, slant_deg: f64) -> Result<Self, OutOfRange> {
        check_half_base(half_base)?;
        let expected = "an angle of at least 0° and below 90°";
        OutOfRange::unless((0.0..90.0).contains(&slant_deg), "slant", slant_deg, expected)?;
        Self::leaning(half_base, slant_deg)
    }

    /// Creates a scale that may also lean to the left, with a negative slant.
    ///
    /// The scales of a design lean to the right, but a scale of an imperfect row may lean to the
    /// left. `half_base` is in units of `t`; `slant_deg` is in degrees.
    ///
    /// # Errors
    /// If `half_base` is not positive and finite, or the slant lies outside `(−90°, 90°)`.
    pub fn leaning(half_base: f64, slant_deg: f64) -> Result<Self, OutOfRange> {
        check_half_base(half_base)?;
        let expected = "an angle between -90° and 90°";
        OutOfRange::unless(slant_deg.abs() < 90.0, "slant", slant_deg, expected)?;
        let slant = slant_deg.to_radians();
        Ok(Self { half_base, slant, shift: slant.tan() })
    }

    /// Returns the half-width `a` of the base, in units of `t`.
    pub fn half_base(&self) -> f64 {
        self.half_base
    }

    /// Returns the slant `α`, in radians.
    pub fn slant(&self) -> f64 {
        self.slant
    }

    /// Returns the shift `S/t = tan α` of the top relative to the base.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// Returns the position of a corner relative to the node in the undeformed scale.
    pub fn corner(&self, corner: Corner) -> Vec2 {
        let (a, s) = (self.half_base, self.shift());
        match corner {
            Corner::BottomLeft => Vec2::new(-a, 0.0),
            Corner::BottomRight => Vec2::new(a, 0.0),
            Corner::TopRight => Vec2::new(a + s, 1.0),
            Corner::TopLeft => Vec2::new(s - a, 1.0),
        }
    }

    /// Returns the positions of all corners relative to the node in the undeformed scale.
    ///
    /// The order is counter-clockwise from the bottom left corner, as in [`Corner::ALL`].
    pub fn corners(&self) -> [Vec2; 4] {
        Corner::ALL.map(|corner| self.corner(corner))
    }
}

fn check_half_base(half_base: f64) -> Result<(), OutOfRange> {
    let positive = half_base > 0.0 && half_base.is_finite();
    OutOfRange::unless(positive, "half-width of the base", half_base, "a positive length")
}
