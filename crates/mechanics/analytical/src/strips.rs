//! Rigid strips on an elastic half-plane, the limit of long rectangles.
//!
//! A pressure `p` displaces the surface in plane strain by
//! `u_y = −2/(π E*) ∫ p ln|x − ξ| dξ + const`. On each strip `p = Σ aₙ Tₙ(τ)/√(1 − τ²)` with the
//! Chebyshev polynomials `Tₙ` and the coordinate `τ` from −1 to 1 on this strip. For `n ≥ 1` the
//! integral `∫ Tₙ(τ)/√(1 − τ²) ln|t − τ| dτ` is `−(π/n) Tₙ(t)` on the strip and `−(π/n) wⁿ` beside
//! it, where `w = t − sgn t √(t² − 1)` (N. I. Muskhelishvili, *Singular Integral Equations*,
//! Noordhoff 1953).
//!
//! For a rotation of the middle strip the pressure is odd in `x`, so the constant has no effect.
//! For the same reason the pressure under a long rectangle differs from the pressure under a strip
//! only near the ends of the rectangle.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

/// Moment per unit length for a unit rotation of an isolated strip.
///
/// The half-width of the strip is 1, and `E* = 1`.
pub const ISOLATED_STIFFNESS: f64 = 0.25 * PI;

/// Moments per unit length for a unit rotation of the middle one of three strips.
///
/// The two outer strips are fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rocking {
    /// Moment `α_φ` on the middle strip.
    pub direct: f64,
    /// `β_φ`: moment on an outer strip, with the sign convention of Eq. (1) of Shafiei et al.
    /// (2021).
    pub coupling: f64,
}

/// Returns `α_φ` and `β_φ` per unit length of three strips with gaps `gap` between them.
///
/// The half-width of each strip is 1. The pressure on each strip is a series of Chebyshev
/// polynomials of orders below `2 * terms`. `None` if the equations are singular.
pub fn three_strips(gap: f64, terms: usize) -> Option<Rocking> {
    let centre = 2.0 + gap;
    let size = 3 * terms;
    let mut points = vec![0.0; size];
    for k in 0..2 * terms {
        let point = (PI * (k as f64 + 0.5) / (2 * terms) as f64).cos();
        // Collocation points lie on the right half of the middle strip and on the right strip. The
        // left side follows by antisymmetry.
        if k < terms {
            points[k] = point;
        }
        points[terms + k] = centre + point;
    }
    let displacement = DVector::from_fn(size, |i, _| if i < terms { points[i] } else { 0.0 });
    let potentials = DMatrix::from_fn(size, size, |i, j| {
        let x = points[i];
        let potential = match j.checked_sub(terms) {
            None => log_potential(2 * j + 1, x),
            // The pressure on the left strip is the mirror image of the pressure on the right
            // strip, with the opposite sign.
            Some(n) => log_potential(n, x - centre) - log_potential(n, -x - centre),
        };
        -2.0 / PI * potential
    });
    let loads = potentials.lu().solve(&displacement)?;
    // ∫ τ T₁(τ)/√(1 − τ²) = π/2.
    Some(Rocking { direct: 0.5 * PI * loads[0], coupling: -0.5 * PI * loads[terms + 1] })
}

/// Returns the integral of `Tₙ(τ)/√(1 − τ²) ln|t − τ|` over `τ` from −1 to 1.
fn log_potential(n: usize, t: f64) -> f64 {
    let order = n as f64;
    match (n, t.abs() <= 1.0) {
        (0, true) => -PI * 2_f64.ln(),
        (0, false) => PI * (0.5 * (t.abs() + (t * t - 1.0).sqrt())).ln(),
        (_, true) => -PI / order * (order * t.acos()).cos(),
        (_, false) => -PI / order * (t - t.signum() * (t * t - 1.0).sqrt()).powf(order),
    }
}

#[cfg(test)]
mod tests {
    use super::{ISOLATED_STIFFNESS, three_strips};

    #[test]
    fn twenty_and_forty_terms_give_the_same_stiffnesses() {
        let [coarse, fine] = [20, 40].map(|terms| three_strips(0.05, terms).unwrap());
        assert!((coarse.direct - fine.direct).abs() < 1e-6);
        assert!((coarse.coupling - fine.coupling).abs() < 1e-6);
    }

    #[test]
    fn strips_far_apart_respond_like_an_isolated_strip() {
        let far = three_strips(1e4, 8).unwrap();
        assert!((far.direct - ISOLATED_STIFFNESS).abs() < 1e-6 && far.coupling.abs() < 1e-6);
    }
}
