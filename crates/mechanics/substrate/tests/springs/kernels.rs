//! Corner functions against numerical quadrature.

use std::f64::consts::TAU;

use substrate::half_space::{CornerLine, Influence, cell, corner};

/// Integrates by Simpson's rule on `2 half` intervals.
fn simpson(ends: [f64; 2], half: u32, f: impl Fn(f64) -> f64) -> f64 {
    let step = (ends[1] - ends[0]) / f64::from(2 * half);
    let weight = |k: u32| match k {
        0 => 1.0,
        k if k == 2 * half => 1.0,
        k if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=2 * half).map(|k| weight(k) * f(ends[0] + f64::from(k) * step)).sum::<f64>() * step / 3.0
}

fn assert_close(found: Influence, across: f64, along: f64) {
    assert!((found.across - across).abs() < 1e-9, "{found:?}, expected across {across}");
    assert!((found.along - along).abs() < 1e-9, "{found:?}, expected along {along}");
}

#[test]
fn cells_away_from_the_field_point() {
    for (x, z) in [([0.3, 0.8], [-0.4, 0.5]), ([-2.0, -1.5], [1.0, 1.5]), ([-0.2, 0.3], [0.5, 0.9])]
    {
        let integral = |f: fn(f64, f64) -> f64| {
            simpson(x, 100, |x| simpson(z, 100, |z| f(x, z) / x.hypot(z).powi(3)))
        };
        assert_close(cell(x, z), integral(|_, z| z * z), integral(|x, _| x * x));
    }
}

/// In polar coordinates about an inner field point the integrand is regular.
///
/// `∬ x²/r³ = ∫ R(θ) cos²θ dθ` with the distance `R` to the boundary.
#[test]
fn cells_around_the_field_point() {
    for (x, z) in [([-0.5_f64, 0.5_f64], [-0.5_f64, 0.5_f64]), ([-0.1, 0.7], [-0.02, 0.05])] {
        let boundary = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let reach = |s: f64, side: [f64; 2]| side[usize::from(s > 0.0)] / s;
            reach(cos, x).min(reach(sin, z))
        };
        let mut corners: Vec<f64> = [(0, 0), (1, 0), (1, 1), (0, 1)]
            .map(|(i, j)| z[j].atan2(x[i]).rem_euclid(TAU))
            .to_vec();
        corners.sort_by(f64::total_cmp);
        corners.push(corners[0] + TAU);
        let integral = |f: fn(f64) -> f64| -> f64 {
            let side = |ends: &[f64]| {
                simpson([ends[0], ends[1]], 4000, |angle| boundary(angle) * f(angle).powi(2))
            };
            corners.windows(2).map(side).sum()
        };
        assert_close(cell(x, z), integral(f64::sin), integral(f64::cos));
    }
}

#[test]
fn corner_functions_vanish_with_their_factor() {
    assert_eq!(corner(0.0, 1.0), Influence::default());
    assert_eq!(corner(-2.0, 0.0), Influence::default());
    assert_eq!(corner(0.0, 0.0), Influence::default());
}

/// The centre of a uniformly loaded square of side 2 settles by `8 asinh(1)/π`.
#[test]
fn centre_of_a_uniformly_loaded_square() {
    let square = cell([-1.0, 1.0], [-1.0, 1.0]);
    let exact = analytical::half_space::loaded_square_centre();
    assert!((square.normal() - exact).abs() < 1e-15);
    assert!((square.tangential(0.0) - exact).abs() < 1e-15);
    // Incompressible: larger by half, by symmetry of the square.
    assert!((square.tangential(0.5) - 1.5 * exact).abs() < 1e-14);
}

#[test]
fn a_line_of_corners_agrees_with_single_corners() {
    let depths = [-3.0, -0.5, -1e-6, 0.0, 0.25, 1.0, 40.0];
    for field in [0.0, 0.2, -0.5] {
        let line = CornerLine::new(depths, field);
        for x in [-5.0, -1e-7, 0.3, 2.0] {
            let mut corners = vec![Influence::default(); line.len()];
            line.evaluate(x, &mut corners);
            for (found, depth) in corners.into_iter().zip(depths) {
                let exact = corner(x, depth - field);
                assert!((found.across - exact.across).abs() < 1e-13, "{found:?}, {exact:?}");
                assert!((found.along - exact.along).abs() < 1e-13, "{found:?}, {exact:?}");
            }
        }
    }
}
