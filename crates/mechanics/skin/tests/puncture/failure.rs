//! Tests of the first failure of a row, and of the largest stresses along its path.

use approx::assert_relative_eq;
use skin::puncture::{
    FailureMeasures, FailureMode, Needle, PunctureParameters, RowLength, Strengths,
};
use skin::{Base, Common, Design};
use substrate::{Calibrations, SubstrateLaw};

use crate::complete;
use crate::samples::{design, solve_as, solve_with};

/// Modulus of the polyurethane substrate of the reference study, `MPa`.
const SUBSTRATE_MPA: f64 = 0.31;

fn parameters(strengths: Strengths) -> PunctureParameters {
    PunctureParameters {
        scales: RowLength::Auto,
        failure: Some(strengths),
        ..PunctureParameters::default()
    }
}

fn failure(design: &Design, parameters: &PunctureParameters) -> FailureMeasures {
    let known = Calibrations::default();
    complete(&solve_as(&known, design, &Common::default(), parameters)).failure
}

/// Compares the largest stresses (`MPa`) of three designs with an independent program.
#[test]
fn designs_with_large_critical_forces_bend_or_fold_before_the_critical_tilt() {
    for (gap, length, slant, stress, mode) in [
        (0.1, 0.1, 75.0, 4900.0, FailureMode::Bend),
        (0.1, 0.2, 75.0, 2100.0, FailureMode::Bend),
        (0.1, 0.4, 60.0, 17.0, FailureMode::Fold),
    ] {
        let design = design(gap, length, slant, Base::L);
        let failure = failure(&design, &parameters(Strengths::default()));
        let stress_mpa = SUBSTRATE_MPA * failure.scale_stress.unwrap();
        assert_relative_eq!(stress_mpa, stress, max_relative = 0.05);
        assert_eq!(failure.mode, Some(mode));
        // The slender scales of the first two designs deflect by many times the thickness.
        let deflection = failure.scale_deflection.unwrap();
        assert_eq!(deflection > 10.0, mode == FailureMode::Bend, "{deflection}");
    }
}

/// The pressure under an isolated upright scale follows from load and tilt in closed form. A row
/// has no pressure at a force that it does not reach.
#[test]
fn the_pressure_at_a_force_belongs_to_the_equilibrium_with_that_force() {
    let known = Calibrations::default();
    let unloaded = parameters(Strengths::default());
    let isolated = design(100.0, 0.5, 0.0, Base::L);
    let single = PunctureParameters { scales: RowLength::Scales(1), force: Some(0.01), ..unloaded };
    let puncture = solve_as(&known, &isolated, &Common::default(), &single);
    let tilts = puncture.path.windows(2).find(|pair| pair[1].force >= 0.01);
    let tilts = tilts.expect("the path reaches this force");
    // Load `F/(E_s t²)` on a base of area 0.5, at the tilts of the points before and after.
    let pressures = [tilts[0].tilt_deg, tilts[1].tilt_deg]
        .map(|tilt| 0.01 * 0.5 / 0.75 * tilt.to_radians().cos() / 0.5);
    let pressure = puncture.measures.tissue_pressure_at_force;
    let pressure = pressure.expect("the path reaches this force");
    assert!(pressures[1] <= pressure && pressure <= pressures[0], "{pressure} {pressures:?}");

    let slanted = design(0.2, 0.5, 60.0, Base::L);
    let whole = complete(&solve_with(&known, &slanted, &unloaded));
    let (last, largest) = (whole.critical_force.unwrap(), whole.failure.tissue_pressure.unwrap());
    let [low, almost, beyond] = [1e-3, last * (1.0 - 1e-9), 1.001 * last].map(|force| {
        let parameters = PunctureParameters { force: Some(force), ..unloaded };
        complete(&solve_with(&known, &slanted, &parameters)).tissue_pressure_at_force
    });
    assert_relative_eq!(almost.unwrap(), largest, max_relative = 1e-7);
    assert!(low.unwrap() < 0.1 * largest);
    assert_eq!(beyond, None);
}

/// For an isolated scale all stresses follow from the load and its arm in closed form.
#[test]
fn stresses_of_an_isolated_scale_follow_from_its_load() {
    let upright = Design { width: 2.0, ..design(100.0, 0.5, 0.0, Base::L) };
    let parameters =
        PunctureParameters { scales: RowLength::Scales(1), ..parameters(Strengths::default()) };
    let known = Calibrations::default();
    let measures = complete(&solve_as(&known, &upright, &Common::default(), &parameters));
    let failure = measures.failure;
    // The load `F/(E_s t²)` has components along and across the axis of the tilted scale.
    let force = measures.critical_force.unwrap() * upright.length / 0.75;
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    let (depth, area) = (0.5, 1.0);
    let moment = force * (cos * depth / 2.0 + sin);
    assert_relative_eq!(
        failure.scale_stress.unwrap(),
        6.0 * moment / (area * depth) + force * cos / area,
        max_relative = 1e-10
    );
    assert_relative_eq!(failure.tissue_pressure.unwrap(), force * cos / area, max_relative = 1e-10);
    assert_relative_eq!(
        failure.bond_stress.unwrap(),
        6.0 * moment / (area * depth) - force * cos / area,
        max_relative = 1e-10
    );
    let bending = 9677.0 * area * depth.powi(2) / 12.0;
    let shear = 9677.0 / 2.7 * area / 1.2;
    let bent = force * (cos * depth / 4.0 + sin / 3.0) / bending + force * sin / shear;
    assert_relative_eq!(failure.scale_deflection.unwrap(), bent, max_relative = 1e-10);
    assert_eq!(failure.clearance, None);
    assert_eq!((failure.mode, failure.force), (Some(FailureMode::Tilt), measures.critical_force));
}

/// If a strength is half of the largest stress, the row fails earlier, at exactly this stress.
#[test]
fn failures_are_located_at_the_point_where_a_stress_reaches_its_strength() {
    let known = Calibrations::default();
    let design = design(0.3, 0.6, 45.0, Base::L);
    let whole = failure(&design, &parameters(Strengths::default()));
    let solved =
        complete(&solve_as(&known, &design, &Common::default(), &parameters(Strengths::default())));
    assert_eq!((whole.mode, whole.force), (Some(FailureMode::Tilt), solved.critical_force));
    assert_relative_eq!(whole.clearance.unwrap(), 0.3 * 0.5_f64.sqrt(), max_relative = 1e-14);
    let [scale, bond] =
        [whole.scale_stress, whole.bond_stress].map(|stress| stress.map(|stress| stress / 2.0));
    for (strengths, mode) in [
        (Strengths { scale, bond: None }, FailureMode::Break),
        (Strengths { scale: None, bond }, FailureMode::Debond),
    ] {
        let failed = failure(&design, &parameters(strengths));
        assert_eq!(failed.mode, Some(mode));
        assert!(failed.force < solved.critical_force, "{failed:?}");
        // A path that ends at the tilt of the failure has the strength as its largest stress.
        let point = skin::puncture::At::Force(failed.force.unwrap());
        let springs = substrate::calibrate(&design.footprint(0.5).unwrap()).unwrap();
        let at = skin::puncture::snapshots(
            &design,
            &springs,
            &Common::default(),
            &parameters(Strengths::default()),
            &[point],
        );
        let at = at.unwrap().at[0].clone().unwrap();
        let to_there = PunctureParameters {
            critical_tilt_deg: at.tilt_deg,
            ..parameters(Strengths::default())
        };
        let there = failure(&design, &to_there);
        let (reached, strength) = match mode {
            FailureMode::Break => (there.scale_stress, scale),
            _ => (there.bond_stress, bond),
        };
        assert_relative_eq!(reached.unwrap(), strength.unwrap(), max_relative = 1e-8);
    }
    // Evaluating failures does not change any other measure.
    let plain = PunctureParameters { failure: None, ..parameters(Strengths::default()) };
    let plain = complete(&solve_as(&known, &design, &Common::default(), &plain));
    let without =
        skin::puncture::PunctureMeasures { failure: FailureMeasures::default(), ..solved };
    assert_eq!(plain, without);
}

#[test]
fn the_reported_failure_is_the_first_one_on_the_path() {
    // The surface of this design folds over before 10°, but its slender scales bend even earlier.
    let folding = design(0.1, 0.2, 75.0, Base::L);
    let failed = failure(&folding, &parameters(Strengths::default()));
    assert_eq!(failed.mode, Some(FailureMode::Bend));
    // With stiffer scales the fold is the first failure.
    let stiff = PunctureParameters {
        contact_modulus_over_substrate: 1e9,
        ..parameters(Strengths::default())
    };
    let known = Calibrations::default();
    let measures = complete(&solve_as(&known, &folding, &Common::default(), &stiff));
    assert_eq!(measures.failure.mode, Some(FailureMode::Fold));
    assert_eq!(measures.failure.force, measures.fold_force);
    let rubber = PunctureParameters { substrate_law: SubstrateLaw::NeoHookean, ..stiff };
    assert_eq!(failure(&folding, &rubber).mode, Some(FailureMode::Tilt));
}

/// Returns parameters of a round needle on scales of the given strength.
fn round(strength: f64) -> PunctureParameters {
    PunctureParameters {
        needle: Needle::Guided { friction: 0.3 },
        needle_radius: Some(0.05),
        load_position: 0.95,
        ..parameters(Strengths { scale: Some(strength), bond: None })
    }
}

#[test]
fn a_round_tip_perforates_a_weak_scale() {
    let design = design(0.3, 1.0, 60.0, Base::L);
    let whole = failure(&design, &round(1e6));
    assert_eq!(whole.mode, Some(FailureMode::Tilt));
    // Choose the strength so that `3 σ π r²` is a third of the critical force. The scales do not
    // break at this strength.
    let force = whole.force.unwrap() * design.length / 0.75 / 3.0;
    let strength = force / (3.0 * std::f64::consts::PI * 0.05_f64.powi(2));
    assert!(strength > whole.scale_stress.unwrap(), "{strength} {whole:?}");
    let failed = failure(&design, &round(strength));
    assert_eq!(failed.mode, Some(FailureMode::Perforate));
    // The force of the needle is oblique, so its vertical component at failure is not exactly a
    // third of the critical force.
    assert!(failed.force.unwrap() > whole.force.unwrap() / 4.0, "{failed:?} {whole:?}");
    assert!(failed.force.unwrap() < whole.force.unwrap() / 3.0 * 1.2, "{failed:?} {whole:?}");
}

/// Lists the failure modes that are judged with the given parameters.
fn judged(parameters: &PunctureParameters) -> Vec<FailureMode> {
    let modes = FailureMode::ALL.into_iter();
    modes
        .filter(|mode| mode.not_judged(parameters, parameters.needle_radius.is_some()).is_none())
        .collect()
}

#[test]
fn modes_that_are_not_judged_state_the_reason() {
    let bare = PunctureParameters::default();
    assert_eq!(judged(&bare), [FailureMode::Tilt, FailureMode::Fold, FailureMode::Bend]);
    let all = PunctureParameters {
        needle: Needle::Guided { friction: 0.0 },
        needle_radius: Some(0.5),
        ..parameters(Strengths { scale: Some(100.0), bond: Some(1.0) })
    };
    assert_eq!(judged(&all), FailureMode::ALL);
    let reason = FailureMode::Break.not_judged(&bare, false).unwrap();
    assert_eq!(reason, "the strength of the scales is not given");
}
