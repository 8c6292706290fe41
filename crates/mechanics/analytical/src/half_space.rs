//! Rigid rectangles and point loads on an elastic half-space.
//!
//! The modulus `E* = E_s/(1 − ν²)` is 1. Rectangles have the half-width `a = 1` along `x`; their
//! width is the dimension in the other direction `z`. The stiffnesses are defined by Eq. (1) of
//! Shafiei et al. (2021, doi 10.1016/j.jmps.2020.104176): `α` relates the reaction of a rectangle
//! to its own displacement, `β` to the displacement of a nearest neighbour.

use std::f64::consts::PI;

/// Stiffnesses of a rigid rectangle for displacements along `x` and `y` and for rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffnesses {
    /// Force along `x` for a unit displacement along `x`.
    pub shear: f64,
    /// Force along `y` for a unit displacement along `y`.
    pub normal: f64,
    /// Moment for a unit rotation about the `z` axis, the direction of the width.
    pub rocking: f64,
}

impl Stiffnesses {
    /// Returns the stiffnesses in the order `x`, `y`, `φ`.
    pub fn values(&self) -> [f64; 3] {
        [self.shear, self.normal, self.rocking]
    }
}

/// Stiffnesses of an isolated square of side `2a`, to four decimals.
///
/// `normal` is `P/δ` of a punch of side `s = 2a` with `P = 1.1523 E* s δ` (N. M. Borodachev,
/// *Contact problem for a stamp with a rectangular base*, J. Appl. Math. Mech. 40 (1976) 505).
/// `shear` (for `ν = 0.5`) and `rocking` were computed with converged boundary elements.
pub const SQUARE: Stiffnesses = Stiffnesses { shear: 1.5384, normal: 2.3046, rocking: 2.0807 };

/// Stiffnesses `α` of the middle one of three squares, for `ν = 0.5`.
///
/// The gaps between the squares are a tenth of their side. Computed with converged boundary
/// elements and truncated after three decimals.
pub const THREE_SQUARES_DIRECT: Stiffnesses =
    Stiffnesses { shear: 2.699, normal: 3.376, rocking: 2.473 };

/// Stiffnesses `β` between the middle square and its neighbour, as for [`THREE_SQUARES_DIRECT`].
pub const THREE_SQUARES_COUPLING: Stiffnesses =
    Stiffnesses { shear: 0.993, normal: 1.082, rocking: -0.428 };

/// Returns the normal displacement at the centre of a square that carries a unit pressure.
///
/// The side of the square is 2. The value `8 asinh(1)/π` is the integral of Boussinesq's solution
/// over the square.
pub fn loaded_square_centre() -> f64 {
    8.0 * 1_f64.asinh() / PI
}

/// Returns the normal displacement at distance `r` from a unit normal point load.
///
/// This is Boussinesq's solution.
pub fn point_load(r: f64) -> f64 {
    1.0 / (PI * r)
}

/// Returns the displacement in the direction of a unit tangential point load.
///
/// The displacement is taken at distance `r` from the load, on its line of action. This is
/// Cerruti's solution.
pub fn tangential_point_load(r: f64, poisson_ratio: f64) -> f64 {
    1.0 / (PI * r * (1.0 - poisson_ratio))
}

/// Returns the normal displacement of the surface at distance `r` from a unit couple.
///
/// The displacement is taken in the plane of the couple. The value is the magnitude of the
/// derivative of [`point_load`] with respect to `r`.
pub fn point_couple(r: f64) -> f64 {
    1.0 / (PI * r * r)
}

/// Returns the stiffnesses of an isolated rectangle `2 × width` for `ν = 0.5`.
///
/// Uses the formulas of A. Pais, E. Kausel, *Soil Dyn. Earthq. Eng.* 7 (1988) 213, doi
/// 10.1016/S0267-7261(88)80005-8, which are accurate to about 6 %. The formulas contain the
/// half-sides `B ≤ L` and the shear modulus `G`, with `G/(1 − ν) = E*/2`.
pub fn pais_kausel(width: f64) -> Stiffnesses {
    let half = width / 2.0;
    let (b, ratio) = (half.min(1.0), half.max(1.0) / half.min(1.0));
    // The scale tilts about the axis along its width, which is the longer axis if `wide`.
    let wide = half >= 1.0;
    let rocking = if wide { 3.2 * ratio + 0.8 } else { 3.73 * ratio.powf(2.4) + 0.27 };
    // The formula for shear has this additional term for forces across the longer side.
    let across = if wide { 0.8 * (ratio - 1.0) } else { 0.0 };
    Stiffnesses {
        shear: b / 6.0 * (6.8 * ratio.powf(0.65) + 2.4 + across),
        normal: 0.5 * b * (3.1 * ratio.powf(0.75) + 1.6),
        rocking: 0.5 * b.powi(3) * rocking,
    }
}

/// Returns the normal stiffness of an isolated rectangle `2 × width`.
///
/// Uses the formula of G. Gazetas, *J. Geotech. Eng.* 117 (1991) 1363, doi
/// 10.1061/(ASCE)0733-9410(1991)117:9(1363), which is accurate to about 6 %.
pub fn gazetas_normal(width: f64) -> f64 {
    let half = width / 2.0;
    let (b, ratio) = (half.min(1.0), half.max(1.0) / half.min(1.0));
    let chi = 1.0 / ratio;
    b * ratio * (0.73 + 1.54 * chi.powf(0.75))
}
