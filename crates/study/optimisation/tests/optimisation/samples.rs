//! Goals about samples with optima in closed form.

use optimisation::{Answer, BestDesign, DesignGoal, Estimate, Found, Judgement, Limit};
use run::Start;

use crate::searches::{found_in, objectives, optimum};

/// Returns a goal with gap and slant as variables; gaps have a deviation of 0.02.
fn goal(text: &str) -> DesignGoal {
    let text = format!(
        "name = 'made'\nmeasures = 'coverage'\n[variables]\ngap_over_t = {{ from = 0.1, to = 1 }}\n\
         slant_deg = {{ from = 0, to = 60 }}\n[designs]\nlength_over_t = 1\n[material]\nthickness_mm = 1\n\
         scale_density_kg_m3 = 1000\n[tolerance]\ngap_over_t = {{ batch_sd = 0.02 }}\n[goal]\nsamples = 64\n{text}"
    );
    DesignGoal::parse(&text, "x.toml", &[]).expect("a goal")
}

fn found(goal: &DesignGoal) -> Found {
    let folder = tempfile::tempdir().expect("a folder");
    found_in(folder.path(), goal, 2, Start::New)
}

fn estimate<'b>(best: &'b BestDesign, name: &str) -> &'b Estimate {
    best.confirmation.as_ref().and_then(|made| made.estimate(name)).expect("an estimate")
}

/// Returns the reach `S` of scales of 60°, which have the coverage `(S − d)/S`.
fn reach() -> f64 {
    60_f64.to_radians().tan()
}

/// Standard normal quantiles of 5 %, 10 %.
const Z05: f64 = 1.644_853_626_951_472_2;
const Z10: f64 = 1.281_551_565_544_600_4;

/// Returns the standard error of a quantile of `n` normal numbers.
///
/// In standard deviations it is √(p (1 − p)/n)/φ(z).
fn quantile_error(share: f64, z: f64, n: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    (share * (1.0 - share) / n).sqrt() / density
}

#[test]
fn a_required_yield_moves_the_gap_by_its_quantile() {
    let goal = goal(
        "minimize = 'areal_mass_kg_m2'\nrequire = ['coverage >= 0.5', 'yield >= 0.9']\nskins = 2000",
    );
    let found = found(&goal);
    let best = optimum(&found);
    // The nominal gap could be S/2. If it is 1.28 standard deviations narrower, nine of ten gaps
    // are below S/2.
    let gap = best.row.case.design.gap;
    let error = quantile_error(0.1, Z10, 2000.0);
    let shift = (0.5 * reach() - gap) / 0.02;
    assert!((shift - Z10).abs() < 3.0 * error, "{shift}");
    assert!(best.bindings.iter().any(|binding| binding.limit == Limit::Requirement(1)));
    let of = estimate(best, "yield");
    // The yield seen by the search is the required one, up to one sample.
    assert!(of.seen.is_some_and(|seen| (0.9..0.9 + 2.0 / 2000.0).contains(&seen)), "{of:?}");
    let [low, high] = of.interval.map(|end| end.expect("an end"));
    assert!(low < high && (low..=high).contains(&of.value.expect("a yield")));
    assert!((of.value.expect("a yield") - 0.9).abs() < 4.0 * (0.09_f64 / 1000.0).sqrt() + 0.01);
    // A yield has no multiplier, but its limits have, here S/(1 + d)² · λ/m = 0.47 %.
    let reason = "coverage and slant_deg at its upper end 60 limit this design: \
                  with 1 % less required coverage, areal_mass_kg_m2 falls by about 0.47 %.";
    assert_eq!(best.reason.as_deref(), Some(reason));
}

#[test]
fn a_rounded_design_meets_a_required_yield() {
    // The gap may be at most 0.84 for a yield of 0.9, and 0.866 without deviations.
    let text = "minimize = 'areal_mass_kg_m2'\nrequire = ['coverage >= 0.5', 'yield >= 0.9']\nround = 0.02";
    let found = found(&goal(text));
    let best = optimum(&found);
    assert!([0.82, 0.84].contains(&best.row.case.design.gap), "{:?}", best.row.case.design);
    assert!(estimate(best, "yield").value.is_some_and(|value| value >= 0.87));
    assert!(found.rounding.is_some_and(|rounding| rounding.rounded.is_some()));
}

#[test]
fn a_required_quantile_binds_with_the_exact_multiplier() {
    let goal = goal("minimize = 'areal_mass_kg_m2'\nrequire = 'coverage_p05 >= 0.5'\nskins = 2000");
    let found = found(&goal);
    let best = optimum(&found);
    let gap = best.row.case.design.gap;
    let shift = (0.5 * reach() - gap) / 0.02;
    assert!((shift - Z05).abs() < 3.0 * quantile_error(0.05, Z05, 2000.0), "{shift}");
    let binding = best.bindings.iter().find(|binding| binding.limit == Limit::Requirement(0));
    let price = binding.and_then(|binding| binding.price).expect("a price");
    // dm/dλ = S/(1 + d)², as for the nominal coverage, because the deviation adds to the gap.
    assert!((price - reach() / (1.0 + gap).powi(2)).abs() < 1e-4, "{price}");
    let of = estimate(best, "coverage_p05");
    assert!((of.seen.expect("a quantile") - 0.5).abs() < 1e-6);
    let exact = 1.0 - (gap + 0.02 * Z05) / reach();
    let [low, high] = of.interval.map(|end| end.expect("an end"));
    assert!((low..=high).contains(&exact), "{low} {exact} {high}");
}

#[test]
fn the_quantile_of_the_best_design_matches_its_distribution() {
    let text = "maximize = 'coverage_p05'\nrequire = ['gap_over_t >= 0.3', 'slant_deg <= 45']";
    let found = found(&goal(text));
    let best = optimum(&found);
    // Scales of 45° reach S = 1, less than the pitch, so their coverage is (S − d)/S.
    let design = best.row.case.design;
    assert!((design.gap - 0.3).abs() < 1e-4 && (design.slant_deg - 45.0).abs() < 1e-2);
    let of = estimate(best, "coverage_p05");
    let exact = 1.0 - (0.3 + 0.02 * Z05);
    let error = 0.02 * quantile_error(0.05, Z05, 1000.0);
    for value in [of.seen, of.value] {
        assert!((value.expect("a quantile") - exact).abs() < 3.5 * error, "{of:?} {exact}");
    }
    // The width of the 95 % interval matches the standard error of the quantile.
    let [low, high] = of.interval.map(|end| end.expect("an end"));
    assert!((0.7..1.4).contains(&((high - low) / (2.0 * 1.96 * error))), "{low} {high} {error}");
    // The yield is reported in addition: half of the gaps are narrower than required.
    let half = estimate(best, "yield").value.expect("a yield");
    assert!((half - 0.5).abs() < 3.5 * (0.25_f64 / 1000.0).sqrt(), "{half}");
}

#[test]
fn the_largest_yield_is_in_the_middle_between_two_bounds() {
    // At 60°, coverage ≥ 0.5 requires gaps below S/2, and mass ≤ 0.55 gaps above 1/0.55 − 1. The
    // bounds are 2.4 standard deviations apart.
    let text = "maximize = 'yield'\nrequire = ['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.55']";
    let found = found(&goal(text));
    let best = optimum(&found);
    let (low, high) = (1.0 / 0.55 - 1.0, 0.5 * reach());
    let half = 0.5 * (high - low) / 0.02;
    let exact = normal_share(half) - normal_share(-half);
    let gap = best.row.case.design.gap;
    let yielded = estimate(best, "yield");
    let [from, to] = yielded.interval.map(|end| end.expect("an end"));
    assert!((from..=to).contains(&exact), "{from} {exact} {to}, at {gap}");
    assert!(objectives(best)[0] >= exact - 0.03, "{:?}", objectives(best));
    assert!((gap - 0.5 * (low + high)).abs() < 0.012, "{gap} between {low} and {high}");
}

/// Returns the standard normal distribution function to 2e-7.
///
/// Abramowitz & Stegun 7.1.26.
fn normal_share(z: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * z.abs() / 2_f64.sqrt());
    let series = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    let sum = series.iter().rev().fold(0.0, |sum, a| t * (sum + a));
    let tail = 0.5 * sum * (-0.5 * z * z).exp();
    if z > 0.0 { 1.0 - tail } else { tail }
}

#[test]
fn a_front_may_have_a_quantile() {
    let goal = goal("maximize = 'coverage_p05'\nminimize = 'areal_mass_kg_m2'\npoints = 5");
    let found = found(&goal);
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    assert_eq!(front.designs.len(), 5);
    for best in &front.designs {
        let [covered, mass] = objectives(best) else { panic!("two objectives") };
        // No design on the front of nominal designs covers more for its mass.
        let gap = (reach() * (1.0 - covered)).min(1.0 + 0.02 * Z05) - 0.02 * Z05;
        assert!(*mass >= (1.0 / (1.0 + gap)).min(1.0) - 0.01, "{covered} {mass}");
        assert!(best.confirmation.is_some());
    }
}

#[test]
fn samples_do_not_depend_on_threads_or_interruptions() {
    let text =
        "minimize = 'areal_mass_kg_m2'\nrequire = ['coverage >= 0.5', 'yield >= 0.9']\nskins = 50";
    let goal = goal(text);
    let what = |found: &Found| {
        let candidate =
            |c: &optimisation::Candidate| (c.stage.word(), c.point.clone(), c.verdict.clone());
        let best = optimum(found);
        (
            found.history.iter().map(candidate).collect::<Vec<_>>(),
            best.confirmation.clone(),
            best.bindings.clone(),
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let whole = found_in(folder.path(), &goal, 1, Start::New);
    let journal = folder.path().join(results::ResultsFolder::EVALUATIONS);
    let bytes = std::fs::read(&journal).expect("a journal");
    for share in [0.3, 0.6, 0.95] {
        let kept = (bytes.len() as f64 * share) as usize;
        std::fs::write(&journal, &bytes[..kept]).expect("writable");
        let again = found_in(folder.path(), &goal, 3, Start::Resume);
        assert_eq!(what(&again), what(&whole), "{share}");
        assert_eq!(again.evaluations, whole.evaluations);
    }
}

#[test]
fn infeasible_yields_report_the_nearest_sampled_design() {
    let text = "maximize = 'gap_over_t'\nrequire = ['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.54', 'yield >= 0.99']";
    let found = found(&goal(text));
    let Answer::Infeasible(Some(nearest)) = found.answer else { panic!("no design") };
    assert!(nearest > 64, "a sampled design is nearer than any design that was not sampled");
    // The gap would have to be between 0.852 and 0.866, with a standard deviation of 0.02. No
    // sample misses both limits.
    let Judgement::Judged(worth) = &found.history[nearest].verdict else { panic!("sampled") };
    let missed: f64 = found.missed.iter().map(|missed| missed.share).sum();
    assert!((missed - (1.0 - worth.required[2])).abs() < 1e-12, "{:?}", found.missed);
    let names = found.missed.iter().filter_map(|m| Some(m.requirement.as_ref()?.column.as_str()));
    let mut names: Vec<_> = names.collect();
    names.sort_unstable();
    assert_eq!(names, ["areal_mass_kg_m2", "coverage"]);
}

#[test]
fn a_required_yield_includes_deviations_of_thickness() {
    // Lengths are in mm: when the thickness of 1 mm deviates, all other lengths are unchanged.
    let text = "name = 'made'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
        slant_deg = { from = 40, to = 45 }\n[designs]\nlength_over_t = 1\n[material]\nthickness_mm = 1\n\
        [tolerance]\ngap_mm = { batch_sd = 0.02, scale_sd = 0.01 }\nthickness_mm = { batch_sd = 0.03 }\n\
        [goal]\nmaximize = 'gap_over_t'\nrequire = ['coverage >= 0.5', 'yield >= 0.95']\nsamples = 64\nskins = 2000";
    let found = found(&DesignGoal::parse(text, "x.toml", &[]).expect("a goal"));
    let gap = optimum(&found).row.case.design.gap;
    // λ = 1 − d/t ≥ 1/2 requires d + x ≤ (1 + y)/2, so d = 1/2 − z √(0.02² + (0.03/2)²).
    let spread = 0.02_f64.hypot(0.015);
    let shift = (0.5 - gap) / spread;
    assert!((shift - Z05).abs() < 3.0 * quantile_error(0.05, Z05, 2000.0), "{shift}");
}
