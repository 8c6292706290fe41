//! `squama rank` and `squama compare`: their output, files and errors.

use crate::{FEW, Place};

const TABLE: &str =
    "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,\
                     compliance,puncture_status,flexure_status
0001,0.1,0.2,0,0,1,0.1,0.5,complete,complete
0002,0.1,0.2,45,0.6,4,0.2,0.3,complete,complete
0003,0.1,1,45,0.9,2,0.25,0.1,complete,complete
0004,0.5,0.2,45,0.3,1.5,0.1,0.7,complete,complete
0005,0.5,1,45,0.25,1.25,0.3,0.2,complete,complete
0006,0.5,1,60,0.5,,,0.4,no convergence,complete
";

/// Returns a folder with the results `a`, a table without a definition.
fn place() -> Place {
    let place = Place::new();
    put(&place, "a", TABLE);
    place
}

/// Writes `table` as `designs.csv` to a new folder.
fn put(place: &Place, folder: &str, table: &str) {
    std::fs::create_dir(place.path(folder)).expect("a folder");
    std::fs::write(place.path(folder).join("designs.csv"), table).expect("writable");
}

#[test]
fn the_best_designs_are_printed() {
    let place = place();
    insta::assert_snapshot!(place.prints("rank a --top 3 --resolution 10"));
    assert_eq!(
        place.list("a"),
        "derived designs.csv pareto.csv quaternary.csv ranking.csv ranking.toml winners.csv"
    );
    insta::assert_snapshot!(place.read("a/ranking.csv"));
    insta::assert_snapshot!(place.read("a/winners.csv"));
}

/// A table in which the strongest design folds the surface long before its critical force.
const FOLDED: &str =
    "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,compliance,fold_force,sound_force
0001,0.1,0.1,75,0.5,20,0.5,0.1,5,5
0002,0.1,0.2,75,0.5,9,0.4,0.2,,9
0003,0.1,0.3,75,0.5,1,0.1,0.3,,1
";

#[test]
fn the_best_design_without_a_fold_is_listed_beside_a_folded_winner() {
    let place = Place::new();
    put(&place, "a", FOLDED);
    let printed = place.prints("rank a --weights 0,1,0,0");
    let best = printed.lines().find(|line| line.contains("  0002 ")).expect("a row");
    assert!(best.contains("best without a fold"), "{printed}");
    // Every line that lists the folded design has the mark ⚠.
    let named = printed.lines().filter(|line| line.contains("0001"));
    assert!(
        named.clone().count() > 1 && named.clone().all(|line| line.contains("0001⚠")),
        "{printed}"
    );
    assert!(!printed.contains("0002⚠") && printed.contains("⚠ the surface"), "{printed}");
    let sound = place.prints("rank a --maximize sound_force");
    assert!(!sound.contains("folds over"), "{sound}");
    let table = place.read("a/ranking.csv");
    assert_eq!(crate::table::cells(&table, "design"), ["0002", "0001", "0003"]);
    assert_eq!(crate::table::cells(&table, "sound_force"), ["9", "5", "1"]);
}

#[test]
fn tables_can_be_written_to_another_folder() {
    let place = place();
    place.prints("rank a --weights 0.4,0.3,0.2,0.1 --out b");
    assert_eq!(place.list("a"), "designs.csv");
    assert_eq!(
        place.list("b"),
        "derived pareto.csv quaternary.csv ranking.csv ranking.toml winners.csv"
    );
}

#[test]
fn one_design_is_ranked_alone() {
    let place = Place::new();
    let one: Vec<_> = TABLE.lines().take(3).collect();
    put(&place, "a", &one.join("\n"));
    insta::assert_snapshot!(place.prints("rank a --resolution 1"));
}

#[test]
fn a_new_run_removes_an_earlier_ranking() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q").assert().code(0);
    place.prints("rank results/few");
    assert!(place.list("results/few").contains("ranking.csv"));
    place.squama("run x.toml -q --set measures=coverage --fresh").assert().code(0);
    assert_eq!(
        place.list("results/few"),
        "contents.toml coverage.csv designs.csv failures.csv journal.jsonl ro-crate-metadata.json run.toml"
    );
    let message = place.refused("rank results/few");
    insta::assert_snapshot!(message, @"error: results/few/designs.csv: no design can be ranked (4: coverage is 0; 4: no critical_force), expected one with all of coverage, critical_force, penetration, compliance");
}

#[test]
fn invalid_weights_and_results_are_rejected() {
    let place = place();
    let messages = [
        "rank a --weights 0,0,0,0",
        "rank a --weights -0.5,0.5,0.5,0.5",
        "rank a --weights 1,0,0",
        "rank a --weights a,b,c,d",
        "rank a --criteria slant_deg",
        "rank a --criteria max:critical_forc",
        "rank a --criteria coverage --maximize coverage",
        "rank a --require coverage=1",
        "rank a --require puncture_status>=1",
        "rank a --scale cubic",
        "rank a --resolution 0",
        "rank a --out a/designs.csv",
        "rank b",
        "compare a b",
        "compare a a --tolerance -1",
        "compare a a --tolerance x",
    ];
    let messages = messages.map(|arguments| place.refused(arguments));
    insta::assert_snapshot!(messages.concat());
    assert_eq!(place.list("a"), "designs.csv", "nothing is written");
}

#[test]
fn designs_that_meet_all_requirements_are_ranked() {
    let place = place();
    insta::assert_snapshot!(
        place.prints("rank a --require coverage>=0.3 --require penetration<=0.2 --minimize length_over_t --maximize critical_force")
    );
    insta::assert_snapshot!(place.read("a/ranking.toml"));
    let text = place.prints("rank a --require coverage>=0.3 --minimize penetration --scale log");
    assert!(text.contains("\nBest by penetration resistance, log scale\n"), "{text}");
    assert_eq!(place.list("a"), "derived designs.csv pareto.csv ranking.csv ranking.toml");
}

#[test]
fn the_nearest_design_is_reported_if_none_meets_the_requirements() {
    let place = place();
    place.prints("rank a");
    let arguments = "rank a --require coverage>=0.8 --require critical_force>3";
    let output = place.squama(arguments).assert().code(1).get_output().stdout.clone();
    insta::assert_snapshot!(String::from_utf8(output).expect("text"));
    assert_eq!(
        place.list("a"),
        "derived designs.csv ranking.toml",
        "the earlier ranking is removed"
    );
}

#[test]
fn compare_prints_differences() {
    let place = place();
    let other = TABLE.replace("0.5,1,60,0.5,,,0.4,no convergence", "0.5,1,75,0.4,3,1,0.4,complete");
    put(&place, "b", &other.replace(",0.3,complete,complete", ",0.30003,complete,complete"));
    insta::assert_snapshot!(place.prints("compare a b"));
    assert_eq!(place.list("."), "a b", "nothing is written");
    place.prints("compare a b --out c");
    assert_eq!(place.list("c"), "compare.csv derived differences.csv");
    place.squama("compare a b --exit-code").assert().code(1);
    place.squama("compare a a --exit-code").assert().code(0);
}

#[test]
fn a_run_with_another_base_is_compared_design_by_design() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --set measures=coverage --out L").assert().code(0);
    place
        .squama("run x.toml -q --set measures=coverage --set scale.base=2L --out 2L")
        .assert()
        .code(0);
    let text = place.prints("compare L 2L");
    assert!(
        text.starts_with("L against 2L: 8 designs in both\n  scale.base  L  against 2L\n"),
        "{text}"
    );
    assert!(text.lines().any(|line| line.trim_start().starts_with("coverage  8 ")), "{text}");
}

/// Splits the output of `squama rank` into the ranking and the answer.
fn split(printed: &str) -> (String, String) {
    let (ranking, answer) = printed.split_once("\nThe best design").expect("an answer");
    (ranking.to_owned(), answer.to_owned())
}

/// The best design is solved again for the answer, although designs on a layer are slow to solve.
#[test]
fn a_ranking_on_a_layer_has_an_answer_with_warnings() {
    let place = Place::with(
        "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = [0.8, 1]\nslant_deg = 60\n\
         [substrate]\ntissue_thickness_over_t = 3\n[material]\nthickness_mm = 1\n\
         substrate_modulus_MPa = 1\nmembrane_modulus_MPa = 4.5\n",
    );
    place.squama("run x.toml -q --out x").assert().code(0);
    let printed = place.prints("rank x --require coverage>=0.2");
    let (_, answer) = printed.split_once("The best design: 0001").expect("an answer");
    assert!(answer.contains(">= 0.2, margin"), "{printed}");
    assert!(answer.contains("less than a nozzle") && answer.contains("overhang"), "{printed}");
    let record: serde_json::Value =
        serde_json::from_str(&place.prints("rank x --require coverage>=0.2 --json")).expect("JSON");
    let warnings = record["answer"]["warnings"].as_array().expect("warnings");
    for warning in warnings {
        assert!(answer.contains(warning.as_str().expect("text")), "{warning}: {answer}");
    }
    assert_eq!(record["answer"]["requirements"][0]["requirement"], "coverage >= 0.2");
}

/// The output has two main blocks: the ranking with its legend, and the answer.
#[test]
fn rank_prints_the_ranking_and_the_answer() {
    let place = place();
    let printed = place.prints("rank a --require coverage>=0.1");
    let blocks: Vec<&str> = printed.trim_end().split("\n\n").collect();
    // The first and the last block are the title and the names of the files.
    assert_eq!(blocks.len(), 4, "{printed}");
    assert!(blocks[1].starts_with("Best by") && blocks[2].starts_with("The best design: 0002"));
    assert!(blocks[1].contains("best coverage") && blocks[1].contains("pareto.csv"), "{printed}");
}

#[test]
fn tables_saved_by_spreadsheets_are_ranked() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    let (ranked, answer) = split(&place.prints("rank r"));
    assert!(answer.contains("with full coupling"), "{answer}");
    let table = place.read("r/designs.csv");
    // Use a separate folder, because a changed table in the folder of a run is rejected. The
    // separate folder has no definition, so designs cannot be solved again.
    put(&place, "s", &format!("\u{feff}{table}"));
    let (saved, answer) = split(&place.prints("rank s"));
    assert_eq!(saved, ranked.replace("r: ", "s: "), "a table with commas and a byte-order mark");
    assert!(answer.contains("critical_force") && !answer.contains("full coupling"), "{answer}");
    place.squama("run x.toml -q --out eu --csv excel-eu").assert().code(0);
    let table = place.read("eu/designs.csv");
    let without = table.trim_start_matches('\u{feff}');
    assert_ne!(without, table);
    put(&place, "own", without);
    let (saved, _) = split(&place.prints("rank own"));
    assert_eq!(
        saved,
        ranked.replace("r: ", "own: "),
        "a table with semicolons and no byte-order mark"
    );
}

#[test]
fn round_off_is_not_a_difference() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out a").assert().code(0);
    let table = place.read("a/designs.csv");
    let force = crate::table::cell(&table, "0004", "critical_force");
    let next = force.parse::<f64>().expect("a number").next_up().to_string();
    assert_ne!(force, next);
    put(&place, "b", &table.replace(force, &next));
    let text = place.prints("compare a b --exit-code");
    assert!(text.contains("\nno difference above 1e-12: "), "{text}");
    let text = place.squama("compare a b --exit-code --tolerance 0").assert().code(1);
    let text = String::from_utf8_lossy(&text.get_output().stdout).into_owned();
    assert!(text.lines().any(|line| line.trim_start().starts_with("critical_force ")), "{text}");
}

/// The best design fails a check: with full coupling its surface folds. The next design passes.
#[test]
fn the_best_design_that_passes_all_checks_is_listed() {
    let place = Place::with(
        "name = 'x'\n[designs]\ngap_over_t = [0.1, 0.2]\nlength_over_t = [0.4, 0.6]\n\
         slant_deg = [45, 60]\n[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\n\
         load_inset_over_t = 0.05\n[material]\nthickness_mm = 2\nsubstrate_modulus_MPa = 1\n",
    );
    place.squama("run x.toml -q --out x").assert().code(0);
    let printed = rank_by_force(&place, "1", "");
    assert!(printed.contains("The best design that passes all checks: 0003\n"), "{printed}");
    let row = printed.lines().find(|row| row.contains("  0003 ")).expect("a row");
    assert!(row.contains("best that passes all checks"), "{printed}");
    let (_, rejected) = printed.split_once("Best by coverage").expect("a ranking");
    assert!(rejected.lines().nth(2).is_some_and(|row| row.contains("0002✗")), "{printed}");
    assert!(printed.contains("✗ fails a check"), "{printed}");
    let printed = rank_by_force(&place, "1", "--json");
    let record: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(record["fail_checks"], serde_json::json!(["0002"]));
    assert_eq!(record["best_that_passes_checks"], "0003");
    let printed = rank_by_force(&place, "2", "");
    assert!(printed.contains("Of the first 3 designs none passes all checks."));
    assert!(!rank_by_force(&place, "0.5", "").contains('✗'), "the best design passes");
}

/// Ranks the designs with a critical force of at least `limit`, in N, and returns the output.
fn rank_by_force(place: &Place, limit: &str, format: &str) -> String {
    let requirement = format!("critical_force_N >= {limit}");
    let mut command = place.squama(&format!("rank x {format}"));
    let output = command.args(["--require", &requirement]).assert().code(0);
    String::from_utf8(output.get_output().stdout.clone()).expect("text")
}
