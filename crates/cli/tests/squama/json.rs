//! What is printed for programs.

use serde_json::Value;

use crate::table::cell;
use crate::{FEW, Place};

impl Place {
    /// The JSON that `squama` prints.
    fn json(&self, arguments: &str) -> Value {
        serde_json::from_str(&self.prints(arguments)).expect("JSON")
    }
}

#[test]
fn a_design_has_all_its_values() {
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
    let beside = place.json("design x.toml --gap 0.15 --length 1 --slant 45 --json");
    assert_eq!(beside["design"], Value::Null);
}

#[test]
fn a_definition_is_told() {
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
fn the_status_of_a_run_is_told() {
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
