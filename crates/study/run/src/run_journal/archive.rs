//! A journal of a run that was read.

use std::fs::File;
use std::io::{self, BufRead};
use std::ops::Range;
use std::path::{Path, PathBuf};

use journal::{JournalError, Records, Seal, Windows};
use results::{Contents, CsvFormat, DesignRow, JournalExtent, ResultsFolder};
use sweep::{Subset, SubsetDesigns, Sweep};
use text::reason;

use super::JournalHeader;
use super::entry::{JournalEntry, Line, SessionStart};
use super::index::Index;

/// A journal that was read: its header and the offsets of its designs.
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
    /// The rate of the latest session.
    latest: LatestSession,
    /// Bytes that are intact.
    length: u64,
    /// Lines that are intact.
    lines: u64,
}

/// The rate of the latest session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LatestSession {
    /// The number of designs that the session has finished.
    pub designs: u64,
    /// Seconds from its beginning to the last of them.
    pub seconds: f64,
}

impl Records for Archive {
    type Line = Line;

    type Designs = Subset;

    const KEY: &'static str = "journal";

    fn begin(header: JournalHeader, length: u64, path: &Path) -> Result<Self, String> {
        let sweep = Sweep::parse(header.definition(), "definition", &[]);
        let sweep = sweep.map_err(|error| error.to_string())?;
        let designs = SubsetDesigns::new(sweep.grid().len(), *header.subset());
        let designs = designs.map_err(|error| error.to_string())?;
        Ok(Self {
            path: path.to_owned(),
            seal: header.seal(),
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

    fn take(&mut self, line: Line, bytes: Range<u64>) -> Result<(), String> {
        match line {
            Line::Session(session) => {
                // Only the latest session counts, because machine and threads may differ between sessions.
                self.latest = LatestSession::default();
                self.sessions.push(session);
            }
            Line::Design(entry) => {
                let position = self.position(&entry);
                let none = || format!("there is no design {} in it", entry.design);
                self.index.insert(position.ok_or_else(none)?, entry.rerun, bytes.start);
                self.latest = LatestSession { designs: self.latest.designs + 1, seconds: entry.at };
                self.reruns = self.reruns.max(entry.rerun);
            }
        }
        self.length = bytes.end;
        self.lines += 1;
        Ok(())
    }

    fn header(&self) -> &JournalHeader {
        &self.header
    }

    fn is_empty(&self) -> bool {
        self.done() == 0
    }
}

impl Archive {
    /// Reads the journal in `folder` without a claim to it: a run may be writing it.
    ///
    /// # Errors
    /// If there is none, or it is damaged.
    pub fn open(folder: &ResultsFolder) -> Result<Self, JournalError> {
        let path = folder.journal();
        // Also if the first line is torn: nothing was solved then.
        let missing = || JournalError::Missing(folder.path().to_owned());
        if !path.exists() {
            return Err(missing());
        }
        journal::read(&path)?.ok_or_else(missing)
    }

    /// Reads a journal from any source of bytes, said to be the file `path`; `None` if not even its first
    /// line is complete.
    ///
    /// # Errors
    /// If it cannot be read or is damaged.
    pub fn read_from(source: impl BufRead, path: &Path) -> Result<Option<Self>, JournalError> {
        journal::read_from(source, path)
    }

    fn position(&self, entry: &JournalEntry) -> Option<u64> {
        self.designs.position(entry.index()?)
    }

    /// The header.
    pub fn header(&self) -> &JournalHeader {
        &self.header
    }

    /// Returns the header of the journal that holds the designs of all shards.
    pub(crate) fn header_of_all_shards(&self) -> JournalHeader {
        let subset = Subset { shard: None, ..*self.header.subset() };
        self.header.clone().with_subset(subset)
    }

    /// The sweep that it is of.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// The designs that it is to hold when it is complete.
    pub fn designs(&self) -> &SubsetDesigns {
        &self.designs
    }

    /// The message if the journal has fewer lines than it had when the tables in `folder` were written.
    pub(crate) fn lost_lines(&self, folder: &ResultsFolder) -> Option<String> {
        // Only whole lines are counted: a torn one was never stated.
        let stated = Contents::stated_in(folder)?.journal.lines;
        let lost = stated.checked_sub(self.lines).filter(|lost| *lost > 0)?;
        Some(format!(
            "{lost} of the {stated} lines are missing that it had when its tables were written"
        ))
    }

    /// Whether the line that counts for the design at `position` stands among the first `bytes` bytes.
    pub(crate) fn stands_before(&self, position: u64, bytes: u64) -> bool {
        self.index.offset(position).is_some_and(|offset| offset < bytes)
    }

    /// Refuses it if it has lost lines.
    pub(crate) fn require_all_lines(&self, folder: &ResultsFolder) -> Result<(), JournalError> {
        let path = self.path.clone();
        self.lost_lines(folder).map_or(Ok(()), |lost| Err(JournalError::LinesLost { path, lost }))
    }

    /// How far it has come.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn extent(&self) -> Result<JournalExtent, JournalError> {
        let extent = JournalExtent::read(&self.path, self.length, self.lines);
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

    /// The rate of the latest session.
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
        // An index that was read lies in the grid.
        let index = entry.index().unwrap_or_default();
        let grid = self.sweep.grid();
        DesignRow { number: grid.number(index), case: grid.case(index), result: entry.result }
    }

    fn unreadable(&self, error: &io::Error) -> JournalError {
        JournalError::Unreadable { path: self.path.clone(), reason: reason(error) }
    }
}

/// Reads entries at their offsets.
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
        let problem = match self.archive.seal.read(&mut bytes) {
            Ok(Line::Design(entry)) => return Ok(*entry),
            Ok(Line::Session(_)) => "it is no design any more".to_owned(),
            Err(problem) => problem,
        };
        let reason = format!("it has changed meanwhile, {problem}");
        Err(JournalError::Unreadable { path: self.archive.path.clone(), reason })
    }
}
