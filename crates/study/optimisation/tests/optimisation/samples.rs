//! Tests of goals with quantiles or yields that have optima in closed form.

use optimisation::{Answer, BestDesign, DesignGoal, Estimate, Found, Judgement, Limit};
use run::Start;

use crate::searches::{found_in, objectives, optimum};

/// Returns a goal with gap and slant as variables.
///
/// The gap has a batch deviation with a standard deviation of 0.02. `text` are further lines of the
/// section `[goal]`.
fn goal(text: &str) -> DesignGoal {
    let text = format!(
        "name = 'made'\nmeasures = 'coverage'\n[variables]\ngap_over_t = {{ from = 0.1, to = 1 }}\n\
         slant_deg = {{ from = 0, to = 60 }}\n[designs]\nlength_over_t = 1\n[material]\nthickness_mm = 1\n\
         scale_density_kg_m3 = 1000\n[tolerance]\ngap_over_t = {{ batch_sd = 0.02 }}\n[goal]\nsamples = 64\n{text}"
    );
    DesignGoal::parse(&text, "x.toml", &[]).expect("a goal")
}

/// Runs the search for `goal` in a temporary folder.
fn found(goal: &DesignGoal) -> Found {
    let folder = tempfile::tempdir().expect("a folder");
    found_in(folder.path(), goal, 2, Start::New)
}

/// Returns the estimate of the statistic `name` from independent samples.
fn estimate<'b>(best: &'b BestDesign, name: &str) -> &'b Estimate {
    best.confirmation
        .as_ref()
        .and_then(|confirmation| confirmation.estimate(name))
        .expect("an estimate")
}

/// Returns the reach `S` of scales with a slant of 60°. Their coverage is `(S − d)/S`.
fn reach() -> f64 {
    60_f64.to_radians().tan()
}

/// Value that a standard normal number exceeds with a probability of 5 %.
const Z05: f64 = 1.644_853_626_951_472_2;
/// Value that a standard normal number exceeds with a probability of 10 %.
const Z10: f64 = 1.281_551_565_544_600_4;

/// Returns the standard error of a quantile of `n` normal numbers, in standard deviations.
///
/// The standard error is `√(p (1 − p)/n)/φ(z)` with the probability `p` (`share`), the exact
/// quantile `z` and the normal density `φ`.
fn quantile_error(share: f64, z: f64, n: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    (share * (1.0 - share) / n).sqrt() / density
}

#[test]
fn required_yield_reduces_the_gap_by_a_quantile_of_its_deviation() {
    let goal = goal(
        "minimize = 'areal_mass_kg_m2'\nrequire = ['coverage >= 0.5', 'yield >= 0.9']\nskins = 2000",
    );
    let found = found(&goal);
    let best = optimum(&found);
    // The coverage is at least 0.5 for gaps up to S/2. If the nominal gap is 1.28 standard
    // deviations smaller than S/2, the gaps of 90 % of the samples are below S/2.
    let gap = best.row.case.design.gap;
    let error = quantile_error(0.1, Z10, 2000.0);
    let shift = (0.5 * reach() - gap) / 0.02;
    assert!((shift - Z10).abs() < 3.0 * error, "{shift}");
    assert!(best.bindings.iter().any(|binding| binding.limit == Limit::Requirement(1)));
    let of = estimate(best, "yield");
    // Among the samples of the search, at most one more than required meets the limits.
    assert!(of.seen.is_some_and(|seen| (0.9..0.9 + 2.0 / 2000.0).contains(&seen)), "{of:?}");
    let [low, high] = of.interval.map(|end| end.expect("an end of the interval"));
    assert!(low < high && (low..=high).contains(&of.value.expect("a yield")));
    assert!((of.value.expect("a yield") - 0.9).abs() < 4.0 * (0.09_f64 / 1000.0).sqrt() + 0.01);
    // The reason uses the multiplier of the coverage: 1 % of the limit changes the mass by 1 % ·
    // S/(1 + d)² · λ/m = 0.47 %.
    let reason = "coverage and slant_deg at its upper end 60 limit this design: \
                  with 1 % less required coverage, areal_mass_kg_m2 falls by about 0.47 %.";
    assert_eq!(best.reason.as_deref(), Some(reason));
}

#[test]
fn rounded_design_meets_the_required_yield() {
    // The largest gap is 0.84 for a yield of 0.9, and 0.866 without deviations.
    let text = "minimize = 'areal_mass_kg_m2'\nrequire = ['coverage >= 0.5', 'yield >= 0.9']\nround = 0.02";
    let found = found(&goal(text));
    let best = optimum(&found);
    assert!([0.82, 0.84].contains(&best.row.case.design.gap), "{:?}", best.row.case.design);
    assert!(estimate(best, "yield").value.is_some_and(|value| value >= 0.87));
    assert!(found.rounding.is_some_and(|rounding| rounding.rounded.is_some()));
}

#[test]
fn required_quantile_binds_with_the_exact_multiplier() {
    let goal = goal("minimize = 'areal_mass_kg_m2'\nrequire = 'coverage_p05 >= 0.5'\nskins = 2000");
    let found = found(&goal);
    let best = optimum(&found);
    let gap = best.row.case.design.gap;
    let shift = (0.5 * reach() - gap) / 0.02;
    assert!((shift - Z05).abs() < 3.0 * quantile_error(0.05, Z05, 2000.0), "{shift}");
    let binding = best.bindings.iter().find(|binding| binding.limit == Limit::Requirement(0));
    let price = binding.and_then(|binding| binding.price).expect("a price");
    // The multiplier is dm/dλ = S/(1 + d)², as for the nominal coverage, because the deviation is
    // added to the gap.
    assert!((price - reach() / (1.0 + gap).powi(2)).abs() < 1e-4, "{price}");
    let of = estimate(best, "coverage_p05");
    assert!((of.seen.expect("a quantile") - 0.5).abs() < 1e-6);
    let exact = 1.0 - (gap + 0.02 * Z05) / reach();
    let [low, high] = of.interval.map(|end| end.expect("an end of the interval"));
    assert!((low..=high).contains(&exact), "{low} {exact} {high}");
}

#[test]
fn quantile_of_the_best_design_matches_the_closed_form() {
    let text = "maximize = 'coverage_p05'\nrequire = ['gap_over_t >= 0.3', 'slant_deg <= 45']";
    let found = found(&goal(text));
    let best = optimum(&found);
    // Scales with a slant of 45° have the reach S = 1, which is less than the pitch, so their
    // coverage is (S − d)/S.
    let design = best.row.case.design;
    assert!((design.gap - 0.3).abs() < 1e-4 && (design.slant_deg - 45.0).abs() < 1e-2);
    let of = estimate(best, "coverage_p05");
    let exact = 1.0 - (0.3 + 0.02 * Z05);
    let error = 0.02 * quantile_error(0.05, Z05, 1000.0);
    for value in [of.seen, of.value] {
        assert!((value.expect("a quantile") - exact).abs() < 3.5 * error, "{of:?} {exact}");
    }
    // The width of the 95 % interval matches the standard error of the quantile.
    let [low, high] = of.interval.map(|end| end.expect("an end of the interval"));
    assert!((0.7..1.4).contains(&((high - low) / (2.0 * 1.96 * error))), "{low} {high} {error}");
    // The yield is reported too. It is 0.5, because half of the samples have a gap below 0.3.
    let half = estimate(best, "yield").value.expect("a yield");
    assert!((half - 0.5).abs() < 3.5 * (0.25_f64 / 1000.0).sqrt(), "{half}");
}

#[test]
fn largest_yield_is_in_the_middle_between_two_bounds() {
    // At 60° a coverage of at least 0.5 requires gaps below S/2, and a mass of at most 0.55
    // requires gaps above 1/0.55 − 1. These bounds are 2.4 standard deviations apart.
    let text = "maximize = 'yield'\nrequire = ['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.55']";
    let found = found(&goal(text));
    let best = optimum(&found);
    let (low, high) = (1.0 / 0.55 - 1.0, 0.5 * reach());
    let half = 0.5 * (high - low) / 0.02;
    let exact = normal_share(half) - normal_share(-half);
    let gap = best.row.case.design.gap;
    let yielded = estimate(best, "yield");
    let [from, to] = yielded.interval.map(|end| end.expect("an end of the interval"));
    assert!((from..=to).contains(&exact), "{from} {exact} {to}, at {gap}");
    assert!(objectives(best)[0] >= exact - 0.03, "{:?}", objectives(best));
    assert!((gap - 0.5 * (low + high)).abs() < 0.012, "{gap} between {low} and {high}");
}

/// Returns the standard normal distribution function at `z` with an error below 2e-7.
///
/// Abramowitz & Stegun, formula 7.1.26.
fn normal_share(z: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * z.abs() / 2_f64.sqrt());
    let series = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    let sum = series.iter().rev().fold(0.0, |sum, a| t * (sum + a));
    let tail = 0.5 * sum * (-0.5 * z * z).exp();
    if z > 0.0 { 1.0 - tail } else { tail }
}

#[test]
fn front_of_a_quantile_is_not_better_than_the_closed_form() {
    let goal = goal("maximize = 'coverage_p05'\nminimize = 'areal_mass_kg_m2'\npoints = 5");
    let found = found(&goal);
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    assert_eq!(front.designs.len(), 5);
    for best in &front.designs {
        let [covered, mass] = objectives(best) else { panic!("two objectives") };
        // `gap` is the nominal gap at which the 5 % quantile of the coverage is `covered`. A design
        // with this quantile needs at least the mass of this gap.
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
fn goals_with_an_infeasible_yield_report_the_nearest_sampled_design() {
    let text = "maximize = 'gap_over_t'\nrequire = ['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.54', 'yield >= 0.99']";
    let found = found(&goal(text));
    let Answer::Infeasible(Some(nearest)) = found.answer else { panic!("an infeasible goal") };
    assert!(nearest > 64, "the nearest design is not one of the first 64, which have no samples");
    // The gap of a sample must be between 0.852 and 0.866, but its standard deviation is 0.02. Each
    // sample misses at most one of the two limits.
    let Judgement::Judged(worth) = &found.history[nearest].verdict else {
        panic!("a design with samples")
    };
    let missed: f64 = found.missed.iter().map(|missed| missed.share).sum();
    assert!((missed - (1.0 - worth.required[2])).abs() < 1e-12, "{:?}", found.missed);
    let names = found.missed.iter().filter_map(|m| Some(m.requirement.as_ref()?.column.as_str()));
    let mut names: Vec<_> = names.collect();
    names.sort_unstable();
    assert_eq!(names, ["areal_mass_kg_m2", "coverage"]);
}

#[test]
fn required_yield_includes_deviations_of_the_thickness() {
    // The gap is in mm, so it does not change if the thickness of 1 mm deviates.
    let text = "name = 'made'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
        slant_deg = { from = 40, to = 45 }\n[designs]\nlength_over_t = 1\n[material]\nthickness_mm = 1\n\
        [tolerance]\ngap_mm = { batch_sd = 0.02, scale_sd = 0.01 }\nthickness_mm = { batch_sd = 0.03 }\n\
        [goal]\nmaximize = 'gap_over_t'\nrequire = ['coverage >= 0.5', 'yield >= 0.95']\nsamples = 64\nskins = 2000";
    let found = found(&DesignGoal::parse(text, "x.toml", &[]).expect("a goal"));
    let gap = optimum(&found).row.case.design.gap;
    // A sample has the gap d + x and the thickness 1 + y. Its coverage λ = 1 − (d + x)/(1 + y) is
    // at least 1/2 if d + x ≤ (1 + y)/2. A yield of 0.95 requires d = 1/2 − z √(0.02² + (0.03/2)²).
    let spread = 0.02_f64.hypot(0.015);
    let shift = (0.5 - gap) / spread;
    assert!((shift - Z05).abs() < 3.0 * quantile_error(0.05, Z05, 2000.0), "{shift}");
}
