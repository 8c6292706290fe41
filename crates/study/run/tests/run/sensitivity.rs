//! Derivatives of all measures agree with finite differences of complete solutions.

mod branches;
mod curves;
pub mod designs;
mod differences;
mod failure;
mod kinks;
mod load_positions;
mod scatter;
mod tilts;
mod turning_points;

use std::time::{Duration, Instant};

use rayon::prelude::*;
use results::ParameterDerivative;
use run::Evaluator;
use sweep::{Case, Measure, Parameter, Sweep};

use designs::random_case;
use differences::Differences;

/// Tolerated error of a derivative compared with differences, relative to the derivative.
const TOLERANCE: f64 = 1e-6;

fn derivatives(case: &Case) -> Vec<ParameterDerivative> {
    let solved = Evaluator::new(&Measure::ALL).solve(designs::number(), case);
    solved.row.result.sensitivity
}

/// Compares the derivatives of `case` with differences, and returns the number of comparisons.
///
/// In a long campaign, the derivative of each measure along its gradient is compared, too.
fn compare(case: &Case) -> usize {
    compare_with(case, is_long())
}

/// Compares derivatives with differences, and returns the number of comparisons.
///
/// `along_gradients` also compares the derivative of each measure along its gradient.
fn compare_with(case: &Case, along_gradients: bool) -> usize {
    let (derivatives, differences) = (derivatives(case), Differences::of(case));
    let compared = compare_components(case, &derivatives, &differences);
    // Each gradient needs its own solutions, which take most of the time.
    if !along_gradients {
        return compared;
    }
    compared + compare_along_gradients(case, &derivatives, &differences)
}

/// Compares each derivative with differences, and returns the number of comparisons.
fn compare_components(
    case: &Case,
    derivatives: &[ParameterDerivative],
    differences: &Differences,
) -> usize {
    let mut compared = 0;
    for derivative in derivatives {
        let Some(ours) = derivative.derivative() else { continue };
        let parameter = Parameter::named(derivative.parameter).unwrap();
        let size = parameter.size(case).unwrap();
        let along = [(parameter, size)];
        let Some(off) = differences.off(derivative.measure, &along, ours * size) else { continue };
        let ParameterDerivative { measure, parameter, .. } = derivative;
        assert!(off <= TOLERANCE, "{measure} by {parameter}: {ours:e} is off by {off:e}, {case:?}");
        compared += 1;
    }
    compared
}

/// Compares the derivative of each measure along its gradient with differences.
///
/// In this direction errors of the components do not cancel.
fn compare_along_gradients(
    case: &Case,
    derivatives: &[ParameterDerivative],
    differences: &Differences,
) -> usize {
    let mut measures: Vec<_> = derivatives.iter().map(|d| d.measure).collect();
    measures.dedup();
    let mut compared = 0;
    for measure in measures {
        let mut gradient = Vec::new();
        for derivative in derivatives.iter().filter(|d| d.measure == measure) {
            let parameter = Parameter::named(derivative.parameter).unwrap();
            let size = parameter.size(case).unwrap();
            gradient.extend(derivative.derivative().map(|slope| (parameter, size, slope * size)));
        }
        let length = gradient.iter().map(|(.., slope)| slope * slope).sum::<f64>().sqrt();
        if length == 0.0 {
            continue;
        }
        let along = gradient.iter().map(|(p, size, slope)| (*p, size * slope / length));
        let along: Vec<_> = along.collect();
        let Some(off) = differences.off(measure, &along, length) else { continue };
        assert!(off <= TOLERANCE, "{measure} along its gradient is off by {off:e}, {case:?}");
        compared += 1;
    }
    compared
}

/// Returns true if the environment variable `SQUAMA_CAMPAIGNS` requests a long campaign.
fn is_long() -> bool {
    std::env::var_os("SQUAMA_CAMPAIGNS").is_some_and(|value| value == "long")
}

fn compare_designs(count: u64) {
    let begun = Instant::now();
    let numbers =
        (0..count).into_par_iter().filter(|number| *number < FEW || begun.elapsed() < LONGEST);
    let compared =
        numbers.map(|number| compare_with(&random_case(number), number < 2 || is_long()));
    let compared: Vec<_> = compared.collect();
    assert!(compared.iter().sum::<usize>() > 100 * compared.len(), "{compared:?}");
}

/// Number of designs that are always compared, and time after which no further design is started.
const FEW: u64 = 8;
const LONGEST: Duration = Duration::from_secs(8);

/// Compares eight random designs, and in a long campaign up to three hundred.
#[test]
fn derivatives_match_differences_of_solutions() {
    compare_designs(if is_long() { 300 } else { FEW });
}

/// Compares rows with friction; some of them end with sticking contacts.
///
/// The slip of a sticking contact was accumulated along the path and depends on the parameters,
/// too.
#[test]
fn derivatives_of_rows_with_friction_match_differences() {
    let begun = Instant::now();
    let count = if is_long() { 100 } else { 5 };
    let compared = (0..count)
        .into_par_iter()
        .filter(|number| *number < 5 || begun.elapsed() < LONGEST)
        .map(|number| {
            let mut case = random_case(1000 + number);
            case.common.friction = 0.05 + 0.4 * (number % 7) as f64 / 7.0;
            compare(&case)
        });
    let compared: Vec<_> = compared.collect();
    assert!(compared.iter().sum::<usize>() > 80 * compared.len(), "{compared:?}");
}

/// A smooth maximum of the force moves along the path when a parameter changes.
#[test]
fn the_position_of_a_smooth_peak_has_derivatives() {
    let text = "name = 'smooth-peak'\nmeasures = 'puncture'\n[designs]\ngap_over_t = 0.166\nlength_over_t = 0.735\n\
                slant_deg = 74.723\nwidth_over_t = 1.874\n[substrate]\npoisson_ratio = 0.433\n[puncture]\n\
                load_position = 0.865\ncritical_tilt_deg = 16.63\ncontact_modulus_over_substrate = 114";
    let case = Sweep::parse(text, "smooth-peak.toml", &[]).unwrap().grid().case(0);
    let derivatives = derivatives(&case);
    for measure in ["peak_force", "peak_displacement", "peak_tilt_deg", "load_stability_force"] {
        let by_gap = derivatives
            .iter()
            .filter(|d| d.parameter == "gap_over_t")
            .find(|d| d.measure == measure);
        let by_gap = by_gap.and_then(ParameterDerivative::derivative);
        assert!(by_gap.is_some_and(|slope| slope != 0.0), "{measure}: {by_gap:?}");
    }
    assert!(compare(&case) > 90);
}

/// At a slant of 0, derivatives need solutions at negative slants, which definitions do not accept.
#[test]
fn upright_scales_have_derivatives_in_puncture_and_bending() {
    let mut case = random_case(0);
    case.design.slant_deg = 0.0;
    let derivatives = derivatives(&case);
    for measure in ["critical_force", "compliance", "contact_curvature"] {
        let by_gap = derivatives
            .iter()
            .find(|d| d.measure == measure && d.parameter == "gap_over_t")
            .and_then(ParameterDerivative::derivative);
        assert!(by_gap.is_some_and(|slope| slope != 0.0), "{measure}: {by_gap:?}");
    }
}

/// Designs on a layer have derivatives with respect to all parameters, also its thickness.
#[test]
fn designs_on_a_layer_have_derivatives() {
    let count = if is_long() { 3 } else { 1 };
    for (number, thickness) in [(1, 3.0), (2, 1.2), (5, 7.0)].into_iter().take(count) {
        let case = Case { tissue_thickness: Some(thickness), ..random_case(number) };
        let by_thickness = derivatives(&case);
        let by_thickness = by_thickness.iter().filter(|d| d.parameter == "tissue_thickness_over_t");
        assert!(by_thickness.filter(|d| d.derivative().is_some()).count() > 8);
        assert!(compare(&case) > 100);
    }
}
