//! Tests of rankings and comparisons.

mod comparison;
mod ranking;

#[path = "../../../results/tests/samples/mod.rs"]
mod samples;
