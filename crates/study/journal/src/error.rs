//! Errors of journals that cannot be used.

use std::path::PathBuf;

use crate::atomic_file::OutputError;
use crate::header::FORMAT;

/// A journal that cannot be used. Each message is one line that says what would be right.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// There are results already.
    #[error("{}: already holds results; use --resume to continue from them, or --fresh to discard them", .0.display())]
    Exists(PathBuf),
    /// There are the results of another command.
    #[error("{}: holds the results of {what}; choose another folder with --out DIR", folder.display())]
    Holds {
        /// The folder.
        folder: PathBuf,
        /// A word for those results.
        what: &'static str,
    },
    /// There are tables that no journal stands behind.
    #[error("{}: holds {file} without a journal; choose another folder with --out DIR, or use --fresh to delete the files that have the names of results", folder.display())]
    NoJournal {
        /// The folder.
        folder: PathBuf,
        /// The first such file.
        file: String,
    },
    /// There is none.
    #[error("{}: holds no journal, expected the folder of a run", .0.display())]
    Missing(PathBuf),
    /// Another process writes it.
    #[error("{}: another squama is writing there; wait until it ends", .0.display())]
    InUse(PathBuf),
    /// Something else stands in the place of the journal.
    #[error("{}: is not a regular file, expected a journal that squama writes", .0.display())]
    NoFile(PathBuf),
    /// A line was changed and sealed again.
    #[error("{}: {line} is not what {table} says, which was written from it: somebody has changed one of its lines; put back the journal as it was, or solve everything again {again}", path.display())]
    Edited {
        /// The path of the journal.
        path: PathBuf,
        /// What the first such line is of.
        line: String,
        /// The table.
        table: String,
        /// How to solve everything again.
        again: &'static str,
    },
    /// Lines at the end of the journal are missing.
    #[error("{}: {lost}; restore them from a copy of the journal, or solve them again with squama run --resume", path.display())]
    LinesLost {
        /// The path of the journal.
        path: PathBuf,
        /// How many there were and are.
        lost: String,
    },
    /// The journal cannot be read.
    #[error("{}: cannot be read ({reason}), expected a journal that squama writes", path.display())]
    Unreadable {
        /// Path of the journal.
        path: PathBuf,
        /// The message of the system.
        reason: String,
    },
    /// A line before the last is not as it was written.
    #[error("{}:{line}: damaged line ({problem}); restore the line, or remove line {line} to have what it holds solved again", path.display())]
    Damaged {
        /// Path of the journal.
        path: PathBuf,
        /// Number of the line, from 1.
        line: u64,
        /// The damage.
        problem: String,
    },
    /// The first line is not as it was written.
    #[error("{}:1: not the first line of a journal ({problem}); restore it, or use --fresh to discard everything", path.display())]
    NoHeader {
        /// Path of the journal.
        path: PathBuf,
        /// The damage.
        problem: String,
    },
    /// The journal is of a format that another version of the program writes.
    #[error("{}:1: a journal of format {found}, this squama reads format {}; squama {by} wrote it and still reads it; --fresh or another folder with --out DIR solves everything again", path.display(), FORMAT)]
    OtherFormat {
        /// Path of the journal.
        path: PathBuf,
        /// The format of the journal.
        found: u64,
        /// The program that wrote it.
        by: String,
    },
    /// The journal is of another definition, another subset of the designs or another program.
    #[error("{}: {difference}; expected {expected}", path.display())]
    Different {
        /// Path of the journal.
        path: PathBuf,
        /// The difference.
        difference: String,
        /// The values that would be right.
        expected: &'static str,
    },
    /// The disk does not take it.
    #[error(transparent)]
    Output(#[from] OutputError),
}
