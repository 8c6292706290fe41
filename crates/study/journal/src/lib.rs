//! Files that outlive whatever ends their writer: journals, to which one process at a time adds lines, and files that appear whole or
//! not at all. Runs, searches and samples are kept in journals of this one form.
//!
//! ```text
//! header ─► {"crc":"…","journal":{format, version, revision, definition}}     the first line
//! line   ─► {"crc":"…", …}                                                    sealed with the header: a line of another journal is damaged
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Journal`] | a journal that is being written: locked, appended to, forced to the disk once a second |
//! | [`Records`], [`read`] | what the lines of a journal come to, and how they are read without a claim to the file |
//! | [`JournalHeader`], [`Designs`], [`Program`], [`Start`] | what a journal is of, by which program, and what becomes of one that is there |
//! | [`Seal`], [`Windows`] | the checksum of a line, and lines read by their places |
//! | [`JournalError`], [`OutputError`] | why a journal cannot be used, why a file cannot be written; each in one line |
//! | [`AtomicFile`], [`write_text`] | files that appear when they are complete, with their SHA-256 |

mod atomic_file;
mod digest;
mod error;
mod header;
mod journal;
mod lines;
mod partial_file;
mod reader;
mod seal;
mod tail;
mod windows;

pub use atomic_file::{AtomicFile, OutputError, make_folder, read_text, sync_folder, write_text};
pub use digest::{sha256, sha256_of};
pub use error::JournalError;
pub use header::{Designs, JournalHeader, Program};
pub use journal::{Journal, Start, in_use, lock_folder, lock_journal};
pub use partial_file::exit_without_partial_files;
pub use reader::{Records, read, read_from};
pub use seal::Seal;
pub use windows::Windows;
