//! Tests of `squama run`: files, exit codes, and equal tables for any number of threads.

use crate::table::cell;
use crate::{FEW, Place};

/// Tables that must not depend on interruptions or on the number of threads of a run.
pub const TABLES: [&str; 6] = [
    "designs.csv",
    "coverage.csv",
    "critical_force.csv",
    "penetration.csv",
    "compliance.csv",
    "failures.csv",
];

#[test]
fn tables_are_written_to_the_folder_of_the_sweep() {
    let place = Place::with(FEW);
    place.squama("run x.toml --quiet").assert().code(0).stdout("").stderr("");
    assert_eq!(
        place.list("results/few"),
        "compliance.csv contents.toml coverage.csv critical_force.csv designs.csv failures.csv journal.jsonl \
         penetration.csv ro-crate-metadata.json run.toml"
    );
    let table = place.read("results/few/designs.csv");
    let rows: Vec<_> = table.lines().collect();
    assert!(rows[0].starts_with(
        "design,gap_over_t,length_over_t,slant_deg,coverage,critical_force,penetration,compliance,puncture_status,"
    ));
    assert_eq!(rows.len(), 1 + 8);
    assert!(rows[1].starts_with("0001,0.1,0.2,0,0,"));
    assert!(rows[8].starts_with("0008,0.5,1,45,0.4"));
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let place = Place::with(FEW);
    for threads in [1, 2, 8] {
        place
            .squama(&format!("run x.toml -q --threads {threads} --out {threads}"))
            .assert()
            .code(0);
    }
    for table in TABLES {
        let one = place.read(&format!("1/{table}"));
        assert_eq!(one, place.read(&format!("2/{table}")));
        assert_eq!(one, place.read(&format!("8/{table}")));
    }
}

#[test]
fn a_run_is_repeated_from_its_record() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --set contact.c1=0.7 --out a").assert().code(0);
    place.squama("run a/run.toml -q --out b").assert().code(0);
    for table in TABLES {
        assert_eq!(place.read(&format!("a/{table}")), place.read(&format!("b/{table}")));
    }
    let record = place.read("a/run.toml");
    let version = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    for line in ["\"complete\" = 8", "designs = 8", "failed = 0", &version, "c1 = 0.7"] {
        assert!(record.lines().any(|other| other == line), "{line} is missing in\n{record}");
    }
}

#[test]
fn designs_that_stop_early_have_a_row_and_give_exit_code_1() {
    let place = Place::with(FEW);
    place.squama("run x.toml --set solver.max_points=3").assert().code(1);
    let table = place.read("results/few/critical_force.csv");
    let row = table.lines().nth(1).expect("a row");
    assert!(row.starts_with("0001,0.1,0.2,0,,too many points,"), "{row}");
    // The largest force on the path has a value, but measures at the critical tilt have none.
    let none = ["critical_force", "critical_displacement", "secant_stiffness"];
    assert!(none.iter().all(|column| cell(&table, "0001", column).is_empty()), "{row}");
    assert!(!cell(&table, "0001", "peak_force").is_empty(), "{row}");
    assert!(place.read("results/few/run.toml").contains("\"too many points\" = 8"));
}

#[test]
fn metadata_list_every_file_and_column_and_do_not_depend_on_threads() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --threads 1 --out a").assert().code(0);
    place.squama("run x.toml -q --threads 2 --out b").assert().code(0);
    let text = place.read("a/ro-crate-metadata.json");
    assert_eq!(text, place.read("b/ro-crate-metadata.json"));
    let metadata: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let graph = metadata["@graph"].as_array().expect("entities");
    let [mut files, columns] = ["File", "PropertyValue"].map(|kind| {
        let entities = graph.iter().filter(|entity| entity["@type"] == kind);
        entities.map(|entity| entity["name"].as_str().expect("a name")).collect::<Vec<_>>()
    });
    files.push("ro-crate-metadata.json");
    files.sort_unstable();
    assert_eq!(files.join(" "), place.list("a"));
    let table = place.read("a/designs.csv");
    let header = table.lines().next().expect("a header");
    assert_eq!(columns.join(","), header);
}

#[test]
fn omitted_measures_have_empty_cells_and_no_table() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q").assert().code(0);
    place.squama("run x.toml -q --set measures=coverage --fresh").assert().code(0);
    assert_eq!(
        place.list("results/few"),
        "contents.toml coverage.csv designs.csv failures.csv journal.jsonl ro-crate-metadata.json run.toml"
    );
    let table = place.read("results/few/designs.csv");
    let row = table.lines().nth(8).expect("a row");
    assert_eq!(row.trim_end_matches(',').matches(',').count(), 4, "{row}");
    assert_eq!(
        row.matches(',').count(),
        table.lines().next().expect("a header").matches(',').count()
    );
}

#[test]
fn further_axes_have_a_column() {
    let place = Place::with(FEW);
    place
        .squama("run x.toml -q --set designs.base=[\"L\",\"2L\"] --set designs.gap_over_t=1")
        .assert()
        .code(0);
    let table = place.read("results/few/coverage.csv");
    let rows: Vec<_> = table.lines().take(4).collect();
    assert_eq!(rows[0], "design,gap_over_t,length_over_t,slant_deg,coverage,base");
    assert_eq!(rows[1], "0001,1,0.2,0,0,L");
    assert_eq!(rows[3], "0003,1,0.2,0,0,2L");
}

/// Returns the number of designs in the journal of `r`.
fn solved(place: &Place) -> usize {
    place.read("r/journal.jsonl").matches("\"design\":{").count()
}

/// `--resume` with more values on an axis keeps solved designs and gives the tables of a fresh run.
#[test]
fn a_resumed_run_reuses_the_designs_of_a_shorter_axis() {
    let place = Place::with(FEW);
    let longer = FEW.replace("[0, 45]", "{ from = 0, to = 45, step = 15 }");
    let longer = longer.replace("[0.1, 0.5]", "[0.05, 0.1, 0.5]");
    std::fs::write(place.path("longer.toml"), &longer).expect("writable");
    let list = longer.replace("{ from = 0, to = 45, step = 15 }", "[0, 15, 30, 45]");
    std::fs::write(place.path("list.toml"), list).expect("writable");
    place.squama("run x.toml -q --out r").assert().code(0);
    let message = resume(&place, "longer.toml");
    assert!(
        message.contains("8 solved designs belong to both definitions and are kept"),
        "{message}"
    );
    assert_eq!(solved(&place), 24, "the other 16 are solved");
    place.squama("run longer.toml -q --out fresh").assert().code(0);
    for table in ["designs.csv", "critical_force.csv", "compliance.csv", "failures.csv"] {
        assert_eq!(place.read(&format!("r/{table}")), place.read(&format!("fresh/{table}")));
    }
    let message = resume(&place, "list.toml");
    assert!(
        message.contains("24 solved designs belong to both definitions and are kept"),
        "{message}"
    );
    assert_eq!(solved(&place), 24, "nothing is solved again");
    assert_eq!(place.read("r/designs.csv"), place.read("fresh/designs.csv"));
    // A definition with fewer designs is rejected, because solved designs are never dropped. A
    // definition with other parameters is rejected, because its designs are different.
    assert!(place.refused("run x.toml --out r --resume").contains("has another definition"));
    let other = "run list.toml --out r --resume --set scale.width_over_t=2";
    assert!(place.refused(other).contains("has another definition"));
    assert_eq!(solved(&place), 24);
}

/// Resumes the run in `r` with another definition, and returns the messages.
fn resume(place: &Place, definition: &str) -> String {
    let run = place.squama(&format!("run {definition} -q --out r --resume")).assert().code(0);
    String::from_utf8(run.get_output().stderr.clone()).expect("text")
}
