//! Facts about a run, from its record `run.toml`.

use text::toml_source::{self, Value};

use crate::page::Fact;

/// Returns names and values of the entries of `[run]` in the text of `run.toml`.
pub fn facts(text: &str) -> Vec<Fact> {
    // An invalid record gives a workbook without facts. A page rejects such a record before this
    // call.
    let table = toml_source::parse(text, "run.toml").unwrap_or_default();
    let run = table.into_iter().find(|entry| entry.key == "run").map(|entry| entry.value);
    let Some(Value::Table(entries)) = run else { return Vec::new() };
    entries
        .into_iter()
        .map(|entry| (entry.key.replace('_', " "), value_text(entry.value)))
        .collect()
}

fn value_text(value: Value) -> String {
    match value {
        Value::Table(counts) => counts
            .iter()
            .map(|entry| format!("{} {}", entry.value, entry.key))
            .collect::<Vec<_>>()
            .join(", "),
        Value::Text(text) => text,
        value => value.to_string(),
    }
}
