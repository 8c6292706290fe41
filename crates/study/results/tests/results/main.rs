//! Tests of the tables of a results folder and of their columns.

mod tables;

use sweep::Sweep;

/// Parses the valid definition `text`.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}
