//! The guide to the results explains every column.

use results::Column;
use uncertainty::{INDEX_COLUMNS, SOURCE_COLUMNS, TOLERANCE_COLUMNS, YIELD_COLUMNS};

fn table<R>(columns: &[Column<R>]) -> String {
    let lines: Vec<_> = columns
        .iter()
        .map(|c| format!("| `{}` | {} | {} |\n", c.name, c.unit, c.meaning))
        .collect();
    format!("| Column | Unit | Meaning |\n|---|---|---|\n{}\n", lines.concat())
}

#[test]
fn every_column_is_explained() {
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
