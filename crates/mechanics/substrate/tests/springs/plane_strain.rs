//! Long rectangles agree with the plane problem of rigid strips, [`analytical::strips`].
//!
//! The rotational stiffness of a long rectangle grows by the stiffness of the plane problem for
//! each unit of length. An independent method solves the plane problem.

use analytical::strips;
use substrate::{Footprint, extrapolated};

/// Returns `α_φ` and `β_φ` of rectangles per unit length.
///
/// The difference of the values for two lengths eliminates the effect of the ends.
fn slope(gap: f64) -> [f64; 2] {
    let [short, long] = [40.0, 80.0]
        .map(|width| extrapolated(&Footprint::new(gap, width, 0.5).unwrap(), [8, 12]).unwrap());
    [2, 5].map(|i| (long[i] - short[i]) / 40.0)
}

/// A rigid strip without neighbours resists a rotation with `M = (π/4) E* a² φ` per unit length.
#[test]
fn an_isolated_long_rectangle_agrees_with_a_strip() {
    let found = slope(1e4)[0];
    assert!((found - strips::ISOLATED_STIFFNESS).abs() < 2e-4 * found, "{found}");
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
