//! Derivatives of the force at the first failure and of the largest stresses.

use results::ParameterDerivative;
use run::Evaluator;
use skin::Base;
use skin::puncture::{Bending, FailureMeasures, FailureMode, Strengths};
use substrate::SubstrateLaw;
use sweep::{Case, Measure};

use super::designs::{number, random_case};
use super::differences::Differences;
use super::{compare, compare_components, derivatives, is_long};

const MEASURES: [&str; 7] = [
    "failure_force",
    "scale_stress_max",
    "scale_deflection_max",
    "bond_stress_max",
    "tissue_pressure_max",
    "tissue_pressure_at_force",
    "clearance",
];

fn failure(case: &Case) -> FailureMeasures {
    let solved = Evaluator::new(&[Measure::Puncture]).solve(number(), case);
    solved.row.result.puncture.unwrap().measures.failure
}

/// A third of the designs has a strength of scales, a third a strength of bonds, a third neither.
#[test]
fn first_failure_derivatives_match_differences_of_solutions() {
    let mut modes = Vec::new();
    for number in 0..if is_long() { 9 } else { 6 } {
        let mut case = random_case(number);
        case.judge_failure = true;
        let whole = failure(&case);
        // The needle force is half of the force at the first failure, in units of E_s t².
        let plane_strain = 1.0 - case.puncture.poisson_ratio.powi(2);
        case.needle_force =
            whole.force.map(|force| 0.5 * force * case.design.length / plane_strain);
        case.strengths = match number % 3 {
            0 => Strengths { scale: whole.scale_stress.map(|stress| 0.6 * stress), bond: None },
            1 => Strengths { scale: None, bond: whole.bond_stress.map(|stress| 0.4 * stress) },
            _ => Strengths::default(),
        };
        let mode = failure(&case).mode;
        modes.extend(mode);
        let mut derivatives: Vec<ParameterDerivative> = derivatives(&case);
        derivatives.retain(|derivative| MEASURES.contains(&derivative.measure));
        let compared = compare_components(&case, &derivatives, &Differences::of(&case));
        assert!(compared >= 30, "{compared} {case:?}");
        // The force depends on a strength exactly if this strength determines the first failure.
        let by_strength = derivatives
            .iter()
            .find(|d| d.measure == "failure_force" && d.parameter.contains("strength"));
        let slope = by_strength.and_then(ParameterDerivative::derivative);
        let moves = matches!(mode, Some(FailureMode::Break | FailureMode::Debond));
        assert_eq!(slope.is_some_and(|slope| slope > 0.0), moves, "{by_strength:?} {mode:?}");
    }
    assert!(
        modes.contains(&FailureMode::Break) && modes.contains(&FailureMode::Debond),
        "{modes:?}"
    );
}

/// Slender elastic scales reach the bending limit before the critical tilt.
#[test]
fn elastic_scale_derivatives_match_differences_of_solutions() {
    for number in [0, 1] {
        let mut case = random_case(number);
        (case.design.gap, case.design.length) = (0.1 + 0.02 * number as f64, 0.12);
        (case.design.slant_deg, case.design.base) = (74.0, Base::L);
        (case.puncture.substrate_law, case.puncture.critical_tilt_deg) =
            (SubstrateLaw::Linear, 9.0);
        case.puncture.contact_modulus_over_substrate = 3000.0;
        case.puncture.bending = Bending::Elastic;
        case.judge_failure = true;
        let bent = failure(&case);
        assert_eq!(bent.mode, Some(FailureMode::Bend), "{case:?}");
        let at_end = ["failure_force", "peak_force", "peak_displacement", "peak_tilt_deg"];
        let derivatives = derivatives(&case);
        for measure in at_end {
            let by_gap =
                derivatives.iter().find(|d| d.measure == measure && d.parameter == "gap_over_t");
            let slope = by_gap.and_then(ParameterDerivative::derivative);
            assert!(slope.is_some_and(|slope| slope != 0.0), "{measure}: {by_gap:?}");
        }
        // Measures without a value have no derivatives.
        assert!(derivatives.iter().all(|d| d.measure != "critical_force"), "{case:?}");
        // The first design has no row across and the second has one. In a long campaign each design
        // is compared with and without a row across.
        let rows_across = if is_long() { vec![false, true] } else { vec![number == 1] };
        for across in rows_across {
            case.across = across;
            assert!(compare(&case) >= 60, "{case:?}");
        }
    }
}

/// Half of the designs have a separate gap across; the other half uses the gap of the row.
#[test]
fn force_across_derivatives_match_differences_of_solutions() {
    for number in 0..4 {
        let mut case = random_case(number);
        case.judge_failure = true;
        case.across = true;
        if number % 2 == 0 {
            case.gap_across = Some(0.7 * case.design.gap);
        }
        let mut derivatives = derivatives(&case);
        let names = ["force_across", "force_any_direction", "failure_force"];
        derivatives.retain(|derivative| names.contains(&derivative.measure));
        let compared = compare_components(&case, &derivatives, &Differences::of(&case));
        assert!(compared >= 20, "{compared} {case:?}");
    }
}
