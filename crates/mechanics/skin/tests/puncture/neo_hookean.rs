//! Tests of the neo-Hookean substrate. Its surface cannot fold over.

use approx::assert_relative_eq;
use skin::puncture::{self, Puncture, PunctureParameters, RowLength};
use skin::{Base, Common, Design, Status};
use solver::Settings;
use substrate::{Calibrations, Coupling, RowStiffness, SubstrateLaw};

use crate::samples::{
    LAWS, blocks, design, domino, finer, long_campaigns, on_row, random, reference_study, settled,
    solve_as, solve_with, spread, with_law,
};
use crate::{assert_same_measures, complete};
use rayon::prelude::*;

/// Returns `parameters` with a neo-Hookean substrate.
fn neo_hookean(parameters: PunctureParameters) -> PunctureParameters {
    PunctureParameters { substrate_law: SubstrateLaw::NeoHookean, ..parameters }
}

fn automatic() -> PunctureParameters {
    neo_hookean(PunctureParameters { scales: RowLength::Auto, ..PunctureParameters::default() })
}

/// Returns true if every gap is open at every point of a path.
fn is_open(puncture: &Puncture) -> bool {
    puncture.path.iter().all(|point| point.gap_stretch.is_none_or(|g| g.min > 0.0))
        && puncture.folds.is_empty()
}

/// Solves successive designs alternately with the printed and the exchanged contact law.
#[test]
fn no_gap_closes_in_the_reference_study() {
    let (known, parameters) = (Calibrations::default(), neo_hookean(on_row(41)));
    for (k, law) in LAWS.into_iter().enumerate() {
        for base in [Base::L, Base::TwoL] {
            reference_study(base).par_iter().skip(k).step_by(LAWS.len()).for_each(|design| {
                let puncture = solve_as(&known, design, &with_law(law), &parameters);
                assert_eq!(puncture.status, Status::Complete, "{design:?}");
                assert!(is_open(&puncture), "{design:?}");
                assert_eq!(puncture.measures.sound_force, puncture.measures.critical_force);
            });
        }
    }
}

/// One design in a thousand may stop early. A long campaign solves ten times as many designs.
#[test]
fn random_designs_are_complete_and_do_not_fold() {
    let (known, parameters) = (Calibrations::default(), neo_hookean(on_row(41)));
    let designs = random(if long_campaigns() { 2000 } else { 200 }, 1);
    for law in LAWS {
        let stopped: Vec<_> = designs
            .par_iter()
            .filter_map(|design| {
                let puncture = solve_as(&known, design, &with_law(law), &parameters);
                assert!(is_open(&puncture), "{design:?}");
                (puncture.status != Status::Complete).then_some((puncture.status, design))
            })
            .collect();
        assert!(stopped.len() <= designs.len() / 1000, "{stopped:?}");
    }
}

/// Computes the relative difference between the critical forces of both substrate laws at a tilt.
fn difference(design: &Design, tilt_deg: f64) -> f64 {
    let linear = PunctureParameters { critical_tilt_deg: tilt_deg, ..on_row(21) };
    let [linear, neo_hookean] = [linear, neo_hookean(linear)].map(|parameters| {
        let puncture = solve_with(&Calibrations::default(), design, &parameters);
        complete(&puncture).critical_force.unwrap()
    });
    (neo_hookean - linear).abs() / linear
}

/// The relative difference must decrease at least in proportion to the tilt.
///
/// Scales of the `steep` design touch almost at once, so its gaps are compressed from the start.
#[test]
fn both_substrate_laws_agree_to_first_order_at_small_loads() {
    let steep = Design { gap: 1e-4, ..design(0.1, 0.3, 60.0, Base::L) };
    for tilt_deg in [0.1, 0.01, 0.001] {
        let [there, nearer] = [tilt_deg, 0.1 * tilt_deg].map(|tilt| difference(&steep, tilt));
        assert!(there < 1.0 && nearer < 0.15 * there, "{there} {nearer} at {tilt_deg}°");
    }
    assert!(difference(&steep, 0.1) > 1e-6);
    // Before contact gaps change only by the rotation of the bases, an effect of second order.
    assert!(difference(&settled(), 0.01) < 1e-7);
}

#[test]
fn steps_ten_times_smaller_give_the_same_measures() {
    let (known, coarse) = (Calibrations::default(), Settings::default());
    for design in spread() {
        for law in LAWS {
            let [ours, theirs] = [coarse, finer(coarse)].map(|solver| {
                let common = Common { law, solver, ..Common::default() };
                complete(&solve_as(&known, &design, &common, &neo_hookean(on_row(41))))
            });
            assert_same_measures(&ours, &theirs, 1e-6);
        }
    }
}

/// The far field of an endless row is computed with linear springs. The solved part must extend to
/// gaps in which neo-Hookean bars agree with linear springs up to round-off.
#[test]
fn automatic_rows_match_longer_rows() {
    let known = Calibrations::default();
    let narrow = design(0.1, 0.4, 75.0, Base::TwoL);
    for design in [blocks(), settled(), domino(), narrow, design(1.0, 0.025, 75.0, Base::TwoL)] {
        let ours = complete(&solve_with(&known, &design, &automatic()));
        let longer = neo_hookean(on_row(2 * ours.scales + 301));
        let theirs = complete(&solve_with(&known, &design, &longer));
        assert_same_measures(&ours, &theirs, 1e-9);
        for (ours, theirs) in [
            (ours.gap_stretch_min, theirs.gap_stretch_min),
            (ours.gap_stretch_max, theirs.gap_stretch_max),
        ] {
            assert_relative_eq!(ours.unwrap(), theirs.unwrap(), max_relative = 1e-7);
        }
    }
}

#[test]
fn a_fully_coupled_row_does_not_fold_over() {
    let (law, long) = (Common::default(), automatic());
    for design in [domino(), settled(), design(0.1, 0.4, 75.0, Base::L)] {
        let stiffness =
            RowStiffness::compute(&design.footprint(0.5).unwrap(), Coupling::Full).unwrap();
        let puncture = puncture::solve(&design, &stiffness, &law, &long).unwrap();
        assert!((puncture.path.last().unwrap().tilt_deg - 10.0).abs() < 1e-9, "{design:?}");
        assert!(is_open(&puncture), "{design:?}");
    }
}
