//! Tests of searches: optima in closed form, fronts, interruptions and damaged journals.

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

/// Text of a goal without its section `[goal]`. The variables are gap and slant, and only the
/// coverage is measured.
const COVERED: &str = "name = 'covered'\nmeasures = 'coverage'\n[variables]\n\
    gap_over_t = { from = 0.1, to = 1 }\nslant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\n\
    [material]\nthickness_mm = 1\nscale_density_kg_m3 = 1000\n";

/// Runs the search for `goal` with its journal in `folder`.
pub(crate) fn found_in(folder: &Path, goal: &DesignGoal, threads: usize, start: Start) -> Found {
    let (stop, progress) = (AtomicBool::new(false), SearchProgress::default());
    let options = SearchOptions { threads, start, stop: &stop, progress: &progress };
    optimise(goal, folder, &options, &PROGRAM).expect("a search").expect("no stop request")
}

/// Returns the goal `COVERED` with further lines of its section `[goal]`.
pub(crate) fn goal(text: &str) -> DesignGoal {
    DesignGoal::parse(&format!("{COVERED}[goal]\nsamples = 64\n{text}"), "x.toml", &[])
        .expect("a goal")
}

/// Tests that a level of a standard becomes a requirement, and that the goal records the standard.
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

/// Tests a search that ends at a design with as many binding limits as variables.
///
/// Derivatives prove that this design is optimal, so ridge search and derivative-free search are
/// omitted. The reported design has the values of all columns, which the search does not compute.
#[test]
fn search_does_not_continue_at_an_optimum_that_derivatives_prove() {
    let (found, _) = reference_search();
    let best = optimum(found);
    assert!((objectives(best)[0] - 2.141_936_6).abs() < 2e-6, "{:?}", objectives(best));
    // One of the three full searches starts away from the optimum, and reaches it by a ridge search.
    // With the designs just beyond first contact, this takes 8 evaluations. Without the proof by
    // derivatives, each full search would need about 45 evaluations of ridge search and polish.
    let stages = found.history.iter().map(|candidate| candidate.stage);
    let confirming =
        stages.filter(|s| matches!(s, SearchStage::Ridge | SearchStage::Polish)).count();
    assert!(confirming < 20, "{confirming}");
    let searched = found.history.iter().filter_map(|c| c.result.puncture);
    assert!(searched.into_iter().all(|p| p.measures.max_stiffness.is_none()));
    assert!(best.row.result.puncture.is_some_and(|p| p.measures.max_stiffness.is_some()));
}

/// Runs the reference search once for all tests, and returns its result and its progress.
///
/// The progress is a list of pairs: number of evaluated designs, and completed fraction.
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
                seen.push([progress.designs() as f64, progress.completed_fraction()]);
                std::thread::sleep(std::time::Duration::from_millis(2));
            }
            let found = search.join().expect("a search without panic").expect("a search");
            let found = found.expect("no stop request");
            seen.push([progress.designs() as f64, progress.completed_fraction()]);
            (found, seen)
        })
    })
}

/// Runs the search for `goal` on one thread in a temporary folder.
fn found(goal: &DesignGoal) -> Found {
    let folder = tempfile::tempdir().expect("a folder");
    found_in(folder.path(), goal, 1, Start::New)
}

/// Returns the best design of a search with one objective.
pub(crate) fn optimum(found: &Found) -> &BestDesign {
    let Answer::Optimum(best) = &found.answer else { panic!("an optimum") };
    best
}

/// Returns the values of the objectives of a best design.
pub(crate) fn objectives(best: &BestDesign) -> &[f64] {
    let Judgement::Judged(worth) = &best.candidate.verdict else { panic!("a valid judgement") };
    &worth.objectives
}

#[test]
fn binding_limits_have_the_exact_multipliers() {
    let goal = goal("minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'");
    let found = found(&goal);
    let best = optimum(&found);
    // The mass is 1/(1 + d), so the gap is as wide as the coverage λ = (S − d)/S = 0.5 allows.
    let reach = 60_f64.to_radians().tan();
    let gap = 0.5 * reach;
    assert!((objectives(best)[0] - 1.0 / (1.0 + gap)).abs() < 1e-9, "{:?}", objectives(best));
    // The multiplier of the coverage is dm/dλ = S/(1 + d)². For each degree of slant the gap could
    // be wider by (1 − λ) dS/dα.
    let price = reach / (1.0 + gap).powi(2);
    let rate = (1.0 + reach * reach) * 1_f64.to_radians();
    for (limit, price) in
        [(Limit::Requirement(0), price), (Limit::Upper(1), 0.5 * rate / (1.0 + gap).powi(2))]
    {
        let binding = best.bindings.iter().find(|binding| binding.limit == limit);
        let found = binding.and_then(|binding| binding.price).expect("a price");
        assert!((found - price).abs() < 1e-6, "{limit:?}: {found}");
    }
    // A change of the limit by 1 % changes the mass by 1 % · dm/dλ · λ/m = 0.464 %.
    let reason = "coverage and slant_deg at its upper end 60 limit this design: \
                  with 1 % less required coverage, areal_mass_kg_m2 falls by 0.46 %.";
    assert_eq!(best.reason.as_deref(), Some(reason));
}

/// Tests rounding to multiples of 0.1 if the largest feasible gap is 0.866.
///
/// Rounding to the nearest multiple, 0.9, would miss the required coverage.
#[test]
fn rounded_design_meets_the_requirements() {
    let text = "minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'\nround = 0.1";
    let found = found(&goal(text));
    let best = optimum(&found);
    let design = best.row.case.design;
    assert_eq!((design.gap, design.slant_deg), (0.8, 60.0));
    let Some(Rounding { step, unit, exact, rounded: Some(rounded) }) = found.rounding else {
        panic!("a rounded design")
    };
    assert_eq!((step, unit), (0.1, "mm"));
    assert!((exact - 1.0 / (1.0 + 0.5 * 60_f64.to_radians().tan())).abs() < 1e-9);
    assert!((rounded - 1.0 / 1.8).abs() < 1e-12, "{rounded}");
}

#[test]
fn exact_design_is_kept_if_no_rounded_design_is_feasible() {
    // Feasible gaps are between 0.852 and 0.866.
    let text = "maximize = 'gap_over_t'\nrequire = ['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.54']\nround = 0.1";
    let found = found(&goal(text));
    assert_eq!(found.rounding.as_ref().expect("a rounding").rounded, None);
    let gap = optimum(&found).row.case.design.gap;
    assert!((gap - 0.5 * 60_f64.to_radians().tan()).abs() < 1e-9, "{gap}");
}

#[test]
fn optimum_on_a_kink_has_no_multipliers() {
    let text = "maximize = 'coverage'\nrequire = 'gap_over_t >= 0.3'";
    let found = found(&goal(text));
    let best = optimum(&found);
    // The optimum is on the coverage peak at S = p, where λ = 1/(1 + d). The coverage falls on both
    // sides of the peak.
    assert!((objectives(best)[0] - 1.0 / 1.3).abs() < 1e-6, "{:?}", objectives(best));
    assert!(best.bindings.iter().all(|binding| binding.price.is_none()));
    assert!(found.history.iter().any(|candidate| candidate.stage == SearchStage::Ridge));
}

#[test]
fn search_follows_a_ridge_to_its_end() {
    // The ridge is the coverage peak at S = p. Along the ridge longer scales cover more, until the
    // surface folds or the interval of the length ends.
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
        let puncture = best.row.result.puncture.expect("a solved path").measures;
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

/// Tests the largest stiffness of a path, which jumps if a contact appears on the path.
///
/// The largest stiffness is a step function of the variables, and gradient searches end on any of
/// many steps (e.g. at 4.464, 4.349, 3.854 and 4.320). The test runs one seed. It runs three seeds
/// with `SQUAMA_CAMPAIGNS=long`, and twelve seeds with `SQUAMA_CAMPAIGNS=endless`.
#[test]
fn searches_with_different_seeds_agree_on_an_objective_that_jumps() {
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
        // The best result of searches with twenty seeds is 4.4879.
        assert!(objectives(best)[0] > 4.4879 * 0.999, "{seed}: {:?}", objectives(best));
        let agreement = best.agreement.expect("an agreement");
        assert!(agreement.agreeing >= 2 && agreement.searches > 3, "{seed}: {agreement:?}");
    }
}

#[test]
fn local_searches_that_agree_cause_no_restart() {
    let found = found(&goal("minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'"));
    let agreement = optimum(&found).agreement.expect("an agreement");
    assert!(agreement.spread.expect("the spread of several searches") < 1e-8, "{agreement:?}");
    // Without restarts there are 33 local searches: 24 short searches, 6 gradient searches and 3
    // full searches.
    assert!(agreement.agreeing >= 2 && found.starts == 33, "{agreement:?}");
}

#[test]
fn search_evaluates_all_values_of_a_discrete_variable() {
    let text = COVERED
        .replace("length_over_t = 1\n", "")
        .replace("slant_deg = {", "length_over_t = [0.5, 1, 2]\nslant_deg = {");
    let text = text.replace("[designs]\n", "");
    let text = format!("{text}[goal]\nminimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'");
    let goal = DesignGoal::parse(&text, "x.toml", &[]).expect("a goal");
    let found = found(&goal);
    let best = optimum(&found);
    // The shortest scales are lightest: their mass is 0.5 divided by the pitch.
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
    // If two points have the same design, one of them is replaced by another point.
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
        // At the largest slant the coverage is (S − d)/S. Designs with larger coverage are on the
        // coverage peak, where coverage and mass are equal.
        let reach = 60_f64.to_radians().tan();
        let gap = (reach * (1.0 - coverage)).min(1.0);
        let least = (1.0 / (1.0 + gap)).max(coverage);
        assert!(mass >= least - 1e-9 && mass <= least * (1.0 + 1e-3), "{coverage} {mass} {least}");
    }
}

#[test]
fn ends_of_a_front_are_optimal_in_the_second_objective_too() {
    // The largest coverage is 0.8. All designs with d/p = 0.2 on a coverage peak have this
    // coverage. Among these designs, the design with the longest scales has the widest gap, 0.25.
    let text = "name = 'x'\nmeasures = ['coverage', 'flexure']\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
                length_over_t = { from = 0.025, to = 1 }\nslant_deg = { from = 0, to = 75 }\n[goal]\n\
                maximize = ['coverage', 'gap_over_t']\nrequire = 'compliance >= 0.2'\nsamples = 64\npoints = 5";
    let found = found(&DesignGoal::parse(text, "x.toml", &[]).expect("a goal"));
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    let end = objectives(&front.designs[0]);
    assert!((end[0] - 0.8).abs() < 1e-5 && (end[1] - 0.25).abs() < 1e-5, "{end:?}");
}

#[test]
fn front_of_three_objectives_has_the_requested_number_of_points() {
    let text = "maximize = ['coverage', 'gap_over_t']\nminimize = 'slant_deg'\npoints = 24";
    let found = found(&goal(text));
    let Answer::Front(front) = &found.answer else { panic!("a front") };
    assert_eq!(front.designs.len(), 24, "{} {}", front.same, front.beaten);
    for best in &front.designs {
        let [coverage, gap, slant] = *objectives(best) else { panic!("three objectives") };
        // The designs are on the first coverage peak or at smaller slants. Their coverage is (S −
        // d)/S, at most 1/(1 + d).
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
        let Answer::Infeasible(Some(nearest)) = found.answer else { panic!("an infeasible goal") };
        let Judgement::Judged(worth) = &found.history[nearest].verdict else {
            panic!("a valid judgement")
        };
        // The coverage cannot exceed the mass. At the nearest design both are equal, and so are
        // both shortfalls s: 0.9 (1 − s) = 0.8 (1 + s).
        let shortfall = 0.1 / 1.7;
        assert!((worth.shortfall() - shortfall).abs() < 1e-9, "{}", worth.shortfall());
    }
}

/// Returns the largest critical force that a search finds under the requirements `required`.
///
/// The variables have the ranges of the paper. Asserts that the search needs fewer than `most`
/// evaluations.
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

/// Tests the number of evaluations of a search with a narrow feasible set.
///
/// The search needs few evaluations only if full searches start at feasible designs, and if
/// gradient searches avoid the jump of the compliance although the goal requires no coverage.
#[test]
fn search_in_a_narrow_feasible_set_needs_few_evaluations() {
    let text = "name = 'x'\nmeasures = ['coverage', 'puncture', 'flexure']\n[variables]\n\
         gap_over_t = { from = 0.1, to = 1 }\nlength_over_t = { from = 0.025, to = 1 }\n\
         slant_deg = { from = 0, to = 75 }\n[goal]\nminimize = 'penetration'\n\
         require = ['critical_force >= 0.5', 'compliance >= 0.3']\n";
    let goal = DesignGoal::parse(text, "x.toml", &[]).expect("a goal");
    let found = found(&goal);
    assert!(found.evaluations < 1250, "{}", found.evaluations);
    assert!((objectives(optimum(&found))[0] - 0.026_397_047).abs() < 1e-8);
}

/// Tests that the completed fraction grows with evaluations, not with the number of local searches.
#[test]
fn completed_fraction_is_proportional_to_evaluations() {
    let (_, seen) = reference_search();
    let all = seen.last().expect("a last entry")[0];
    let inner = seen.iter().filter(|[designs, _]| (0.15..0.85).contains(&(designs / all)));
    let ratios: Vec<f64> = inner.map(|[designs, share]| designs / share / all).collect();
    assert!(ratios.len() > 20, "{}", ratios.len());
    let ends = ratios.iter().fold([f64::MAX, 0.0], |[low, high], r| [r.min(low), r.max(high)]);
    assert!(ends[0] > 0.5 && ends[1] < 2.0, "{ends:?}");
}

#[test]
fn search_finds_a_design_that_is_feasible_only_on_coverage_peaks() {
    // The coverage is at most 1 − d/p and the compliance at most d/p. The sum of both limits is 1,
    // so only designs on coverage peaks are feasible. A search near only a few peaks finds 0.493.
    assert!(strongest("'coverage >= 0.7', 'compliance >= 0.3'", 0, 600) >= 1.538);
}

#[test]
fn search_finds_the_best_of_all_coverage_peaks() {
    // The optimum is near the seventh coverage peak. The best design near the sixth peak has 1.816.
    assert!(strongest("'coverage >= 0.65', 'compliance >= 0.3'", 0, 600) >= 1.982);
}

#[test]
fn search_finds_the_optimum_of_limits_without_a_feasible_interior() {
    // Coverage and compliance both bind, so one length on each coverage peak is feasible. The
    // optimum is on the ninth peak. The best design on the eighth peak has 1.448.
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
    insta::assert_snapshot!(refused("'coverage >= 0.95'"), @"x.toml:13: goal.require: coverage >= 0.95 is not accepted, expected at most 0.9090909090909091 within the ranges of the variables: coverage is at most 1 - d/p, the fraction of the pitch that scales occupy");
    insta::assert_snapshot!(refused("'compliance >= 0.6'"), @"x.toml:13: goal.require: compliance >= 0.6 is not accepted, expected at most 0.5 within the ranges of the variables: compliance is at most d/p, the fraction of the pitch that gaps occupy");
    insta::assert_snapshot!(refused("'coverage >= 0.7', 'initial_compliance >= 0.4'"), @"x.toml:13: goal.require: coverage >= 0.7 is not accepted, expected at most 0.6 together with initial_compliance >= 0.4: coverage is at most 1 - d/p and compliance at most d/p, the fractions of the pitch that scales and gaps occupy");
    // These limits equal the bounds up to round-off, so they are accepted.
    assert_eq!(refused("'coverage >= 0.7', 'compliance >= 0.3'"), "");
    assert_eq!(refused("'coverage >= 0.9090909090909'"), "");
}

#[test]
fn points_of_a_front_over_two_decades_have_similar_ratios() {
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
        // The smallest mass is ρ t/(1 + d) at the widest gap, d = 1. The ends of the front differ
        // by a factor of 100.
        assert!((other[0] / (0.5 * other[1]) - 1.0).abs() < 1e-6, "{other:?}");
        let ratio = (other[1] / one[1]).abs();
        assert!((1.3..2.5).contains(&ratio), "{one:?} {other:?}");
    }
    // Designs that differ only in thickness share one solution.
    let evaluated = found.history.len();
    assert!(found.evaluations * 3 < evaluated * 2, "{} of {evaluated}", found.evaluations);
}

#[test]
fn results_do_not_depend_on_threads_or_interruptions() {
    let goal = goal("maximize = 'coverage'\nminimize = 'areal_mass_kg_m2'\npoints = 4");
    let stages_and_points = |found: &Found| {
        found.history.iter().map(|c| (c.stage.word(), c.point.clone())).collect::<Vec<_>>()
    };
    let folder = tempfile::tempdir().expect("a folder");
    let whole = found_in(folder.path(), &goal, 1, Start::New);
    let journal = folder.path().join(results::ResultsFolder::EVALUATIONS);
    let bytes = std::fs::read(&journal).expect("a journal");
    for share in [3, 2] {
        // Simulate an interruption: cut the journal in the middle of a line.
        std::fs::write(&journal, &bytes[..bytes.len() / share]).expect("writable");
        let again = found_in(folder.path(), &goal, 3, Start::Resume);
        assert_eq!(stages_and_points(&again), stages_and_points(&whole));
        assert_eq!(again.evaluations, whole.evaluations);
    }
    assert!(refused(folder.path(), &goal, Start::New).contains("--resume"));
}

/// Returns the error message of a search that is refused.
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
    // A damaged header or line is an error, and the journal is not changed.
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
            assert_eq!(std::fs::read_to_string(&journal).expect("readable text"), damaged);
        }
    }
    // The error for a journal of format 1 names the program that wrote the journal.
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
fn fresh_search_removes_the_tables_of_the_previous_search() {
    let (old, new) = (goal("maximize = 'coverage'"), goal("minimize = 'areal_mass_kg_m2'"));
    let place = tempfile::tempdir().expect("a folder");
    let folder = results::ResultsFolder::new(place.path());
    let found = found_in(place.path(), &old, 1, Start::New);
    let figures = [("history.svg".to_owned(), "<svg/>".to_owned())];
    write_found(&folder, &old, &found, &figures, CsvFormat::Plain).expect("writable");
    assert!(folder.holds("optimum.csv") && folder.holds("history.svg"));
    // Another search with `Start::Fresh` is stopped before it evaluates a design.
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
fn symbolic_links_in_place_of_the_journal_are_refused() {
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
    assert_eq!(std::fs::read_to_string(&target).expect("readable text"), "a stranger's");
    std::fs::remove_file(&journal).expect("a link");
    std::os::unix::fs::symlink("/dev/zero", &journal).expect("a link");
    assert!(refused(folder.path(), &goal, Start::Resume).contains("is not a regular file"));
}

#[test]
fn nearest_design_does_not_depend_on_the_seed() {
    let [one, other] = [0, 1].map(|seed| {
        let text = format!(
            "name = 'x'\nmeasures = ['coverage', 'puncture']\npuncture.scales = 15\n[variables]\ngap_over_t = {{ from = 0.1, to = 0.4 }}\n\
             length_over_t = {{ from = 0.1, to = 0.6 }}\nslant_deg = {{ from = 60, to = 75 }}\n[goal]\nmaximize = 'critical_force'\n\
             require = ['coverage >= 0.8', 'critical_force >= 10']\nsamples = 32\nseed = {seed}"
        );
        let found = found(&DesignGoal::parse(&text, "x.toml", &[]).expect("a goal"));
        let Answer::Infeasible(Some(nearest)) = found.answer else { panic!("an infeasible goal") };
        let Judgement::Judged(worth) = &found.history[nearest].verdict else {
            panic!("a valid judgement")
        };
        worth.shortfall()
    });
    // At the nearest design the limits of the critical force, of the unfolded surface and of an
    // interval bind. A derivative-free search alone determines the shortfall only to 5e-11.
    assert!((one / other - 1.0).abs() < 1e-13, "{one} {other}");
}

/// Tests that a search finds a better design than all 720 designs of the reference study.
///
/// The test runs only in long campaigns (`SQUAMA_CAMPAIGNS=long`), because it solves two thousand
/// designs.
#[test]
fn search_beats_the_reference_grid() {
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
    assert!(best > 0.5 && found > 3.0 * best, "optimum {found}, best design of the grid {best}");
}

/// Tests a critical tilt of 10°, and a critical tilt just above 10°.
///
/// Up to 10° a search compares designs by the two corners of the top. Above 10° the search solves
/// all load positions.
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
