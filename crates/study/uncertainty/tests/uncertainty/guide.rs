//! Checks that `results/README.md` explains every column of the tables.

use results::Column;
use uncertainty::{INDEX_COLUMNS, SOURCE_COLUMNS, TOLERANCE_COLUMNS, YIELD_COLUMNS};

/// Returns the Markdown table that explains `columns`.
fn table<R>(columns: &[Column<R>]) -> String {
    let lines: Vec<_> = columns
        .iter()
        .map(|c| format!("| `{}` | {} | {} |\n", c.name, c.unit, c.meaning))
        .collect();
    format!("| Column | Unit | Meaning |\n|---|---|---|\n{}\n", lines.concat())
}

#[test]
fn guide_to_results_explains_every_column() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../results/README.md");
    let guide = std::fs::read_to_string(path).expect("the guide");
    for table in [
        table(TOLERANCE_COLUMNS),
        table(SOURCE_COLUMNS),
        table(YIELD_COLUMNS),
        table(INDEX_COLUMNS),
    ] {
        assert!(guide.contains(&table), "the guide lacks\n{table}");
    }
}
