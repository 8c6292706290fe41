//! `squama optimise` with goals on statistics over samples: output, tables and invalid goals.

use crate::Place;

const GOAL: &str = "name = 'made'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
    slant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\n[material]\nthickness_mm = 1\n\
    scale_density_kg_m3 = 1000\n[tolerance]\ngap_over_t = { batch_sd = 0.02 }\n[goal]\n\
    minimize = 'areal_mass_kg_m2'\nrequire = ['coverage >= 0.5', 'yield >= 0.9']\nsamples = 64\n";

#[test]
fn the_best_design_is_confirmed_on_new_samples() {
    let place = Place::with(GOAL);
    let text = place.prints("optimise x.toml --threads 1");
    let (_, answer) = text.split_once("\n\n").expect("an answer");
    insta::assert_snapshot!(answer);
    let header = place.read("results/made/optimum.csv");
    let header = header.lines().next().expect("a header").to_owned();
    assert!(header.ends_with(
        ",binding,prices,failed_checks,yield,yield_low,yield_high,yield_seen,fresh_samples"
    ));
    // The history also lists designs without samples, which have only nominal values.
    let history = place.read("results/made/history.csv");
    for word in [",nominal,", ",short,", ",met,", ",tolerance,"] {
        assert!(history.contains(word), "{word}");
    }
    let record = place.prints("optimise x.toml --json --fresh");
    let record: serde_json::Value = serde_json::from_str(&record).expect("JSON");
    let confirmed = &record["optimum"]["made"];
    let counts = [&confirmed["seen"], &confirmed["fresh"]].map(serde_json::Value::as_u64);
    assert_eq!(counts, [Some(1000); 2]);
    assert_eq!(confirmed["estimates"][0]["quantity"], "yield");
}

/// The yield alone would not show which requirement prevents a larger yield.
#[test]
fn an_infeasible_search_names_the_requirements_that_samples_miss() {
    let required = "['coverage >= 0.5', 'areal_mass_kg_m2 <= 0.54', 'yield >= 0.99']";
    let place = Place::with(&GOAL.replace("['coverage >= 0.5', 'yield >= 0.9']", required));
    let output = place.squama("optimise x.toml").assert().code(1);
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains(" % of the samples, ") && text.contains(" is missed by "), "{text}");
    let output = place.squama("optimise x.toml --json --fresh").assert().code(1);
    let record: serde_json::Value =
        serde_json::from_slice(&output.get_output().stdout).expect("JSON");
    let missed = record["infeasible"]["missed"].as_array().expect("a list");
    assert_eq!(missed.len(), 2, "{missed:?}");
    assert!(missed[0]["share"].as_f64() > Some(0.1), "{missed:?}");
}

#[test]
fn tolerance_confirms_the_yield_of_a_search() {
    let place = Place::with(GOAL);
    let record = place.prints("optimise x.toml --json");
    let record: serde_json::Value = serde_json::from_str(&record).expect("JSON");
    let by_search = record["optimum"]["made"]["estimates"][0]["value"].as_f64().expect("a yield");
    let text = "tolerance results/made/optimum.toml --samples 1000 --json --out t";
    let arguments = text.split(' ').chain(["--require", "coverage >= 0.5"]).map(str::to_owned);
    let arguments: Vec<String> = arguments.collect();
    let output = place.squama_with(&arguments).assert().code(0).get_output().stdout.clone();
    let record: serde_json::Value = serde_json::from_slice(&output).expect("JSON");
    let by_tolerance = record["designs"][0]["yields"][0]["yield"].as_f64().expect("a yield");
    // Search and analysis use independent sets of 1000 samples, so allow three standard deviations
    // of the difference of their yields.
    let difference = (by_tolerance - by_search).abs();
    assert!(difference > 0.0 && difference < 0.04, "{by_tolerance} {by_search}");
}

#[test]
fn tables_of_sampled_searches_do_not_depend_on_threads_or_interruptions() {
    let goal = GOAL.replace(
        "minimize = 'areal_mass_kg_m2'\n",
        "maximize = 'coverage_p05'\nminimize = 'areal_mass_kg_m2'\npoints = 3\nskins = 20\n",
    );
    let place = Place::with(&goal);
    place.squama("optimise x.toml --threads 1 --out one").assert().code(0);
    place.squama("optimise x.toml --threads 3 --out three").assert().code(0);
    let journal = place.read("three/evaluations.jsonl");
    std::fs::write(place.path("three/evaluations.jsonl"), &journal[..journal.len() / 3 * 2])
        .expect("writable");
    place.squama("optimise x.toml --threads 2 --out three --resume").assert().code(0);
    for file in ["front.csv", "history.csv", "goal.toml", "front.svg", "history.svg"] {
        let [one, three] = ["one", "three"].map(|folder| place.read(&format!("{folder}/{file}")));
        assert!(one == three, "{file}");
    }
}

#[test]
fn bad_goals_on_samples_are_reported_on_one_line() {
    let deviations = "[tolerance]\ngap_over_t = { batch_sd = 0.02 }\n";
    let objective = "'areal_mass_kg_m2'";
    let messages = [
        (deviations, ""),
        (deviations, "[imperfection]\ngap_cv = 0.1\n"),
        ("[tolerance]\n", "[imperfection]\ngap_cv = 0.1\n[tolerance]\n"),
        ("'coverage >= 0.5', ", ""),
        ("yield >= 0.9", "yield >= 1.2"),
        ("yield >= 0.9", "yield >= 0"),
        ("yield >= 0.9", "yield > 1"),
        ("yield >= 0.9", "yield <= 0.9"),
        ("yield >= 0.9", "coverage_p5 >= 0.4"),
        ("yield >= 0.9", "coverage_p5x >= 0.4"),
        ("yield >= 0.9", "coverag_p05 >= 0.4"),
        ("yield >= 0.9", "critical_force_p05 >= 0.4"),
        (objective, "'design_p05'"),
        (objective, "'fitness_p05'"),
        (objective, "'yield'"),
        ("samples = 64", "skins = 3"),
        ("'yield >= 0.9']\nsamples = 64", "'coverage <= 0.9']\nskins = 300"),
    ];
    let messages = messages.map(|(from, to)| Place::refused_goal(GOAL, from, to));
    insta::assert_snapshot!(messages.concat());
}
