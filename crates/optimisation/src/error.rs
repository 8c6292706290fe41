//! Errors that keep an optimisation from coming to its end.

use std::path::PathBuf;

use results::OutputError;

/// An error that keeps an optimisation from coming to its end.
#[derive(Debug, thiserror::Error)]
pub enum OptimisationError {
    /// The results cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The folder holds the results of an earlier search.
    #[error("{}: already holds results; use --resume to continue from them, --fresh to discard them, or another folder", folder.display())]
    Exists {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder is that of a run.
    #[error("{}: holds the results of a run; choose another folder", folder.display())]
    HoldsRun {
        /// The folder.
        folder: PathBuf,
    },
    /// Another process writes the journal.
    #[error("{}: another search is writing there; choose another folder", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
    },
    /// The journal is of something else.
    #[error("{}: {difference}; use --fresh to discard the results, or another --out", path.display())]
    Different {
        /// The journal.
        path: PathBuf,
        /// The difference, in words.
        difference: String,
    },
    /// The journal cannot be read.
    #[error("{}: cannot be read ({reason}), expected a journal", path.display())]
    Unreadable {
        /// The journal.
        path: PathBuf,
        /// The message of the system.
        reason: String,
    },
    /// No design has a value in a column of the goal.
    #[error("{column}: none of the {designs} designs has a number in this column")]
    NoValue {
        /// The column.
        column: String,
        /// The number of designs that were solved.
        designs: usize,
    },
    /// The threads cannot be started.
    #[error("{count} threads cannot be started ({reason}), expected fewer")]
    Threads {
        /// The number of threads that were asked for.
        count: usize,
        /// The message of the system.
        reason: String,
    },
}
