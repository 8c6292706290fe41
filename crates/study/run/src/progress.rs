//! Progress and result of a run.

use std::time::Duration;

use journal::{JournalError, OutputError};
use sweep::{InvalidDefinition, SampleTooLarge};

use crate::tables::summary::Summary;

/// An error that ends a run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The results cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The journal cannot be opened or read, or belongs to another run.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The sample is larger than the grid.
    #[error(transparent)]
    Sample(#[from] SampleTooLarge),
    /// The settings of a rerun are not valid.
    #[error(transparent)]
    Definition(#[from] InvalidDefinition),
    /// The threads cannot be started.
    #[error("{count} threads cannot be started ({reason}), expected fewer")]
    Threads {
        /// Requested number of threads.
        count: usize,
        /// Error message of the system.
        reason: String,
    },
}

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Finished {
    /// Counts and best values of the designs.
    pub summary: Summary,
    /// Number of designs that are not solved yet.
    pub missing: u64,
    /// Duration of the session.
    pub duration: Duration,
    /// Names of the written tables.
    pub tables: Vec<String>,
    /// Messages about journal lines or files that were truncated, lost or removed.
    pub notes: Vec<String>,
}

/// Progress of a run.
#[derive(Clone, Copy, Debug)]
pub enum Progress {
    /// The run begins.
    Begun {
        /// Number of designs of the run.
        designs: u64,
        /// Number of designs that were already solved before.
        done: u64,
    },
    /// A design is solved.
    Done {
        /// True if the design lacks a requested value.
        failed: bool,
    },
}
