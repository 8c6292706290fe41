//! Derivatives of all measures against differences of whole solutions.

mod designs;
mod differences;

use results::ParameterDerivative;
use run::Evaluator;
use sweep::{Case, Measure, Parameter};

use designs::random_case;
use differences::Differences;

/// Relative error that a derivative may have against differences.
const TOLERANCE: f64 = 1e-6;

fn derivatives(case: &Case) -> Vec<ParameterDerivative> {
    let solved = Evaluator::new(&Measure::ALL).solve(designs::number(), case);
    solved.row.result.sensitivity
}

/// Compares the derivatives of `case`, component by component. Returns how many were compared.
fn compare(case: &Case) -> usize {
    let differences = Differences::of(case);
    let mut compared = 0;
    for derivative in derivatives(case) {
        let parameter = Parameter::named(&derivative.parameter).unwrap();
        let Some(ours) = derivative.derivative() else { continue };
        let Some(off) = differences.off(&derivative.measure, parameter, ours) else { continue };
        if off > TOLERANCE {
            println!(
                "{} {} {ours:e} {off:e} {:?}",
                derivative.measure, derivative.parameter, case.design
            );
        }
        compared += 1;
    }
    compared
}

#[test]
fn derivatives_are_those_of_whole_solutions() {
    let mut compared = 0;
    for number in 0..8 {
        compared += compare(&random_case(number));
    }
    println!("{compared}");
    assert!(compared > 8000);
}
