//! Error type for journals that cannot be used.

use std::path::PathBuf;

use crate::atomic_file::OutputError;

/// Error: a journal cannot be used.
///
/// Each message is one line, and states the expected input or the remedy.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// The folder already holds results.
    #[error("{}: already holds results; use --resume to continue from them, or --fresh to discard them", .0.display())]
    Exists(PathBuf),
    /// The folder holds results of another command.
    #[error("{}: holds the results of {what}; choose another folder with --out DIR", folder.display())]
    Holds {
        /// Folder.
        folder: PathBuf,
        /// Name of the results in the folder.
        what: &'static str,
    },
    /// The folder holds tables without a journal.
    #[error("{}: holds {file} without a journal; choose another folder with --out DIR, or use --fresh to delete the files that have the names of results", folder.display())]
    NoJournal {
        /// Folder.
        folder: PathBuf,
        /// Name of the first table that was found.
        file: String,
    },
    /// The folder contains no journal.
    #[error("{}: holds no journal, expected the folder of a run", .0.display())]
    Missing(PathBuf),
    /// Another process is writing to the journal.
    #[error("{}: another squama process is writing there; wait until it ends", .0.display())]
    InUse(PathBuf),
    /// The path is not a regular file.
    #[error("{}: is not a regular file, expected a journal that squama writes", .0.display())]
    NoFile(PathBuf),
    /// A line was edited, and its checksum was adapted.
    #[error("{}: {line} differs from {table}, which was written from the journal, so a line of the journal was changed; restore the journal, or solve everything again {again}", path.display())]
    Edited {
        /// Path of the journal.
        path: PathBuf,
        /// Design or point of the first changed line.
        line: String,
        /// Name of the table that was written from the journal.
        table: String,
        /// Option that solves everything again, e.g. `with --fresh`.
        again: &'static str,
    },
    /// Lines at the end of the journal are missing.
    #[error("{}: {lost}; restore them from a copy of the journal, or solve them again with squama run --resume", path.display())]
    LinesLost {
        /// Path of the journal.
        path: PathBuf,
        /// Text that states the number of missing lines and the number of expected lines.
        lost: String,
    },
    /// The journal cannot be read.
    #[error("{}: cannot be read ({reason}), expected a journal that squama writes", path.display())]
    Unreadable {
        /// Path of the journal.
        path: PathBuf,
        /// Error message of the system.
        reason: String,
    },
    /// A line before the last intact line is damaged.
    #[error("{}:{line}: damaged line ({problem}); restore the line, or remove line {line} to solve its design again", path.display())]
    Damaged {
        /// Path of the journal.
        path: PathBuf,
        /// Number of the line, from 1.
        line: u64,
        /// Description of the damage.
        problem: String,
    },
    /// The first line is damaged.
    #[error("{}:1: not the first line of a journal ({problem}); restore the line, or use --fresh to discard all results", path.display())]
    NoHeader {
        /// Path of the journal.
        path: PathBuf,
        /// Description of the damage.
        problem: String,
    },
    /// The journal has the format of another version of the program.
    #[error("{}:1: a journal of format {found}, but this squama reads format {expected}; use squama {by}, which wrote the journal, or solve everything again with --fresh or in another folder with --out DIR", path.display())]
    OtherFormat {
        /// Path of the journal.
        path: PathBuf,
        /// Format of the journal.
        found: u64,
        /// Format that this program reads.
        expected: u64,
        /// Version and revision of the program that wrote the journal.
        by: String,
    },
    /// The journal has another definition, subset of designs or program.
    #[error("{}: {difference}; expected {expected}", path.display())]
    Different {
        /// Path of the journal.
        path: PathBuf,
        /// Description of the difference.
        difference: String,
        /// Text that states the expected values or the remedy.
        expected: &'static str,
    },
    /// The journal cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}
