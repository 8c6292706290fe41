//! Error of an analysis.

use results::OutputError;
use run::JournalError;

use crate::measured_columns::NoSuchColumn;

/// Error of an analysis.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// The analysis was stopped. Solved samples are stored.
    #[error("interrupted after {done} of {of} samples")]
    Stopped {
        /// Number of solved samples.
        done: usize,
        /// Number of requested samples.
        of: usize,
    },
    /// A requirement names an unknown column.
    #[error(transparent)]
    NoSuchColumn(#[from] NoSuchColumn),
    /// Stored samples cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// Samples cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}
