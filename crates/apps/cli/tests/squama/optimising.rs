//! `squama optimise`: output, tables, checks of the best design, and invalid goals.

use crate::Place;

/// A goal on coverage and mass, which are quick to compute.
const GOAL: &str = "name = 'light'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
    slant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\n[material]\nthickness_mm = 1\n\
    scale_density_kg_m3 = 1000\n[goal]\nminimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'\nsamples = 64\n";

#[test]
fn the_optimum_is_a_valid_definition() {
    let place = Place::with(GOAL);
    let text = place.prints("optimise x.toml --threads 1");
    let (_, answer) = text.split_once("\n\n").expect("an answer");
    insta::assert_snapshot!(answer, @"
    The best design
      gap_over_t        0.866025
      slant_deg         60
      areal_mass_kg_m2  0.53590
      coverage          0.50000   >= 0.5, at the limit

    ⚠ The scales overhang by 60° from the vertical: above 45° a filament printer needs supports.
    ⚠ The membrane is only 0.125 mm thick, less than a nozzle of 0.4 mm.

    The search found no better design from 33 starts in 3 regions of the space; 4 of 6 local searches agree within 0.1 %. It is limited by
      coverage >= 0.5                0.01 more coverage adds 0.00497 kg/m^2 of areal_mass_kg_m2
      slant_deg at its upper end 60  1 more slant_deg would gain 0.01 kg/m^2 of areal_mass_kg_m2

    coverage and slant_deg at its upper end 60 limit this design: with 1 % less required coverage, areal_mass_kg_m2 falls by 0.46 %.

    results/light: goal.toml history.csv optimum.csv optimum.toml history.svg optimum.svg
    ");
    let design = place.prints("design results/light/optimum.toml --design 1");
    assert!(design.contains("0.866025"), "{design}");
    // The stored copy of the goal defines the same search.
    place.squama("optimise results/light/goal.toml --out again").assert().code(0);
    for file in ["optimum.csv", "history.csv"] {
        assert_eq!(
            place.read(&format!("again/{file}")),
            place.read(&format!("results/light/{file}"))
        );
    }
}

#[test]
fn a_run_notes_that_it_does_not_vary_variables() {
    let (definition, _) = GOAL.split_once("[goal]").expect("a goal");
    let assert = Place::with(definition).squama("run x.toml --quiet").assert().code(0);
    let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(
        message
            .contains("[variables] gap_over_t, slant_deg: a run uses the middle of their ranges"),
        "{message}"
    );
}

#[test]
fn tables_do_not_depend_on_threads_or_interruptions() {
    let place =
        Place::with(&GOAL.replace("'coverage >= 0.5'", "[]\nmaximize = 'coverage'\npoints = 5"));
    place.squama("optimise x.toml --threads 1 --out one").assert().code(0);
    place.squama("optimise x.toml --threads 3 --out three").assert().code(0);
    let journal = place.read("three/evaluations.jsonl");
    std::fs::write(place.path("three/evaluations.jsonl"), &journal[..journal.len() / 2])
        .expect("writable");
    assert!(place.refused("optimise x.toml --out three").contains("--resume to continue"));
    place.squama("optimise x.toml --threads 2 --out three --resume").assert().code(0);
    for file in ["front.csv", "history.csv", "goal.toml", "front.svg", "history.svg"] {
        assert_eq!(
            place.read(&format!("one/{file}")),
            place.read(&format!("three/{file}")),
            "{file}"
        );
    }
    let different = place.refused("optimise x.toml --set goal.seed=1 --out three --resume");
    assert!(different.contains("has another definition: goal.seed is "), "{different}");
}

#[test]
fn the_status_of_a_search_counts_its_designs() {
    let place = Place::with(GOAL);
    place.squama("optimise x.toml --out done -q").assert().code(0);
    let text = place.prints("status done");
    assert!(text.starts_with("light: search, done\n"), "{text}");
    let journal = place.read("done/evaluations.jsonl");
    std::fs::create_dir(place.path("cut")).expect("a folder");
    let cut: String = journal.split_inclusive('\n').take(11).collect();
    std::fs::write(place.path("cut/evaluations.jsonl"), cut).expect("writable");
    let assert = place.squama("status cut").assert().code(1);
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    assert!(text.starts_with("light: search, not finished; squama optimise --resume"), "{text}");
    assert!(text.contains("solved") && text.contains("10 designs"), "{text}");
    let assert = place.squama("status cut --json").assert().code(1);
    let json: serde_json::Value =
        serde_json::from_slice(&assert.get_output().stdout).expect("JSON");
    assert_eq!((&json["designs"], &json["is_complete"]), (&10.into(), &false.into()));
    // `status` lists a changed table as a problem.
    std::fs::write(place.path("done/history.csv"), "design\n").expect("writable");
    let assert = place.squama("status done").assert().code(1);
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    assert!(text.contains("problems\n") && text.contains("history.csv"), "{text}");
}

#[test]
fn json_output_contains_the_optimum() {
    let place = Place::with(GOAL);
    let text = place.prints("optimise x.toml --json");
    let record: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let best = &record["optimum"];
    assert_eq!(best["variables"]["slant_deg"], 60.0);
    assert_eq!(best["binding"][0]["limit"], "coverage >= 0.5");
    assert!(best["reason"].as_str().is_some_and(|reason| reason.contains("falls by 0.46 %")));
    let infeasible = "optimise x.toml --json --out y --set goal.require=['coverage>=0.9','areal_mass_kg_m2<=0.8']";
    let output = place.squama(infeasible).assert().code(1).get_output().stdout.clone();
    let record: serde_json::Value = serde_json::from_slice(&output).expect("JSON");
    assert_eq!(record["infeasible"]["requirements"][0]["met"], 0);
    let command = "optimise x.toml --json --out w --set measures=puncture --set puncture.scales=5 --set goal.samples=16 \
        --set goal.maximize=['critical_force'] --set goal.minimize=[] --set goal.require=['gap_over_t>=0.5','critical_force>=0.5']";
    let output = place.squama(command).assert().code(1).get_output().stdout.clone();
    let record: serde_json::Value = serde_json::from_slice(&output).expect("JSON");
    let infeasible = &record["infeasible"];
    // The values listed with the requirements belong to the nearest design.
    assert_eq!(infeasible["requirements"][0]["nearest"], infeasible["nearest"]["gap_over_t"]);
    // `nearest.toml` is a valid definition of the nearest design.
    place.squama("run y/nearest.toml -q --out z").assert().code(0);
}

/// The drawing shows the row at rest (a), and under its load (b) if the goal measures punctures.
#[test]
fn the_best_design_is_drawn() {
    let place = Place::with(GOAL);
    place.squama("optimise x.toml --quiet").assert().code(0);
    let drawing = place.read("results/light/optimum.svg");
    assert!(drawing.contains("light: the best design") && drawing.contains("(a)"), "{drawing}");
    assert!(!drawing.contains("(b)"));
    let goal = "name = 'firm'\nmeasures = 'puncture'\n[variables]\nlength_over_t = { from = 0.3, to = 1 }\n\
        [designs]\ngap_over_t = 0.3\nslant_deg = 60\n[goal]\nminimize = 'length_over_t'\nsamples = 2\n";
    let place = Place::with(goal);
    place.squama("optimise x.toml --quiet").assert().code(0);
    assert!(place.read("results/firm/optimum.svg").contains("(b)"));
    // `squama draw` draws the same panels.
    let file = place.prints("draw results/firm --design 1");
    let drawn = std::fs::read_to_string(place.path(file.trim())).expect("a drawing");
    let (_, panels) = drawn.split_once("(a)").expect("a panel");
    let panels = panels.trim_end().trim_end_matches("<!-- squama -->").trim_end();
    assert!(place.read("results/firm/optimum.svg").contains(panels));
}

#[test]
fn a_rounded_design_states_its_loss() {
    let place = Place::with(GOAL);
    let text = place.prints("optimise x.toml --round 0.1");
    let sentence = "Lengths are multiples of 0.1 mm, angles whole degrees: areal_mass_kg_m2 is 3.7 % \
                    worse than before rounding (0.53590).";
    assert!(text.contains(sentence), "{text}");
    assert!(text.contains("Before rounding, it is limited by"), "{text}");
    assert!(place.read("results/light/optimum.toml").contains("gap_over_t = [0.8]\n"));
    // The stored goal contains the rounding, too.
    let record = place.prints("optimise results/light/goal.toml --out again --json");
    let record: serde_json::Value = serde_json::from_str(&record).expect("JSON");
    assert_eq!(record["optimum"]["variables"]["gap_over_t"], 0.8);
    assert_eq!(record["optimum"]["rounding"]["step"], 0.1);
    // No multiple of 0.1 meets both the coverage and this mass.
    let goal = GOAL.replace("'coverage >= 0.5'", "['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.54']");
    let output = Place::with(&goal).squama("optimise x.toml --round 0.1").assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains("this design is not rounded"), "{text}");
}

#[test]
fn bad_goals_are_reported_on_one_line() {
    let messages = [
        (
            "[variables]\ngap_over_t = { from = 0.1, to = 1 }\nslant_deg = { from = 0, to = 60 }",
            "[variables]",
        ),
        ("{ from = 0.1, to = 1 }", "{ from = 1, to = 0.1 }"),
        ("{ from = 0.1, to = 1 }", "{ from = 0.1, to = 1, step = 0.1 }"),
        ("{ from = 0.1, to = 1 }", "{ from = -0.1, to = 1 }"),
        ("{ from = 0.1, to = 1 }", "0.3"),
        ("gap_over_t =", "gap ="),
        (
            "[designs]",
            "max_step = { from = 0.1, to = 1 }
[designs]",
        ),
        ("[designs]\n", "[designs]\nslant_deg = 30\n"),
        ("length_over_t = 1\n", ""),
        ("length_over_t = 1\n", "length_over_t = [0.5, 1]\n"),
        ("minimize = 'areal_mass_kg_m2'\n", ""),
        ("'areal_mass_kg_m2'", "'areal_mas_kg_m2'"),
        ("'areal_mass_kg_m2'", "'critical_force'"),
        ("'coverage >= 0.5'", "'coverage = 0.5'"),
        ("'coverage >= 0.5'", "'coverage == 0.5'"),
        ("'coverage >= 0.5'", "['coverage >= 0.5', 'coverage <= 0.4']"),
        ("'coverage >= 0.5'", "'gap_over_t >= 2'"),
        ("samples = 64", "samples = 1"),
        ("samples = 64", "sample = 64"),
        ("samples = 64", "sound = 'no'"),
        ("samples = 64", "round = 0"),
        ("samples = 64", "round = 2"),
        ("samples = 64", "round = 0.1\nmaximize = 'coverage'"),
        ("samples = 64", "weights = { coverage = 1 }"),
        ("minimize = 'areal_mass_kg_m2'", "maximize = 'fitness'\nweights = { critical_force = 1 }"),
        ("minimize = 'areal_mass_kg_m2'", "maximize = 'fitness'\nweights = { coverage = 0 }"),
        ("minimize = 'areal_mass_kg_m2'", "maximize = 'fitness'\nweights = { gap_over_t = 1 }"),
        (
            "minimize = 'areal_mass_kg_m2'",
            "maximize = 'fitness'\nweights = { coverage = 1 }\nrescale = { coverage = [1, 0] }",
        ),
        (
            "minimize = 'areal_mass_kg_m2'",
            "maximize = 'fitness'\nweights = { coverage = 1 }\nrescale = { penetration = [1, 0.5] }",
        ),
    ];
    let messages = messages.map(|(from, to)| Place::refused_goal(GOAL, from, to));
    insta::assert_snapshot!(messages.concat());
}

#[test]
fn the_fitness_reports_its_criteria_and_their_bounds() {
    let goal = GOAL.replace(
        "minimize = 'areal_mass_kg_m2'\nrequire = 'coverage >= 0.5'",
        "maximize = 'fitness'\nweights = { coverage = 1, areal_mass_kg_m2 = 3 }",
    );
    let place = Place::with(&goal);
    let text = place.prints("optimise x.toml --threads 1 --quiet");
    let (_, answer) = text.split_once("\n\n").expect("an answer");
    insta::assert_snapshot!(answer, @"
    The best design
      gap_over_t        1
      slant_deg         60
      fitness           0.83133
      coverage          0.42265
      areal_mass_kg_m2  0.50000

    ⚠ The scales overhang by 60° from the vertical: above 45° a filament printer needs supports.
    ⚠ The membrane is only 0.125 mm thick, less than a nozzle of 0.4 mm.

    The search found no better design from 33 starts in 3 regions of the space; 3 of 6 local searches agree within 0.1 %. It is limited by
      gap_over_t at its upper end 1  0.01 more gap_over_t would gain 0.00409 of fitness
      slant_deg at its upper end 60  1 more slant_deg would gain 0.0115 of fitness

    slant_deg at its upper end 60 and gap_over_t at its upper end 1 limit this design: with 1 % more slant_deg, fitness rises by 0.83 %.

    The criteria were rescaled between their worst and best values; to keep these bounds: rescale = { coverage = [3.3402e-4, 0.88453], areal_mass_kg_m2 = [0.90909, 0.50000] }

    results/light: goal.toml history.csv optimum.csv optimum.toml history.svg optimum.svg
    ");
    assert!(place.read("results/light/optimum.csv").contains(",fitness,binding,"));
    // The goal may also state the bounds of the criteria.
    let bounds = "--set goal.rescale={coverage=[0,0.9],areal_mass_kg_m2=[1,0.5]}";
    let record = place.prints(&format!("optimise x.toml --out ends --json {bounds}"));
    let record: serde_json::Value = serde_json::from_str(&record).expect("JSON");
    assert_eq!(record["rescaled"]["coverage"], serde_json::json!([0.0, 0.9]));
    assert!(record["optimum"]["values"]["fitness"].as_f64().is_some_and(|fitness| fitness > 0.5));
}

#[test]
fn incomparable_measures_are_rejected_as_objectives() {
    let text = "name = 'x'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\nmax_end_rotation_deg = { from = 30, to = 90 }\n\
        [designs]\nlength_over_t = 1\nslant_deg = 45\n[goal]\nmaximize = 'compliance'\n";
    let place = Place::with(text);
    insta::assert_snapshot!(place.refused("optimise x.toml"), @"error: x.toml:9: goal.maximize: an objective with max_end_rotation_deg as a variable is not accepted, expected values that can be compared between designs");
    for key in ["critical_tilt_deg", "needle_friction"] {
        let text = format!(
            "name = 'x'\n[variables]\n{key} = {{ from = 0.1, to = 0.2 }}\n[goal]\nmaximize = 'critical_force'\n\
             [designs]\nlength_over_t = 1\nslant_deg = 45\ngap_over_t = 1\n"
        );
        let refusal = Place::with(&text).refused("optimise x.toml");
        assert!(refusal.contains(&format!("an objective with {key} as a variable")), "{refusal}");
    }
}

/// At the smallest critical tilt that meets a required force, the force is at its limit.
#[test]
fn the_least_critical_tilt_for_a_force_is_found() {
    let text = "name = 'x'\nmeasures = 'puncture'\n[variables]\ncritical_tilt_deg = { from = 5, to = 15 }\n[goal]\nminimize = 'critical_tilt_deg'\n\
        require = ['critical_force >= 0.5']\n[designs]\ngap_over_t = 0.2\nlength_over_t = 0.5\nslant_deg = 60\n";
    let place = Place::with(text);
    // Exit code 1: full coupling lowers the force slightly below its limit.
    let output = place.squama("optimise x.toml --out tilt --json").assert().code(1);
    let record: serde_json::Value =
        serde_json::from_slice(&output.get_output().stdout).expect("JSON");
    let values = &record["optimum"]["values"];
    assert!((values["critical_force"].as_f64().expect("a force") - 0.5).abs() < 1e-6, "{record}");
    let tilt = values["critical_tilt_deg"].as_f64().expect("a tilt");
    assert!(tilt > 5.0 && tilt < 15.0, "{tilt}");
}

#[test]
fn a_search_does_not_write_to_the_folder_of_a_run() {
    let place = Place::with(crate::FEW);
    place.squama("run x.toml --out r -q --set measures=coverage").assert().code(0);
    std::fs::write(place.path("g.toml"), GOAL).expect("writable");
    insta::assert_snapshot!(place.refused("optimise g.toml --out r --fresh"), @"error: r: holds the results of a run; choose another folder with --out DIR");
}

/// The best design is checked even if tissue of finite thickness makes it slow to solve.
#[test]
fn the_best_design_on_finite_tissue_is_checked_with_full_coupling() {
    let goal = "name = 'firm'\nmeasures = ['coverage', 'puncture']\n[variables]\n\
        length_over_t = { from = 0.3, to = 1 }\n[designs]\ngap_over_t = 0.3\nslant_deg = 60\n[substrate]\n\
        tissue_thickness_over_t = 10\n[goal]\nminimize = 'length_over_t'\nrequire = 'critical_force >= 0.3'\n\
        samples = 2\n";
    let place = Place::with(goal);
    let output = place.squama("optimise x.toml").assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains("✗ With full substrate coupling, critical_force is "), "{text}");
}

/// The ranges of the variables are too narrow for tightened limits, so the answer fails a check.
#[test]
fn a_sampled_search_that_cannot_be_confirmed_keeps_its_best_design() {
    let goal = "name = 'firm'\nmeasures = ['coverage', 'puncture']\n[variables]\n\
        length_over_t = { from = 0.3, to = 0.79 }\n[designs]\ngap_over_t = 0.3\nslant_deg = 60\n\
        [tolerance]\nlength_over_t = { batch_sd = 0.001 }\n[goal]\nminimize = 'length_over_t'\n\
        require = ['critical_force >= 0.3', 'yield >= 0.5']\nsamples = 8\nskins = 20\nconfirm = true\n";
    let place = Place::with(goal);
    let output = place.squama("optimise x.toml").assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains("fails a check"), "{text}");
}

/// The search uses one load position, but another position may have a smaller force.
#[test]
fn a_weaker_load_position_of_the_best_design_is_reported() {
    let goal = "name = 'pinned'\nmeasures = 'puncture'\n[variables]\nslant_deg = { from = 30, to = 40 }\n\
        [designs]\ngap_over_t = 0.1\nlength_over_t = 1\n[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\nload_inset_over_t = 0.3\n\
        [material]\nthickness_mm = 2\nsubstrate_modulus_MPa = 0.5\n[goal]\nsound = false\nmaximize = 'critical_force'\nsamples = 2\n";
    let (text, weakest) = weakest_load_position(goal);
    let (_, line) = text.split_once("Weakest load position, ").expect("a sentence");
    let force =
        line.split_once("critical_force = ").and_then(|(_, rest)| rest.split_once(" there, "));
    let printed: f64 = force.expect("a force").0.parse().expect("a number");
    assert!((printed / weakest - 1.0).abs() < 1e-4, "{line} {weakest}");
    // No position is reported if the goal uses the weakest position, or if the needle is free.
    let weakest = goal.replace("critical_force", "weakest_force");
    let (text, _) =
        weakest_load_position(&weakest.replace("[puncture]\n", "[puncture]\nplaces = 11\n"));
    assert!(!text.contains("Weakest load position"), "{text}");
    let (text, _) = weakest_load_position(&goal.replace("'guided'", "'free'"));
    assert!(!text.contains("Weakest load position"), "{text}");
}

/// Returns the report of a search, and the smallest force of its optimum.
///
/// The force is the smallest of eleven load positions, with full substrate coupling.
fn weakest_load_position(goal: &str) -> (String, f64) {
    let place = Place::with(goal);
    let text = place.prints("optimise x.toml");
    let found = place.prints(
        "design results/pinned --json --set puncture.places=11 --set substrate.coupling=full",
    );
    let found: serde_json::Value = serde_json::from_str(&found).expect("JSON");
    (text, found["measures"]["weakest_force"].as_f64().expect("a number"))
}

/// A check computes the failure force at every load position with full substrate coupling.
#[test]
fn a_failure_at_another_load_position_fails_the_search() {
    let goal = "name = 'pinned'\nmeasures = 'puncture'\n[variables]\nlength_over_t = { from = 1, to = 2 }\n\
        [designs]\ngap_over_t = 0.6\nslant_deg = 60\n[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\n\
        load_inset_over_t = 0.4\nscale_strength_over_substrate = 30\n[goal]\nminimize = 'length_over_t'\n\
        require = 'failure_force >= 0.1'\nsamples = 2\n";
    let place = Place::with(goal);
    let output = place.squama("optimise x.toml --json").assert().code(1);
    let record: serde_json::Value =
        serde_json::from_slice(&output.get_output().stdout).expect("JSON");
    let weakest = &record["optimum"]["weakest_place"][0];
    assert!((weakest["requested"].as_f64().expect("a force") - 0.1).abs() < 1e-7, "{weakest}");
    assert_eq!(weakest["place"], 1.0);
    // A definition with the weakest position and full coupling has the same failure force and mode.
    let again = place.prints("design results/pinned --json --set substrate.coupling=full --set puncture.load_inset_over_t=0");
    let again: serde_json::Value = serde_json::from_str(&again).expect("JSON");
    assert_eq!(again["measures"]["failure_force"], weakest["weakest"]);
    assert_eq!(again["measures"]["first_failure"], weakest["failure"]);
    let failed = "At the right corner of the scale, with full substrate coupling, failure_force is 0.065255, which misses failure_force >= 0.1";
    assert_eq!(record["optimum"]["failed_checks"], serde_json::json!([failed]));
}

/// If the path at another load position ends early, no check confirms the failure force there.
#[test]
fn a_load_position_without_a_force_fails_the_search() {
    let goal = "name = 'pinned'\nmeasures = 'puncture'\n[variables]\nlength_over_t = { from = 0.8, to = 1 }\n\
        [designs]\ngap_over_t = 0.1\nslant_deg = 45\n[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\n\
        scale_strength_over_substrate = 30\n[goal]\nminimize = 'length_over_t'\n\
        require = 'failure_force >= 0.2'\nsamples = 2\n";
    let place = Place::with(goal);
    let output = place.squama("optimise x.toml").assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    let failed = "At the left corner of the scale, with full substrate coupling, failure_force has no valid value (off the edge)";
    assert!(text.contains(failed), "{text}");
}

/// With full substrate coupling, the force of the best design is below its limit.
#[test]
fn a_requirement_that_a_check_contradicts_fails_the_search() {
    let goal = "name = 'firm'\nmeasures = ['coverage', 'puncture']\n[variables]\n\
        length_over_t = { from = 0.3, to = 1 }\n[designs]\ngap_over_t = 0.3\nslant_deg = 60\n[goal]\n\
        minimize = 'length_over_t'\nrequire = 'critical_force >= 0.3'\nsamples = 8\n";
    let place = Place::with(goal);
    let sentence = "With full substrate coupling, critical_force is 0.28038, which misses critical_force >= 0.3.";
    let output = place.squama("optimise x.toml").assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains(sentence), "{text}");
    assert!(place.read("results/firm/optimum.csv").contains("which misses critical_force >= 0.3"));
    for command in ["design results/firm", "make results/firm --set material.thickness_mm=2"] {
        let output = place.squama(command).assert().code(0);
        let warnings = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
        assert!(warnings.contains(sentence), "{command}: {warnings}");
    }
    // The interactive page and the report of a sweep repeat the sentence.
    place.prints("explore results/firm --out e.html");
    let page = place.read("e.html");
    let (_, header) = page.split_once("</h1>").expect("a header");
    let header = header.split("<section").next().expect("a section");
    let shown = sentence.replace(">=", "&gt;=");
    assert!(header.contains(&shown) && header.matches("⚠").count() == 1, "{header}");
    let grid = "run x.toml -q --out g --set designs.length_over_t=[0.4,0.6]";
    std::fs::write(place.path("x.toml"), goal.split("[goal]").next().expect("a sweep"))
        .expect("writable");
    place.squama(grid).assert().code(0);
    place.prints("report g --front results/firm");
    assert!(
        place
            .read("g/report.html")
            .contains("\"notes\":[\"The optimum of results/firm fails a check: ")
    );
    std::fs::write(place.path("x.toml"), goal).expect("writable");
    // With `confirm = true` the search tightens the limit only as far as the check requires.
    place.squama("optimise x.toml --set goal.confirm=true --out c").assert().code(0);
    let full = place.prints("design c --set substrate.coupling=full --json --out d");
    let full: serde_json::Value = serde_json::from_str(&full).expect("JSON");
    let force = full["measures"]["critical_force"].as_f64().expect("a force");
    assert!((0.3..0.305).contains(&force), "{force}");
}
