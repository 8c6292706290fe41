//! Tests of a results folder: its tables and their columns.

mod tables;

use sweep::Sweep;

/// Parses the sweep `text`.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}
