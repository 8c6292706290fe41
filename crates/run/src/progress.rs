//! What a run tells while it goes on, and what it comes to.

use std::time::Duration;

use results::OutputError;
use sweep::{InvalidDefinition, SampleTooLarge};

use crate::journal::{Entry, JournalError};
use crate::tables::summary::Summary;

/// A sweep that cannot run to its end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The results cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The subset is larger than the grid.
    #[error(transparent)]
    Sample(#[from] SampleTooLarge),
    /// The settings of a re-run are not right.
    #[error(transparent)]
    Definition(#[from] InvalidDefinition),
    /// The threads cannot be started.
    #[error("{count} threads cannot be started ({reason}), expected fewer")]
    Threads {
        /// How many.
        count: usize,
        /// What the system says.
        reason: String,
    },
}

/// A run that came to its end.
#[derive(Clone, Debug)]
pub struct Finished {
    /// What it comes to.
    pub summary: Summary,
    /// How many designs are not done.
    pub missing: u64,
    /// How long it took.
    pub duration: Duration,
    /// Names of the tables.
    pub tables: Vec<String>,
}

/// What a run tells while it goes on.
#[derive(Clone, Copy, Debug)]
pub enum News<'a> {
    /// It begins.
    Begun {
        /// How many designs there are.
        designs: u64,
        /// How many of them are done.
        done: u64,
    },
    /// A design is done.
    Done(&'a Entry),
}
