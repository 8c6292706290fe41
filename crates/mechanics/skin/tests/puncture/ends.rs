//! Tests of paths beyond the largest force.

use approx::assert_relative_eq;
use contact::Law;
use rayon::prelude::*;
use skin::puncture::{self, Instability, Needle, Puncture, PunctureParameters};
use skin::{Base, Common, Design, Status};
use solver::{Settings, Termination};
use substrate::{Calibrations, Coupling, SubstrateLaw};

use crate::end;
use crate::samples::{
    BASES, design, finer, long_campaigns, random, reference_study, solve, solve_as, solve_with,
};

fn to_tilt(critical_tilt_deg: f64) -> PunctureParameters {
    PunctureParameters { critical_tilt_deg, ..PunctureParameters::default() }
}

/// The load of this design drops to zero before a tilt of 35°, and would then become negative.
#[test]
fn a_path_stops_at_zero_load() {
    let design = design(0.6, 1.0, 60.0, Base::L);
    let puncture = solve(&design, &to_tilt(35.0));
    let (measures, last) = (puncture.measures, end(&puncture));
    assert_eq!(puncture.status, Status::Stopped(Termination::Unloaded));
    assert!(last.force.abs() < 1e-14 && last.tilt_deg < 35.0, "{last:?}");
    assert!(puncture.path.iter().skip(1).rev().skip(1).all(|point| point.force > 0.0));
    assert_eq!(measures.critical_force.or(measures.penetration), None);
    // A path that ends at the tilt of the largest load has this load as its critical force.
    let to_peak = solve(&design, &to_tilt(measures.peak_tilt_deg.unwrap()));
    assert_eq!(to_peak.status, Status::Complete);
    assert_relative_eq!(
        to_peak.measures.critical_force.unwrap(),
        measures.peak_force.unwrap(),
        max_relative = 1e-9
    );
}

#[test]
fn the_peak_force_does_not_depend_on_the_critical_tilt_beyond_the_peak() {
    let design = design(0.1, 0.5, 45.0, Base::L);
    let peaks = [29.0, 35.0, 60.0].map(|tilt| solve(&design, &to_tilt(tilt)).measures);
    for peak in &peaks {
        assert_relative_eq!(peak.peak_force.unwrap(), 1.409, max_relative = 1e-3);
        assert_relative_eq!(peak.peak_tilt_deg.unwrap(), 28.2, max_relative = 1e-2);
        assert_relative_eq!(
            peak.peak_force.unwrap(),
            peaks[0].peak_force.unwrap(),
            max_relative = 1e-10
        );
    }
}

/// In this design a corner slides to the end of its edge, with a large approach of the contact.
#[test]
fn a_sliding_corner_passes_the_end_of_its_edge() {
    let design = Design {
        gap: 0.024_999_962_711_428_58,
        length: 3.779_684_096_855_260_3,
        slant_deg: 17.129_067_015_845_717,
        base: Base::L,
        width: 0.165_821_562_202_099_45,
    };
    let law = Law { c2: 1.434_444_345_823_402_9, ..Law::PRINTED };
    let common = Common { law, friction: 0.144_166_356_039_949_4, ..Common::default() };
    let parameters = PunctureParameters {
        poisson_ratio: 0.0,
        contact_modulus_over_substrate: 1_084.359_456_455_917,
        ..PunctureParameters::default()
    };
    let puncture = solve_as(&Calibrations::default(), &design, &common, &parameters);
    assert_eq!(puncture.status, Status::Complete);
}

/// In this design 90 scales touch, and a corner at the needle in a notch slides off its face.
#[test]
fn a_notch_that_slides_off_its_face_ends_at_a_limit_point() {
    let design = Design {
        gap: 0.105_771_414_778_684_74,
        length: 0.067_380_346_199_300_57,
        slant_deg: 75.741_251_917_731_5,
        base: Base::TwoL,
        width: 2.291_841_281_033_797,
    };
    let law = Law { c1: 3.222_619_225_995_159_4, ..Law::PRINTED };
    let common = Common { law, ..Common::default() };
    let parameters = PunctureParameters {
        poisson_ratio: 0.126_875_176_930_326_74,
        needle: Needle::Guided { friction: 0.0 },
        critical_tilt_deg: 88.983_460_515_430_51,
        ..PunctureParameters::default()
    };
    let footprint = design.footprint(parameters.poisson_ratio).unwrap();
    let row = Calibrations::default().row(&footprint, Coupling::Full).unwrap();
    let puncture = puncture::solve(&design, &*row, &common, &parameters).unwrap();
    assert_eq!(puncture.status, Status::LimitPoint);
}

/// Solves designs, each to its own critical tilt, and checks forces and status of their paths.
fn check(designs: &[(Design, f64)], known: &Calibrations) {
    let solved: Vec<Puncture> = designs
        .par_iter()
        .map(|(design, tilt)| solve_with(known, design, &to_tilt(*tilt)))
        .collect();
    for ((design, tilt), puncture) in designs.iter().zip(&solved) {
        let measures = &puncture.measures;
        assert!(puncture.path.iter().all(|point| point.force > -1e-12), "{design:?} {tilt}");
        assert!(measures.peak_force.is_some_and(|peak| peak > 0.0), "{design:?} {tilt}");
        assert_eq!(measures.peak_force.is_some(), measures.peak_tilt_deg.is_some());
        let unloaded = puncture.status == Status::Stopped(Termination::Unloaded);
        assert_eq!(unloaded, end(puncture).force.abs() < 1e-12, "{design:?} {tilt}");
        assert_eq!(puncture.status == Status::Complete, measures.critical_force.is_some());
    }
}

#[test]
fn steep_designs_never_have_a_negative_load() {
    let designs = BASES.map(reference_study).concat().into_iter();
    let steep = designs.filter(|design| design.slant_deg >= 60.0);
    let every = if long_campaigns() { 1 } else { 11 };
    let designs: Vec<_> = steep.step_by(every).map(|design| (design, 35.0)).collect();
    check(&designs, &Calibrations::default());
}

/// The state of rest is a regular point, so a path that returns to it has jumped to another branch.
///
/// Tests eight difficult designs, or in a long campaign the whole reference study.
#[test]
fn no_path_returns_to_rest() {
    use SubstrateLaw::{Linear, NeoHookean};
    let difficult = [
        (Linear, 0.1, 0.05),
        (Linear, 0.2, 0.1),
        (NeoHookean, 0.1, 0.8),
        (NeoHookean, 0.1, 1.0),
        (NeoHookean, 0.4, 0.025),
        (NeoHookean, 0.5, 0.05),
        (NeoHookean, 0.6, 0.1),
        (NeoHookean, 0.7, 0.2),
    ];
    let designs: Vec<_> = if long_campaigns() {
        let study = BASES.map(reference_study).concat();
        [Linear, NeoHookean]
            .into_iter()
            .flat_map(|law| study.iter().map(move |design| (law, *design)))
            .collect()
    } else {
        difficult.map(|(law, gap, length)| (law, design(gap, length, 75.0, Base::L))).to_vec()
    };
    let known = Calibrations::default();
    designs.par_iter().for_each(|&(substrate_law, design)| {
        let parameters = PunctureParameters { substrate_law, ..to_tilt(35.0) };
        let puncture = solve_with(&known, &design, &parameters);
        assert_ne!(puncture.status, Status::Stopped(Termination::TooManyPoints), "{design:?}");
        let last = end(&puncture);
        assert!(
            last.tilt_deg > 1.0 && last.displacement > 0.01,
            "{substrate_law:?} {design:?} {last:?}"
        );
    });
}

/// The critical tilts range from 10° to 45°. A long campaign tests ten times as many designs.
#[test]
fn random_designs_never_have_a_negative_load() {
    let designs = random(if long_campaigns() { 2000 } else { 200 }, 7);
    let tilts = (0..8).map(|k| 10.0 + 5.0 * f64::from(k)).cycle();
    let designs: Vec<_> = designs.into_iter().zip(tilts).collect();
    check(&designs, &Calibrations::default());
}

/// When the corner reaches the end of its edge, load, depth and tilt decrease, and the row snaps.
///
/// The snap point does not depend on the step size. After the snap the path reaches the same depth
/// again with a force that is lower by `drop`.
#[test]
fn a_row_snaps_when_a_corner_reaches_a_corner() {
    let design = design(0.1, 1.0, 45.0, Base::TwoL);
    let fine = Common { solver: finer(finer(Settings::default())), ..Common::default() };
    let puncture = solve_as(&Calibrations::default(), &design, &fine, &to_tilt(10.0));
    assert_eq!((puncture.measures.snaps, puncture.snaps.len()), (1, 1));
    let snap = puncture.snaps[0];
    let corner = puncture.events[snap.events_before - 1];
    assert_eq!(corner.point, snap.point);
    assert_eq!(corner.change.name(), "reached corner");
    assert_relative_eq!(snap.point.force, 0.5892, max_relative = 1e-4);
    // The unstable part of the path falls to 0.5826 before it rises again.
    let lowest = puncture.path.iter().skip_while(|p| **p != snap.point).map(|p| p.force);
    assert_relative_eq!(lowest.fold(f64::MAX, f64::min), 0.5826, max_relative = 1e-4);
    let at = puncture.path.iter().position(|point| *point == snap.point).unwrap();
    let behind = puncture.path[at..].windows(2);
    let &[low, high] = behind
        .clone()
        .find(|pair| {
            pair[0].displacement < snap.point.displacement
                && pair[1].displacement > snap.point.displacement
        })
        .unwrap()
    else {
        unreachable!()
    };
    let part =
        (snap.point.displacement - low.displacement) / (high.displacement - low.displacement);
    let landed = low.force + part * (high.force - low.force);
    // The tolerance covers the linear interpolation between two points.
    assert_relative_eq!(snap.drop.unwrap(), snap.point.force - landed, max_relative = 5e-3);
    let measures = puncture.measures;
    assert_eq!(measures.depth_stability_force, Some(snap.point.force));
    assert_eq!(measures.load_stability_force, Some(snap.point.force));
    assert_eq!([measures.stable_under_load, measures.stable_under_depth], [Some(true); 2]);
    // The row is unstable under prescribed load, depth and tilt on the part where the force
    // decreases, and stable elsewhere.
    let back = behind.take_while(|pair| pair[1].force < pair[0].force).count();
    for (k, instability) in puncture.instability.iter().enumerate() {
        let count = usize::from((at..at + back).contains(&k));
        let expected = Instability { load: count, depth: count, tilt: count };
        assert_eq!(*instability, expected, "point {k}, snap at {at}, {back} back");
    }
}

#[test]
fn rows_snap_once_for_each_contact_that_reaches_a_corner() {
    let every = if long_campaigns() { 1 } else { 5 };
    let known = Calibrations::default();
    let designs = BASES.map(reference_study).concat();
    let solved: Vec<(usize, usize)> = designs
        .par_iter()
        .step_by(every)
        .map(|design| {
            let puncture = solve_with(&known, design, &to_tilt(10.0));
            let corners = puncture.events.iter().filter(|e| e.change.name() == "reached corner");
            (puncture.measures.snaps, corners.count())
        })
        .collect();
    assert!(solved.iter().all(|&(snaps, corners)| snaps == corners));
    assert!(solved.iter().any(|&(snaps, _)| snaps > 0));
}
