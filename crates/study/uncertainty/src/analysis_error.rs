//! Error of a tolerance or global sensitivity analysis.

use results::OutputError;
use run::JournalError;

use crate::measured_columns::NoSuchColumn;

/// Error of a tolerance or global sensitivity analysis.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// The analysis was stopped. Samples solved so far are stored.
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
    /// The journal of samples cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A file of samples cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}
