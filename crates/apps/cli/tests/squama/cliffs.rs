//! Measures that change steeply with a parameter, in `squama rank` and `squama plot map`.

use serde_json::Value;

use crate::{FEW, Place};

/// A sweep of designs with measures that depend steeply on the gap.
///
/// The design (0.1, 0.2, 60°) loses half of its critical force if its gap grows by a tenth.
const STEEP: &str = "name = 'steep'\n[designs]\ngap_over_t = [0.1, 0.2, 0.4]\nlength_over_t = [0.1, 0.2]\nslant_deg = [45, 60, 75]\n";

/// Runs a sweep and ranks it; returns the folder and the output of `squama rank`.
fn ranked(definition: &str, arguments: &str) -> (Place, String) {
    let place = Place::with(definition);
    place.squama("run x.toml -q").assert().code(0);
    let printed = place.prints(&format!("rank x.toml {arguments}"));
    (place, printed)
}

#[test]
fn the_best_designs_are_solved_again_with_other_gaps() {
    let (place, printed) = ranked(FEW, "--json");
    let ranking: Value = serde_json::from_str(&printed).expect("JSON");
    let changes = ranking["gap_changes"].as_array().expect("changes");
    let best = [&ranking["best"][0], &ranking["best_by_one_criterion"][1]];
    for winner in best {
        let change = changes.iter().find(|change| change["design"] == winner["design"]);
        let change = change.expect("changes of a winner");
        assert_eq!(change["measures"].as_array().map(Vec::len), Some(4));
        for (key, gap) in [("gap_10_percent_smaller", 0.09), ("gap_10_percent_larger", 0.11)] {
            assert_eq!(change["gap_over_t"], 0.1);
            let length = if winner["design"] == "0004" { 1.0 } else { 0.2 };
            let solved = place.prints(&format!(
                "design x.toml --gap {gap} --length {length} --slant 45 --json --out y"
            ));
            let solved: Value = serde_json::from_str(&solved).expect("JSON");
            for measure in change["measures"].as_array().expect("measures") {
                let column = measure["column"].as_str().expect("a column");
                let [reported, solved] = [&measure[key], &solved["measures"][column]]
                    .map(|v| v.as_f64().expect("a number"));
                let difference = (reported / solved - 1.0).abs();
                assert!(difference < 1e-9, "{column} at {gap}: {reported} {solved}");
            }
        }
    }
}

#[test]
fn sensitivity_to_the_gap_is_reported() {
    let (_, printed) = ranked(
        STEEP,
        "--require length_over_t==0.2 --require slant_deg==60 --require gap_over_t==0.1",
    );
    let (_, answer) = printed.split_once("The best design").expect("an answer");
    let answer = answer.rsplit_once("\n\n").expect("the names of the files").0;
    insta::assert_snapshot!(answer);
}

#[test]
fn the_best_design_is_solved_again_with_full_coupling() {
    let (place, printed) = ranked(FEW, "--require penetration<0.2 --json");
    let ranking: Value = serde_json::from_str(&printed).expect("JSON");
    let [change] = ranking["full_coupling"].as_array().expect("changes").as_slice() else {
        panic!("one design is the best: {printed}")
    };
    let number = change["design"].as_str().expect("a number");
    let full = "--set substrate.coupling=full --json --out y";
    let solved = place.prints(&format!("design x.toml --design {number} {full}"));
    let solved: Value = serde_json::from_str(&solved).expect("JSON");
    let measures = change["measures"].as_array().expect("measures");
    assert_eq!(measures.len(), 4);
    let mut changed = Vec::new();
    for measure in measures {
        let column = measure["column"].as_str().expect("a column");
        assert_eq!(measure["full"], solved["measures"][column], "{column}");
        if measure["full"] != measure["nearest"] {
            changed.push(column);
        }
    }
    assert!(changed.contains(&"penetration") && !changed.contains(&"coverage"), "{printed}");
    // Designs of a sweep with full coupling are not solved again with full coupling.
    let (_, printed) = ranked(&format!("substrate.coupling = 'full'\n{FEW}"), "--json");
    let ranking: Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(ranking["full_coupling"], Value::Array(Vec::new()));
}

#[test]
fn sensitivity_to_the_gap_needs_a_definition() {
    let (place, _) = ranked(FEW, "");
    std::fs::create_dir(place.path("alone")).expect("a folder");
    std::fs::copy(place.path("results/few/designs.csv"), place.path("alone/designs.csv"))
        .expect("a table");
    assert!(!place.prints("rank alone").contains("gap 10 % smaller"));
}

#[test]
fn a_map_is_drawn_over_any_two_parameters() {
    let (place, _) = ranked(STEEP, "");
    let printed =
        place.prints("plot map x.toml --x gap_over_t --y slant_deg --of critical_force --out y");
    assert_eq!(printed, "y/map-of-critical-force-over-gap-over-t-and-slant-deg.svg\n");
    let map = place.read("y/map-of-critical-force-over-gap-over-t-and-slant-deg.svg");
    // Rectangles: nine designs in each of two maps, two borders, 60 cells of the colour bar, and
    // the white paper.
    assert_eq!(map.matches("<g class=\"map\">").count(), 2);
    assert_eq!(map.matches("<rect").count(), 2 * 9 + 2 + 60 + 1, "{map}");
    assert!(map.contains("<g class=\"contours\""), "{map}");
    let fixed = place.prints("plot map x.toml --x gap_over_t --y slant_deg --of compliance --at length_over_t=0.2 --no-title --out y");
    assert_eq!(fixed, "y/map-of-compliance-over-gap-over-t-and-slant-deg-length-over-t-0.2.svg\n");
    let fixed = place.read(fixed.trim());
    assert_eq!(
        (fixed.matches("<g class=\"map\">").count(), fixed.matches("class=\"title\"").count()),
        (1, 0)
    );
}

#[test]
fn invalid_maps_are_rejected() {
    let (place, _) = ranked(STEEP, "");
    let refused = [
        "--x gap --y slant_deg --of critical_force",
        "--x gap_over_t --y gap_over_t --of critical_force",
        "--x gap_over_t --y width_over_t --of critical_force",
        "--x gap_over_t --y slant_deg --of puncture_status",
        "--x gap_over_t --y slant_deg --of compliance --at length_over_t",
        "--x gap_over_t --y slant_deg --of compliance --at length_over_t=3",
        "--x gap_over_t --y slant_deg --of compliance --dpi 0",
    ];
    let messages =
        refused.map(|arguments| place.refused(&format!("plot map x.toml {arguments} --out y")));
    insta::assert_snapshot!(messages.concat());
    assert!(!place.path("y").exists(), "nothing is written");
}
