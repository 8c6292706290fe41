//! The JSON output of commands.

use serde_json::Value;

use crate::table::cell;
use crate::{FEW, Place};

impl Place {
    /// Runs `squama`, which must succeed, and returns the JSON that it prints.
    fn json(&self, arguments: &str) -> Value {
        serde_json::from_str(&self.prints(arguments)).expect("JSON")
    }
}

#[test]
fn json_of_a_design_contains_all_values() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q").assert().code(0);
    let design = place.json("design x.toml --design 6 --json");
    let table = place.read("results/few/designs.csv");
    for name in ["critical_force", "coverage", "calibration_error"] {
        let value = cell(&table, "0006", name).parse::<f64>().expect("a number");
        assert_eq!(design["measures"][name], value, "{name}");
    }
    assert_eq!(design["measures"]["settings"], "");
    assert_eq!(design["units"]["critical_force"], "E_s L t/(1-nu^2)");
    assert_eq!((&design["sweep"], &design["design"]), (&"few".into(), &"0006".into()));
    assert_eq!(design["parameters"]["puncture.scales"], 21);
    assert_eq!(
        (&design["failed"], &design["folder"]),
        (&false.into(), &"results/few/designs/0006".into())
    );
    let off_grid = place.json("design x.toml --gap 0.15 --length 1 --slant 45 --json");
    assert_eq!(off_grid["design"], Value::Null);
}

#[test]
fn json_contains_control_characters_that_text_escapes() {
    let place = Place::with(FEW);
    let folder = "a\u{200b}b";
    place.squama("run x.toml -q --out").arg(folder).assert().code(0);
    let output = place.squama("design --design 6 --json").arg(folder).output().expect("output");
    let design: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(design["folder"], format!("{folder}/designs/0006"));
}

#[cfg(unix)]
#[test]
fn a_definition_may_be_read_from_a_pipe() {
    let place = Place::with(FEW);
    let mut design = place.squama("design /dev/stdin --design 6 --json --out d");
    let output = design.write_stdin(FEW).output().expect("output");
    let design: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(design["design"], "0006");
}

#[test]
fn check_describes_a_definition_as_json() {
    let place = Place::with(FEW);
    let definition = place.json("check x.toml --json");
    assert_eq!((&definition["designs"], &definition["sweep"]), (&8.into(), &"few".into()));
    assert_eq!(definition["axes"][2]["key"], "slant_deg");
    assert_eq!(definition["axes"][2]["values"], serde_json::json!([0.0, 45.0]));
    assert_eq!(definition["parameters"]["puncture.scales"], 21);
    assert_eq!(
        (&definition["calibrations"], &definition["output"]),
        (&4.into(), &"results/few".into())
    );
}

#[test]
fn status_describes_a_run_as_json() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --set solver.max_points=3").assert().code(1);
    let output = place.squama("status x.toml --json").assert().code(1).get_output().stdout.clone();
    let status: Value = serde_json::from_slice(&output).expect("JSON");
    for (key, value) in
        [("designs", 8), ("done", 8), ("failed", 8), ("missing", 0), ("sessions", 1)]
    {
        assert_eq!(status[key], value, "{key}");
    }
    assert_eq!(status["is_running"], false);
    assert_eq!(status["failures"][0]["reason"], "too many points");
    assert_eq!(status["slowest"].as_array().map(Vec::len), Some(5));
}

#[test]
fn rank_describes_a_ranking_as_json() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q").assert().code(0);
    let ranking = place.json("rank x.toml --json --top 1");
    let table = place.read("results/few/ranking.csv");
    let best = table.lines().nth(1).expect("a row").split(',').collect::<Vec<_>>();
    let number = crate::table::columns(&table).position(|name| name == "design");
    assert_eq!(ranking["best"].as_array().map(Vec::len), Some(1));
    assert_eq!(ranking["best"][0]["design"], best[number.expect("a column")]);
    assert!(ranking["best"][0]["values"]["critical_force"].is_f64(), "{ranking}");
    assert_eq!(ranking["best_by_one_criterion"][0]["criterion"], "coverage");
    assert_eq!(ranking["ranked"], table.lines().count() - 1);
    let unmet = place.squama("rank x.toml --json --require coverage>=2").assert().code(1);
    let unmet: Value = serde_json::from_slice(&unmet.get_output().stdout).expect("JSON");
    assert_eq!((&unmet["ranked"], &unmet["requirements"][0]["met_by"]), (&0.into(), &0.into()));
    assert!(unmet["nearest"].is_string(), "{unmet}");
}
