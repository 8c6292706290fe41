//! Fits of curves from known skins.

mod fuzz;
mod recovery;
mod refusals;
mod synthetic_curves;
