//! Displacements of the half-space under a loaded cell agree with numerical quadrature.

use std::f64::consts::TAU;

use substrate::half_space::{CornerLine, Influence};

/// Returns the corner functions `A` and `B` of (S3) at the offset `(x, z)`.
fn corner(x: f64, z: f64) -> Influence {
    let [z_part, x_part] = [(x, z), (z, x)]
        .map(|(s, t): (f64, f64)| if s == 0.0 { 0.0 } else { s * (t / s.abs()).asinh() });
    Influence { z_part, x_part }
}

/// Returns the integrals (S3) over the cell `x[0]..x[1]`, `z[0]..z[1]`, seen from the origin.
fn cell(x: [f64; 2], z: [f64; 2]) -> Influence {
    corner(x[1], z[1]) - corner(x[0], z[1]) - corner(x[1], z[0]) + corner(x[0], z[0])
}

/// Integrates `f` by Simpson's rule on `2 half` intervals.
fn simpson(ends: [f64; 2], half: u32, f: impl Fn(f64) -> f64) -> f64 {
    let step = (ends[1] - ends[0]) / f64::from(2 * half);
    let mut sum = 0.0;
    for k in 0..=2 * half {
        let inner = if k % 2 == 1 { 4.0 } else { 2.0 };
        let weight = if k == 0 || k == 2 * half { 1.0 } else { inner };
        sum += weight * f(ends[0] + f64::from(k) * step);
    }
    sum * step / 3.0
}

fn assert_close(found: Influence, z_part: f64, x_part: f64) {
    assert!((found.z_part - z_part).abs() < 1e-9, "{found:?}, expected z_part {z_part}");
    assert!((found.x_part - x_part).abs() < 1e-9, "{found:?}, expected x_part {x_part}");
}

#[test]
fn cells_away_from_the_field_point_agree_with_quadrature() {
    for (x, z) in [([0.3, 0.8], [-0.4, 0.5]), ([-2.0, -1.5], [1.0, 1.5]), ([-0.2, 0.3], [0.5, 0.9])]
    {
        let integrands: [fn(f64, f64) -> f64; 2] = [|_, z| z * z, |x, _| x * x];
        let [z_part, x_part] = integrands
            .map(|f| simpson(x, 100, |x| simpson(z, 100, |z| f(x, z) / x.hypot(z).powi(3))));
        assert_close(cell(x, z), z_part, x_part);
    }
}

/// Uses polar coordinates about the field point, in which the integrand is regular.
///
/// `∬ x²/r³ = ∫ R(θ) cos²θ dθ` with the distance `R(θ)` from the field point to the boundary.
#[test]
fn cells_around_the_field_point_agree_with_quadrature() {
    for (x, z) in [([-0.5_f64, 0.5_f64], [-0.5_f64, 0.5_f64]), ([-0.1, 0.7], [-0.02, 0.05])] {
        let mut corners: Vec<f64> = [(0, 0), (1, 0), (1, 1), (0, 1)]
            .map(|(i, j)| z[j].atan2(x[i]).rem_euclid(TAU))
            .to_vec();
        corners.sort_by(f64::total_cmp);
        corners.push(corners[0] + TAU);
        let [z_part, x_part] = [f64::sin, f64::cos].map(|f| {
            let sides = corners.windows(2).map(|ends| {
                simpson([ends[0], ends[1]], 4000, |angle| {
                    let reach = [(angle.cos(), x), (angle.sin(), z)]
                        .map(|(s, side)| side[usize::from(s > 0.0)] / s);
                    reach[0].min(reach[1]) * f(angle).powi(2)
                })
            });
            sides.sum()
        });
        assert_close(cell(x, z), z_part, x_part);
    }
}

#[test]
fn corner_functions_are_zero_if_an_offset_is_zero() {
    assert_eq!(corner(0.0, 1.0), Influence::default());
    assert_eq!(corner(-2.0, 0.0), Influence::default());
    assert_eq!(corner(0.0, 0.0), Influence::default());
}

/// The centre of a square of side 2 under unit pressure settles by `8 asinh(1)/π`.
#[test]
fn a_uniformly_loaded_square_settles_as_in_closed_form() {
    let square = cell([-1.0, 1.0], [-1.0, 1.0]);
    let exact = analytical::half_space::loaded_square_centre();
    assert!((square.normal() - exact).abs() < 1e-15);
    assert!((square.tangential(0.0) - exact).abs() < 1e-15);
    // For ν = 0.5 the displacement is 1.5 times as large, because both integrals are equal.
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
                assert!((found.z_part - exact.z_part).abs() < 1e-13, "{found:?}, {exact:?}");
                assert!((found.x_part - exact.x_part).abs() < 1e-13, "{found:?}, {exact:?}");
            }
        }
    }
}
