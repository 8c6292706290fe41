//! Tests of the folding of the substrate surface, and of the stretch of its gaps.

use approx::assert_relative_eq;
use skin::puncture::{Puncture, PunctureParameters, RowLength};
use skin::{Base, Common, Design};
use solver::Settings;
use substrate::Calibrations;

use crate::samples::{LAWS, design, domino, finer, on_row, settled, solve, solve_as};
use crate::{complete, end};

/// Returns designs of the reference study in which the surface folds over before a tilt of 10°.
fn folded() -> [Design; 5] {
    [
        domino(),
        design(0.1, 0.2, 75.0, Base::L),
        design(0.1, 1.0, 75.0, Base::L),
        design(0.2, 0.2, 75.0, Base::L),
        design(0.1, 0.4, 75.0, Base::TwoL),
    ]
}

fn automatic() -> PunctureParameters {
    PunctureParameters { scales: RowLength::Auto, ..PunctureParameters::default() }
}

/// Computes the stretch of every gap at the end of the path from the positions of the base corners.
fn stretches(design: &Design, puncture: &Puncture) -> Vec<f64> {
    let (a, pitch) = (design.half_base(), 2.0 * design.half_base() + design.gap);
    let widths = puncture.scales.windows(2).map(|pair| {
        let corners = [0, 1].map(|k| a * pair[k].rotation_deg.to_radians().cos());
        let right_end = pair[0].displacement[0] + corners[0];
        pitch + pair[1].displacement[0] - corners[1] - right_end
    });
    widths.map(|width| width / design.gap).collect()
}

#[test]
fn gap_stretches_match_the_base_corners() {
    for design in folded().into_iter().chain([settled()]) {
        let puncture = solve(&design, &on_row(41));
        let (measures, stretches) = (complete(&puncture), stretches(&design, &puncture));
        let min = stretches.iter().copied().fold(f64::INFINITY, f64::min);
        let max = stretches.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert_relative_eq!(measures.gap_stretch_min.unwrap(), min, epsilon = 1e-11);
        assert_relative_eq!(measures.gap_stretch_max.unwrap(), max, epsilon = 1e-11);
        let rest = puncture.path[0].gap_stretch.unwrap();
        assert_eq!([rest.min, rest.max], [1.0; 2]);
    }
}

/// The measures of an endless row include gaps beyond its solved part.
#[test]
fn an_endless_row_has_the_gap_stretches_of_a_long_row() {
    let known = Calibrations::default();
    for design in folded().into_iter().chain([settled(), design(1.0, 0.5, 0.0, Base::L)]) {
        let ours = complete(&solve_as(&known, &design, &Common::default(), &automatic()));
        let long = complete(&solve_as(&known, &design, &Common::default(), &on_row(601)));
        for (ours, long) in [
            (ours.gap_stretch_min, long.gap_stretch_min),
            (ours.gap_stretch_max, long.gap_stretch_max),
        ] {
            assert_relative_eq!(ours.unwrap(), long.unwrap(), max_relative = 1e-6, epsilon = 1e-9);
        }
        assert_eq!(ours.fold_force.is_some(), long.fold_force.is_some());
        if let (Some(ours), Some(long)) = (ours.fold_force, long.fold_force) {
            assert_relative_eq!(ours, long, max_relative = 1e-6);
        }
    }
}

#[test]
fn a_gap_has_zero_width_at_a_fold() {
    for design in folded() {
        let puncture = solve(&design, &automatic());
        let (measures, first) = (complete(&puncture), puncture.folds[0]);
        let stretch = first.point.gap_stretch.unwrap();
        assert!(first.folds && stretch.min.abs() < 1e-10, "{first:?} {design:?}");
        assert_eq!(measures.fold_force, Some(first.point.force));
        assert_eq!(measures.fold_displacement, Some(first.point.displacement));
        assert_eq!(measures.fold_tilt_deg, Some(first.point.tilt_deg));
        assert_eq!(measures.sound_force, measures.fold_force);
        assert!(first.point.tilt_deg < end(&puncture).tilt_deg);
        // The fold lies between the last point at which all gaps are open and the next point.
        let before = puncture.path.iter().take_while(|p| p.gap_stretch.unwrap().min > 0.0).count();
        let [from, to] = [&puncture.path[before - 1], &puncture.path[before]];
        assert!((from.tilt_deg..=to.tilt_deg).contains(&first.point.tilt_deg));
    }
}

/// A gap that is folded at the end of the path has folded once more often than it has unfolded.
#[test]
fn folds_account_for_the_gaps_closed_at_the_end() {
    for design in folded() {
        let puncture = solve(&design, &on_row(41));
        let first = puncture.scales[0].scale;
        for (gap, stretch) in (first..).zip(stretches(&design, &puncture)) {
            let of_gap = puncture.folds.iter().filter(|fold| fold.left_scale == gap);
            let balance: i32 = of_gap.map(|fold| if fold.folds { 1 } else { -1 }).sum();
            assert_eq!(balance, i32::from(stretch <= 0.0), "{gap} {design:?}");
        }
    }
}

#[test]
fn without_folds_the_sound_force_is_the_critical_force() {
    let puncture = solve(&settled(), &automatic());
    let measures = complete(&puncture);
    assert!(puncture.folds.is_empty() && measures.gap_stretch_min.unwrap() > 0.0);
    assert_eq!(measures.sound_force, measures.critical_force);
    let absent = [measures.fold_force, measures.fold_displacement, measures.fold_tilt_deg];
    assert_eq!(absent, [None; 3]);
    let alone = complete(&solve(&settled(), &on_row(1)));
    assert_eq!([alone.gap_stretch_min, alone.gap_stretch_max], [None; 2]);
    assert_eq!(alone.sound_force, alone.critical_force);
}

#[test]
fn folds_do_not_depend_on_the_step_size() {
    let (known, coarse) = (Calibrations::default(), Settings::default());
    for design in folded() {
        for law in LAWS {
            let [ours, theirs] = [coarse, finer(coarse)].map(|solver| {
                let common = Common { law, solver, ..Common::default() };
                solve_as(&known, &design, &common, &automatic()).folds
            });
            assert_eq!(ours.len(), theirs.len(), "{design:?}");
            for (ours, theirs) in ours.iter().zip(&theirs) {
                assert_eq!((ours.left_scale, ours.folds), (theirs.left_scale, theirs.folds));
                assert_relative_eq!(ours.point.force, theirs.point.force, max_relative = 1e-6);
            }
        }
    }
}

/// On a path with monotonically increasing tilt, tilts give the order of folds and contact events.
#[test]
fn a_fold_states_the_number_of_contact_events_before_it() {
    let mut monotone = 0;
    for design in folded() {
        let puncture = solve(&design, &automatic());
        if !puncture.path.is_sorted_by(|a, b| a.tilt_deg <= b.tilt_deg) {
            continue;
        }
        monotone += 1;
        for fold in &puncture.folds {
            let (before, after) = puncture.events.split_at(fold.events_before);
            let tilt = fold.point.tilt_deg;
            assert!(before.iter().all(|event| event.point.tilt_deg <= tilt + 1e-9));
            assert!(after.iter().all(|event| event.point.tilt_deg >= tilt - 1e-9));
        }
    }
    assert!(monotone > 1, "{monotone}");
}

/// While two bases touch, the stretch of their gap is zero up to round-off. The fold is the first
/// of these points.
#[test]
fn a_fold_by_touching_bases_does_not_depend_on_the_step_size() {
    let parameters = automatic();
    for (length, friction) in [(4.855, 0.44), (4.5, 0.4)] {
        let (design, known) = (design(0.055, length, 49.7, Base::L), Calibrations::default());
        let forces = [0.2, 0.05, 0.01].map(|max_step| {
            let solver = Settings { max_step, ..Settings::default() };
            let common = Common { friction, solver, ..Common::default() };
            let puncture = solve_as(&known, &design, &common, &parameters);
            let touching = puncture.path.iter().map(|point| point.gap_stretch.unwrap().min);
            let touching = touching.filter(|least| least.abs() < 1e-12).count();
            assert!(touching > 1, "{touching} {design:?}");
            complete(&puncture).fold_force.unwrap()
        });
        for force in forces {
            assert_relative_eq!(force, forces[0], max_relative = 1e-10);
        }
    }
}
