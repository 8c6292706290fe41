//! Footprint of a row: the dimensionless parameters that determine its springs.

use std::hash::{Hash, Hasher};

use geometry::OutOfRange;

/// Dimensionless bases of a row of scales, as loaded areas of the substrate.
///
/// The bases are rectangles `2a × b` at gaps `d`. All lengths are divided by the half-width `a`.
/// The substrate has a Poisson's ratio, and a thickness if it is a layer on a rigid base.
///
/// ```text
///        z
///        │   ┌────────┐    ┌────────┐    ┌────────┐  ┬
///        │   │        │    │    ○   │    │        │  b
///        │   └────────┘    └────────┘    └────────┘  ┴
///        └── x        ├ d ─┤─ 2a ───┤
/// ```
///
/// Two footprints are equal, with equal hash, if their four numbers are bitwise equal. No number is
/// NaN and zeros are positive, so a footprint can be the key of a hash map.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    gap_over_a: f64,
    width_over_a: f64,
    poisson_ratio: f64,
    /// Substrate thickness divided by the half-width `a`; infinite for a half-space.
    thickness_over_a: f64,
}

/// Bases of a row and their substrate, with lengths in any unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bases {
    /// Half-width `a` of a base along the row.
    pub half_width: f64,
    /// Gap `d` between neighbouring bases.
    pub gap: f64,
    /// Width `b` out of the plane.
    pub width: f64,
    /// Poisson's ratio `ν` of the substrate.
    pub poisson_ratio: f64,
    /// Thickness `h` of the substrate; `None` for a half-space.
    pub thickness: Option<f64>,
}

/// Parameter of a footprint with respect to which a stiffness is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FootprintParameter {
    /// Gap `d/a`.
    Gap,
    /// Width out of the plane `b/a`.
    Width,
    /// Poisson's ratio `ν`.
    PoissonRatio,
    /// Thickness of the substrate `h/a`.
    Thickness,
    /// Logarithm of a common factor of `d/a`, `b/a` and `h/a`, which grow if `a` shrinks.
    Size,
}

impl Bases {
    /// Returns the footprint of the bases.
    ///
    /// # Errors
    /// If a parameter is out of range, see [`Footprint::new`] and [`Footprint::on_layer`].
    pub fn footprint(&self) -> Result<Footprint, OutOfRange> {
        let a = self.half_width;
        let footprint = Footprint::new(self.gap / a, self.width / a, self.poisson_ratio)?;
        self.thickness.map_or(Ok(footprint), |thickness| footprint.on_layer(thickness / a))
    }
}

/// Smallest layer thickness divided by `a` that the cells of a mesh resolve.
const THINNEST: f64 = 0.25;

impl Footprint {
    /// Creates the footprint of rectangles on a half-space.
    ///
    /// Arguments are the gap `d/a`, the out-of-plane width `b/a` and Poisson's ratio `ν`.
    ///
    /// # Errors
    /// If a length is not positive and finite, or `ν` lies outside `0..=0.5`.
    pub fn new(gap_over_a: f64, width_over_a: f64, poisson_ratio: f64) -> Result<Self, OutOfRange> {
        positive("gap over a", gap_over_a)?;
        positive("width over a", width_over_a)?;
        let possible = (0.0..=0.5).contains(&poisson_ratio);
        OutOfRange::unless(possible, "poisson's ratio", poisson_ratio, "a ratio from 0 to 0.5")?;
        // −0.0 + 0.0 = +0.0, so that ratios of −0.0 and +0.0 have the same hash.
        let poisson_ratio = poisson_ratio + 0.0;
        Ok(Self { gap_over_a, width_over_a, poisson_ratio, thickness_over_a: f64::INFINITY })
    }

    /// Returns the footprint of the same rectangles on a bonded layer of thickness `h/a`.
    ///
    /// # Errors
    /// If the layer is thinner than a quarter of the half-width `a`.
    pub fn on_layer(self, thickness_over_a: f64) -> Result<Self, OutOfRange> {
        let possible = thickness_over_a >= THINNEST;
        let expected = "at least a quarter of the half-width a of a base";
        OutOfRange::unless(possible, "thickness of the layer over a", thickness_over_a, expected)?;
        Ok(Self { thickness_over_a, ..self })
    }

    /// Returns the footprint of the same rectangles on the half-space.
    #[must_use]
    pub fn on_half_space(self) -> Self {
        Self { thickness_over_a: f64::INFINITY, ..self }
    }

    /// Returns the thickness `h/a` of the substrate, infinite if it is a half-space.
    pub fn thickness_over_a(&self) -> f64 {
        self.thickness_over_a
    }

    /// Returns true if the substrate is a layer on a rigid base.
    pub fn is_on_layer(&self) -> bool {
        self.thickness_over_a.is_finite()
    }

    /// Returns the gap `d/a` between neighbouring rectangles.
    pub fn gap_over_a(&self) -> f64 {
        self.gap_over_a
    }

    /// Returns the out-of-plane width `b/a` of the rectangles.
    pub fn width_over_a(&self) -> f64 {
        self.width_over_a
    }

    /// Returns Poisson's ratio `ν` of the substrate.
    pub fn poisson_ratio(&self) -> f64 {
        self.poisson_ratio
    }

    /// Returns the pitch `p/a = 2 + d/a` of the rectangles.
    pub fn pitch_over_a(&self) -> f64 {
        2.0 + self.gap_over_a
    }

    /// Returns the footprint with one of its numbers increased by `step`.
    ///
    /// `number` is 0 for the gap, 1 for the width, 2 for Poisson's ratio and 3 for the thickness.
    /// Poisson's ratio may leave its valid range, because the shear compliance is defined beyond
    /// it.
    pub(crate) fn moved(&self, number: usize, step: f64) -> Self {
        let mut numbers = self.numbers();
        numbers[number] += step;
        let [gap_over_a, width_over_a, poisson_ratio, thickness_over_a] = numbers;
        Self { gap_over_a, width_over_a, poisson_ratio, thickness_over_a }
    }

    /// Returns the step of a finite difference with respect to a parameter.
    ///
    /// For a length the step is `fraction` times this length, for Poisson's ratio `fraction`
    /// itself.
    pub(crate) fn step(&self, parameter: FootprintParameter, fraction: f64) -> f64 {
        match parameter {
            FootprintParameter::PoissonRatio => fraction,
            length => fraction * self.numbers()[length as usize],
        }
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
