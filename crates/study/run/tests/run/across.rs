//! Tests of the force across the row: known values of isolated scales, counts by another program.

use rayon::prelude::*;
use results::DesignResult;
use run::Evaluator;
use skin::puncture::FailureMode;
use sweep::{Measure, Sweep};

/// Solves all designs of a definition and returns their results in order.
fn results(text: &str) -> Vec<DesignResult> {
    let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
    let evaluator = Evaluator::new(&[Measure::Puncture]);
    let numbers: Vec<_> = (0..sweep.grid().len()).collect();
    let solve =
        |index: &u64| evaluator.row(sweep.grid().number(*index), &sweep.grid().case(*index)).result;
    numbers.par_iter().map(solve).collect()
}

/// Returns the critical forces along and across the row.
fn forces(result: &DesignResult) -> (Option<f64>, Option<f64>) {
    let measures = result.puncture.expect("a puncture").measures;
    (measures.critical_force, measures.across.force)
}

/// The forces are in units of `E* t²`, at a tilt of 10° and for a width of `t`.
#[test]
fn the_force_across_an_isolated_scale_matches_known_values() {
    for (length, force) in [(0.1, 0.0170), (0.2, 0.0237), (0.5, 0.0412), (1.0, 0.0682)] {
        let text = format!(
            "name = 'x'\nmeasures = 'puncture'\n[designs]\ngap_over_t = 500\n\
             length_over_t = {length}\nslant_deg = 60\n[array]\nacross = true"
        );
        let (_, across) = forces(&results(&text)[0]);
        let found = across.expect("a force") * length;
        assert!((found - force).abs() < 1e-4, "{length}: {found}");
    }
}

#[test]
fn the_weaker_direction_determines_the_force_and_the_first_failure() {
    let text = "name = 'x'\nmeasures = 'puncture'\n[designs]\ngap_over_t = 0.3\nlength_over_t = 1\n\
                slant_deg = [0, 60]\n[array]\nacross = true\n[puncture]\nfailure = true\n\
                needle = 'guided'\nneedle_friction = 0.3\nload_inset_over_t = 0.05";
    let all = results(text);
    let (along, across) = forces(&all[1]);
    let (along, across) = (along.expect("a force"), across.expect("a force"));
    assert!((along - 0.45).abs() < 0.005 && (across - 0.27).abs() < 0.005, "{along} {across}");
    let measures = all[1].puncture.expect("a puncture").measures;
    assert_eq!(measures.across.any_direction, Some(across));
    assert_eq!(
        (measures.failure.mode, measures.failure.force),
        (Some(FailureMode::Across), Some(across))
    );
    // An upright scale with a square base is equally strong in both directions.
    let (along, across) = forces(&all[0]);
    let (along, across) = (along.expect("a force"), across.expect("a force"));
    assert!((along / across - 1.0).abs() < 1e-9, "{along} {across}");
}

#[test]
fn the_load_on_the_row_across_has_the_same_distance_from_the_edge() {
    let across = |load: &str| {
        let text = format!(
            "name = 'x'\nmeasures = 'puncture'\n[designs]\ngap_over_t = 0.5\nlength_over_t = 2\n\
             slant_deg = 60\n[scale]\nwidth_over_t = 4\n[array]\nacross = true\n[puncture]\n\
             needle = 'guided'\nneedle_friction = 0.3\nneedle_radius_over_t = 0.3\n{load}"
        );
        forces(&results(&text)[0]).1.expect("a force")
    };
    // The base is 2 t wide, so the positions 0.8 and 0.2 are 0.4 t from a corner.
    let inset = across("load_inset_over_t = 0.4");
    assert!((across("load_position = 0.8") / inset - 1.0).abs() < 1e-9);
    assert!((across("load_position = 0.2") / inset - 1.0).abs() < 1e-9);
    // A needle between two scales acts at the edge of the row across, with the inset 0.
    let edge = across("load_inset_over_t = 0");
    assert!((across("load_position = 1.1") / edge - 1.0).abs() < 1e-9);
    assert!(inset > 1.02 * edge, "{inset} {edge}");
}

/// An upright block under a central load is balanced and can tilt to either side at a bifurcation.
///
/// A fixed rule, not rounding, must decide whether it tilts and to which side.
#[test]
fn a_load_in_the_middle_tilts_blocks_across_but_not_along() {
    let text = "name = 'x'\nmeasures = 'puncture'\nsubstrate.coupling = 'full'\n[designs]\n\
                gap_over_t = { from = 0.23, to = 0.24, step = 0.001 }\nlength_over_t = 1.97\n\
                slant_deg = 0\n[scale]\nwidth_over_t = 1.97\n[array]\nacross = true\n\
                [puncture]\nneedle = 'guided'\nload_position = 0.5";
    let all: Vec<_> = results(text).iter().map(forces).collect();
    assert_eq!(all.len(), 11);
    for pair in all.windows(2) {
        let [(along, narrow), (_, wide)] = [pair[0], pair[1]];
        assert_eq!(along, None);
        let ratio = narrow.expect("a force across") / wide.expect("a force across");
        assert!((ratio - 1.0).abs() < 1e-2, "{ratio}");
    }
}

const PAPER: &str = "name = 'x'\nmeasures = 'puncture'\n[designs]\n\
    gap_over_t = { from = 0.1, to = 1, step = 0.1 }\n\
    length_over_t = [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1]\n\
    slant_deg = { from = 0, to = 75, step = 15 }\n[array]\nacross = true\n";

/// Returns the number of designs with forces along and across, and how many are weaker across.
fn counts(text: &str) -> (usize, usize) {
    let both: Vec<_> = results(text)
        .iter()
        .filter_map(|result| {
            let (along, across) = forces(result);
            Some((along?, across?))
        })
        .collect();
    // Ignore rounding: upright square scales are equally strong in both directions.
    let weaker = both.iter().filter(|(along, across)| *across < along * (1.0 - 1e-9));
    (both.len(), weaker.count())
}

#[test]
fn many_designs_of_the_reference_study_are_weaker_across_the_row() {
    assert_eq!(counts(PAPER), (720, 127));
    let advised =
        "[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\nload_inset_over_t = 0.05\n";
    assert_eq!(counts(&format!("{PAPER}{advised}")), (688, 219));
}
