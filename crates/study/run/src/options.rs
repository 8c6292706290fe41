//! The options of a run.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use results::CsvFormat;

use crate::solve::work::WorkMeter;

/// The options of a run.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// The number of designs that are solved at a time.
    pub threads: usize,
    /// The format of the tables; `None` keeps the format that they have.
    pub format: Option<CsvFormat>,
    /// Whether the first failure ends the run.
    pub fail_fast: bool,
    /// The interval at which the tables are written while the run goes on.
    pub tables_every: Duration,
    /// Set to request a stop; designs already started are finished and the tables written.
    pub stop: &'a AtomicBool,
    /// Told of the work that the run has and has done.
    pub work: &'a WorkMeter,
}
