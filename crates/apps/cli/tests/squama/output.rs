//! The text that commands print, and the pages that `squama explore` writes.

use std::process::Stdio;

use serde_json::{Value, json};

use crate::{FEW, Place};

#[test]
fn check_describes_the_run() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(
        place.prints("check x.toml --set designs.c1={from=0.01,to=1,step=0.01}")
    );
    assert_eq!(place.list("."), "x.toml", "no file is written");
}

#[test]
fn calibrate_prints_six_coefficients() {
    let text = Place::new().prints("calibrate --gap 0.1 --length 1");
    // Expected stiffnesses of three square bases, separated by a tenth of their side.
    for (name, expected) in [("alpha", [2.699, 3.376, 2.473]), ("beta", [0.993, 1.082, -0.428])] {
        let line = text.lines().find(|line| line.trim_start().starts_with(name));
        let words = line.expect("a line").split_whitespace().skip(1);
        let found: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-3), "{found:?}");
    }
}

/// On a layer, a force along the row also rotates a scale and displaces its neighbours vertically.
///
/// In this test, the layer is twice as thick as the scales.
#[test]
fn calibrate_prints_the_couplings_of_a_layer() {
    let place = Place::new();
    let text = place.prints("calibrate --gap 0.1 --length 1 --tissue-thickness 2");
    insta::assert_snapshot!(text);
    let text = place.refused("calibrate --gap 0.1 --length 1 --tissue-thickness 0.1");
    assert!(text.contains("a quarter of the half-width"), "{text}");
}

/// Returns the JSON data in the text of an interactive page.
fn page_data(page: &str) -> Value {
    let (_, data) = page.split_once("id=\"live-data\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("an end");
    serde_json::from_str(data).expect("JSON")
}

/// The sliders of the page have the ranges of the goal's variables, in mm.
#[test]
fn explore_keeps_the_ranges_of_a_goal_and_of_its_optimum() {
    let place = Place::with(
        "name = 'x'\nmeasures = ['coverage']\n[variables]\ngap_mm = { from = 0.2, to = 2 }\nlength_mm = { from = 1, to = 4 }\n\
         [designs]\nslant_deg = 60\n[material]\nthickness_mm = 2\n[goal]\nmaximize = 'coverage'\nrequire = ['coverage <= 0.9']",
    );
    place.prints("optimise x.toml --out o");
    for source in ["x.toml", "o", "o/optimum.toml"] {
        place.prints(&format!("explore {source} --no-open"));
        let data = page_data(&place.read("explore.html"));
        let controls = data["controls"].as_array().expect("controls");
        let gap = controls.iter().find(|one| one["key"] == "gap_mm").expect("a gap in mm");
        assert_eq!(
            (&gap["min"], &gap["max"], &gap["unit"]),
            (&json!(0.2), &json!(2.0), &json!("mm"))
        );
        assert_eq!(data["requirements"][0], "coverage <= 0.9", "{source}");
    }
}

/// The page searches these designs for a design that meets the requirements.
#[test]
fn the_page_of_a_run_contains_its_solved_designs() {
    let place = Place::with(
        "name = 'x'\nmeasures = ['coverage']\ndesigns.gap_over_t = [0.1, 0.2]\ndesigns.slant_deg = 30",
    );
    place.prints("run x.toml --out r");
    place.prints("explore r --no-open");
    let solved = page_data(&place.read("explore.html"))["solved"].clone();
    let columns = json!(["length_over_t", "gap_over_t", "slant_deg", "coverage"]);
    assert_eq!(solved["columns"], columns);
    assert_eq!(solved["rows"][1][1], 0.2);
}

#[test]
fn explore_accepts_tissue_of_finite_thickness() {
    let place = Place::with("name = 'x'\nbody = 'finger'\nmaterial.thickness_mm = 2");
    place.prints("explore x.toml --no-open");
    assert!(place.read("explore.html").contains("tissue_thickness_mm = 5"));
}

/// The page solves single designs, which have no statistics over samples.
#[test]
fn explore_leaves_out_requirements_on_samples() {
    let place = Place::with("name = 'x'");
    let mut command =
        place.squama("explore x.toml --no-open --require yield>=0.9 --require coverage>=0.5");
    let assert = command.assert().code(0);
    let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(message.contains("yield >= 0.9 is left out"), "{message}");
    let page = place.read("explore.html");
    assert!(page.contains("coverage >= 0.5") && !page.contains("yield >="));
}

/// The page shows a command to copy, with the definition and settings from which it was made.
#[test]
fn the_page_contains_its_definition_and_settings() {
    let place = Place::with("name = 'x'");
    place.prints("explore x.toml --no-open --set contact.friction=0.1 --set scale.base=2L");
    let source = "x.toml --set contact.friction=0.1 --set scale.base=2L";
    assert!(place.read("explore.html").contains(&format!("\"source\":\"{source}\"")));
}

/// A goal defines no single design, so options must give a value for each variable.
#[test]
fn designs_of_a_goal_are_selected_by_value() {
    let place = Place::with(
        "name = 'x'\nmeasures = ['coverage']\n[variables]\ngap_mm = { from = 0.2, to = 2 }\nlength_mm = { from = 1, to = 4 }\n\
         thickness_mm = { from = 1, to = 2 }\n[designs]\nslant_deg = 60\n[goal]\nmaximize = 'coverage'",
    );
    let chosen = "--gap 0.5 --length 2 --set designs.thickness_mm=1.5 --out o";
    let text = place.prints(&format!("design x.toml {chosen}"));
    for value in ["gap_mm  0.5 ", "length_mm  2 ", "thickness_mm  1.5 ", "slant_deg  60 "] {
        assert!(
            text.lines().any(|line| {
                line.split_whitespace()
                    .eq(value.split_whitespace().chain(line.split_whitespace().skip(2)))
            }),
            "{value} in {text}"
        );
    }
    for command in ["design x.toml", "design x.toml --design 1", "run x.toml", "draw x.toml"] {
        let text = place.refused(command);
        assert!(text.contains("run squama optimise, then"), "{command}: {text}");
    }
    insta::assert_snapshot!(place.prints("check x.toml"));
    let json: serde_json::Value =
        serde_json::from_str(&place.prints("check x.toml --json")).expect("JSON");
    assert_eq!(json["variables"]["designs.gap_mm"], serde_json::json!([0.2, 2.0]));
}

#[test]
fn help_shows_examples() {
    let place = Place::new();
    let commands = [
        "",
        "run ",
        "rerun ",
        "status ",
        "merge ",
        "slurm ",
        "export ",
        "design ",
        "rank ",
        "compare ",
        "check ",
        "calibrate ",
        "init ",
        "completions ",
        "man ",
        "draw ",
        "plot ",
        "plot curves ",
        "fit ",
    ];
    for command in commands {
        let text = place.prints(&format!("{command}--help"));
        assert!(text.contains("Examples:\n  squama "), "{text}");
    }
    insta::assert_snapshot!(place.prints("run --help"));
    insta::assert_snapshot!(place.prints("rank --help"));
    insta::assert_snapshot!(place.prints("compare --help"));
}

#[test]
fn a_run_ends_with_a_summary() {
    let place = Place::with(FEW);
    let text = place.prints("run x.toml --threads 1");
    let (title, rest) = text.split_once('\n').expect("lines");
    assert!(
        title.starts_with("few: 8 designs in ") && title.ends_with(" s on 1 thread"),
        "{title}"
    );
    let names: Vec<_> = rest.lines().map(|line| line.split("  ").nth(1).unwrap_or("")).collect();
    assert_eq!(
        names,
        [
            "puncture",
            "flexure",
            "best coverage",
            "largest critical force",
            "least penetration",
            "largest compliance",
            "tables"
        ]
    );
}

#[test]
fn a_closed_pipe_is_no_error() {
    let place = Place::with(FEW);
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin!("squama"))
        .args(["design", "x.toml", "--design", "1"])
        .current_dir(place.folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

/// The design with the largest critical force folds the surface at a fifth of this force.
#[test]
fn a_folded_best_design_is_marked_in_the_summary() {
    let folding = FEW.replace("[0.1, 0.5]", "0.1").replace("[0, 45]", "[45, 75]");
    let text = Place::with(&folding).prints("run x.toml --threads 1");
    let line = text.lines().find(|line| line.contains("largest critical force")).expect("a line");
    assert!(
        line.contains("(design 0004) ⚠ not valid, the surface folds; without a fold"),
        "{text}"
    );
    let coverage = text.lines().find(|line| line.contains("best coverage")).expect("a line");
    assert!(!coverage.contains('⚠'), "coverage does not depend on the substrate: {text}");
}
