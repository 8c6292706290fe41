//! Copies the damaged end of a journal to another file before it is cut off.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use crate::atomic_file::OutputError;
use crate::error::JournalError;
use crate::reader::unreadable;

/// Copies all bytes of the journal at `path` after the first `length` to a new file.
///
/// The new file is in the folder of the journal. Returns a message for the user about the copy, or
/// `None` if the journal is not longer than `length` bytes.
pub(super) fn keep(path: &Path, length: u64) -> Result<Option<String>, JournalError> {
    let unread = |error: io::Error| unreadable(path, &error);
    let mut journal = File::open(path).map_err(unread)?;
    let torn = journal.metadata().map_err(unread)?.len().saturating_sub(length);
    if torn == 0 {
        return Ok(None);
    }
    journal.seek(SeekFrom::Start(length)).map_err(unread)?;
    let (mut copy, name) = create(path).map_err(|error| OutputError::file(path, &error))?;
    let copied = io::copy(&mut journal, &mut copy).and_then(|_| copy.sync_all());
    copied.map_err(|error| OutputError::file(&name, &error))?;
    Ok(Some(format!(
        "{}: {torn} damaged bytes at its end were cut off; a copy of them is in {}",
        path.display(),
        name.display()
    )))
}

/// Creates a new file `NAME.cut-N` in the folder of the journal at `path`.
fn create(path: &Path) -> io::Result<(File, PathBuf)> {
    let mut number = 1;
    loop {
        let name = path.with_extension(format!("cut-{number}"));
        match OpenOptions::new().write(true).create_new(true).open(&name) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
            opened => return opened.map(|file| (file, name)),
        }
    }
}
