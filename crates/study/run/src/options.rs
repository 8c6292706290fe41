//! Options of a run.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use results::CsvFormat;

use crate::solve::work::WorkMeter;

/// Options of a run.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// Number of designs solved at the same time.
    pub threads: usize,
    /// Format of the tables; `None` keeps their format.
    pub format: Option<CsvFormat>,
    /// True to stop at the first failure.
    pub fail_fast: bool,
    /// Interval at which the tables are written during the run.
    pub tables_every: Duration,
    /// Set to request a stop. Started designs are finished and tables are written.
    pub stop: &'a AtomicBool,
    /// Receives the total and the completed work.
    pub work: &'a WorkMeter,
}
