//! The promises of a results folder: which tables it holds, with which columns.

mod tables;

use sweep::Sweep;

/// The sweep that `text` defines.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}
