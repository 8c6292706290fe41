//! Flat designs that are worn on curved bodies.

use run::{Evaluator, curved_body_warning};
use sweep::Sweep;

/// Solves a steep design with further lines, and returns the warning and the critical force.
fn warned(further: &str) -> (Option<String>, f64) {
    let text = format!(
        "name = 'x'\n{further}\n[designs]\ngap_over_t = 0.3\nlength_over_t = 0.8\nslant_deg = 60\n\
        [material]\nthickness_mm = 2\nsubstrate_modulus_MPa = 1"
    );
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a sweep");
    let number = sweep.grid().number(0);
    let row = Evaluator::new(sweep.measures()).row(number, &sweep.grid().case(0));
    let force = row.result.puncture.as_ref().and_then(|p| p.measures.critical_force);
    (curved_body_warning(&sweep, &row), force.expect("a force"))
}

#[test]
fn a_flat_design_is_compared_with_named_bodies() {
    let (warning, flat) = warned("");
    let (on_finger, worn) = warned("body.radius_mm = 10");
    assert_eq!(on_finger, None, "a definition with a body");
    assert!(worn < 0.5 * flat, "{worn} {flat}");
    let warning = warning.expect("a lower force");
    let number = |before: &str| -> f64 {
        let (start, _) = warning.split_once(before).expect(before);
        start.rsplit(' ').next().expect("a word").parse().expect("a number")
    };
    let ratio = number(" on a finger (radius 10 mm)") / number(" on a flat body");
    assert!((ratio / (worn / flat) - 1.0).abs() < 0.01, "{warning} {worn} {flat}");
    assert!(warning.starts_with("critical_force_N is "), "{warning}");
}
