//! A journal that was read.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::{Path, PathBuf};

use results::{Contents, CsvFormat, DesignRow, JournalExtent, RunFolder};
use sweep::{SubsetDesigns, Sweep, reason};

use super::entry::{JournalEntry, SessionStart};
use super::error::JournalError;
use super::header::{FORMAT, JournalHeader};
use super::index::Index;
use super::lines::Lines;
use super::require_file;
use super::seal::{BEFORE, Line, Seal};
use super::windows::Windows;

/// A journal that was read: what it is of, and where its designs stand.
#[derive(Debug)]
pub struct Archive {
    path: PathBuf,
    header: JournalHeader,
    seal: Seal,
    sweep: Sweep,
    designs: SubsetDesigns,
    index: Index,
    sessions: Vec<SessionStart>,
    /// The number of reruns.
    reruns: u64,
    /// The rate of the last session.
    latest: LatestSession,
    /// Bytes that are intact.
    length: u64,
    /// Lines that are intact.
    lines: u64,
}

/// The rate of the last session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LatestSession {
    /// The number of designs that the session has finished.
    pub designs: u64,
    /// Seconds from its beginning to the last of them.
    pub seconds: f64,
}

impl Archive {
    /// Reads the journal in `folder` without a claim to it: a run may be writing it.
    ///
    /// # Errors
    /// If there is none, or it is damaged.
    pub fn open(folder: &RunFolder) -> Result<Self, JournalError> {
        let path = folder.journal();
        let missing = || JournalError::Missing { folder: folder.path().to_owned() };
        if !path.exists() {
            return Err(missing());
        }
        Self::read(&path)?.ok_or_else(missing)
    }

    /// Reads the journal at `path`; `None` if not even its first line was written.
    pub(crate) fn read(path: &Path) -> Result<Option<Self>, JournalError> {
        let unreadable = |error: io::Error| JournalError::Unreadable {
            path: path.to_owned(),
            reason: reason(&error),
        };
        require_file(path)?;
        let file = File::open(path).map_err(unreadable)?;
        Self::read_from(BufReader::with_capacity(1 << 16, file), path)
    }

    /// Reads a journal from any source of bytes, said to be the file `path`; `None` if not even its first
    /// line is complete.
    ///
    /// # Errors
    /// If it cannot be read or is damaged.
    pub fn read_from(source: impl BufRead, path: &Path) -> Result<Option<Self>, JournalError> {
        let unreadable = |error: io::Error| JournalError::Unreadable {
            path: path.to_owned(),
            reason: reason(&error),
        };
        let mut lines = Lines::new(source);
        if !lines.begin_with(BEFORE).map_err(unreadable)? {
            let problem = "squama begins none like this".to_owned();
            return Err(JournalError::NoHeader { path: path.to_owned(), problem });
        }
        let first = lines.next().map_err(unreadable)?;
        let Some(first) = first.filter(|bytes| bytes.ends_with(b"\n")) else {
            return Ok(None);
        };
        let mut archive = Self::begin(first, path)?;
        let mut tail = Tail::default();
        while let Some(bytes) = lines.next().map_err(unreadable)? {
            let length = bytes.len() as u64;
            match archive.line(bytes) {
                Ok(line) => {
                    tail.refuse(path)?;
                    archive.add(&line, length);
                }
                Err(problem) => tail.note(lines.number(), problem),
            }
        }
        Ok(Some(archive))
    }

    fn begin(bytes: &mut [u8], path: &Path) -> Result<Self, JournalError> {
        let length = bytes.len() as u64;
        let header = read_header(bytes, path)?;
        let refuse = |problem: String| JournalError::NoHeader { path: path.to_owned(), problem };
        let sweep = Sweep::parse(&header.definition, "definition", &[]);
        let sweep = sweep.map_err(|error| refuse(error.to_string()))?;
        let designs = SubsetDesigns::new(sweep.grid().len(), header.subset);
        let designs = designs.map_err(|error| refuse(error.to_string()))?;
        Ok(Self {
            path: path.to_owned(),
            seal: Seal::of(&header),
            header,
            sweep,
            designs,
            index: Index::default(),
            sessions: Vec::new(),
            reruns: 0,
            latest: LatestSession::default(),
            length,
            lines: 1,
        })
    }

    /// A line that may stand in this journal.
    fn line(&self, bytes: &mut [u8]) -> Result<Line, String> {
        let line = self.seal.read(bytes)?;
        match &line {
            Line::Design(entry) if self.position(entry).is_none() => {
                Err(format!("there is no design {} in it", entry.design))
            }
            _ => Ok(line),
        }
    }

    fn position(&self, entry: &JournalEntry) -> Option<u64> {
        self.designs.position(entry.index()?)
    }

    /// Notes a line at the end of the file.
    pub(super) fn add(&mut self, line: &Line, length: u64) {
        match line {
            Line::Header(_) => {}
            Line::Session(session) => {
                self.latest = LatestSession::default();
                self.sessions.push(session.clone());
            }
            Line::Design(entry) => {
                self.latest = LatestSession { designs: self.latest.designs + 1, seconds: entry.at };
                self.reruns = self.reruns.max(entry.rerun);
                if let Some(position) = self.position(entry) {
                    self.index.insert(position, entry.rerun, self.length);
                }
            }
        }
        self.length += length;
        self.lines += 1;
    }

    /// The header.
    pub fn header(&self) -> &JournalHeader {
        &self.header
    }

    /// The sweep that it is of.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// The designs that it is to hold when it is complete.
    pub fn designs(&self) -> &SubsetDesigns {
        &self.designs
    }

    pub(super) fn seal(&self) -> &Seal {
        &self.seal
    }

    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// The message if the journal has fewer lines than it had when the tables in `folder` were written.
    pub(crate) fn lost_lines(&self, folder: &RunFolder) -> Option<String> {
        let stated = Contents::stated_in(folder)?.journal.lines;
        let lost = stated.checked_sub(self.lines).filter(|lost| *lost > 0)?;
        Some(format!(
            "{lost} of the {stated} lines are missing that it had when its tables were written"
        ))
    }

    /// Refuses it if it has lost lines.
    pub(crate) fn require_all_lines(&self, folder: &RunFolder) -> Result<(), JournalError> {
        let path = self.path.clone();
        self.lost_lines(folder).map_or(Ok(()), |lost| Err(JournalError::LinesLost { path, lost }))
    }

    /// How far it has come.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn extent(&self) -> Result<JournalExtent, JournalError> {
        let extent = JournalExtent::of(&self.path, self.length, self.lines);
        extent.map_err(|error| self.unreadable(&error))
    }

    /// The number of designs that are done.
    pub fn done(&self) -> u64 {
        self.index.done()
    }

    /// The designs that are done, as indices of the grid, in order.
    pub(crate) fn held(&self) -> impl Iterator<Item = u64> {
        self.index.lines_that_count().map(|(position, _)| self.designs.design(position))
    }

    /// Positions of the designs that are not done.
    pub fn missing(&self) -> Vec<Range<u64>> {
        self.index.missing(self.designs.len())
    }

    /// The sessions so far.
    pub fn sessions(&self) -> &[SessionStart] {
        &self.sessions
    }

    /// The format that the last session gave to the tables.
    pub fn format(&self) -> Option<CsvFormat> {
        self.sessions.last().map(|session| session.csv)
    }

    /// The number of reruns.
    pub fn reruns(&self) -> u64 {
        self.reruns
    }

    /// The rate of the last session.
    pub fn latest(&self) -> LatestSession {
        self.latest
    }

    /// A reader of its entries.
    pub(crate) fn entries(&self) -> Result<Entries<'_>, JournalError> {
        let file = File::open(&self.path);
        let file = file.map_err(|error| self.unreadable(&error))?;
        Ok(Entries { archive: self, lines: Windows::new(file) })
    }

    /// The row that an entry gives in the tables.
    pub fn row(&self, entry: JournalEntry) -> DesignRow {
        // What was read has an index of the grid.
        let index = entry.index().unwrap_or_default();
        let grid = self.sweep.grid();
        DesignRow { number: grid.number(index), case: grid.case(index), result: entry.result }
    }

    fn unreadable(&self, error: &io::Error) -> JournalError {
        JournalError::Unreadable { path: self.path.clone(), reason: reason(error) }
    }
}

/// The header that the first line of a journal holds.
fn read_header(bytes: &mut [u8], path: &Path) -> Result<JournalHeader, JournalError> {
    let refuse = |problem: String| JournalError::NoHeader { path: path.to_owned(), problem };
    let object = Seal::default().open(bytes).map_err(refuse)?;
    if let Some(found) = Line::format_of(object).filter(|found| *found != u64::from(FORMAT)) {
        return Err(JournalError::OtherFormat { path: path.to_owned(), found });
    }
    match Line::parse(object) {
        Ok(Line::Header(header)) if header.is_sound() => Ok(header),
        Ok(_) => Err(refuse("squama writes no such line there".to_owned())),
        Err(problem) => Err(refuse(problem)),
    }
}

/// Damaged lines with nothing intact after them. They were torn by a crash, and are cut off; a
/// damaged line before an intact one is refused, because nothing after it can be trusted to be
/// complete.
#[derive(Default)]
struct Tail {
    first: Option<(u64, String)>,
}

impl Tail {
    /// Notes a damaged line.
    fn note(&mut self, line: u64, problem: String) {
        self.first.get_or_insert((line, problem));
    }

    /// Refuses the first damaged line, because an intact one follows.
    fn refuse(&mut self, path: &Path) -> Result<(), JournalError> {
        let damaged = self.first.take();
        damaged.map_or(Ok(()), |(line, problem)| {
            Err(JournalError::Damaged { path: path.to_owned(), line, problem })
        })
    }
}

/// Reads entries by where they stand.
pub(crate) struct Entries<'a> {
    archive: &'a Archive,
    lines: Windows,
}

impl Entries<'_> {
    /// The last entry of each design that is done, in the order of the designs.
    pub fn in_order(mut self) -> impl Iterator<Item = Result<JournalEntry, JournalError>> {
        let offsets = self.archive.index.lines_that_count();
        offsets.map(move |(_, offset)| self.at(offset))
    }

    /// Entries that replaced an earlier one, after that.
    pub fn replaced(
        mut self,
    ) -> impl Iterator<Item = Result<(JournalEntry, JournalEntry), JournalError>> {
        let replaced = self.archive.index.replaced();
        replaced.into_iter().map(move |line| Ok((self.at(line.old)?, self.at(line.new)?)))
    }

    /// Every entry of the design at `position`, the first one first.
    pub fn history(&mut self, position: u64) -> Result<Vec<JournalEntry>, JournalError> {
        let offsets = self.archive.index.history(position);
        offsets.into_iter().map(|offset| self.at(offset)).collect()
    }

    /// The last entry of the design at `position`.
    pub fn last(&mut self, position: u64) -> Result<Option<JournalEntry>, JournalError> {
        self.archive.index.offset(position).map(|offset| self.at(offset)).transpose()
    }

    fn at(&mut self, offset: u64) -> Result<JournalEntry, JournalError> {
        let read = self.lines.line(offset);
        let mut bytes = read.map_err(|error| self.archive.unreadable(&error))?;
        match self.archive.line(&mut bytes) {
            Ok(Line::Design(entry)) => Ok(*entry),
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
