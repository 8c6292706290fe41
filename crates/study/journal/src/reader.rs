//! Reads journals, and detects damaged lines.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use text::reason;

use crate::error::JournalError;
use crate::header::{Designs, JournalHeader};
use crate::lines::Lines;
use crate::seal::BEFORE;

/// Content of a journal. Each kind of journal implements this trait.
pub trait Records: Sized {
    /// Content of a line after the header.
    type Line: Serialize + DeserializeOwned;

    /// Type of the subset of the designs in the header.
    type Designs: Designs;

    /// Key of the header in the JSON object of the first line.
    const KEY: &'static str;

    /// Creates the records of a journal that contains only this `header`.
    ///
    /// The header occupies the first `length` bytes of the file at `path`.
    ///
    /// # Errors
    ///
    /// If the header is not valid. The error describes the problem.
    fn begin(
        header: JournalHeader<Self::Designs>,
        length: u64,
        path: &Path,
    ) -> Result<Self, String>;

    /// Adds a line, which occupies the byte range `bytes` of the file.
    ///
    /// # Errors
    ///
    /// If the line does not fit the lines before it. The error describes the problem, and the line
    /// counts as damaged.
    fn take(&mut self, line: Self::Line, bytes: Range<u64>) -> Result<(), String>;

    /// Returns the header.
    fn header(&self) -> &JournalHeader<Self::Designs>;

    /// Returns true if deleting the journal would lose no results.
    fn is_empty(&self) -> bool;
}

/// Reads the journal at `path` without a lock, so another process may write to it.
///
/// Returns `None` if the first line is incomplete.
///
/// # Errors
///
/// If the journal is missing, unreadable or damaged.
pub fn read<R: Records>(path: &Path) -> Result<Option<R>, JournalError> {
    Ok(intact(path)?.map(|(records, _)| records))
}

/// Reads a journal from a source of bytes; `path` is used in messages.
///
/// Returns `None` if the first line is incomplete.
///
/// # Errors
///
/// If the journal is unreadable or damaged.
pub fn read_from<R: Records>(source: impl BufRead, path: &Path) -> Result<Option<R>, JournalError> {
    Ok(intact_from(source, path)?.map(|(records, _)| records))
}

/// Reads the journal at `path`.
///
/// Returns the records and the length of the intact lines in bytes. Returns `None` if the first
/// line is incomplete.
pub(crate) fn intact<R: Records>(path: &Path) -> Result<Option<(R, u64)>, JournalError> {
    require_file(path)?;
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    intact_from(BufReader::with_capacity(1 << 16, file), path)
}

/// Reads a journal from `source`, like [`intact`]; `path` is used in messages.
fn intact_from<R: Records>(
    source: impl BufRead,
    path: &Path,
) -> Result<Option<(R, u64)>, JournalError> {
    let io = |error| unreadable(path, &error);
    let mut lines = Lines::new(source);
    if !lines.begin_with(BEFORE).map_err(io)? {
        let problem = "it does not begin with a checksum".to_owned();
        return Err(JournalError::NoHeader { path: path.to_owned(), problem });
    }
    let first = lines.next().map_err(io)?;
    // An incomplete first line is no error: the process was killed before it wrote any results.
    let Some(first) = first.filter(|bytes| bytes.ends_with(b"\n")) else { return Ok(None) };
    let mut length = first.len() as u64;
    let header = JournalHeader::read(first, R::KEY, path)?;
    let seal = header.seal();
    let mut records = R::begin(header, length, path)
        .map_err(|problem| JournalError::NoHeader { path: path.to_owned(), problem })?;
    let mut damage: Option<JournalError> = None;
    while let Some(bytes) = lines.next().map_err(io)? {
        let end = length + bytes.len() as u64;
        let taken = seal.read(bytes).and_then(|line| records.take(line, length..end));
        match (taken, damage.take()) {
            (Ok(()), None) => length = end,
            // An intact line follows a damaged line, so more lines may be missing between them.
            (Ok(()), Some(damage)) => return Err(damage),
            // Damaged lines at the end of the file come from a crash; the next writer cuts them
            // off.
            (Err(_), Some(first)) => damage = Some(first),
            (Err(problem), None) => {
                let (path, line) = (path.to_owned(), lines.number());
                damage = Some(JournalError::Damaged { path, line, problem });
            }
        }
    }
    Ok(Some((records, length)))
}

/// Creates the error for an unreadable journal at `path`.
pub(crate) fn unreadable(path: &Path, error: &io::Error) -> JournalError {
    JournalError::Unreadable { path: path.to_owned(), reason: reason(error) }
}

/// Refuses pipes, devices and folders, because opening a pipe may block forever.
pub(crate) fn require_file(path: &Path) -> Result<(), JournalError> {
    match path.metadata() {
        Ok(metadata) if !metadata.is_file() => Err(JournalError::NoFile(path.to_owned())),
        _ => Ok(()),
    }
}
