//! Tests of the comparison of two runs.

use ranking::{Comparison, compare, write_comparison};
use results::Results;
use tempfile::TempDir;

/// Reads results from a folder with `designs.csv` and, if a definition is given, `run.toml`.
fn results(table: &str, definition: Option<&str>) -> Results {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("designs.csv"), table).expect("writable");
    if let Some(definition) = definition {
        std::fs::write(folder.path().join("run.toml"), definition).expect("writable");
    }
    Results::read(folder.path()).expect("results")
}

const FIRST: &str = "design,gap_over_t,length_over_t,slant_deg,coverage,compliance,flexure_status
0001,0.1,1,0,0,1,complete
0002,0.1,1,45,0.5,2,complete
0003,0.2,1,0,0,4,complete
0004,0.2,1,45,0.25,,too many points";

/// Table of a second run, with another order of the axes, one more slant and other values.
const SECOND: &str = "design,gap_over_t,length_over_t,slant_deg,coverage,compliance,flexure_status
0001,0.1,1,0,0,1,complete
0002,0.2,1,0,0,5,complete
0003,0.1,1,45,0.5,,no convergence
0004,0.2,1,45,0.25,3,complete
0005,0.2,1,60,0.1,7,complete";

fn column<'c>(comparison: &'c Comparison<'_>, name: &str) -> &'c ranking::ColumnDifference {
    let column = comparison.columns.iter().find(|column| column.name == name);
    column.expect("a column of both runs")
}

#[test]
fn designs_are_matched_by_their_parameters() {
    let (first, second) = (results(FIRST, None), results(SECOND, None));
    let comparison = compare(&first, &second, 0.0).expect("comparable");
    assert_eq!(comparison.matched(), 4);
    assert_eq!(comparison.unmatched(), [vec![], vec!["0005"]]);
    assert!(column(&comparison, "coverage").has_no_differences());
    let compliance = column(&comparison, "compliance");
    assert_eq!((compliance.compared, compliance.differing), (2, 1));
    assert_eq!((compliance.only_first, compliance.only_second), (1, 1));
    let extreme = compliance.relative.as_ref().expect("a difference");
    assert_eq!((extreme.design.as_str(), extreme.difference), ("0003", 0.2));
    assert_eq!((extreme.first, extreme.second), (4.0, 5.0));
    assert_eq!(compliance.absolute.as_ref().expect("a difference").difference, 1.0);
    let changes = &column(&comparison, "flexure_status").changes;
    let changes: Vec<_> = changes.iter().map(|((a, b), n)| format!("{a} > {b}: {n}")).collect();
    assert_eq!(changes, ["complete > no convergence: 1", "too many points > complete: 1"]);
    assert!(!comparison.has_no_differences());
}

#[test]
fn a_run_equals_itself() {
    let first = results(FIRST, None);
    let comparison = compare(&first, &first, 0.0).expect("comparable");
    assert!(comparison.has_no_differences());
    assert_eq!(column(&comparison, "compliance").correlation, Some(1.0));
    assert_eq!(column(&comparison, "flexure_status").correlation, None);
}

#[test]
fn differences_within_the_tolerance_are_ignored() {
    let (first, second) = (results(FIRST, None), results(&FIRST.replace(",4,", ",4.0004,"), None));
    let differing = [0.0, 0.9e-4, 1.1e-4].map(|tolerance| {
        let comparison = compare(&first, &second, tolerance).expect("comparable");
        column(&comparison, "compliance").differing
    });
    assert_eq!(differing, [1, 1, 0]);
}

#[test]
fn changes_of_constant_parameters_are_listed() {
    let (first, second) = (
        results(FIRST, Some("name = 'x'")),
        results(FIRST, Some("name = 'y'\nscale.base = '2L'\ncontact.c1 = 2")),
    );
    let comparison = compare(&first, &second, 0.0).expect("comparable");
    let changes = comparison.parameters().iter();
    let changes: Vec<_> =
        changes.map(|c| format!("{}: {} {}", c.parameter.path(), c.first, c.second)).collect();
    assert_eq!(changes, ["scale.base: L 2L", "contact.c1: 1.1 2"]);
}

#[test]
fn an_axis_of_one_run_may_be_a_constant_of_the_other_run() {
    let wide = "design,gap_over_t,length_over_t,slant_deg,coverage,c2
0001,0.1,1,0,0,0.23
0002,0.1,1,0,0,1.1";
    let axes = "\n[designs]\ngap_over_t = 0.1\nlength_over_t = 1\nslant_deg = 0";
    let wide = results(wide, Some(&format!("name = 'x'{axes}\nc2 = [0.23, 1.1]")));
    let narrow = "design,gap_over_t,length_over_t,slant_deg,coverage\n0001,0.1,1,0,0";
    let known = results(narrow, Some(&format!("name = 'x'\ncontact.c2 = 1.1{axes}")));
    let comparison = compare(&wide, &known, 0.0).expect("comparable");
    assert_eq!(comparison.matched(), 1);
    assert_eq!(comparison.unmatched(), [vec!["0001"], vec![]]);
    // Without `run.toml`, the value of c2 in the second run is unknown.
    let message = compare(&wide, &results(narrow, None), 0.0).expect_err("ambiguous").to_string();
    let message = message.replace(&wide.folder().display().to_string(), "x");
    insta::assert_snapshot!(message, @"x/designs.csv: designs 0001 and 0002 differ only in a parameter that one of the runs does not record; each table needs its run.toml");
}

#[test]
fn tables_of_a_comparison_match_the_snapshot() {
    let (first, second) = (results(FIRST, None), results(SECOND, None));
    let comparison = compare(&first, &second, 0.0).expect("comparable");
    let folder = TempDir::new().expect("a folder");
    let files = write_comparison(folder.path(), &comparison).expect("writable");
    let tables = files.map(|file| {
        let table = std::fs::read_to_string(folder.path().join(file)).expect("a table");
        format!("{file}\n{table}\n")
    });
    insta::assert_snapshot!(tables.concat());
}

#[test]
fn designs_are_matched_up_to_round_off() {
    let first = results("design,gap_over_t,coverage\n1,0.09999999999999999,1\n2,0.3,2\n", None);
    let second = results("design,gap_over_t,coverage\n1,0.30000000000000004,2\n2,0.1,1\n", None);
    let comparison = compare(&first, &second, 1e-12).expect("comparable");
    assert_eq!((comparison.matched(), comparison.has_no_differences()), (2, true));
    let twice = results("design,gap_over_t,coverage\n1,0.1,1\n2,0.10000000000000002,2\n", None);
    let error = compare(&first, &twice, 1e-12).expect_err("equal designs");
    assert!(error.to_string().contains("designs 1 and 2"), "{error}");
}
