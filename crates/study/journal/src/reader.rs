//! Journals that are read.

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

/// What the lines of a journal come to.
pub trait Records: Sized {
    /// The content of a line behind the first.
    type Line: Serialize + DeserializeOwned;

    /// The part of the designs that the header states.
    type Designs: Designs;

    /// The key under which the first line names the header.
    const KEY: &'static str;

    /// The records of a journal with that header at `path`, of whose lines none was read; the first takes `length` bytes.
    ///
    /// # Errors
    /// If the header makes no sense, with the problem.
    fn begin(
        header: JournalHeader<Self::Designs>,
        length: u64,
        path: &Path,
    ) -> Result<Self, String>;

    /// Takes the line that stands at these bytes of the file.
    ///
    /// # Errors
    /// If no such line belongs there, with the problem: it is then as good as damaged.
    fn take(&mut self, line: Self::Line, bytes: Range<u64>) -> Result<(), String>;

    /// The header.
    fn header(&self) -> &JournalHeader<Self::Designs>;

    /// Whether there is nothing yet that would be lost with the journal.
    fn is_empty(&self) -> bool;
}

/// Reads the journal at `path` without a claim to it: its writer may be at work. `None` if not even its first line is complete.
///
/// # Errors
/// If there is none, it cannot be read, or it is damaged.
pub fn read<R: Records>(path: &Path) -> Result<Option<R>, JournalError> {
    Ok(intact(path)?.map(|(records, _)| records))
}

/// Reads a journal from any source of bytes, said to be the file `path`; `None` if not even its first line is complete.
///
/// # Errors
/// If it cannot be read or is damaged.
pub fn read_from<R: Records>(source: impl BufRead, path: &Path) -> Result<Option<R>, JournalError> {
    Ok(intact_from(source, path)?.map(|(records, _)| records))
}

/// The records of the journal at `path`, and how many of its bytes are intact.
pub(crate) fn intact<R: Records>(path: &Path) -> Result<Option<(R, u64)>, JournalError> {
    require_file(path)?;
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    intact_from(BufReader::with_capacity(1 << 16, file), path)
}

fn intact_from<R: Records>(
    source: impl BufRead,
    path: &Path,
) -> Result<Option<(R, u64)>, JournalError> {
    let io = |error| unreadable(path, &error);
    let mut lines = Lines::new(source);
    if !lines.begin_with(BEFORE).map_err(io)? {
        let problem = "squama begins none like this".to_owned();
        return Err(JournalError::NoHeader { path: path.to_owned(), problem });
    }
    let first = lines.next().map_err(io)?;
    // A writer that was killed over the first line has left nothing that could be used.
    let Some(first) = first.filter(|bytes| bytes.ends_with(b"\n")) else { return Ok(None) };
    let mut length = first.len() as u64;
    let header = JournalHeader::read::<R>(first, path)?;
    let seal = header.seal();
    let refuse = |problem| JournalError::NoHeader { path: path.to_owned(), problem };
    let mut records = R::begin(header, length, path).map_err(refuse)?;
    let mut damage: Option<JournalError> = None;
    while let Some(bytes) = lines.next().map_err(io)? {
        let end = length + bytes.len() as u64;
        let taken = seal.read(bytes).and_then(|line| records.take(line, length..end));
        match (taken, damage.take()) {
            (Ok(()), None) => length = end,
            // Nothing after a damaged line can be trusted to be complete.
            (Ok(()), Some(damage)) => return Err(damage),
            // Damaged lines with nothing intact after them were torn by a crash, and are cut off by whoever goes on.
            (Err(_), Some(first)) => damage = Some(first),
            (Err(problem), None) => {
                let (path, line) = (path.to_owned(), lines.number());
                damage = Some(JournalError::Damaged { path, line, problem });
            }
        }
    }
    Ok(Some((records, length)))
}

/// The error of a journal at `path` that cannot be read.
fn unreadable(path: &Path, error: &io::Error) -> JournalError {
    JournalError::Unreadable { path: path.to_owned(), reason: reason(error) }
}

/// Refuses a pipe, a device or a folder in place of a journal: opening one may never return.
pub(crate) fn require_file(path: &Path) -> Result<(), JournalError> {
    match path.metadata() {
        Ok(metadata) if !metadata.is_file() => Err(JournalError::NoFile(path.to_owned())),
        _ => Ok(()),
    }
}
