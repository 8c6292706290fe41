//! Smallest critical force of a design on bodies between two radii.

use results::{DesignResult, Outcome, PunctureResult};
use run::Evaluator;
use sweep::{Measure, Sweep};

fn solved(measures: &[Measure], body: &str) -> DesignResult {
    let text = format!(
        "name = 'x'\n[designs]\ngap_over_t = 0.3\nlength_over_t = 1\nslant_deg = 60\n[body]\n{body}"
    );
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
    Evaluator::new(measures).row(sweep.grid().number(0), &sweep.grid().case(0)).result
}

fn punctured(body: &str) -> PunctureResult {
    solved(&[Measure::Puncture], body).puncture.expect("a puncture")
}

#[test]
fn the_worst_force_does_not_depend_on_the_order_of_the_radii() {
    let finger = punctured("radius_over_t = 8").measures.critical_force;
    for body in [
        "radius_over_t = 8\nradius_to_over_t = 500",
        "radius_over_t = 500\nradius_to_over_t = 8",
        "radius_to_over_t = 8",
    ] {
        let between = punctured(body);
        assert_eq!(between.between, Some(Outcome::Complete), "{body}");
        let (worst, finger) = (between.measures.between.force.unwrap(), finger.unwrap());
        assert!((worst / finger - 1.0).abs() < 1e-9, "{body}: {worst} instead of {finger}");
        let curvature = between.measures.between.curvature.unwrap();
        assert!((curvature - 0.125).abs() < 1e-15, "{body}: {curvature}");
    }
}

#[test]
fn no_body_between_the_radii_has_a_force_below_the_worst_force() {
    let between = punctured("radius_over_t = 3\nradius_to_over_t = -40");
    let worst = between.measures.between.force.expect("a force");
    for k in 0..=32 {
        let curvature = 1.0 / 3.0 - f64::from(k) / 32.0 * (1.0 / 3.0 + 1.0 / 40.0);
        let here = punctured(&format!("curvature_times_t = {curvature}"));
        let here = here.measures.critical_force.expect("a force");
        assert!(worst <= here * (1.0 + 1e-3), "t/R = {curvature}: {here} below {worst}");
    }
}

#[test]
fn the_worst_force_is_unknown_if_scales_overlap_on_a_body() {
    let between = punctured("radius_over_t = 5\nradius_to_over_t = -1.2");
    assert_eq!(between.outcome, Outcome::Complete);
    assert_eq!(between.between, Some(Outcome::Overlapping));
    assert_eq!(between.measures.between.force, None);
}

/// Solves a design with derivatives on bodies between the radii 200 t and `to`.
fn differentiated(gap: f64, to: f64) -> DesignResult {
    let text = format!(
        "name = 'x'\n[designs]\ngap_over_t = {gap}\nlength_over_t = 1\nslant_deg = 60\n\
         [body]\nradius_over_t = 200\nradius_to_over_t = {to}"
    );
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep");
    let evaluator = Evaluator::new(&[Measure::Puncture, Measure::Sensitivity]);
    evaluator.row(sweep.grid().number(0), &sweep.grid().case(0)).result
}

fn worst_force(gap: f64, to: f64) -> f64 {
    differentiated(gap, to).puncture.unwrap().measures.between.force.unwrap()
}

#[test]
fn derivatives_of_the_worst_force_agree_with_differences() {
    let here = differentiated(0.3, 8.0);
    for (key, difference) in [
        ("gap_over_t", (worst_force(0.3 + 1e-5, 8.0) - worst_force(0.3 - 1e-5, 8.0)) / 2e-5),
        ("radius_to_over_t", (worst_force(0.3, 8.001) - worst_force(0.3, 7.999)) / 2e-3),
    ] {
        let mut derivatives = here.sensitivity.iter();
        let found = derivatives
            .find(|of| of.measure == "worst_force_between" && of.parameter == key)
            .and_then(|of| of.left)
            .expect("a derivative");
        assert!((found / difference - 1.0).abs() < 1e-5, "{key}: {found}, {difference}");
    }
}
