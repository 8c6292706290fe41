//! Long rectangles against the plane problem of [`analytical::strips`].
//!
//! Each unit of length adds the rotational stiffness of the plane problem, solved by an independent
//! method.

use analytical::strips;
use substrate::{Footprint, extrapolated};

/// Returns `α_φ` and `β_φ` per length from rectangles.
///
/// The difference of two lengths eliminates end effects.
fn slope(gap: f64) -> [f64; 2] {
    let [short, long] = [40.0, 80.0]
        .map(|width| extrapolated(&Footprint::new(gap, width, 0.5).unwrap(), [8, 12]).unwrap());
    [2, 5].map(|i| (long[i] - short[i]) / 40.0)
}

/// An isolated rigid strip resists a rotation with `M = (π/4) E* a² φ` per length.
#[test]
fn a_long_rectangle_alone_agrees_with_a_strip() {
    let found = slope(1e4)[0];
    assert!((found - strips::ALONE).abs() < 2e-4 * found, "{found}");
}

#[test]
fn long_rectangles_in_a_row_agree_with_strips() {
    for gap in [0.05, 0.2, 1.0] {
        let ([direct, coupling], exact) = (slope(gap), strips::three_strips(gap, 30).unwrap());
        let alpha = exact.direct;
        assert!((direct - alpha).abs() < 3e-4 * alpha, "d/a = {gap}: {direct}, {exact:?}");
        assert!(
            (coupling - exact.coupling).abs() < 3e-4 * alpha,
            "d/a = {gap}: {coupling}, {exact:?}"
        );
    }
}
