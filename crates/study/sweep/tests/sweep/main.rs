//! The promises of a sweep: what is refused and how, what a grid numbers.

mod definitions;
mod fuzz;
mod grids;
mod refusals;

use sweep::Sweep;

/// The sweep that `text` defines.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}
