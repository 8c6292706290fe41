//! Pressure of a needle on tissue without scales.

use run::{BareNeedle, Evaluator, bare_needle};
use sweep::{Measure, Sweep};

/// Modulus of the tissue in `MPa`.
const MODULUS: f64 = 1.5;

/// Solves a design; returns the bare needle, the force in N, and the pressure under the skin in
/// kPa.
fn solved(radius: &str) -> (Option<BareNeedle>, f64, f64) {
    let text = format!(
        "name = 'x'\nmeasures = 'puncture'\n[designs]\ngap_over_t = 0.2\nlength_over_t = 0.8\n\
         slant_deg = 45\n[puncture]\nneedle = 'guided'\n{radius}\n\
         failure = true\n[substrate]\npoisson_ratio = 0.4\n[material]\nthickness_mm = 2\n\
         substrate_modulus_MPa = {MODULUS}"
    );
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a sweep");
    let case = sweep.grid().case(0);
    let row = Evaluator::new(&[Measure::Puncture]).row(sweep.grid().number(0), &case);
    let measures = row.result.puncture.expect("a puncture").measures;
    let force = measures.critical_force.expect("a force");
    // F = F* E* L t, with E* = E_s/(1 − ν²), L = 1.6 mm and t = 2 mm.
    let at_end = force * MODULUS / (1.0 - 0.4 * 0.4) * 1.6 * 2.0;
    let pressure = measures.tissue_pressure_at_force.or(measures.failure.tissue_pressure);
    let pressure = 1e3 * MODULUS * pressure.expect("a pressure");
    (bare_needle(&row), case.needle_force_n.unwrap_or(at_end), pressure)
}

#[test]
fn bare_pressure_follows_hertz_up_to_the_radius_of_the_shaft() {
    // A thin needle sinks in up to its shaft. A thick needle touches the tissue with a part of its
    // tip, both with the critical force and with a smaller force in the definition.
    let needles = [("0.1", 0.1, true), ("2", 2.0, false), ("2\nforce_N = 0.3", 2.0, false)];
    for (given, radius, is_shaft) in needles {
        let (bare, force, under_skin) = solved(&format!("needle_radius_mm = {given}"));
        let bare = bare.expect("a round needle");
        let contact = (0.75 * force * radius * (1.0 - 0.4 * 0.4) / MODULUS).cbrt();
        assert_eq!(contact > radius, is_shaft, "{contact}");
        let pressure = 1e3 * force / (std::f64::consts::PI * contact.min(radius).powi(2));
        assert!((bare.pressure_kpa / pressure - 1.0).abs() < 1e-9, "{bare:?} {pressure}");
        let reduction = pressure / under_skin;
        assert!((bare.reduction / reduction - 1.0).abs() < 1e-9, "{bare:?} {reduction}");
    }
}

#[test]
fn a_sharp_needle_has_no_pressure_on_bare_tissue() {
    assert_eq!(solved("").0, None);
}
