//! Tests of sweeps: valid and refused definitions, named values, numbers of designs.

mod definitions;
mod fuzz;
mod grids;
mod named_bodies;
mod named_materials;
mod refusals;

use sweep::Sweep;

/// Parses the valid definition `text`.
fn sweep(text: &str) -> Sweep {
    Sweep::parse(text, "x.toml", &[]).expect("a valid sweep")
}
