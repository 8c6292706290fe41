//! Tests of the two blocks in Fig. 3 of Shafiei et al. (2021), with a kink at first contact.

use skin::puncture::{Puncture, PuncturePoint};
use skin::{Base, Common, ContactChange, Design};
use solver::Settings;
use substrate::Calibrations;

use crate::samples::{blocks, design, on_row, solve_as};

/// Solves the puncture of a row of two scales in small steps.
fn finely(design: &Design) -> Puncture {
    let solver = Settings { first_step: 1e-3, max_step: 1e-3, ..Settings::default() };
    let common = Common { solver, ..Common::default() };
    solve_as(&Calibrations::default(), design, &common, &on_row(2))
}

/// Computes the change of the force divided by the change of the displacement, from two points.
fn stiffness(points: &[PuncturePoint]) -> f64 {
    (points[1].force - points[0].force) / (points[1].displacement - points[0].displacement)
}

/// Computes the stiffness just after first contact divided by the stiffness just before.
fn kink(puncture: &Puncture) -> f64 {
    let at = puncture.path.iter().position(|point| point.contacts > 0).unwrap();
    stiffness(&puncture.path[at..]) / stiffness(&puncture.path[at - 1..])
}

#[test]
fn the_stiffness_jumps_at_first_contact() {
    let puncture = finely(&blocks());
    crate::complete(&puncture);
    assert_eq!(puncture.events[0].change, ContactChange::Closed);
    let kink = kink(&puncture);
    println!("two blocks, L/t = 1, d/t = 0.1: stiffness after / before contact {kink:.3}");
    assert!(kink > 1.5, "{kink}");
    // The path has no other kink: elsewhere the slope changes little from step to step.
    let slopes: Vec<f64> = puncture.path.windows(2).map(stiffness).collect();
    let jumps = slopes.windows(2).filter(|pair| (pair[1] / pair[0] - 1.0).abs() > 0.05).count();
    assert_eq!(jumps, 1);
}

#[test]
fn blocks_far_apart_do_not_touch() {
    let puncture = finely(&design(1.0, 1.0, 0.0, Base::L));
    assert_eq!(crate::complete(&puncture).first_contact_displacement, None);
    assert!(puncture.events.is_empty());
}
