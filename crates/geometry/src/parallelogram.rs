//! One scale.

use crate::Vec2;

/// A number that no scale or row can have.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} is {value}, expected {expected}")]
pub struct InvalidGeometry {
    /// Which quantity.
    pub quantity: &'static str,
    /// What was given.
    pub value: f64,
    /// What would be right.
    pub expected: &'static str,
}

/// A scale: a parallelogram of height 1 (the thickness `t`) that leans to the right.
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
}

/// A corner of a scale.
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
    /// The four corners, counter-clockwise from the bottom left.
    pub const ALL: [Self; 4] = [Self::BottomLeft, Self::BottomRight, Self::TopRight, Self::TopLeft];
}

impl Parallelogram {
    /// A scale with half-width `half_base` of its base (over `t`) and slant `slant_deg` from the
    /// vertical (degrees).
    ///
    /// # Errors
    /// If `half_base` is not positive and finite, or the slant lies outside `[0°, 90°)`.
    pub fn new(half_base: f64, slant_deg: f64) -> Result<Self, InvalidGeometry> {
        if half_base > 0.0 && !(0.0..90.0).contains(&slant_deg) {
            let expected = "an angle of at least 0° and below 90°";
            return Err(InvalidGeometry { quantity: "slant", value: slant_deg, expected });
        }
        Self::leaning(half_base, slant_deg)
    }

    /// A scale that may lean to the left too: its slant is then negative. Designs lean to the right;
    /// single scales of an imperfect row need not.
    ///
    /// # Errors
    /// If `half_base` is not positive and finite, or the slant lies outside `(−90°, 90°)`.
    pub fn leaning(half_base: f64, slant_deg: f64) -> Result<Self, InvalidGeometry> {
        if !(half_base > 0.0 && half_base.is_finite()) {
            return Err(InvalidGeometry {
                quantity: "half-width of the base",
                value: half_base,
                expected: "a positive length",
            });
        }
        if slant_deg.is_nan() || slant_deg.abs() >= 90.0 {
            let expected = "an angle between -90° and 90°";
            return Err(InvalidGeometry { quantity: "slant", value: slant_deg, expected });
        }
        Ok(Self { half_base, slant: slant_deg.to_radians() })
    }

    /// Half-width `a` of the base, over `t`.
    pub fn half_base(&self) -> f64 {
        self.half_base
    }

    /// Slant angle `α`, in radians.
    pub fn slant(&self) -> f64 {
        self.slant
    }

    /// Horizontal shift `S = t tan α` of the top against the base, over `t`.
    pub fn shift(&self) -> f64 {
        self.slant.tan()
    }

    /// Position of a corner relative to the node, undeformed.
    pub fn corner(&self, corner: Corner) -> Vec2 {
        let (a, s) = (self.half_base, self.shift());
        match corner {
            Corner::BottomLeft => Vec2::new(-a, 0.0),
            Corner::BottomRight => Vec2::new(a, 0.0),
            Corner::TopRight => Vec2::new(a + s, 1.0),
            Corner::TopLeft => Vec2::new(s - a, 1.0),
        }
    }

    /// The four corners relative to the node, counter-clockwise from the bottom left.
    pub fn corners(&self) -> [Vec2; 4] {
        Corner::ALL.map(|corner| self.corner(corner))
    }
}
