//! Tests of sweeps: refused definitions and their messages, grid numbers.

mod definitions;
mod fuzz;
mod grids;
mod named_bodies;
mod named_materials;
mod refusals;

use sweep::Sweep;

/// Parses the sweep `text`.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}
