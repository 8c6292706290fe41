//! The footprint of a row: all that its springs depend on.

use std::hash::{Hash, Hasher};

use geometry::OutOfRange;

/// The bases of a row of scales as the substrate sees them: rectangles `2a × b` at gaps `d`, over
/// the half-width `a`, the Poisson's ratio of the substrate, and its thickness if it is a layer on a rigid base.
///
/// ```text
///        z
///        │   ┌────────┐    ┌────────┐    ┌────────┐  ┬
///        │   │        │    │    ○   │    │        │  b
///        │   └────────┘    └────────┘    └────────┘  ┴
///        └── x        ├ d ─┤─ 2a ───┤
/// ```
///
/// Two footprints are equal, and hash alike, when their four numbers are the same bit by bit
/// (none is NaN, and a zero has no sign), so that a footprint can be the key of a map.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    gap_over_a: f64,
    width_over_a: f64,
    poisson_ratio: f64,
    /// Infinite on the half-space.
    thickness_over_a: f64,
}

/// The bases of a row and their substrate, with lengths in any unit: what its footprint is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bases {
    /// Half the width `a` of a base along the row.
    pub half_width: f64,
    /// The gap `d` between neighbouring bases.
    pub gap: f64,
    /// The width `b` out of the plane.
    pub width: f64,
    /// Poisson's ratio `ν` of the substrate.
    pub poisson_ratio: f64,
    /// The thickness `h` of the substrate; `None` of a half-space.
    pub thickness: Option<f64>,
}

impl Bases {
    /// Returns their footprint.
    ///
    /// # Errors
    /// As [`Footprint::new`] and [`Footprint::on_layer`].
    pub fn footprint(&self) -> Result<Footprint, OutOfRange> {
        let a = self.half_width;
        let footprint = Footprint::new(self.gap / a, self.width / a, self.poisson_ratio)?;
        self.thickness.map_or(Ok(footprint), |thickness| footprint.on_layer(thickness / a))
    }
}

/// The thinnest layer that the cells of a mesh resolve, over `a`.
const THINNEST: f64 = 0.25;

impl Footprint {
    /// Creates the footprint of rectangles with gap `d/a` and out-of-plane width `b/a`, on a substrate of Poisson's ratio `ν`.
    ///
    /// # Errors
    /// If a length is not positive and finite, or `ν` lies outside `[0, 0.5]`.
    pub fn new(gap_over_a: f64, width_over_a: f64, poisson_ratio: f64) -> Result<Self, OutOfRange> {
        positive("gap over a", gap_over_a)?;
        positive("width over a", width_over_a)?;
        let possible = (0.0..=0.5).contains(&poisson_ratio);
        OutOfRange::unless(possible, "poisson's ratio", poisson_ratio, "a ratio from 0 to 0.5")?;
        // −0 + 0 = 0: one key for one number.
        let poisson_ratio = poisson_ratio + 0.0;
        Ok(Self { gap_over_a, width_over_a, poisson_ratio, thickness_over_a: f64::INFINITY })
    }

    /// Returns the same rectangles on a layer of a thickness `h/a`, bonded to a rigid base.
    ///
    /// # Errors
    /// If the layer is thinner than a quarter of the half-width `a`.
    pub fn on_layer(self, thickness_over_a: f64) -> Result<Self, OutOfRange> {
        let possible = thickness_over_a >= THINNEST;
        let expected = "a quarter of the half-width a of a base at least";
        OutOfRange::unless(possible, "thickness of the layer over a", thickness_over_a, expected)?;
        Ok(Self { thickness_over_a, ..self })
    }

    /// Returns the same rectangles on the half-space.
    #[must_use]
    pub fn on_half_space(self) -> Self {
        Self { thickness_over_a: f64::INFINITY, ..self }
    }

    /// Returns the thickness `h/a` of the substrate, infinite if it is a half-space.
    pub fn thickness_over_a(&self) -> f64 {
        self.thickness_over_a
    }

    /// Returns whether the substrate is a layer on a rigid base.
    pub fn is_on_layer(&self) -> bool {
        self.thickness_over_a.is_finite()
    }

    /// Returns the gap `d/a` between neighbouring rectangles.
    pub fn gap_over_a(&self) -> f64 {
        self.gap_over_a
    }

    /// Returns the out-of-plane width `b/a` of the rectangles, whose other side is `2a`.
    pub fn width_over_a(&self) -> f64 {
        self.width_over_a
    }

    /// Returns Poisson's ratio `ν` of the substrate.
    pub fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio
    }

    /// Returns the pitch `p/a = 2 + d/a`.
    pub fn pitch_over_a(&self) -> f64 {
        2.0 + self.gap_over_a
    }

    /// Returns the footprint with one of its numbers larger by a small step: the gap, the width, Poisson's ratio, the thickness. Its
    /// shear has a meaning for ratios beyond the ends of their range too.
    pub(crate) fn moved(&self, number: usize, step: f64) -> Self {
        let mut numbers = self.numbers();
        numbers[number] += step;
        let [gap_over_a, width_over_a, poisson_ratio, thickness_over_a] = numbers;
        Self { gap_over_a, width_over_a, poisson_ratio, thickness_over_a }
    }

    pub(crate) fn numbers(&self) -> [f64; 4] {
        [self.gap_over_a, self.width_over_a, self.poisson_ratio, self.thickness_over_a]
    }

    fn bits(&self) -> [u64; 4] {
        self.numbers().map(f64::to_bits)
    }
}

impl PartialEq for Footprint {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits()
    }
}

impl Eq for Footprint {}

impl Hash for Footprint {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().hash(state);
    }
}

fn positive(quantity: &'static str, value: f64) -> Result<(), OutOfRange> {
    OutOfRange::unless(value > 0.0 && value.is_finite(), quantity, value, "a positive length")
}
