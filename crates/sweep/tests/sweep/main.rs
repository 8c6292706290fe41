//! The promises of a sweep: what is refused and how, what a grid numbers, what a table holds.

mod comparison;
mod definitions;
mod documentation;
mod fuzz;
mod grids;
mod journals;
mod ranking;
mod reference;
mod refusals;
mod tables;
mod workbooks;

#[path = "../samples/mod.rs"]
mod samples;

use sweep::Sweep;

/// The sweep that `text` defines.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}
