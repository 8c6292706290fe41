//! Facts about a run, from its record.

use text::toml_source::{self, KeyValue, Value};

use crate::page::Fact;

/// Returns the entries of the table `run` in the text of `run.toml`.
pub fn facts(text: &str) -> Vec<Fact> {
    // Pages reject an invalid record earlier; a workbook omits the facts.
    let table = toml_source::parse(text, "run.toml").unwrap_or_default();
    let run = table.into_iter().find(|entry| entry.key == "run").map(|entry| entry.value);
    let Some(Value::Table(entries)) = run else { return Vec::new() };
    let fact = |entry: KeyValue| (entry.key.replace('_', " "), words(entry.value));
    entries.into_iter().map(fact).collect()
}

fn words(value: Value) -> String {
    match value {
        Value::Table(counts) => {
            let count = |entry: &KeyValue| format!("{} {}", entry.value, entry.key);
            counts.iter().map(count).collect::<Vec<_>>().join(", ")
        }
        Value::Text(text) => text,
        value => value.to_string(),
    }
}
