//! Derivatives with respect to the critical tilt.

use rayon::prelude::*;
use results::ParameterDerivative;
use sweep::{Case, Parameter, Sweep};

use super::designs::random_case;
use super::differences::Differences;
use super::{compare_components, derivatives, is_long};

const TILT: &str = "critical_tilt_deg";

fn by_tilt(case: &Case) -> Vec<ParameterDerivative> {
    let mut derivatives = derivatives(case);
    derivatives.retain(|derivative| derivative.parameter == TILT);
    derivatives
}

/// Compares every twentieth design of the paper, and in a long campaign every design.
#[test]
fn derivatives_with_respect_to_the_critical_tilt_match_differences() {
    let paper = Sweep::parse("name = 'paper'", "paper.toml", &[]).unwrap();
    let indices = (0..paper.grid().len()).step_by(if is_long() { 1 } else { 20 });
    let cases: Vec<Case> = indices.map(|index| paper.grid().case(index)).collect();
    let compared = cases.par_iter().map(|case| {
        let derivatives = by_tilt(case);
        let smooth = derivatives.iter().filter(|derivative| derivative.kink.is_none()).count();
        let compared = compare_components(case, &derivatives, &Differences::of(case));
        assert!(compared >= 10, "{compared} of {smooth}: {case:?}");
        compared
    });
    let compared: usize = compared.sum();
    assert!(compared > 11 * cases.len(), "{compared} of {}", cases.len());
}

/// These measures depend on the first part of the path only, which is the same for all tilts.
#[test]
fn measures_before_the_end_do_not_depend_on_the_critical_tilt() {
    for number in 0..6 {
        for derivative in by_tilt(&random_case(number)) {
            let begins = ["first_contact_displacement", "initial_stiffness", "fold_force"];
            if begins.contains(&derivative.measure) {
                assert_eq!(derivative.derivative(), Some(0.0), "{derivative:?}");
            }
        }
    }
}

/// If the needle friction `f` determines the critical tilt `φ`, the tilt is no parameter.
///
/// By the chain rule, the derivatives of a measure `m` are `dm/df = dm/dφ dφ/df`.
#[test]
fn needle_friction_replaces_the_critical_tilt_as_a_parameter() {
    let [friction, tilt] = ["needle_friction", TILT].map(|key| Parameter::named(key).unwrap());
    let value = 0.15_f64;
    let given = random_case(3);
    let by_friction = derivatives(&friction.put(&given, sweep::Scalar::Number(value)));
    let by_tilt = derivatives(&tilt.put(&given, sweep::Scalar::Number(value.atan().to_degrees())));
    assert!(by_friction.iter().all(|derivative| derivative.parameter != TILT));
    let of = |derivatives: &[ParameterDerivative], key: &str| -> Vec<f64> {
        let of_key = derivatives.iter().filter(|derivative| derivative.parameter == key);
        of_key.map(|derivative| derivative.derivative().unwrap()).collect()
    };
    let degrees = (1.0 / (1.0 + value * value)).to_degrees();
    let (ours, theirs) = (of(&by_friction, friction.key), of(&by_tilt, tilt.key));
    assert!(ours.len() == theirs.len() && ours.len() > 10, "{} {}", ours.len(), theirs.len());
    for (ours, theirs) in ours.into_iter().zip(theirs) {
        let off = ours - degrees * theirs;
        assert!(off.abs() <= 1e-7 * ours.abs(), "{ours} {}", degrees * theirs);
    }
}
