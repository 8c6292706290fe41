//! Tests of fits: synthetic curves of known skins, invalid definitions and random files.

mod fuzz;
mod recovery;
mod refusals;
mod synthetic_curves;
