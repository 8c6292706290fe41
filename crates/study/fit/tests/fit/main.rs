//! Fits of curves from known skins.

mod recovery;
mod refusals;
mod synthetic_curves;
