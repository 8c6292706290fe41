//! Derivatives of forces and moments at given points agree with differences of solutions.

use rayon::prelude::*;
use run::{CurvePoints, Evaluator};
use sweep::{Case, Measure, Parameter, Sweep};

use super::designs::{number, random_case};
use super::is_long;

/// Tolerated error of a derivative times the size of its parameter, relative to the value.
const TOLERANCE: f64 = 1e-6;

type CurveOf = fn(&Evaluator, &Case, &[&'static Parameter], &[f64]) -> CurvePoints;

fn forces(e: &Evaluator, case: &Case, by: &[&'static Parameter], at: &[f64]) -> CurvePoints {
    e.force_curve(case, by, at).expect("a curve")
}

fn moments(e: &Evaluator, case: &Case, by: &[&'static Parameter], at: &[f64]) -> CurvePoints {
    e.moment_curve(case, by, at).expect("a curve")
}

/// Compares the derivatives at points of a curve with differences of solutions.
///
/// Skips points at which differences with a step and with half a step disagree. Returns the number
/// of comparisons.
fn compare(case: &Case, keys: &[&str], positions: &[f64], curve: CurveOf) -> usize {
    let evaluator = Evaluator::new(&[]);
    let parameters: Vec<_> =
        keys.iter().map(|key| Parameter::named(key).expect("a parameter")).collect();
    let points = curve(&evaluator, case, &parameters, positions);
    let mut compared = 0;
    for (j, parameter) in parameters.iter().enumerate() {
        let Some(size) = parameter.size(case) else { continue };
        let around = [-2e-4, -1e-4, 1e-4, 2e-4].map(|by| {
            let moved = parameter.moved(case, by * size).expect("a number");
            curve(&evaluator, &moved, &[], positions)
        });
        for (k, point) in points.iter().enumerate() {
            let Some((point, rate)) = point.as_ref().and_then(|p| Some((p, p.rates[j]?))) else {
                continue;
            };
            let [Some(a), Some(b), Some(c), Some(d)] =
                around.each_ref().map(|curve| Some(curve[k].as_ref()?.value))
            else {
                continue;
            };
            let [near, far] = [(c - b) / 2e-4, (d - a) / 4e-4];
            if (near - far).abs() > 1e-6 * point.value.abs() {
                continue;
            }
            let off = (rate * size - (4.0 * near - far) / 3.0).abs() / point.value.abs();
            assert!(off <= TOLERANCE, "{} at {}: {off:e}, {case:?}", parameter.key, positions[k]);
            compared += 1;
        }
    }
    compared
}

const OF_PUNCTURE: [&str; 8] = [
    "gap_over_t",
    "slant_deg",
    "length_over_t",
    "width_over_t",
    "poisson_ratio",
    "friction",
    "contact_modulus_over_substrate",
    "needle_friction",
];

/// Compares random rows with and without friction, under free and guided needles.
///
/// Some points of the curves lie beyond the critical displacement.
#[test]
fn derivatives_of_force_curves_match_differences() {
    let count = if is_long() { 12 } else { 6_u64 };
    let compared = (0..count).into_par_iter().map(|k| {
        let mut case = random_case(2000 + k);
        case.common.friction = [0.0, 0.2][k as usize % 2];
        if k % 3 == 0 {
            let guided = Parameter::named("needle").expect("a parameter");
            let text = "name = 'x'\n[puncture]\nneedle = 'guided'\nneedle_friction = 0.3";
            let of = Sweep::parse(text, "x.toml", &[]).expect("a sweep").grid().case(0);
            case = guided.put(&case, guided.get(&of));
            let friction = Parameter::named("needle_friction").expect("a parameter");
            case = friction.put(&case, friction.get(&of));
        }
        let solved = Evaluator::new(&[Measure::Puncture]).solve(number(), &case);
        let end = solved.puncture.and_then(|p| Some(p.path.last()?.displacement));
        let Some(end) = end.filter(|end| *end > 0.0) else { return 0 };
        let positions: Vec<_> =
            [0.1, 0.37, 0.62, 0.93, 1.2].iter().map(|part| part * end).collect();
        compare(&case, &OF_PUNCTURE, &positions, forces)
    });
    let compared: Vec<_> = compared.collect();
    assert!(compared.iter().sum::<usize>() > 16 * count as usize, "{compared:?}");
}

/// Compares random strips, with and without contact.
#[test]
fn derivatives_of_moment_curves_match_differences() {
    let keys = [
        "gap_over_t",
        "slant_deg",
        "length_over_t",
        "width_over_t",
        "membrane_thickness_over_t",
        "contact_modulus_over_membrane",
    ];
    let compared = (0..12_u64).into_par_iter().map(|k| {
        let case = random_case(3000 + k);
        let solved = Evaluator::new(&[Measure::Flexure]).solve(number(), &case);
        let end = solved.flexure.and_then(|f| Some(f.path.last()?.curvature));
        let Some(end) = end.filter(|end| *end > 0.0) else { return 0 };
        let positions: Vec<_> = [0.1, 0.4, 0.8].iter().map(|part| part * end).collect();
        compare(&case, &keys, &positions, moments)
    });
    let compared: Vec<_> = compared.collect();
    assert!(compared.iter().sum::<usize>() > 100, "{compared:?}");
}

/// The derivative with respect to an unused parameter is `None`, at the index of the parameter.
#[test]
fn a_parameter_that_the_case_does_not_use_has_no_derivative() {
    let case = random_case(1);
    let case = Case { tissue_thickness: None, ..case };
    let keys = ["gap_over_t", "tissue_thickness_over_t", "slant_deg"];
    let parameters: Vec<_> = keys.iter().filter_map(|key| Parameter::named(key)).collect();
    let points = forces(&Evaluator::new(&[]), &case, &parameters, &[0.01, 1e3]);
    let rates = &points[0].as_ref().expect("a point").rates;
    assert_eq!([0, 1, 2].map(|k| rates[k].is_some()), [true, false, true]);
    assert!(points[1].is_none(), "no path reaches this depth");
}

/// The derivative by a length in mm, times the thickness, is the derivative by length/thickness.
#[test]
fn derivatives_by_lengths_in_mm_equal_scaled_derivatives_by_relative_lengths() {
    let text = "name = 'x'\n[designs]\ngap_mm = 0.5\nlength_mm = 2.0\nslant_deg = 40\n[material]\nthickness_mm = 2.0\nsubstrate_modulus_MPa = 0.1";
    let case = Sweep::parse(text, "x.toml", &[]).expect("a sweep").grid().case(0);
    let keys = ["gap_mm", "gap_over_t", "length_mm", "length_over_t"];
    let parameters = keys.map(|key| Parameter::named(key).expect("a parameter"));
    let points = forces(&Evaluator::new(&[]), &case, &parameters, &[0.05, 0.2]);
    for point in points {
        let rates: Vec<_> = point.expect("a point").rates.into_iter().flatten().collect();
        for pair in rates.chunks(2) {
            assert!((pair[0] * 2.0 - pair[1]).abs() < 1e-8 * pair[1].abs(), "{rates:?}");
        }
        assert_eq!(rates.len(), 4);
    }
}
