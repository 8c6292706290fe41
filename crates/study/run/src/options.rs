//! Options of a run, for example its number of threads.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use results::CsvFormat;

use crate::solve::work::WorkMeter;

/// Options of a run besides its sweep and its folder.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// Number of threads; each thread solves one design at a time.
    pub threads: usize,
    /// Format of the tables; `None` keeps the format of existing tables.
    pub format: Option<CsvFormat>,
    /// True to stop at the first design that lacks a value.
    pub fail_fast: bool,
    /// Minimum interval between two updates of the tables during the run.
    pub tables_every: Duration,
    /// Set to true to stop the run: started designs are finished and the tables are written.
    pub stop: &'a AtomicBool,
    /// Meter that receives the total and the completed work.
    pub work: &'a WorkMeter,
}
