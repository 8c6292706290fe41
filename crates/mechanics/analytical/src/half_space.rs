//! Rigid rectangles and point loads on an elastic half-space.
//!
//! Values are in units of `E* = E_s/(1 − ν²)`. Rectangles have the half-width `a = 1` along `x`.
//! The stiffnesses are defined by Eq. (1) of Shafiei et al. (2021, doi 10.1016/j.jmps.2020.104176):
//! `α` couples a rectangle with itself, `β` nearest neighbours.

use std::f64::consts::PI;

/// Stiffnesses of a rigid rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffnesses {
    /// Force along `x` for a unit shift along `x`.
    pub shear: f64,
    /// Force along `y` for a unit shift along `y`.
    pub normal: f64,
    /// Moment for a unit rotation about the axis of the width.
    pub rocking: f64,
}

impl Stiffnesses {
    /// Returns the stiffnesses in the order `x`, `y`, `φ`.
    pub fn values(&self) -> [f64; 3] {
        [self.shear, self.normal, self.rocking]
    }
}

/// Isolated square of side `2a`, to four decimals.
///
/// Normal: a punch of side `s` needs `P = 1.1523 E* s δ` (N. M. Borodachev, *Contact problem for a
/// stamp with a rectangular base*, J. Appl. Math. Mech. 40 (1976) 505), with `s = 2a`. Shear at
/// `ν = 0.5`, and rotation: converged boundary elements.
pub const SQUARE: Stiffnesses = Stiffnesses { shear: 1.5384, normal: 2.3046, rocking: 2.0807 };

/// `α` of three squares with gaps of a tenth of their side at `ν = 0.5`.
///
/// From converged boundary elements, truncated after three decimals.
pub const THREE_SQUARES_DIRECT: Stiffnesses =
    Stiffnesses { shear: 2.699, normal: 3.376, rocking: 2.473 };

/// `β` of the same three squares.
pub const THREE_SQUARES_COUPLING: Stiffnesses =
    Stiffnesses { shear: 0.993, normal: 1.082, rocking: -0.428 };

/// Returns the displacement of the centre of a square under a unit pressure.
///
/// The side of the square is 2. The value `8 asinh(1)/π` is the integral of Boussinesq's solution.
pub fn loaded_square_centre() -> f64 {
    8.0 * 1_f64.asinh() / PI
}

/// Returns the normal displacement at distance `r` from a unit normal load.
///
/// This is the solution of Boussinesq.
pub fn point_load(r: f64) -> f64 {
    1.0 / (PI * r)
}

/// Returns the displacement along a unit tangential load, at distance `r` ahead.
///
/// This is the solution of Cerruti.
pub fn tangential_point_load(r: f64, poisson_ratio: f64) -> f64 {
    1.0 / (PI * r * (1.0 - poisson_ratio))
}

/// Returns the normal displacement at distance `r` in the plane of a unit couple.
///
/// This is the derivative of [`point_load`].
pub fn point_couple(r: f64) -> f64 {
    1.0 / (PI * r * r)
}

/// Returns the stiffnesses of an isolated rectangle `2 × width` at `ν = 0.5`.
///
/// By the formulas of A. Pais, E. Kausel, *Soil Dyn. Earthq. Eng.* 7 (1988) 213, doi
/// 10.1016/S0267-7261(88)80005-8, with an accuracy of about 6 %.
///
/// With the half-sides `B ≤ L` the formulas are written for `G/(1 − ν) = E*/2`.
pub fn pais_kausel(width: f64) -> Stiffnesses {
    let half = width / 2.0;
    // The scale tilts about the axis of its width.
    let (b, ratio) = (half.min(1.0), half.max(1.0) / half.min(1.0));
    let wide = half >= 1.0;
    let rocking = if wide { 3.2 * ratio + 0.8 } else { 3.73 * ratio.powf(2.4) + 0.27 };
    // Shear across the longer side.
    let across = if wide { 0.8 * (ratio - 1.0) } else { 0.0 };
    Stiffnesses {
        shear: b / 6.0 * (6.8 * ratio.powf(0.65) + 2.4 + across),
        normal: 0.5 * b * (3.1 * ratio.powf(0.75) + 1.6),
        rocking: 0.5 * b.powi(3) * rocking,
    }
}

/// Returns the normal stiffness of an isolated rectangle `2 × width`.
///
/// By the formula of G. Gazetas, *J. Geotech. Eng.* 117 (1991) 1363, doi
/// 10.1061/(ASCE)0733-9410(1991)117:9(1363), with an accuracy of about 6 %.
pub fn gazetas_normal(width: f64) -> f64 {
    let half = width / 2.0;
    let (b, ratio) = (half.min(1.0), half.max(1.0) / half.min(1.0));
    let chi = 1.0 / ratio;
    b * ratio * (0.73 + 1.54 * chi.powf(0.75))
}
