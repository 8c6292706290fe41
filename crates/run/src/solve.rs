//! Solving designs: one by one, and many at a time.

pub mod evaluator;
pub mod workers;
