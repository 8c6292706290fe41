//! Long rectangles: what a unit of length adds to the rotational stiffness is the solution of the
//! plane problem, found here by another method altogether.
//!
//! In plane strain `u_y' = −2/(π E*) ∫ p ln|x − ξ| dξ + const`. With `p = Σ aₙ Tₙ(τ)/√(1 − τ²)` on each
//! strip, `∫ Tₙ(τ)/√(1 − τ²) ln|t − τ| dτ` is `−(π/n) Tₙ(t)` on the strip and `−(π/n) wⁿ` off it,
//! `w = t − sgn t √(t² − 1)` (Muskhelishvili). The rotation is odd in `x`, so nothing depends on the
//! constant, and the end effects of a long rectangle stay at its ends.

use std::f64::consts::PI;

use faer::Mat;
use faer::prelude::Solve;
use substrate::{Footprint, extrapolated};

/// `∫ Tₙ(τ)/√(1 − τ²) ln|t − τ| dτ` over `−1 … 1`.
fn log_potential(n: usize, t: f64) -> f64 {
    let inside = t.abs() <= 1.0;
    match (n, inside) {
        (0, true) => -PI * 2_f64.ln(),
        (0, false) => PI * (0.5 * (t.abs() + (t * t - 1.0).sqrt())).ln(),
        (_, true) => -PI / n as f64 * (n as f64 * t.acos()).cos(),
        (_, false) => {
            let w = t - t.signum() * (t * t - 1.0).sqrt();
            -PI / n as f64 * w.powi(i32::try_from(n).unwrap())
        }
    }
}

/// `α_φ` and `β_φ` per length of three strips of half-width 1 at gaps `gap`, from `2 terms` Chebyshev
/// polynomials on each.
fn strips(gap: f64, terms: usize) -> [f64; 2] {
    let centre = 2.0 + gap;
    let point = |k: usize, n: usize| (PI * (k as f64 + 0.5) / n as f64).cos();
    // The positive half of the middle strip, then the right strip.
    let x = |i: usize| {
        if i < terms { point(i, 2 * terms) } else { centre + point(i - terms, 2 * terms) }
    };
    let potential = |i: usize, j: usize| {
        let odd = |n: usize, x: f64| log_potential(n, x - centre) - log_potential(n, -x - centre);
        let x = x(i);
        -2.0 / PI * if j < terms { log_potential(2 * j + 1, x) } else { odd(j - terms, x) }
    };
    let size = 3 * terms;
    let displacement = Mat::from_fn(size, 1, |i, _| if i < terms { x(i) } else { 0.0 });
    let loads = Mat::from_fn(size, size, potential).partial_piv_lu().solve(&displacement);
    // ∫ τ T₁(τ)/√(1 − τ²) = π/2.
    [0.5 * PI * loads[(0, 0)], -0.5 * PI * loads[(terms + 1, 0)]]
}

/// The same from the rectangles: the difference of two lengths leaves out their ends.
fn slope(gap: f64) -> [f64; 2] {
    let of = |width: f64| extrapolated(&Footprint::new(gap, width, 0.5).unwrap(), [8, 12]).unwrap();
    let (short, long) = (of(40.0), of(80.0));
    [2, 5].map(|i| (long[i] - short[i]) / 40.0)
}

#[test]
fn the_plane_solution_has_converged() {
    let [coarse, fine] = [20, 40].map(|terms| strips(0.05, terms));
    assert!((coarse[0] - fine[0]).abs() < 1e-6 && (coarse[1] - fine[1]).abs() < 1e-6);
}

/// A rigid strip alone resists a rotation with `M = (π/4) E* a² φ` per length.
#[test]
fn a_long_rectangle_alone() {
    assert!((strips(1e4, 8)[0] - 0.25 * PI).abs() < 1e-6);
    let found = slope(1e4)[0];
    assert!((found - 0.25 * PI).abs() < 2e-4 * found, "{found}");
}

#[test]
fn long_rectangles_in_a_row() {
    for gap in [0.05, 0.2, 1.0] {
        let ([direct, coupling], [alpha, beta]) = (slope(gap), strips(gap, 30));
        assert!((direct - alpha).abs() < 3e-4 * alpha, "d/a = {gap}: {direct}, {alpha}");
        assert!((coupling - beta).abs() < 3e-4 * alpha, "d/a = {gap}: {coupling}, {beta}");
    }
}
