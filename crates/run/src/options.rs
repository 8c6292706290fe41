//! How a sweep is run, and by which program.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use results::Dialect;

/// The program that runs a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// Its version.
    pub version: &'static str,
    /// Revision of its source.
    pub revision: &'static str,
}

/// How a sweep is run.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// How many designs are solved at a time.
    pub threads: usize,
    /// How the tables are written; if nothing is said, as they were before.
    pub dialect: Option<Dialect>,
    /// Whether the first failure ends the run.
    pub fail_fast: bool,
    /// How often the tables are written while the run goes on.
    pub tables_every: Duration,
    /// Told to end the run: designs in hand are finished and the tables written.
    pub stop: &'a AtomicBool,
}
