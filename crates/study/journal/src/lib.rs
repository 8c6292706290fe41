//! Crash-safe files: append-only journals, and files that are written atomically.
//!
//! The results of runs, searches and sampling are stored in journals of this format. One process at
//! a time appends lines.
//!
//! ```text
//! header ─► {"crc":"…","journal":{format, version, revision, definition}}     the first line
//! line   ─► {"crc":"…", …}                                                    a result
//! ```
//!
//! The checksum of a line includes the header, so lines of another journal count as damaged.
//!
//! | Type | Role |
//! |---|---|
//! | [`Journal`] | a journal open for writing: locked, and synchronised once a second |
//! | [`Records`], [`read`] | content of the lines, and reading without a lock |
//! | [`JournalHeader`], [`Designs`], [`Program`] | definition, designs and program of a journal |
//! | [`Start`] | treatment of an existing journal |
//! | [`Seal`], [`Windows`] | checksum of a line, and random access to lines |
//! | [`JournalError`], [`OutputError`] | unusable journals and unwritable files |
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
