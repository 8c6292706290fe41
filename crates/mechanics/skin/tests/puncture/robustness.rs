//! Checks that the designs of the reference study, and random designs, reach the critical tilt.

use contact::Law;
use rayon::prelude::*;
use skin::Status;
use skin::puncture::{Needle, Puncture, PunctureParameters};
use skin::{Base, Design};
use solver::Termination;
use substrate::Calibrations;

use crate::end;
use crate::samples::{
    BASES, LAWS, design, long_campaigns, on_row, random, reference_study, solve_as, with_law,
};

/// Solves the puncture of all designs with the given contact law, in parallel.
fn solve_all(
    designs: &[Design],
    law: Law,
    parameters: &PunctureParameters,
    known: &Calibrations,
) -> Vec<Puncture> {
    designs.par_iter().map(|design| solve_as(known, design, &with_law(law), parameters)).collect()
}

fn both_studies() -> Vec<Design> {
    BASES.map(reference_study).concat()
}

#[test]
fn every_design_of_the_reference_study_completes_with_both_contact_laws() {
    let known = Calibrations::default();
    for law in LAWS {
        let designs = both_studies();
        for (design, puncture) in designs.iter().zip(solve_all(&designs, law, &on_row(41), &known))
        {
            assert_eq!(puncture.status, Status::Complete, "{design:?}");
        }
    }
}

/// Tests every seventh design. All gaps, lengths and slants occur, because 7 is coprime to their
/// numbers.
#[test]
fn designs_with_hard_and_soft_contacts_reach_the_critical_tilt() {
    let known = Calibrations::default();
    let designs: Vec<Design> = both_studies().into_iter().step_by(7).collect();
    for law in LAWS {
        for factor in [1e-2, 1e2, 1e4] {
            let mut parameters = on_row(41);
            parameters.contact_modulus_over_substrate *= factor;
            for (design, puncture) in
                designs.iter().zip(solve_all(&designs, law, &parameters, &known))
            {
                assert!((end(&puncture).tilt_deg - 10.0).abs() < 1e-9, "{design:?}");
                // The softest contacts with the exchanged law may let scales pass through each
                // other, which the audit reports.
                let may_pass_through = factor < 1.0 && law == Law::EXCHANGED;
                let fine = puncture.status == Status::Complete
                    || may_pass_through && puncture.status == Status::Interpenetration;
                assert!(fine, "{:?} {design:?}", puncture.status);
            }
        }
    }
}

/// With the exchanged contact law and 1/100 of the reference modulus, the approach of contacts
/// exceeds the thickness.
#[test]
fn scales_too_soft_to_carry_the_load_fail_the_audit() {
    let design = design(0.1, 0.5, 75.0, skin::Base::L);
    let mut parameters = on_row(41);
    parameters.contact_modulus_over_substrate *= 1e-2;
    let known = Calibrations::default();
    let puncture = solve_as(&known, &design, &with_law(Law::EXCHANGED), &parameters);
    assert_eq!(puncture.status, Status::Interpenetration);
    assert!((end(&puncture).tilt_deg - 10.0).abs() < 1e-9);
    assert_eq!(puncture.measures.critical_force, None);
}

/// Tests 200 designs, or 2,000 in a long campaign.
#[test]
fn random_designs_reach_the_critical_tilt() {
    let known = Calibrations::default();
    let designs = random(if long_campaigns() { 2000 } else { 200 }, 1);
    for law in LAWS {
        let solved = solve_all(&designs, law, &on_row(41), &known);
        for (design, puncture) in designs.iter().zip(&solved) {
            assert_eq!(puncture.status, Status::Complete, "{design:?}");
            assert!((end(puncture).tilt_deg - 10.0).abs() < 1e-9);
        }
    }
}

/// At large tilts tips slide off their edges or pass below neighbouring bases.
///
/// The contact model does not cover these states. The path must then stop for a mechanical reason,
/// not for a numerical one. Tests 100 random designs, or 1,000 in a long campaign.
#[test]
fn paths_to_large_tilts_stop_for_mechanical_reasons() {
    let known = Calibrations::default();
    let mut designs = random(if long_campaigns() { 1000 } else { 100 }, 2);
    designs.push(design(2.6, 1.6, 48.0, BASES[1]));
    let mut off_edge = 0;
    for tilt in [35.0, 60.0, 85.0] {
        let parameters = PunctureParameters { critical_tilt_deg: tilt, ..Default::default() };
        for (design, puncture) in
            designs.iter().zip(solve_all(&designs, Law::PRINTED, &parameters, &known))
        {
            let is_mechanical = !matches!(
                puncture.status,
                Status::Stopped(
                    Termination::NoConvergence
                        | Termination::Singular
                        | Termination::NotFinite
                        | Termination::Cycling
                )
            );
            assert!(is_mechanical, "{:?} at {tilt}: {design:?}", puncture.status);
            off_edge += usize::from(puncture.status == Status::OffEdge);
        }
    }
    assert!(off_edge > designs.len() / 3, "{off_edge}");
}

/// Tips of these steep scales slide along bases and tops, and around corners.
#[test]
fn scales_steeper_than_in_the_reference_study_reach_the_critical_tilt() {
    let known = Calibrations::default();
    let mut designs = Vec::new();
    for base in BASES {
        for gap in [0.02, 0.05, 0.1, 0.2, 0.5, 0.8] {
            for length in [0.05, 0.15, 0.3, 0.5, 1.6, 2.4, 3.0] {
                designs.extend([79.0, 80.0, 82.0].map(|slant| design(gap, length, slant, base)));
            }
        }
    }
    for (design, puncture) in
        designs.iter().zip(solve_all(&designs, Law::PRINTED, &on_row(41), &known))
    {
        assert_eq!(puncture.status, Status::Complete, "{design:?}");
    }
}

/// Without friction a skin is elastic, so the loop work is zero. In some of these designs the
/// needle enters a notch and leaves it during unloading.
#[test]
fn a_frictionless_skin_unloads_along_its_loading_path() {
    let known = Calibrations::default();
    let needle = Needle::Guided { friction: 0.0 };
    let wide = Design { width: 0.718_475, ..design(0.030_111_5, 0.741_038, 30.2871, Base::TwoL) };
    let steep = Design { width: 0.289_1, ..design(0.041_111_6, 0.050_850_9, 59.4158, Base::TwoL) };
    let soft = Law { c1: 3.707_42, c2: 1.033_08 };
    let mut notches = 0;
    for (design, law, load_position, ratio, poisson_ratio) in [
        (wide, soft, 1.0, 2463.56, 0.327_968),
        (steep, Law::PRINTED, 0.295_15, 61.833_6, 0.137_307),
        (design(0.1, 1.0, 75.0, Base::L), Law::PRINTED, 1.0, 9677.0, 0.5),
        (design(0.3, 0.5, 45.0, Base::L), Law::PRINTED, 0.9, 9677.0, 0.5),
        (design(0.1, 0.2, 60.0, Base::L), Law::EXCHANGED, 1.0, 9677.0, 0.5),
    ] {
        let parameters = PunctureParameters {
            needle,
            load_position,
            poisson_ratio,
            contact_modulus_over_substrate: ratio,
            unload: true,
            ..PunctureParameters::default()
        };
        let puncture = solve_as(&known, &design, &with_law(law), &parameters);
        assert_eq!(puncture.status, Status::Complete, "{design:?}");
        let unloading = puncture.unloading.unwrap();
        assert_eq!(unloading.stop, Termination::Unloaded, "{design:?}");
        let energy = puncture.path.last().unwrap().substrate_energy;
        assert!(unloading.loop_work.unwrap().abs() < 1e-9 * energy, "{unloading:?}");
        notches += usize::from(puncture.measures.passage.passing_force.is_some());
    }
    assert!(notches >= 3, "{notches}");
}
