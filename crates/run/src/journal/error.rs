//! Why a journal cannot be used.

use std::path::{Path, PathBuf};

use super::Start;
use results::OutputError;

/// A journal that cannot be used. Each message is one line that says what would be right.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// There are results already.
    #[error("{}: holds results already, expected --resume to go on with them or --fresh to throw them away", folder.display())]
    Exists {
        /// Where.
        folder: PathBuf,
    },
    /// There are tables that no journal stands behind.
    #[error("{}: holds tables without a journal, expected --fresh to throw them away or another folder with --out DIR", folder.display())]
    NoJournal {
        /// Where.
        folder: PathBuf,
    },
    /// There is none.
    #[error("{}: holds no journal, expected the folder of a run", folder.display())]
    Missing {
        /// Where.
        folder: PathBuf,
    },
    /// Another process writes it.
    #[error("{}: another squama is writing there, expected one at a time", folder.display())]
    InUse {
        /// Where.
        folder: PathBuf,
    },
    /// It cannot be read.
    #[error("{}: cannot be read ({reason}), expected the journal of a run", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// A line before the last is not as it was written.
    #[error("{}:{line}: damaged line ({problem}), expected it as it was written; remove line {line} to have its design solved again", path.display())]
    Damaged {
        /// Which file.
        path: PathBuf,
        /// Which line, from 1.
        line: u64,
        /// What is wrong with it.
        problem: String,
    },
    /// The first line is not as it was written.
    #[error("{}:1: not the first line of a journal ({problem}), expected it as it was written, or --fresh to throw all of it away", path.display())]
    NoHeader {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// It is of another definition, another part of the designs or another program.
    #[error("{}: {difference}; expected {expected}", path.display())]
    Different {
        /// Which file.
        path: PathBuf,
        /// In what.
        difference: String,
        /// What would be right.
        expected: &'static str,
    },
    /// The disk does not take it.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl JournalError {
    pub(super) fn exists(folder: &Path, start: Start) -> Self {
        let folder = folder.to_owned();
        if start == Start::New { Self::Exists { folder } } else { Self::NoJournal { folder } }
    }
}
