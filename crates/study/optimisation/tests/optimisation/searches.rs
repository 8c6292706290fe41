//! Searches with optima in closed form.

use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use journal::Seal;
use optimisation::{
    Answer, BestDesign, DesignGoal, Found, Judgement, Limit, Rounding, SearchOptions,
    SearchProgress, SearchStage, optimise, write_found,
};
use results::{CsvFormat, Results};
use run::{Program, Start};

const PROGRAM: Program = Program { version: "1.0", revision: "none" };

/// Goal with gap and slant of scales as variables; only the coverage is measured.
const COVERED: &str = "name = 'covered'\nmeasures = 'coverage'\n[variables]\n\
    gap_over_t = { from = 0.1, to = 1 }\nslant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\n\
    [material]\nthickness_mm = 1\nscale_density_kg_m3 = 1000\n";

pub(crate) fn found_in(folder: &Path, goal: &DesignGoal, threads: usize, start: Start) -> Found {
    let (stop, progress) = (AtomicBool::new(false), SearchProgress::default());
    let options = SearchOptions { threads, start, stop: &stop, progress: &progress };
    optimise(goal, folder, &options, &PROGRAM).expect("a search").expect("an end")
}

pub(crate) fn goal(text: &str) -> DesignGoal {
    DesignGoal::parse(&format!("{COVERED}[goal]\nsamples = 64\n{text}"), "x.toml", &[])
        .expect("a goal")
}

/// A level of a standard is a requirement; the goal also records the standard.
#[test]
fn goals_accept_levels_of_standards() {
    let text = "name = 'x'\nmeasures = 'puncture'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
                [designs]\nlength_over_t = 1\nslant_deg = 45\n\
                [material]\nthickness_mm = 1\nsubstrate_modulus_MPa = 1\n[goal]\nmaximize = 'gap_over_t'\n";
    let read =
        |level: &str| DesignGoal::parse(&format!("{text}protects = '{level}'"), "x.toml", &[]);
    let goal = read("needle 2").expect("a goal");
    let required: Vec<_> = goal.requirements.iter().map(ToString::to_string).collect();
    assert_eq!(required, ["critical_force_N >= 4"]);
    assert_eq!(goal.standards.iter().map(|standard| standard.name).collect::<Vec<_>>(), ["needle"]);
    let wrong = read("needle 9").expect_err("no such level").to_string();
    assert!(
        wrong.starts_with("x.toml:13: goal.protects: ")
            && wrong.contains("'needle 1' to 'needle 5'"),
        "{wrong}"
    );
}

/// The reference search ends at a corner of limits, which derivatives prove to be the optimum.
///
/// Ridge search and polish would only confirm it. The reported design still has all values.
#[test]
fn a_search_does_not_confirm_an_optimum_that_derivatives_prove() {
    let (found, _) = reference_search();
    let best = optimum(found);
    assert!((objectives(best)[0] - 2.141_936_6).abs() < 2e-6, "{:?}", objectives(best));
    // One of the three full searches starts away from the optimum, and needs one round of ridge
    // search and polish (47 evaluations). Confirmations would need as many in each of the others.
    let stages = found.history.iter().map(|candidate| candidate.stage);
    let confirming =
        stages.filter(|s| matches!(s, SearchStage::Ridge | SearchStage::Polish)).count();
    assert!(confirming < 60, "{confirming}");
    let searched = found.history.iter().filter_map(|c| c.result.puncture);
    assert!(searched.into_iter().all(|p| p.measures.max_stiffness.is_none()));
    assert!(best.row.result.puncture.is_some_and(|p| p.measures.max_stiffness.is_some()));
}

/// Runs the reference search once, and returns its result with its progress.
///
/// Progress is the number of evaluated designs and the completed fraction.
fn reference_search() -> &'static (Found, Vec<[f64; 2]>) {
    static SEARCH: OnceLock<(Found, Vec<[f64; 2]>)> = OnceLock::new();
    SEARCH.get_or_init(|| {
        let text = "name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n[variables]\n\
            gap_over_t = { from = 0.1, to = 1 }\nlength_over_t = { from = 0.025, to = 1 }\n\
            slant_deg = { from = 0, to = 75 }\n[goal]\nmaximize = 'critical_force'\n\
            require = ['coverage >= 0.5', 'compliance >= 0.2']\nsamples = 64\n";
        let goal = DesignGoal::parse(text, "x.toml", &[]).expect("a goal");
        let folder = tempfile::tempdir().expect("a folder");
        let (stop, progress) = (AtomicBool::new(false), SearchProgress::default());
        let options =
            SearchOptions { threads: 1, start: Start::New, stop: &stop, progress: &progress };
        std::thread::scope(|scope| {
            let search = scope.spawn(|| optimise(&goal, folder.path(), &options, &PROGRAM));
            let mut seen = Vec::new();
            while !search.is_finished() {
                seen.push([progress.designs() as f64, progress.share()]);
                std::thread::sleep(std::time::Duration::from_millis(2));
            }
            let found = search.join().expect("no panic").expect("a search").expect("an end");
            seen.push([progress.designs() as f64, progress.share()]);
            (found, seen)
        })
    })
}

fn found(goal: &DesignGoal) -> Found {
    let folder = tempfile::tempdir().expect("a folder");
    found_in(folder.path(), goal, 1, Start::New)
}

pub(crate) fn optimum(found: &Found) -> &BestDesign {
    let Answer::Optimum(best) = &found.answer else { panic!("an optimum") };
    best
}

pub(crate) fn objectives(best: &BestDesign) -> &[f64] {
    let Judgement::Judged(worth) = &best.candidate.verdict else { panic!("judged") };
    &worth.objectives
}

#[test]
fn binding_limits_have_the_exact_multipliers() {
    let goal = goal("minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'");
    let found = found(&goal);
    let best = optimum(&found);
    // The gap is as wide as the coverage λ = (S − d)/S allows, to minimise the mass 1/(1 + d).
    let reach = 60_f64.to_radians().tan();
    let gap = 0.5 * reach;
    assert!((objectives(best)[0] - 1.0 / (1.0 + gap)).abs() < 1e-9, "{:?}", objectives(best));
    // dm/dλ = S/(1 + d)². One degree more slant would widen the gap by (1 − λ) dS/dα.
    let price = reach / (1.0 + gap).powi(2);
    let rate = (1.0 + reach * reach) * 1_f64.to_radians();
    for (limit, price) in
        [(Limit::Requirement(0), price), (Limit::Upper(1), 0.5 * rate / (1.0 + gap).powi(2))]
    {
        let binding = best.bindings.iter().find(|binding| binding.limit == limit);
        let found = binding.and_then(|binding| binding.price).expect("a price");
        assert!((found - price).abs() < 1e-6, "{limit:?}: {found}");
    }
    // 1 % of the limit changes the mass by dm/dλ · λ/m = 0.464 %.
    let reason = "coverage and slant_deg at its upper end 60 limit this design: \
                  with 1 % less required coverage, areal_mass_kg_m2 falls by 0.46 %.";
    assert_eq!(best.reason.as_deref(), Some(reason));
}

/// The gap may be at most 0.866, so rounding to the nearest multiple would miss the coverage.
#[test]
fn a_rounded_design_meets_the_requirements() {
    let text = "minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'\nround = 0.1";
    let found = found(&goal(text));
    let best = optimum(&found);
    let design = best.row.case.design;
    assert_eq!((design.gap, design.slant_deg), (0.8, 60.0));
    let Some(Rounding { step, unit, exact, rounded: Some(rounded) }) = found.rounding else {
        panic!("rounded")
    };
    assert_eq!((step, unit), (0.1, "mm"));
    assert!((exact - 1.0 / (1.0 + 0.5 * 60_f64.to_radians().tan())).abs() < 1e-9);
    assert!((rounded - 1.0 / 1.8).abs() < 1e-12, "{rounded}");
}

#[test]
fn a_goal_without_a_feasible_rounded_design_keeps_the_exact_one() {
    // The gap is between 0.852 and 0.866.
    let text = "maximize = 'gap_over_t'\nrequire = ['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.54']\nround = 0.1";
    let found = found(&goal(text));
    assert_eq!(found.rounding.as_ref().expect("tried").rounded, None);
    let gap = optimum(&found).row.case.design.gap;
    assert!((gap - 0.5 * 60_f64.to_radians().tan()).abs() < 1e-9, "{gap}");
}

#[test]
fn an_optimum_on_a_kink_is_found_without_multipliers() {
    let text = "maximize = 'coverage'\nrequire = 'gap_over_t >= 0.3'";
    let found = found(&goal(text));
    let best = optimum(&found);
    // At S = p, the coverage λ = 1/(1 + d) has a peak and falls on both sides.
    assert!((objectives(best)[0] - 1.0 / 1.3).abs() < 1e-6, "{:?}", objectives(best));
    assert!(best.bindings.iter().all(|binding| binding.price.is_none()));
    assert!(found.history.iter().any(|candidate| candidate.stage == SearchStage::Ridge));
}

#[test]
fn an_optimum_at_the_end_of_a_ridge_is_found() {
    // Along S = p, longer scales cover more, until the surface folds or the interval ends.
    let text = "name = 'ridge'\nmeasures = ['coverage', 'puncture']\npuncture.scales = 9\n[variables]\n\
        length_over_t = { from = 0.5, to = 1 }\nslant_deg = { from = 30, to = 55 }\n[designs]\ngap_over_t = 0.1\n\
        [goal]\nmaximize = 'coverage'\nsamples = 16\n";
    for sound in [true, false] {
        let goal = DesignGoal::parse(&format!("{text}sound = {sound}"), "x.toml", &[]);
        let found = found(&goal.expect("a goal"));
        let best = optimum(&found);
        let design = best.row.case.design;
        let (pitch, shift) = (design.length + 0.1, design.slant_deg.to_radians().tan());
        assert!((shift / pitch - 1.0).abs() < 1e-7, "{design:?}");
        assert!((objectives(best)[0] / (design.length / pitch) - 1.0).abs() < 1e-7);
        let puncture = best.row.result.puncture.expect("measured").measures;
        let stretch = puncture.gap_stretch_min.expect("a gap");
        assert_eq!(design.length < 1.0, sound);
        assert!(!sound || (-1e-9..1e-7).contains(&stretch), "{stretch}");
    }
}

#[test]
fn different_seeds_find_the_same_optimum() {
    let [one, two] = [1, 2].map(|seed| {
        let text =
            format!("minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'\nseed = {seed}");
        objectives(optimum(&found(&goal(&text))))[0]
    });
    assert!((one / two - 1.0).abs() < 1e-9);
}

/// The largest stiffness jumps where a path gains a contact.
///
/// Gradient searches end on any of many steps (4.464, 4.349, 3.854 and 4.320 with these seeds).
/// `SQUAMA_CAMPAIGNS=endless` runs twelve seeds, `long` three of them.
#[test]
fn seeds_agree_on_an_objective_that_jumps() {
    let text = "name = 'stiff'\nmeasures = ['coverage', 'puncture', 'flexure']\n[variables]\n\
        gap_over_t = { from = 0.1, to = 1 }\nlength_over_t = { from = 0.05, to = 1 }\n\
        slant_deg = { from = 0, to = 75 }\n[goal]\nmaximize = 'max_stiffness'\n\
        require = ['coverage >= 0.5', 'compliance >= 0.25', 'penetration <= 0.2']\nseed = ";
    let seeds = match std::env::var("SQUAMA_CAMPAIGNS").as_deref() {
        Ok("endless") => (0..12).collect(),
        Ok("long") => vec![2, 5, 10],
        _ => vec![2],
    };
    for seed in seeds {
        let goal = DesignGoal::parse(&format!("{text}{seed}"), "x.toml", &[]).expect("a goal");
        let folder = tempfile::tempdir().expect("a folder");
        let found = found_in(folder.path(), &goal, 2, Start::New);
        let best = optimum(&found);
        // The best of twenty seeds reached 4.4879.
        assert!(objectives(best)[0] > 4.4879 * 0.999, "{seed}: {:?}", objectives(best));
        let agreement = best.agreement.expect("of one objective");
        assert!(agreement.agreeing >= 2 && agreement.searches > 3, "{seed}: {agreement:?}");
    }
}

#[test]
fn searches_that_agree_need_no_restart() {
    let found = found(&goal("minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'"));
    let agreement = optimum(&found).agreement.expect("of one objective");
    assert!(agreement.spread.expect("several searches") < 1e-8, "{agreement:?}");
    // Searches of the plan: 24 short ones, six gradient searches, three full ones.
    assert!(agreement.agreeing >= 2 && found.starts == 33, "{agreement:?}");
}

#[test]
fn all_choices_are_searched() {
    let text = COVERED
        .replace("length_over_t = 1\n", "")
        .replace("slant_deg = {", "length_over_t = [0.5, 1, 2]\nslant_deg = {");
    let text = text.replace("[designs]\n", "");
    let text = format!("{text}[goal]\nminimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'");
    let goal = DesignGoal::parse(&text, "x.toml", &[]).expect("a goal");
    let found = found(&goal);
    let best = optimum(&found);
    // Short scales are light: the mass is 0.5 over the pitch.
    assert_eq!(best.row.case.design.length, 0.5);
    let gap = best.row.case.design.gap;
    assert!((objectives(best)[0] - 0.5 / (0.5 + gap)).abs() < 1e-12);
}

#[test]
fn points_of_a_front_match_the_closed_form() {
    let text = "maximize = 'coverage'\nminimize = 'areal_mass_kg_m2'\npoints = 9";
    let goal = goal(text);
    let found = found(&goal);
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    // If a point has the design of another one, a further point replaces it.
    assert_eq!(front.designs.len(), 9, "{} {}", front.same, front.beaten);
    let pairs: Vec<[f64; 2]> =
        front.designs.iter().map(|best| [objectives(best)[0], objectives(best)[1]]).collect();
    assert!(
        pairs.windows(2).all(|pair| pair[0][0] > pair[1][0] && pair[0][1] > pair[1][1]),
        "{pairs:?}"
    );
    let best_coverage = 1.0 / 1.1;
    assert!((pairs[0][0] - best_coverage).abs() < 1e-6, "{pairs:?}");
    for [coverage, mass] in pairs {
        // For steep slants the coverage is (S − d)/S; for gentle slants at the kink it equals the
        // mass.
        let reach = 60_f64.to_radians().tan();
        let gap = (reach * (1.0 - coverage)).min(1.0);
        let least = (1.0 / (1.0 + gap)).max(coverage);
        assert!(mass >= least - 1e-9 && mass <= least * (1.0 + 1e-3), "{coverage} {mass} {least}");
    }
}

#[test]
fn ends_of_a_front_are_optimal_in_the_second_objective_too() {
    // Where d/p = 0.2 and the coverage is at a peak, both limits bind. The longest of these scales
    // have the widest gap. Different seeds once reached gaps of 0.10 to 0.17.
    let text = "name = 'x'\nmeasures = ['coverage', 'flexure']\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
                length_over_t = { from = 0.025, to = 1 }\nslant_deg = { from = 0, to = 75 }\n[goal]\n\
                maximize = ['coverage', 'gap_over_t']\nrequire = 'compliance >= 0.2'\nsamples = 64\npoints = 5";
    let found = found(&DesignGoal::parse(text, "x.toml", &[]).expect("a goal"));
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    let end = objectives(&front.designs[0]);
    assert!((end[0] - 0.8).abs() < 1e-5 && (end[1] - 0.25).abs() < 1e-5, "{end:?}");
}

#[test]
fn a_front_of_three_objectives_has_the_requested_number_of_points() {
    let text = "maximize = ['coverage', 'gap_over_t']\nminimize = 'slant_deg'\npoints = 24";
    let found = found(&goal(text));
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    assert_eq!(front.designs.len(), 24, "{} {}", front.same, front.beaten);
    for best in &front.designs {
        let [coverage, gap, slant] = *objectives(best) else { panic!("three") };
        // On the first coverage peak or before it, where the coverage is at most (S − d)/S.
        let reach = slant.to_radians().tan();
        let most = (1.0 - gap / reach).max(0.0).min(1.0 / (1.0 + gap));
        assert!((coverage - most).abs() < 1e-6, "{coverage} of {most} at {gap} {slant}");
    }
}

#[test]
fn infeasible_goals_report_the_nearest_design() {
    for seed in [0, 1] {
        let found = found(&goal(&format!(
            "maximize = 'gap_over_t'\nrequire = ['coverage >= 0.9', 'areal_mass_kg_m2 <= 0.8']\nseed = {seed}",
        )));
        let Answer::Infeasible(Some(nearest)) = found.answer else { panic!("no design") };
        let Judgement::Judged(worth) = &found.history[nearest].verdict else { panic!("judged") };
        // The coverage is at most the mass here, so both shortfalls are equal: 0.9 (1 − s) = 0.8 (1
        // + s).
        let shortfall = 0.1 / 1.7;
        assert!((worth.shortfall() - shortfall).abs() < 1e-9, "{}", worth.shortfall());
    }
}

/// Returns the best critical force in the paper's box under these requirements.
///
/// Checks that the search evaluates fewer than `most` designs.
fn strongest(required: &str, seed: usize, most: usize) -> f64 {
    let text = format!(
        "name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n[variables]\ngap_over_t = {{ from = 0.1, to = 1 }}\n\
         length_over_t = {{ from = 0.025, to = 1 }}\nslant_deg = {{ from = 0, to = 75 }}\n[goal]\n\
         maximize = 'critical_force'\nrequire = [{required}]\nsamples = 32\nseed = {seed}"
    );
    let found = found(&DesignGoal::parse(&text, "x.toml", &[]).expect("a goal"));
    assert!(found.evaluations < most, "{}", found.evaluations);
    objectives(optimum(&found))[0]
}

/// The search is fast although the feasible set is narrow.
///
/// Gradient searches must avoid the jump of the compliance without a requirement on coverage, and
/// full searches must start at feasible designs.
#[test]
fn least_penetration_is_found_as_fast_as_other_objectives() {
    let text = "name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n[variables]\n\
         gap_over_t = { from = 0.1, to = 1 }\nlength_over_t = { from = 0.025, to = 1 }\n\
         slant_deg = { from = 0, to = 75 }\n[goal]\nminimize = 'penetration'\n\
         require = ['critical_force >= 0.5', 'compliance >= 0.3']\n";
    let goal = DesignGoal::parse(text, "x.toml", &[]).expect("a goal");
    let found = found(&goal);
    assert!(found.evaluations < 1250, "{}", found.evaluations);
    assert!((objectives(optimum(&found))[0] - 0.026_397_047).abs() < 1e-8);
}

/// A full search counts by its evaluations, not like a short search.
#[test]
fn the_completed_fraction_follows_the_evaluations() {
    let (_, seen) = reference_search();
    let all = seen.last().expect("an end")[0];
    let inner = seen.iter().filter(|[designs, _]| (0.15..0.85).contains(&(designs / all)));
    let ratios: Vec<f64> = inner.map(|[designs, share]| designs / share / all).collect();
    assert!(ratios.len() > 20, "{}", ratios.len());
    let ends = ratios.iter().fold([f64::MAX, 0.0], |[low, high], r| [r.min(low), r.max(high)]);
    assert!(ends[0] > 0.5 && ends[1] < 2.0, "{ends:?}");
}

#[test]
fn a_design_that_is_feasible_on_coverage_peaks_only_is_found() {
    // The coverage is at most 1 − d/p and the compliance at most d/p, so both bind at peaks only. A
    // search of only a few strips reached 0.493.
    assert!(strongest("'coverage >= 0.7', 'compliance >= 0.3'", 0, 600) >= 1.538);
}

#[test]
fn the_best_of_all_coverage_strips_is_found() {
    // Near the seventh peak. A search of only a few strips reached 1.816, near the sixth.
    assert!(strongest("'coverage >= 0.65', 'compliance >= 0.3'", 0, 600) >= 1.982);
}

#[test]
fn limits_without_a_feasible_interior_are_searched() {
    // Coverage and compliance both bind, at one length on each peak. Half of the seeds once reached
    // 1.448 on the eighth peak, and missed the ninth.
    for seed in [2, 3] {
        let found = strongest("'coverage >= 0.6', 'compliance >= 0.4'", seed, 700);
        assert!(found >= 1.702, "{seed}: {found}");
    }
}

#[test]
fn requirements_that_no_design_can_meet_are_refused() {
    let refused = |required: &str| {
        let text = format!("{COVERED}[goal]\nmaximize = 'gap_over_t'\nrequire = [{required}]");
        let text = text.replace("'coverage'\n", "['coverage', 'flexure']\n");
        DesignGoal::parse(&text, "x.toml", &[])
            .map_or_else(|error| error.to_string(), |_| String::new())
    };
    insta::assert_snapshot!(refused("'coverage >= 0.95'"), @"x.toml:13: goal.require: coverage >= 0.95 is not accepted, expected at most 0.9090909090909091 between these ends of the variables: coverage is at most 1 - d/p, the fraction of the pitch that scales occupy");
    insta::assert_snapshot!(refused("'compliance >= 0.6'"), @"x.toml:13: goal.require: compliance >= 0.6 is not accepted, expected at most 0.5 between these ends of the variables: compliance is at most d/p, the fraction of the pitch that gaps occupy");
    insta::assert_snapshot!(refused("'coverage >= 0.7', 'initial_compliance >= 0.4'"), @"x.toml:13: goal.require: coverage >= 0.7 is not accepted, expected at most 0.6 beside initial_compliance >= 0.4: scales occupy 1 - d/p of the pitch, which bounds coverage, and gaps d/p, which bounds compliance");
    // Feasible up to round-off.
    assert_eq!(refused("'coverage >= 0.7', 'compliance >= 0.3'"), "");
    assert_eq!(refused("'coverage >= 0.9090909090909'"), "");
}

#[test]
fn points_of_a_front_over_decades_have_equal_ratios() {
    let text = COVERED
        .replace("thickness_mm = 1\n", "")
        .replace("[designs]", "thickness_mm = { from = 0.1, to = 10 }\n[designs]");
    let text = format!(
        "{text}[goal]\nminimize = 'areal_mass_kg_m2'\nmaximize = 'thickness_mm'\nsamples = 64\npoints = 9"
    );
    let found = found(&DesignGoal::parse(&text, "x.toml", &[]).expect("a goal"));
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    assert_eq!(front.designs.len(), 9);
    for pair in front.designs.windows(2) {
        let [one, other] = [&pair[0], &pair[1]].map(objectives);
        // The widest gap gives the least mass, ρ t/(1 + d). The ends differ by a factor of 100.
        assert!((other[0] / (0.5 * other[1]) - 1.0).abs() < 1e-6, "{other:?}");
        let ratio = (other[1] / one[1]).abs();
        assert!((1.3..2.5).contains(&ratio), "{one:?} {other:?}");
    }
    // Designs that only differ in thickness are solved once, with and without derivatives.
    let evaluated = found.history.len();
    assert!(found.evaluations * 3 < evaluated * 2, "{} of {evaluated}", found.evaluations);
}

#[test]
fn results_do_not_depend_on_threads_or_interruptions() {
    let goal = goal("maximize = 'coverage'\nminimize = 'areal_mass_kg_m2'\npoints = 4");
    let places = |found: &Found| {
        found.history.iter().map(|c| (c.stage.word(), c.point.clone())).collect::<Vec<_>>()
    };
    let folder = tempfile::tempdir().expect("a folder");
    let whole = found_in(folder.path(), &goal, 1, Start::New);
    let journal = folder.path().join(results::ResultsFolder::EVALUATIONS);
    let bytes = std::fs::read(&journal).expect("a journal");
    for share in [3, 2] {
        // Cut in the middle of a line.
        std::fs::write(&journal, &bytes[..bytes.len() / share]).expect("writable");
        let again = found_in(folder.path(), &goal, 3, Start::Resume);
        assert_eq!(places(&again), places(&whole));
        assert_eq!(again.evaluations, whole.evaluations);
    }
    assert!(refused(folder.path(), &goal, Start::New).contains("--resume"));
}

/// Returns the error of a search that does not start.
fn refused(folder: &Path, goal: &DesignGoal, start: Start) -> String {
    let (stop, progress) = (AtomicBool::new(false), SearchProgress::default());
    let options = SearchOptions { threads: 1, start, stop: &stop, progress: &progress };
    optimise(goal, folder, &options, &PROGRAM).expect_err("refused").to_string()
}

#[test]
fn damaged_journals_are_refused_and_kept() {
    let goal = goal("maximize = 'coverage'\nminimize = 'areal_mass_kg_m2'\npoints = 2");
    let folder = tempfile::tempdir().expect("a folder");
    found_in(folder.path(), &goal, 1, Start::New);
    let journal = folder.path().join(results::ResultsFolder::EVALUATIONS);
    let sound = std::fs::read_to_string(&journal).expect("a journal");
    let lines: Vec<&str> = sound.split_inclusive('\n').collect();
    // Neither a damaged header nor a damaged line discards the others, unless a fresh start is
    // requested.
    for (line, what) in [(0, ":1: not the first line"), (lines.len() / 2, ": damaged line")] {
        let mut damaged = lines.clone();
        let changed = lines[line].replacen('0', "1", 1);
        damaged[line] = &changed;
        let damaged = damaged.concat();
        assert_ne!(damaged, sound);
        std::fs::write(&journal, &damaged).expect("writable");
        for start in [Start::New, Start::Resume] {
            let message = refused(folder.path(), &goal, start);
            assert!(message.contains(what), "{message}");
            assert_eq!(std::fs::read_to_string(&journal).expect("text"), damaged);
        }
    }
    // The error for format 1 names the program that can read it.
    let old = Seal::default().seal(&serde_json::json!({
        "optimisation": 1, "program": "0.1.0 (abc)", "goal_sha256": "0"
    }));
    std::fs::write(&journal, &old).expect("writable");
    let message = refused(folder.path(), &goal, Start::Resume);
    assert!(
        message.contains("a journal of format 1") && message.contains("0.1.0 (abc)"),
        "{message}"
    );
}

#[test]
fn a_fresh_search_removes_the_tables_of_the_last_one() {
    let (old, new) = (goal("maximize = 'coverage'"), goal("minimize = 'areal_mass_kg_m2'"));
    let place = tempfile::tempdir().expect("a folder");
    let folder = results::ResultsFolder::new(place.path());
    let found = found_in(place.path(), &old, 1, Start::New);
    let figures = [("history.svg".to_owned(), "<svg/>".to_owned())];
    write_found(&folder, &old, &found, &figures, CsvFormat::Plain).expect("writable");
    assert!(folder.holds("optimum.csv") && folder.holds("history.svg"));
    // Another search starts afresh and is stopped before it finds anything.
    let (stop, progress) = (AtomicBool::new(true), SearchProgress::default());
    let options =
        SearchOptions { threads: 1, start: Start::Fresh, stop: &stop, progress: &progress };
    let ended = optimise(&new, place.path(), &options, &PROGRAM).expect("a search");
    assert!(ended.is_none());
    for file in ["optimum.csv", "optimum.toml", "goal.toml", "history.csv", "history.svg"] {
        assert!(!folder.holds(file), "{file}");
    }
}

#[cfg(unix)]
#[test]
fn links_in_place_of_the_journal_are_refused() {
    let goal = goal("maximize = 'coverage'\nminimize = 'areal_mass_kg_m2'\npoints = 2");
    let folder = tempfile::tempdir().expect("a folder");
    let journal = folder.path().join(results::ResultsFolder::EVALUATIONS);
    let target = folder.path().join("target");
    std::fs::write(&target, "a stranger's").expect("writable");
    std::os::unix::fs::symlink(&target, &journal).expect("a link");
    for start in [Start::New, Start::Resume, Start::Fresh] {
        let message = refused(folder.path(), &goal, start);
        assert!(message.contains("is not a regular file"), "{message}");
    }
    assert_eq!(std::fs::read_to_string(&target).expect("text"), "a stranger's");
    std::fs::remove_file(&journal).expect("a link");
    std::os::unix::fs::symlink("/dev/zero", &journal).expect("a link");
    assert!(refused(folder.path(), &goal, Start::Resume).contains("is not a regular file"));
}

#[test]
fn the_nearest_design_does_not_depend_on_the_seed() {
    let [one, other] = [0, 1].map(|seed| {
        let text = format!(
            "name = 'x'\nmeasures = ['coverage', 'puncture']\npuncture.scales = 15\n[variables]\ngap_over_t = {{ from = 0.1, to = 0.4 }}\n\
             length_over_t = {{ from = 0.1, to = 0.6 }}\nslant_deg = {{ from = 60, to = 75 }}\n[goal]\nmaximize = 'critical_force'\n\
             require = ['coverage >= 0.8', 'critical_force >= 10']\nsamples = 32\nseed = {seed}"
        );
        let found = found(&DesignGoal::parse(&text, "x.toml", &[]).expect("a goal"));
        let Answer::Infeasible(Some(nearest)) = found.answer else { panic!("no design") };
        let Judgement::Judged(worth) = &found.history[nearest].verdict else { panic!("judged") };
        worth.shortfall()
    });
    // Critical force, soundness and the end of an interval meet at this design. Derivative-free
    // steps reached it within 5e-11, and within 3 % with the long rows that designs of this size
    // need.
    assert!((one / other - 1.0).abs() < 1e-13, "{one} {other}");
}

/// A search finds a better design than all 720 designs of the reference study.
///
/// Runs in long campaigns only, because it solves two thousand designs.
#[test]
fn a_search_beats_the_reference_grid() {
    if std::env::var_os("SQUAMA_CAMPAIGNS").is_none_or(|campaigns| campaigns != "long") {
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let goal = DesignGoal::read(&root.join("sweeps/goals/strong-and-covered.toml"), &[]);
    let folder = tempfile::tempdir().expect("a folder");
    let found = found_in(folder.path(), &goal.expect("a goal"), 2, Start::New);
    let found = objectives(optimum(&found))[0];
    let grid = Results::read(&root.join("results/reference/paper")).expect("the reference study");
    let value = |row: usize, name: &str| {
        grid.number(row, grid.column(name).expect("a column")).expect("a number")
    };
    let forces = (0..grid.len())
        .filter(|row| {
            let is_sound = value(*row, "gap_stretch_min").is_none_or(|least| least > 0.0);
            is_sound
                && value(*row, "coverage").is_some_and(|value| value >= 0.5)
                && value(*row, "compliance").is_some_and(|value| value >= 0.2)
        })
        .filter_map(|row| value(row, "critical_force"));
    let best = forces.fold(0.0, f64::max);
    assert!(best > 0.5 && found > 3.0 * best, "{found} between the points, {best} on them");
}

/// Up to a critical tilt of 10°, a search compares designs by the two corners of the top. Just
/// above this limit it solves all load positions.
#[test]
fn corners_and_all_load_positions_lead_to_the_same_optimum() {
    let searches = [10.0, 10.000_001].map(|tilt| {
        let text = format!(
            "name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n[variables]\n\
             gap_over_t = {{ from = 0.1, to = 1 }}\nlength_over_t = {{ from = 0.1, to = 1.5 }}\n\
             slant_deg = {{ from = 0, to = 50 }}\n[puncture]\ncritical_tilt_deg = {tilt}\n\
             places = 5\n[goal]\nmaximize = 'weakest_force'\nsamples = 64\n\
             require = ['coverage >= 0.6', 'compliance >= 0.3']"
        );
        found(&DesignGoal::parse(&text, "x.toml", &[]).expect("a goal"))
    });
    let [by_corners, by_all] = searches.each_ref().map(|found| objectives(optimum(found))[0]);
    assert!((by_corners - by_all).abs() < 1e-5 * by_all, "{by_corners} {by_all}");
}
