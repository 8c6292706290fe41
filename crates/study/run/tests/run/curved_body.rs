//! Tests of the forces of designs on curved bodies, compared with a flat body.

use std::path::Path;

use run::{Evaluator, curved_body_warning};
use sweep::{Measure, Sweep};

/// Solves a steep design with more lines in its definition; returns warning and critical force.
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
    let (on_finger, curved) = warned("body.radius_mm = 10");
    assert_eq!(on_finger, None, "a definition with a body needs no warning");
    assert!(curved < 0.5 * flat, "{curved} {flat}");
    let warning = warning.expect("a lower force");
    let number = |before: &str| -> f64 {
        let (start, _) = warning.split_once(before).expect(before);
        start.rsplit(' ').next().expect("a word").parse().expect("a number")
    };
    let ratio = number(" on a finger (radius 10 mm)") / number(" on a flat body");
    assert!((ratio / (curved / flat) - 1.0).abs() < 0.01, "{warning} {curved} {flat}");
    assert!(warning.starts_with("critical_force_N is "), "{warning}");
}

/// Radius of each named body divided by the thickness, for scales of 2 mm.
const RADII: [(&str, f64); 5] =
    [("flat", f64::INFINITY), ("torso", 72.5), ("thigh", 49.5), ("forearm", 22.5), ("finger", 5.0)];

/// A design with its coverage and critical force on a body.
#[derive(Clone, Copy, Debug)]
struct OnBody {
    /// Gap and length divided by the thickness, and slant in degrees.
    design: [f64; 3],
    coverage: f64,
    force: f64,
}

/// Solves 75 designs under the recommended needle on a body with this `radius` (unit: thickness).
fn designs_on(radius: f64) -> Vec<OnBody> {
    let text = format!(
        "name = 'x'\n[designs]\ngap_over_t = [0.1, 0.2, 0.3]\n\
         length_over_t = [0.2, 0.4, 0.6, 0.8, 1.0]\nslant_deg = [0, 15, 30, 45, 60]\n\
         [puncture]\nneedle = 'guided'\nneedle_friction = 0.3\nload_inset_over_t = 0.05\n\
         [body]\ncurvature_times_t = {}",
        radius.recip()
    );
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a sweep");
    let evaluator = Evaluator::new(&[Measure::Coverage, Measure::Puncture]);
    let mut all = Vec::new();
    for index in 0..sweep.grid().len() {
        let case = sweep.grid().case(index);
        let result = evaluator.row(sweep.grid().number(index), &case).result;
        let measures = result.puncture.expect("a puncture").measures;
        all.push(OnBody {
            design: [case.design.gap, case.design.length, case.design.slant_deg],
            coverage: result.coverage.expect("a coverage"),
            force: measures.critical_force.expect("a force"),
        });
    }
    all
}

/// Returns the rank of the force of each design: the number of designs with a smaller force.
fn ranks(designs: &[OnBody]) -> impl Iterator<Item = f64> {
    let below = designs.iter().map(|one| designs.iter().filter(|d| d.force < one.force).count());
    below.map(|count| count as f64)
}

/// Computes Spearman's rank correlation of the forces in two lists; assumes no equal forces.
fn rank_correlation(one: &[OnBody], other: &[OnBody]) -> f64 {
    let squares: f64 = ranks(one).zip(ranks(other)).map(|(a, b)| (a - b).powi(2)).sum();
    let count = one.len() as f64;
    1.0 - 6.0 * squares / (count * (count * count - 1.0))
}

/// Returns the strongest design with a coverage of at least one half.
fn strongest(designs: &[OnBody]) -> OnBody {
    let covering = designs.iter().filter(|design| design.coverage >= 0.5);
    *covering.max_by(|a, b| a.force.total_cmp(&b.force)).expect("a design")
}

/// Computes a row of the table of bodies in `docs/needle.md`.
fn row_of_advice(name: &str, radius: f64, flat: &[OnBody]) -> String {
    let curved = designs_on(radius);
    let mut ratios: Vec<f64> = curved.iter().zip(flat).map(|(c, f)| c.force / f.force).collect();
    let halved = ratios.iter().filter(|ratio| **ratio < 0.5).count();
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    let rank = rank_correlation(flat, &curved);
    let OnBody { design: [gap, length, slant], force, .. } = strongest(&curved);
    let best_flat = strongest(flat).design;
    let of_flat = curved.iter().find(|d| d.design == best_flat).expect("a design").force;
    let radius = if name == "flat" { "–".to_owned() } else { format!("{radius} t") };
    format!(
        "| {name} | {radius} | {median:.2} | {halved} | {rank:.2} | {gap}, {length}, {slant}° \
         | {force:.3} | {of_flat:.3} |"
    )
}

#[test]
fn the_needle_page_states_the_forces_on_named_bodies() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/needle.md");
    let page = std::fs::read_to_string(page).expect("a page");
    let flat = designs_on(f64::INFINITY);
    let rows = RADII.map(|(name, radius)| row_of_advice(name, radius, &flat)).join("\n");
    assert!(page.contains(&rows), "docs/needle.md lacks the rows\n{rows}");
}
