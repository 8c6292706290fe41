//! Crash-safe files: append-only journals, and files that are written atomically.
//!
//! Runs, searches and tolerance analyses store their results in journals of this format. A journal
//! is a file of JSON lines. Only one process at a time may append lines to a journal.
//!
//! ```text
//! header ─► {"crc":"…","journal":{format, version, revision, definition}}     the first line
//! line   ─► {"crc":"…", …}                                                    a result
//! ```
//!
//! The checksum of a result line also covers definition and program in the header. A line copied
//! from the journal of another definition or program is therefore detected as damaged.
//!
//! | Type | Role |
//! |---|---|
//! | [`Journal`] | a journal open for writing: locked, and flushed to disk once a second |
//! | [`Records`], [`read`] | content of the lines, and a function that reads it without a lock |
//! | [`JournalHeader`], [`Designs`], [`Program`] | definition, designs and program of a journal |
//! | [`Start`] | action if results exist already: refuse, continue or discard them |
//! | [`Seal`], [`Windows`] | checksum of a line, and random access to lines |
//! | [`JournalError`], [`OutputError`] | errors: unusable journals and unwritable files |
//! | [`AtomicFile`], [`write_text`] | files that appear only when complete, with their SHA-256 |

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
