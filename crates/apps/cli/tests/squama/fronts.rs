//! The option `--front` shows designs of a search in the report of a sweep.

use crate::Place;
use crate::table::cell;

const GRID: &str = "name = 'grid'\nmeasures = 'coverage'\n[designs]\ngap_over_t = [0.2, 0.6]\n\
                    length_over_t = 1\nslant_deg = [30, 60]\n";
const GOAL: &str = "name = 'goal'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
                    slant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\nwidth_over_t = 2\n[goal]\nsamples = 32\n\
                    points = 4\nrequire = 'slant_deg <= 50'\n";

/// Searches for `objectives`, and returns the report of the grid with the designs of the search.
fn page(place: &Place, objectives: &str) -> String {
    std::fs::write(place.path("goal.toml"), format!("{GOAL}{objectives}\n")).expect("writable");
    place.squama("optimise goal.toml --out found --fresh").assert().code(0);
    place.prints("report grid --front found");
    place.read("grid/report.html")
}

/// Returns a folder with the results of the sweep in `grid`.
fn grid() -> Place {
    let place = Place::with(GRID);
    place.squama("run x.toml --out grid --quiet").assert().code(0);
    place
}

#[test]
fn a_front_is_shown_with_the_designs_of_the_grid() {
    let html = page(&grid(), "maximize = ['coverage', 'gap_over_t']");
    let (_, found) = html.split_once("\"found\":{").expect("a front");
    let (found, _) = found.split_once("\"values\"").expect("its designs");
    assert!(found.contains("\"axes\":[\"coverage\",\"gap_over_t\"]"), "{found}");
    assert!(found.contains("\"count\":4"), "{found}");
    assert!(
        found.contains("\"column\":\"slant_deg\",\"limit\":50.0,\"sign\":\"\\u003c=\""),
        "{found}"
    );
    assert!(html.contains("\"variables\":[\"gap_over_t\",\"slant_deg\"]"));
    // The page reports fixed parameters that differ between search and grid, but not variables.
    assert!(found.contains("\"differences\":[\"scale.width_over_t 2 instead of 1\"]"), "{found}");
}

#[test]
fn designs_of_a_front_are_selected_by_number() {
    let place = grid();
    page(&place, "maximize = ['coverage', 'gap_over_t']");
    let front = place.read("found/front.csv");
    for number in ["0001", "0003"] {
        place.prints(&format!("design found --design {number} --set scale.width_over_t=3"));
        let measures = place.read(&format!("found/designs/{number}/measures.csv"));
        for column in ["gap_over_t", "slant_deg", "coverage"] {
            let value = measures.lines().find(|line| line.starts_with(&format!("{column},")));
            let cell = cell(&front, number, column);
            assert!(value.is_some_and(|line| line.contains(cell)), "{column} {cell}: {value:?}");
        }
    }
    place.prints(
        "draw found --design 2,4 --width 85 --set puncture.scales=3 --set designs.slant_deg=45",
    );
    let drawing = place.read("found/drawings/design-0004-puncture-at-critical-tilt.svg");
    assert!(drawing.contains(" width=\"85mm\" height=\""));
    // The size of letters is proportional to the width, so half the size gives half the width.
    let [large, small] = ["8", "4"].map(|size| -> f64 {
        place.prints(&format!("draw found --design 2 --font-size {size} --set puncture.scales=3"));
        let drawing = place.read("found/drawings/design-0002-puncture-at-critical-tilt.svg");
        let (_, rest) = drawing.split_once(" width=\"").expect("has a width");
        rest.split_once("mm").expect("in mm").0.parse().expect("a number")
    });
    assert!((large - 2.0 * small).abs() < 0.02);
    insta::assert_snapshot!(place.refused("design found"), @"error: found: holds a Pareto front of 4 designs; choose with --design");
    insta::assert_snapshot!(place.refused("design found --design 5"), @"error: --design 5: not accepted, expected 1 to 4, the designs of front.csv");
    insta::assert_snapshot!(place.refused("draw found --design 1 --width 5"), @"error: --width 5: out of range, expected 10 to 2000");
    insta::assert_snapshot!(place.refused("draw found --design 1 --font-size 0"), @"error: --font-size 0: out of range, expected 1 to 72");
}

#[test]
fn a_single_optimum_is_shown_with_the_requirements() {
    let html = page(&grid(), "maximize = 'coverage'");
    assert!(html.contains("\"axes\":[\"coverage\",\"slant_deg\"]"));
}

#[test]
fn folders_without_a_front_for_the_grid_are_rejected() {
    let place = grid();
    insta::assert_snapshot!(place.refused("report grid --front grid"), @"error: --front grid: holds neither front.csv nor optimum.csv, expected a results folder of squama optimise");
    let physical =
        GOAL.replace("[goal]", "[material]\nthickness_mm = 1\nscale_density_kg_m3 = 1000\n[goal]");
    std::fs::write(place.path("goal.toml"), physical + "minimize = 'areal_mass_kg_m2'\n")
        .expect("writable");
    place.squama("optimise goal.toml --out found").assert().code(0);
    insta::assert_snapshot!(place.refused("report grid --front found"), @"error: --front found: its objective areal_mass_kg_m2 is not a column of the designs in grid, expected a sweep with the same measures and [material]");
}
