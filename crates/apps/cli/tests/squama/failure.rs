//! Failure modes in the output of the commands.

use std::path::Path;

use serde_json::Value;

use crate::table::cells;
use crate::{FEW, Place};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../..");

/// Material strengths and a tolerance, to append to a sweep.
const JUDGED: &str = "[array]\nacross = true\n[material]\nthickness_mm = 2\nscale = 'PLA'\n\
                      tissue = 'polyurethane'\nmembrane_modulus_MPa = 4.5\n[tolerance]\n\
                      gap_mm = { batch_sd = 0.01 }\n";

/// Parses a text as JSON.
fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// Returns the measure `name` in the JSON output of `squama design`.
fn number(json: &Value, name: &str) -> f64 {
    json["measures"][name].as_f64().expect("a number")
}

#[test]
fn outputs_with_a_failure_force_name_the_failure_mode() {
    let place = Place::with(&format!("{FEW}{JUDGED}"));
    place.squama("run x.toml -q --out r").assert().code(0);
    let table = place.read("r/designs.csv");
    let first = cells(&table, "first_failure")[0].to_owned();
    let modes = "Failure modes judged: tilt, fold, break, bend, debond, across\nNot judged: ";

    let rank = "rank r --maximize failure_force_N --require coverage>=0";
    let text = place.prints(rank);
    assert!(text.contains(modes) && text.contains("failure_force_N  first_failure"), "{text}");
    let ranked = json(&place.prints(&format!("{rank} --json")));
    let best = &ranked["best"][0];
    let row = cells(&table, "design").iter().position(|number| *number == best["design"]);
    let expected = cells(&table, "first_failure")[row.expect("a design")].to_owned();
    assert_eq!(best["values"]["first_failure"], expected.as_str());
    assert_eq!(ranked["failure_modes"]["across"], Value::Null);
    // A ranking without the failure force does not name failure modes.
    assert!(!place.prints("rank r --maximize coverage").contains("Failure modes"));

    // A map has a coloured cell for every design with a failure mode, and a legend of the modes.
    let map = "plot map r --x gap_over_t --y slant_deg --of first_failure --at length_over_t=1";
    place.squama(&format!("{map} --out f")).assert().code(0);
    let map = "f/map-of-first-failure-over-gap-over-t-and-slant-deg-length-over-t-1.svg";
    let map = place.read(map);
    let lengths = cells(&table, "length_over_t");
    let firsts = cells(&table, "first_failure");
    let drawn =
        lengths.iter().zip(&firsts).filter(|(length, mode)| **length == "1" && !mode.is_empty());
    assert_eq!(map.matches("data-design").count(), drawn.clone().count());
    assert!(drawn.into_iter().all(|(_, mode)| map.contains(&format!(">{mode}<"))), "{map}");
    place.squama("plot r --out f").assert().code(0);
    assert!(place.path("f/first-failure-by-gap-slant.svg").is_file());

    let tolerance = "tolerance x.toml --design 1 --samples 0 --out t";
    let text = place.prints(tolerance);
    let line = format!("First failure of the nominal design: {first}\n\n{modes}");
    assert!(text.contains(&line) && text.contains("failure_force_N  "), "{text}");
    let text = place.prints("make x.toml --design 1 --out skin.stl");
    assert!(
        text.contains(&format!("First failure: {first}, at ")) && text.contains(modes),
        "{text}"
    );
    let text = place.prints("check x.toml");
    assert!(text.contains("failure modes  tilt, fold, break, bend, debond, across\n"), "{text}");
    place.squama("report r").assert().code(0);
    let page = place.read("r/report.html");
    assert!(page.contains("\"failure_force_N\":\"first_failure\""));
    assert!(page.contains("not judged: the needle is not guided"));
}

/// The figure states the mode and the force of the first failure, as in `designs.csv`.
#[test]
fn curves_mark_the_failure_limits_of_a_design() {
    let weak = "scale_modulus_MPa = 3000\nscale_strength_MPa = 0.15";
    let judged = JUDGED.replace("scale = 'PLA'", weak);
    let place = Place::with(&format!("{FEW}{judged}"));
    place.squama("run x.toml -q --out r").assert().code(0);
    let table = place.read("r/designs.csv");
    let (modes, forces) = (cells(&table, "first_failure"), cells(&table, "failure_force_N"));
    let mut seen = Vec::new();
    for (row, (mode, force)) in modes.iter().zip(&forces).enumerate() {
        place.squama(&format!("plot curves x.toml --design {} --out c", row + 1)).assert().code(0);
        let figure = format!("c/force-displacement-curves-of-{:04}.svg", row + 1);
        let figure = place.read(&figure);
        let Ok(force) = force.parse::<f64>() else {
            assert!(!figure.contains("font-weight=\"bold\"><tspan"), "{figure}");
            continue;
        };
        // The figure states the force with three significant digits.
        let force = format!("{force:.*}", (2.0 - force.log10().floor()).max(0.0) as usize);
        assert!(figure.contains(&format!(">{mode} {force}<")), "{mode} {force} {figure}");
        seen.push((*mode).to_owned());
        let limits = figure.matches("class=\"limit\"").count();
        assert!(limits + figure.matches("class=\"level\"").count() > 0, "{figure}");
    }
    assert!(["break", "tilt"].iter().all(|mode| seen.iter().any(|s| s == mode)), "{seen:?}");
    // With `--to` the path continues beyond the critical tilt, and the limits are still marked.
    place.squama("plot curves x.toml --design 4 --to 0.3 --out c").assert().code(0);
    let figure = place.read("c/force-displacement-curves-to-u-0.3-of-0004.svg");
    assert!(figure.contains("dots: limits of failure, the first one bold"), "{figure}");
    // A design without strengths has no limits to mark.
    let place = Place::with(FEW);
    place.squama("plot curves x.toml --design 4 --out c").assert().code(0);
    let figure = place.read("c/force-displacement-curves-of-0004.svg");
    assert!(!figure.contains("class=\"limits\""), "{figure}");
}

/// Solves the optimum of the goal for a strong skin again, and checks every failure mode.
#[test]
fn the_recommended_skin_fails_in_no_mode_below_its_failure_force() {
    let place = Place::new();
    let goal = Path::new(ROOT).join("sweeps/goals/strong-under-a-needle.toml");
    let goal = goal.display();
    let search = format!("optimise {goal} --out found --set goal.samples=16");
    let text = place.prints(&search);
    assert!(text.contains("first_failure    across\n"), "{text}");

    let solved = json(&place.prints("design found/optimum.toml --design 1 --json"));
    let force = number(&solved, "failure_force_N");
    // The row across fails first: along the row, the critical tilt needs a larger force, and the
    // stresses stay below the strengths.
    assert!(number(&solved, "critical_force_N") > force);
    assert!(number(&solved, "scale_stress_max_MPa") < 50.0);
    assert!(number(&solved, "bond_stress_max_MPa") < 0.3);
    let length =
        number(&json(&place.prints("design found/optimum.toml --design 1 --json")), "length_mm");
    // The limit of the mode `bend` is a tip rotation of 5°. The tip of a cantilever under an end
    // load rotates by 1.5 times the angle of its chord.
    assert!(number(&solved, "scale_deflection_max_mm") < length * 5.0_f64.to_radians() / 1.5);
    assert_eq!(solved["measures"]["fold_force"], Value::Null);

    // Solve the row across as a design of its own: a row of upright blocks.
    let gap = solved["parameters"]["designs.gap_over_t"].as_f64().expect("a gap");
    let base = solved["parameters"]["designs.length_over_t"].as_f64().expect("a length");
    let across = format!(
        "design found/optimum.toml --json --gap {gap} --length 1 --slant 0 --set scale.width_over_t={base} \
         --set array.across=false --out across"
    );
    let across = json(&place.prints(&across));
    assert!((number(&across, "critical_force_N") / force - 1.0).abs() < 1e-6, "{across} {force}");
}

/// Runs the commands of `docs/failure.md`, and compares the values on the page with the results.
#[test]
fn the_page_on_failure_quotes_values_of_its_commands() {
    let page = std::fs::read_to_string(Path::new(ROOT).join("docs/failure.md")).expect("a page");
    let place = Place::new();
    std::fs::create_dir(place.path("sweeps")).expect("a folder");
    let name = "sweeps/first-failure.toml";
    std::fs::copy(Path::new(ROOT).join(name), place.path(name)).expect("a copy");
    let blocks: Vec<&str> = page.split("```").collect();
    let printed = output_of_commands(&place, &blocks);
    let quoted = blocks.iter().filter_map(|block| block.strip_prefix("text\n"));
    let quoted: Vec<&str> = quoted.flat_map(str::lines).filter(|line| !line.is_empty()).collect();
    assert!(quoted.len() > 5, "{quoted:?}");
    for line in quoted {
        assert!(printed.contains(line), "{line}\n{printed}");
    }
    assert_strongest_skins(&place, &page);
    assert_first_failures_by_slant(&place, &page);
}

/// Runs the commands in the shell blocks of a page, and returns their joined output.
fn output_of_commands(place: &Place, blocks: &[&str]) -> String {
    let mut printed = String::new();
    for line in blocks.iter().filter_map(|block| block.strip_prefix("sh\n")).flat_map(str::lines) {
        let Some(arguments) = line.strip_prefix("squama ") else { continue };
        let arguments: Vec<String> =
            arguments.split(' ').map(|word| word.trim_matches('\'').to_owned()).collect();
        // `squama run` reports failed designs: upright scales that are pushed straight down have no
        // critical force.
        let code = i32::from(arguments[0] == "run");
        let output = place.squama_with(&arguments).assert().code(code).get_output().stdout.clone();
        printed.push_str(&String::from_utf8_lossy(&output));
    }
    printed
}

/// Compares the 20 skins with the largest critical force and the 20 with the largest failure force.
///
/// The page must quote the median of failure force divided by critical force.
fn assert_strongest_skins(place: &Place, page: &str) {
    let table = place.read("results/first-failure/designs.csv");
    let modes = cells(&table, "first_failure");
    let forces = ["critical_force", "failure_force"].map(|column| -> Vec<f64> {
        cells(&table, &format!("{column}_N"))
            .iter()
            .map(|cell| cell.parse().unwrap_or(0.0))
            .collect()
    });
    let strongest = forces.each_ref().map(|forces| {
        let mut rows: Vec<usize> = (0..forces.len()).collect();
        rows.sort_by(|a, b| forces[*b].total_cmp(&forces[*a]));
        rows.truncate(20);
        rows
    });
    let [by_tilt, by_failure] = &strongest;
    let counted =
        ["across", "bend"].map(|mode| by_tilt.iter().filter(|row| modes[**row] == mode).count());
    let common = by_tilt.iter().filter(|row| by_failure.contains(row)).count();
    assert_eq!((counted[0], counted[1], common), (11, 9, 4));
    let mut ratios: Vec<f64> =
        by_tilt.iter().map(|row| forces[1][*row] / forces[0][*row]).collect();
    ratios.sort_by(f64::total_cmp);
    let median = 50.0 * (ratios[9] + ratios[10]);
    assert!(page.contains(&format!("{median:.1} %")), "{median}");
}

/// Checks the table of the page that counts the skins by first failure, slant and width.
fn assert_first_failures_by_slant(place: &Place, page: &str) {
    for (folder, title) in [("first-failure", "width `t`"), ("wide", "width `3 t`")] {
        let table = place.read(&format!("results/{folder}/designs.csv"));
        let (slants, modes) = (cells(&table, "slant_deg"), cells(&table, "first_failure"));
        for slant in ["0", "15", "30", "45", "60", "75"] {
            let counts = ["tilt", "across", "bend", ""].map(|mode| {
                let matching =
                    slants.iter().zip(&modes).filter(|(s, m)| **s == slant && **m == mode);
                matching.count().to_string()
            });
            assert_eq!(
                counts.iter().map(|n| n.parse::<usize>().expect("a number")).sum::<usize>(),
                120
            );
            let row = format!("| {title}, {slant}° | {} |", counts.join(" | "));
            assert!(page.contains(&row), "{row}");
        }
    }
}
