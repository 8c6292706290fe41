//! Why there is no analysis.

use results::OutputError;
use run::JournalError;

use crate::measured_columns::NoSuchColumn;

/// Why there is no analysis.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// The work was to stop. The samples so far are kept.
    #[error("interrupted after {done} of {of} samples")]
    Stopped {
        /// Samples that were solved.
        done: usize,
        /// Samples that were asked for.
        of: usize,
    },
    /// A requirement is about a column that does not exist.
    #[error(transparent)]
    NoSuchColumn(#[from] NoSuchColumn),
    /// The samples that are kept cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The disk does not take the samples.
    #[error(transparent)]
    Output(#[from] OutputError),
}
