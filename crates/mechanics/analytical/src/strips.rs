//! Rigid strips on an elastic half-plane, the limit of long rectangles.
//!
//! In plane strain, `u_y' = −2/(π E*) ∫ p ln|x − ξ| dξ + const`. With `p = Σ aₙ Tₙ(τ)/√(1 − τ²)` on
//! each strip, `∫ Tₙ(τ)/√(1 − τ²) ln|t − τ| dτ` is `−(π/n) Tₙ(t)` on the strip and `−(π/n) wⁿ` off
//! it, `w = t − sgn t √(t² − 1)` (N. I. Muskhelishvili, *Singular Integral Equations*, Noordhoff
//! 1953). The rotation is odd in `x`, so the constant has no effect, and end effects stay at the
//! ends of a long rectangle.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

/// Moment per length for a unit rotation of an isolated strip.
///
/// The strip has half-width 1, and `E* = 1`.
pub const ALONE: f64 = 0.25 * PI;

/// Moments per length for a unit rotation of the middle one of three strips.
///
/// The outer strips are fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rocking {
    /// `α_φ`: moment on the middle strip.
    pub direct: f64,
    /// `β_φ`: moment on a neighbour, with the sign of Eq. (1) of Shafiei et al. (2021).
    pub coupling: f64,
}

/// Returns `α_φ` and `β_φ` per length of three strips at gaps `gap`.
///
/// The strips have half-width 1. Uses `2 terms` Chebyshev polynomials on each strip. `None` if the
/// equations are singular.
pub fn three_strips(gap: f64, terms: usize) -> Option<Rocking> {
    let centre = 2.0 + gap;
    let size = 3 * terms;
    let mut points = vec![0.0; size];
    for k in 0..2 * terms {
        let point = (PI * (k as f64 + 0.5) / (2 * terms) as f64).cos();
        // The positive half of the middle strip, then the right strip.
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
            // The left strip mirrors the right one and carries the opposite pressure.
            Some(n) => log_potential(n, x - centre) - log_potential(n, -x - centre),
        };
        -2.0 / PI * potential
    });
    let loads = potentials.lu().solve(&displacement)?;
    // ∫ τ T₁(τ)/√(1 − τ²) = π/2.
    Some(Rocking { direct: 0.5 * PI * loads[0], coupling: -0.5 * PI * loads[terms + 1] })
}

/// Returns `∫ Tₙ(τ)/√(1 − τ²) ln|t − τ| dτ` over `−1 … 1`.
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
    use super::{ALONE, three_strips};

    #[test]
    fn the_series_has_converged() {
        let [coarse, fine] = [20, 40].map(|terms| three_strips(0.05, terms).unwrap());
        assert!((coarse.direct - fine.direct).abs() < 1e-6);
        assert!((coarse.coupling - fine.coupling).abs() < 1e-6);
    }

    #[test]
    fn strips_far_apart_are_alone() {
        let far = three_strips(1e4, 8).unwrap();
        assert!((far.direct - ALONE).abs() < 1e-6 && far.coupling.abs() < 1e-6);
    }
}
