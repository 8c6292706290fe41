//! Derivatives of forces and positions at which load or depth reverses.

use rayon::prelude::*;
use run::Evaluator;
use sweep::{Case, Measure};

use super::branches::steep_case;
use super::designs;
use super::differences::Differences;
use super::{compare_components, derivatives, is_long};

const MEASURES: [&str; 4] =
    ["peak_displacement", "peak_tilt_deg", "load_stability_force", "depth_stability_force"];

/// Returns, for load and depth, whether the first reversal is at a change of contact.
///
/// `None` if the load or depth does not reverse.
fn turns_at_events(case: &Case) -> [Option<bool>; 2] {
    let puncture = Evaluator::new(&Measure::USUAL).solve(designs::number(), case).puncture.unwrap();
    let measures = puncture.measures;
    [measures.load_stability_force, measures.depth_stability_force].map(|force| {
        force.map(|force| puncture.events.iter().any(|event| event.point.force == force))
    })
}

/// Returns a steep design with soft contacts and another load position.
///
/// In a few of these designs the depth reverses smoothly.
fn soft_case(number: u64) -> Case {
    let mut case = steep_case(number);
    case.puncture.load_position = 0.2 + 0.8 * (number % 13) as f64 / 13.0;
    case.puncture.contact_modulus_over_substrate = (5.0 * (number % 5) as f64 / 5.0).exp();
    case.puncture.critical_tilt_deg *= 1.5;
    case
}

/// The designs contain all combinations of smooth reversals and reversals at a change of contact.
#[test]
fn derivatives_at_turning_points_match_differences() {
    let mut cases = [5, 6].map(steep_case).to_vec();
    cases.extend([121, 521].map(soft_case));
    if is_long() {
        cases.extend([9, 64, 72].map(steep_case));
        cases.push(soft_case(808));
    }
    let turns = cases.par_iter().map(|case| {
        let mut derivatives = derivatives(case);
        derivatives.retain(|derivative| MEASURES.contains(&derivative.measure));
        let differences = Differences::of_measures(case, &[Measure::Puncture]);
        let compared = compare_components(case, &derivatives, &differences);
        let turns = turns_at_events(case);
        let measures = 2 + turns.iter().flatten().count();
        assert!(compared >= 8 * measures, "{compared} of {measures}, {turns:?}, {case:?}");
        turns
    });
    let turns: Vec<_> = turns.collect();
    for load in [true, false] {
        for depth in [true, false] {
            assert!(turns.contains(&[Some(load), Some(depth)]), "{load} {depth} {turns:?}");
        }
    }
}
