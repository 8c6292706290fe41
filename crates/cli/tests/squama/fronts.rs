//! What a search has found, on the page of a sweep.

use crate::Place;

const GRID: &str = "name = 'grid'\nmeasures = 'coverage'\n[designs]\ngap_over_t = [0.2, 0.6]\n\
                    length_over_t = 1\nslant_deg = [30, 60]\n";
const GOAL: &str = "name = 'goal'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n\
                    slant_deg = { from = 0, to = 60 }\n[designs]\nlength_over_t = 1\nwidth_over_t = 2\n[goal]\nsamples = 32\n\
                    points = 4\nrequire = 'slant_deg <= 50'\n";

/// The data of the page of the grid, with what a search for `objectives` has found.
fn page(place: &Place, objectives: &str) -> String {
    std::fs::write(place.path("goal.toml"), format!("{GOAL}{objectives}\n")).expect("writable");
    place.squama("optimise goal.toml --out found --fresh").assert().code(0);
    place.prints("report grid --front found");
    place.read("grid/report.html")
}

fn grid() -> Place {
    let place = Place::with(GRID);
    place.squama("run x.toml --out grid --quiet").assert().code(0);
    place
}

#[test]
fn a_front_stands_over_the_designs_of_the_grid() {
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
    // What the search holds otherwise is told; what it varies is not.
    assert!(found.contains("\"differences\":[\"scale.width_over_t 2 instead of 1\"]"), "{found}");
}

#[test]
fn a_single_best_design_stands_beside_what_is_required() {
    let html = page(&grid(), "maximize = 'coverage'");
    assert!(html.contains("\"axes\":[\"coverage\",\"slant_deg\"]"));
}

#[test]
fn a_folder_without_a_front_for_the_grid_is_refused() {
    let place = grid();
    insta::assert_snapshot!(place.refused("report grid --front grid"), @"error: --front grid: holds neither front.csv nor optimum.csv, expected a results folder of squama optimise");
    let physical =
        GOAL.replace("[goal]", "[material]\nthickness_mm = 1\nscale_density_kg_m3 = 1000\n[goal]");
    std::fs::write(place.path("goal.toml"), physical + "minimize = 'areal_mass_kg_m2'\n")
        .expect("writable");
    place.squama("optimise goal.toml --out found").assert().code(0);
    insta::assert_snapshot!(place.refused("report grid --front found"), @"error: --front found: its objective areal_mass_kg_m2 is not a column of the designs in grid, expected a sweep with the same measures and [material]");
}
