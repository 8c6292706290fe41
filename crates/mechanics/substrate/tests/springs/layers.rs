//! Substrates that are layers on a rigid base, (S19)–(S22).

use std::f64::consts::PI;

use approx::assert_relative_eq;
use nalgebra::{Matrix3, Matrix4, Vector4};
use substrate::FootprintParameter::{Gap, PoissonRatio, Size, Thickness, Width};
use substrate::layer::{Layer, deviation_from_half_space};
use substrate::{Coupling, Footprint, NEIGHBOURS, RowStiffness, StiffnessSlopes};

/// Returns the stiffness of a row of square bases at the gap `0.2 a` on a layer.
fn squares(thickness: f64) -> RowStiffness {
    on(0.2, thickness, Coupling::Nearest)
}

fn on(gap: f64, thickness: f64, coupling: Coupling) -> RowStiffness {
    let footprint = Footprint::new(gap, 2.0, 0.5).unwrap().on_layer(thickness).unwrap();
    RowStiffness::compute(&footprint, coupling).unwrap()
}

/// Returns all coefficients of a stiffness.
fn numbers(row: &RowStiffness) -> Vec<f64> {
    let neighbours = row.neighbours.iter();
    let of_neighbour =
        neighbours.flat_map(|n| [n.direct.to_vec(), vec![n.cross, n.lift, n.roll]].concat());
    row.direct.into_iter().chain([row.roll]).chain(of_neighbour).collect()
}

/// Solves the plane equations of a layer with `h = G = 1` under a traction wave `e^(ikx)`.
///
/// The displacements `(i U, V)` are the sum of four fields: two gradients of harmonic functions and
/// two Papkovich–Neuber fields (`κ ψ e_y − y ∇ψ`). They vanish at `y = −1` and have the imposed
/// traction at `y = 0`. Returns `k U` and `k V` at the surface for a normal traction 1, then for a
/// traction `i` along `x`.
fn wave(ratio: f64, k: f64) -> [[f64; 2]; 2] {
    let kappa = 3.0 - 4.0 * ratio;
    // For each field at bottom and top: U, V, shear traction divided by i, normal traction.
    let [bottom, top] = [-1.0, 0.0].map(|y: f64| {
        let fields = [1.0, -1.0].map(|s: f64| {
            let e = (s * k * y).exp();
            let gradient = [k * e, s * k * e, 2.0 * s * k * k * e, 2.0 * k * k * e];
            let (u, v) = (-k * y * e, (kappa - s * k * y) * e);
            let u_slope = -k * e - s * k * k * y * e;
            let v_slope = s * k * (kappa - s * k * y) * e - s * k * e;
            let normal = 2.0 * v_slope + 4.0 * ratio * s * k * e;
            [gradient, [u, v, u_slope + k * v, normal]]
        });
        fields.concat()
    });
    let matrix = Matrix4::from_fn(|row, field| match row {
        0 | 1 => bottom[field][row],
        _ => top[field][row],
    });
    [[0.0, 1.0], [1.0, 0.0]].map(|traction| {
        let right = Vector4::new(0.0, 0.0, traction[0], traction[1]);
        let found = matrix.lu().solve(&right).unwrap();
        [0, 1].map(|part| k * (0..4).map(|field| found[field] * top[field][part]).sum::<f64>())
    })
}

/// Compares (S19) with a direct solution, including the sign of the normal–shear coupling.
#[test]
fn compliances_agree_with_a_directly_solved_layer() {
    for ratio in [0.5, 0.3, 0.0] {
        for x in [0.05, 0.3, 1.0, 2.5, 4.0] {
            let [[crossed, normal], [shear, back]] = wave(ratio, x);
            let [n, mean, difference, cross] = deviation_from_half_space(ratio, x);
            let (deep, incompressible) = (1.0 - ratio, 1.0 - 2.0 * ratio);
            assert_relative_eq!(deep + n, normal, epsilon = 1e-9);
            assert_relative_eq!(deep + mean + difference, shear, epsilon = 1e-9);
            assert_relative_eq!(1.0 + mean - difference, x.tanh(), epsilon = 1e-9);
            assert_relative_eq!(cross - 0.5 * incompressible, crossed, epsilon = 1e-9);
            assert_relative_eq!(crossed, back, epsilon = 1e-9);
        }
    }
}

/// Returns the Bessel function `J` of an integer order by Bessel's integral.
fn bessel(order: f64, z: f64) -> f64 {
    let angles = (0..400).map(|k| PI * (f64::from(k) + 0.5) / 400.0);
    angles.map(|t| (order * t - z * t.sin()).cos()).sum::<f64>() / 400.0
}

/// Integrates a compliance of (S19) times a Bessel function by the trapezoidal rule.
fn hankel_transform(ratio: f64, part: usize, order: f64, rho: f64) -> f64 {
    let step = 0.01;
    let mut values = (0..1600).map(|k| step * f64::from(k)).map(|x| {
        let weight = if x == 0.0 { 0.5 } else { 1.0 };
        weight * deviation_from_half_space(ratio, x)[part] * bessel(order, x * rho)
    });
    let (first, second) = (values.next().unwrap(), values.next().unwrap());
    // The integrand vanishes at the upper limit. At x = 0 the Euler–Maclaurin correction with the
    // slope of the integrand reduces the error of the rule.
    let slope = (second - 2.0 * first) / step;
    (first + second + values.sum::<f64>()) * step + step * step / 12.0 * slope
}

/// Compares the tabulated displacements (S20) due to point loads with the trapezoidal rule.
#[test]
fn point_loads_are_hankel_transforms() {
    for ratio in [0.5, 0.2] {
        for [x, z] in [[0.0, 0.0], [0.3, 0.1], [-1.7, 0.4], [2.0, -5.0], [9.0, 3.0]] {
            let (thickness, r) = (1.5, f64::hypot(x, z));
            let [normal, mean, difference, cross] = [(0, 0.0), (1, 0.0), (2, 2.0), (3, 1.0)]
                .map(|(part, order)| hankel_transform(ratio, part, order, r / thickness));
            let cos = if r > 0.0 { x / r } else { 0.0 };
            let unit = 1.0 / (PI * (1.0 - ratio) * thickness);
            let found = Layer::with_poisson_ratio(ratio).deviation_from_half_space(thickness, x, z);
            let shear = mean - (2.0 * cos * cos - 1.0) * difference;
            assert_relative_eq!(found.normal, unit * normal, epsilon = 1e-6);
            assert_relative_eq!(found.shear, unit * shear, epsilon = 1e-6);
            assert_relative_eq!(found.cross, -unit * cos * cross, epsilon = 1e-6);
        }
    }
}

/// The contribution of the rigid base decreases with the thickness, for normal loads as `1/h`.
#[test]
fn thick_layers_approach_the_half_space() {
    for coupling in [Coupling::Nearest, Coupling::Full] {
        let half_space =
            RowStiffness::compute(&Footprint::new(0.2, 2.0, 0.5).unwrap(), coupling).unwrap();
        let [thick, thicker, thickest] = [2e3, 2e4, 1e9].map(|thickness| {
            let layer = numbers(&on(0.2, thickness, coupling));
            let added = layer.iter().zip(numbers(&half_space)).map(|(layer, half)| layer - half);
            added.collect::<Vec<_>>()
        });
        assert_relative_eq!(thick[1] / thicker[1], 10.0, max_relative = 0.01);
        assert!(thicker.iter().all(|number| number.abs() < 1e-4), "{thicker:?}");
        assert!(thickest.iter().all(|number| number.abs() < 1e-8));
    }
}

/// Compares with two-digit values of an independent program on coarse meshes.
///
/// First the stiffness of an isolated square, divided by its value on the half-space; then `K_0`
/// along the row, `r_0` and `l` of three squares.
#[test]
fn layers_agree_with_an_independent_program() {
    let alone = RowStiffness::compute(&Footprint::new(100.0, 2.0, 0.5).unwrap(), Coupling::Nearest);
    let alone = alone.unwrap().direct;
    for (thickness, expected) in
        [(10.0, [1.05, 1.15, 1.00]), (5.0, [1.11, 1.33, 1.01]), (2.0, [1.29, 2.12, 1.11])]
    {
        let found = on(100.0, thickness, Coupling::Nearest).direct;
        for k in 0..3 {
            assert_relative_eq!(found[k] / alone[k], expected[k], max_relative = 0.02);
        }
    }
    for (thickness, along, roll, lift) in
        [(4.0, 2.7, 0.013, 0.07), (2.0, 2.9, 0.10, 0.28), (1.0, 3.3, 0.51, 0.71)]
    {
        let row = squares(thickness);
        assert_relative_eq!(row.direct[0], along, max_relative = 0.04);
        assert_relative_eq!(row.roll.abs(), roll, max_relative = 0.05);
        assert_relative_eq!(row.neighbours[0].lift.abs(), lift, max_relative = 0.11);
    }
}

/// The estimated error stays below a bound for each thickness; layers thinner than `a/4` are
/// refused.
#[test]
fn the_estimated_error_is_small_and_thin_layers_are_refused() {
    for (thickness, bound) in [(10.0, 1e-4), (2.0, 3e-4), (1.0, 5e-4), (0.5, 2e-3)] {
        let error = squares(thickness).error;
        assert!(error < bound, "{thickness} {error:e}");
    }
    let refused = Footprint::new(0.2, 2.0, 0.5).unwrap().on_layer(0.2).unwrap_err();
    assert!(refused.to_string().contains("a quarter of the half-width"), "{refused}");
}

/// The 3 × 3 stiffness of an infinite row for waves `exp(i q k)`, as in (S12), is positive
/// definite.
#[test]
fn the_stiffness_is_positive_definite() {
    for thickness in [0.5, 1.0, 2.0, 5.0, 20.0] {
        for (coupling, scales) in [(Coupling::Nearest, 1), (Coupling::Full, NEIGHBOURS)] {
            let row = on(0.2, thickness, coupling);
            assert_eq!(row.neighbours.len(), scales);
            for step in 0..=100 {
                let q = PI * f64::from(step) / 100.0;
                let (mut direct, mut roll, mut lift, mut cross) = (row.direct, row.roll, 0.0, 0.0);
                for (k, n) in row.neighbours.iter().enumerate() {
                    let (sin, cos) = ((k + 1) as f64 * q).sin_cos();
                    direct = std::array::from_fn(|i| direct[i] + 2.0 * cos * n.direct[i]);
                    roll += 2.0 * cos * n.roll;
                    (lift, cross) = (lift + 2.0 * sin * n.lift, cross + 2.0 * sin * n.cross);
                }
                // The Hermitian matrix becomes real if y is shifted by a quarter wave.
                let matrix = Matrix3::from_fn(|i, j| match (i.min(j), i.max(j)) {
                    (0, 1) => lift,
                    (0, 2) => roll,
                    (1, 2) => -cross,
                    _ => direct[i],
                });
                let least = matrix.symmetric_eigenvalues().min();
                assert!(least > 0.0, "{thickness} {coupling:?} {q} {least}");
            }
        }
    }
}

/// Derivatives agree with finite differences of the stiffness.
///
/// The parameters are gap, width, Poisson's ratio, thickness, and a common factor of all lengths.
#[test]
fn derivatives_agree_with_differences() {
    for (coupling, [gap, width, ratio, thickness]) in [
        (Coupling::Nearest, [0.23, 1.7, 0.31, 2.6]),
        (Coupling::Nearest, [1.4, 6.0, 0.5, 9.0]),
        (Coupling::Full, [0.3, 2.4, 0.45, 1.9]),
    ] {
        let center = [gap, width, ratio, thickness];
        let found = StiffnessSlopes::compute(&layer(center), coupling).unwrap();
        // Finite differences with respect to gap, width, ratio and thickness, with two step
        // lengths.
        let by: [Vec<f64>; 4] = std::array::from_fn(|k| {
            let step = 1e-3;
            if k == 2 && ratio == 0.5 {
                return Vec::new();
            }
            let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(|steps| {
                let mut moved = center;
                moved[k] += steps * step;
                numbers(&RowStiffness::compute(&layer(moved), coupling).unwrap())
            });
            let four = a.iter().zip(b).zip(c.iter().zip(d));
            four.map(|((a, b), (c, d))| (8.0 * (a - b) - (c - d)) / (12.0 * step)).collect()
        });
        let [by_gap, by_width, by_ratio, by_thickness] = by;
        // The parameter `Size` scales gap, width and thickness.
        let lengths = by_gap.iter().zip(&by_width).zip(&by_thickness);
        let by_size = lengths
            .map(|((by_gap, by_width), by)| gap * by_gap + width * by_width + thickness * by);
        let by_size = by_size.collect();
        for (parameter, expected) in [
            (Gap, by_gap),
            (Width, by_width),
            (Size, by_size),
            (Thickness, by_thickness),
            (PoissonRatio, by_ratio),
        ] {
            let largest = expected.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
            for (ours, expected) in numbers(found.by(parameter).unwrap()).iter().zip(expected) {
                let off = (ours - expected).abs() / largest;
                assert!(off < 1e-6, "{coupling:?} {parameter:?}: {ours} {expected} {off:e}");
            }
        }
    }
}

fn layer([gap, width, ratio, thickness]: [f64; 4]) -> Footprint {
    Footprint::new(gap, width, ratio).unwrap().on_layer(thickness).unwrap()
}
