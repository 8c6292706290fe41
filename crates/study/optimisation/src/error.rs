//! Errors of an optimisation.

use results::OutputError;
use run::JournalError;

/// Error of an optimisation.
#[derive(Debug, thiserror::Error)]
pub enum OptimisationError {
    /// The results cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// No design has a value in a column of the goal.
    #[error("{column}: none of the {designs} designs has a number in this column")]
    NoValue {
        /// Column name.
        column: String,
        /// Number of solved designs.
        designs: usize,
    },
    /// The threads cannot be started.
    #[error("{count} threads cannot be started ({reason}), expected fewer")]
    Threads {
        /// Requested number of threads.
        count: usize,
        /// Error message of the system.
        reason: String,
    },
}
