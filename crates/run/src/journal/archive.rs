//! What a journal holds.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::{Path, PathBuf};

use results::RunFolder;
use sweep::{Selection, Sweep, reason};

use super::entry::{Entry, Session};
use super::error::JournalError;
use super::header::Header;
use super::index::Index;
use super::seal::{Line, Seal};

/// A journal that was read: what it is of, and where its designs stand.
#[derive(Debug)]
pub struct Archive {
    path: PathBuf,
    header: Header,
    seal: Seal,
    sweep: Sweep,
    selection: Selection,
    index: Index,
    sessions: Vec<Session>,
    /// How many re-runs there were.
    reruns: u64,
    /// What is known of the last session.
    latest: Latest,
    /// Bytes that are intact.
    length: u64,
}

/// What is known of the last session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Latest {
    /// How many designs it has finished.
    pub designs: u64,
    /// Seconds from its beginning to the last of them.
    pub seconds: f64,
}

impl Archive {
    /// What the journal in `folder` holds, without a claim to it: a run may be writing it.
    ///
    /// # Errors
    /// If there is none, or it is damaged.
    pub fn open(folder: &Path) -> Result<Self, JournalError> {
        let path = folder.join(RunFolder::JOURNAL);
        let missing = || JournalError::Missing { folder: folder.to_owned() };
        if !path.exists() {
            return Err(missing());
        }
        Self::read(&path)?.ok_or_else(missing)
    }

    /// What the journal at `path` holds; `None` if not even its first line was written.
    pub(crate) fn read(path: &Path) -> Result<Option<Self>, JournalError> {
        let unreadable = |error: io::Error| JournalError::Unreadable {
            path: path.to_owned(),
            reason: reason(&error),
        };
        let file = File::open(path).map_err(unreadable)?;
        Self::read_from(BufReader::with_capacity(1 << 16, file), path)
    }

    /// What stands in any source of bytes, said to be the file `path`.
    ///
    /// # Errors
    /// If it cannot be read or is damaged.
    pub fn read_from(mut source: impl BufRead, path: &Path) -> Result<Option<Self>, JournalError> {
        let unreadable = |error: io::Error| JournalError::Unreadable {
            path: path.to_owned(),
            reason: reason(&error),
        };
        let mut bytes = Vec::new();
        source.read_until(b'\n', &mut bytes).map_err(unreadable)?;
        if !bytes.ends_with(b"\n") {
            return Ok(None);
        }
        let mut archive = Self::begin(&mut bytes, path)?;
        let mut damage = None;
        for line in 2.. {
            bytes.clear();
            if source.read_until(b'\n', &mut bytes).map_err(unreadable)? == 0 {
                break;
            }
            let length = bytes.len() as u64;
            match (archive.line(&mut bytes), damage.take()) {
                (Ok(line), None) => archive.add(&line, length),
                // What is damaged at the end was torn by a crash.
                (Err(problem), None) => damage = Some((line, problem)),
                (Err(_), earlier) => damage = earlier,
                (Ok(_), Some((line, problem))) => {
                    return Err(JournalError::Damaged { path: path.to_owned(), line, problem });
                }
            }
        }
        Ok(Some(archive))
    }

    fn begin(bytes: &mut [u8], path: &Path) -> Result<Self, JournalError> {
        let length = bytes.len() as u64;
        let refuse = |problem: String| JournalError::NoHeader { path: path.to_owned(), problem };
        let header = match Seal::default().read(bytes) {
            Ok(Line::Header(header)) if header.is_sound() => header,
            Ok(_) => return Err(refuse("it is none that this program writes".to_owned())),
            Err(problem) => return Err(refuse(problem)),
        };
        let sweep = Sweep::parse(&header.definition, "definition", &[]);
        let sweep = sweep.map_err(|error| refuse(error.to_string()))?;
        let selection = Selection::new(sweep.grid().len(), header.part);
        let selection = selection.map_err(|error| refuse(error.to_string()))?;
        Ok(Self {
            path: path.to_owned(),
            seal: Seal::of(&header),
            header,
            sweep,
            selection,
            index: Index::default(),
            sessions: Vec::new(),
            reruns: 0,
            latest: Latest::default(),
            length,
        })
    }

    /// A line that may stand in this journal.
    fn line(&self, bytes: &mut [u8]) -> Result<Line, String> {
        let line = self.seal.read(bytes)?;
        let Line::Design(entry) = &line else { return Ok(line) };
        let cells = results::row::cells(&entry.row).count();
        if self.position(entry).is_none() {
            return Err(format!("there is no design {} in it", entry.design));
        }
        if cells != self.header.columns.len() {
            return Err(format!("{cells} cells instead of {}", self.header.columns.len()));
        }
        Ok(line)
    }

    fn position(&self, entry: &Entry) -> Option<u64> {
        self.selection.position(entry.index()?)
    }

    /// Notes a line at the end of the file.
    pub(super) fn add(&mut self, line: &Line, length: u64) {
        match line {
            Line::Header(_) => {}
            Line::Session(session) => {
                self.latest = Latest::default();
                self.sessions.push(session.clone());
            }
            Line::Design(entry) => {
                self.latest = Latest { designs: self.latest.designs + 1, seconds: entry.at };
                self.reruns = self.reruns.max(entry.rerun);
                if let Some(position) = self.position(entry) {
                    self.index.insert(position, self.length);
                }
            }
        }
        self.length += length;
    }

    /// What it is of.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The sweep that it is of.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// The designs that it is to hold.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    pub(super) fn seal(&self) -> &Seal {
        &self.seal
    }

    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// How many designs are done.
    pub fn done(&self) -> u64 {
        self.index.done()
    }

    /// Positions of the designs that are not done.
    pub fn missing(&self) -> Vec<Range<u64>> {
        self.index.missing(self.selection.len())
    }

    /// The sessions so far.
    pub fn sessions(&self) -> &[Session] {
        &self.sessions
    }

    /// How many re-runs there were.
    pub fn reruns(&self) -> u64 {
        self.reruns
    }

    /// What is known of the last session.
    pub fn latest(&self) -> Latest {
        self.latest
    }

    /// A reader of its entries.
    pub(crate) fn entries(&self) -> Result<Entries<'_>, JournalError> {
        let file = File::open(&self.path);
        let file = file.map_err(|error| self.unreadable(&error))?;
        Ok(Entries { archive: self, file: BufReader::with_capacity(1 << 16, file), at: 0 })
    }

    fn unreadable(&self, error: &io::Error) -> JournalError {
        JournalError::Unreadable { path: self.path.clone(), reason: reason(error) }
    }
}

/// Reads entries by where they stand.
pub(crate) struct Entries<'a> {
    archive: &'a Archive,
    file: BufReader<File>,
    at: u64,
}

impl Entries<'_> {
    /// The last entry of each design that is done, in the order of the designs.
    pub fn in_order(mut self) -> impl Iterator<Item = Result<Entry, JournalError>> {
        self.archive.index.offsets().map(move |offset| self.at(offset))
    }

    /// Entries that replaced an earlier one, after that.
    pub fn replaced(mut self) -> impl Iterator<Item = Result<(Entry, Entry), JournalError>> {
        let replaced = self.archive.index.replaced();
        replaced.into_iter().map(move |line| Ok((self.at(line.old)?, self.at(line.new)?)))
    }

    /// Every entry of the design at `position`, the first one first.
    pub fn history(&mut self, position: u64) -> Result<Vec<Entry>, JournalError> {
        let index = &self.archive.index;
        let replaced = index.replaced().into_iter().filter(|line| line.position == position);
        let earlier = replaced.map(|line| line.old);
        let offsets: Vec<_> = earlier.chain(index.offset(position)).collect();
        offsets.into_iter().map(|offset| self.at(offset)).collect()
    }

    /// The last entry of the design at `position`.
    pub fn last(&mut self, position: u64) -> Result<Option<Entry>, JournalError> {
        self.archive.index.offset(position).map(|offset| self.at(offset)).transpose()
    }

    fn at(&mut self, offset: u64) -> Result<Entry, JournalError> {
        let mut bytes = Vec::new();
        let read = self
            .file
            .seek_relative(offset.cast_signed() - self.at.cast_signed())
            .and_then(|()| self.file.read_until(b'\n', &mut bytes));
        read.map_err(|error| self.archive.unreadable(&error))?;
        self.at = offset + bytes.len() as u64;
        match self.archive.line(&mut bytes) {
            Ok(Line::Design(entry)) => Ok(entry),
            Ok(_) => Err(self.changed("it is no design any more")),
            Err(problem) => Err(self.changed(&problem)),
        }
    }

    /// The file is not as it was when it was read first.
    fn changed(&self, problem: &str) -> JournalError {
        let reason = format!("it has changed meanwhile, {problem}");
        JournalError::Unreadable { path: self.archive.path.clone(), reason }
    }
}
