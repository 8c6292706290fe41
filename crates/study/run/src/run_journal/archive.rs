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
    /// Number of reruns.
    reruns: u64,
    /// Rate of the latest session.
    latest: LatestSession,
    /// Number of intact bytes.
    length: u64,
    /// Number of intact lines.
    lines: u64,
}

/// Rate of the latest session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LatestSession {
    /// Number of designs finished in the session.
    pub designs: u64,
    /// Seconds from the start of the session to its last finished design.
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
                // Only the latest session counts, because machine and threads may differ between
                // sessions.
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
    /// Reads the journal in `folder` without a lock; a run may be writing to it.
    ///
    /// # Errors
    ///
    /// If there is none, or it is damaged.
    pub fn open(folder: &ResultsFolder) -> Result<Self, JournalError> {
        let path = folder.journal();
        // Also missing if the first line is torn, because no design was solved then.
        let missing = || JournalError::Missing(folder.path().to_owned());
        if !path.exists() {
            return Err(missing());
        }
        journal::read(&path)?.ok_or_else(missing)
    }

    /// Reads a journal from `source`; `path` is used in messages.
    ///
    /// Returns `None` if the first line is incomplete.
    ///
    /// # Errors
    ///
    /// If it cannot be read or is damaged.
    pub fn read_from(source: impl BufRead, path: &Path) -> Result<Option<Self>, JournalError> {
        journal::read_from(source, path)
    }

    fn position(&self, entry: &JournalEntry) -> Option<u64> {
        self.designs.position(entry.index()?)
    }

    /// Returns the header.
    pub fn header(&self) -> &JournalHeader {
        &self.header
    }

    /// Returns the header of the journal that holds the designs of all shards.
    pub(crate) fn header_of_all_shards(&self) -> JournalHeader {
        let subset = Subset { shard: None, ..*self.header.subset() };
        self.header.clone().with_subset(subset)
    }

    /// Returns the sweep.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// Returns all designs of the run, finished or not.
    pub fn designs(&self) -> &SubsetDesigns {
        &self.designs
    }

    /// Describes missing lines, compared to the tables in `folder`.
    ///
    /// `None` if the journal has all lines that it had when these tables were written.
    pub(crate) fn lost_lines(&self, folder: &ResultsFolder) -> Option<String> {
        // Tables state the number of whole lines; torn lines do not count.
        let stated = Contents::stated_in(folder)?.journal.lines;
        let lost = stated.checked_sub(self.lines).filter(|lost| *lost > 0)?;
        Some(format!("{lost} of the {stated} lines from which the tables were written are missing"))
    }

    /// Returns true if the valid line of a design is in the first `bytes` bytes.
    pub(crate) fn is_before(&self, position: u64, bytes: u64) -> bool {
        self.index.offset(position).is_some_and(|offset| offset < bytes)
    }

    /// Returns an error if lines are missing.
    pub(crate) fn require_all_lines(&self, folder: &ResultsFolder) -> Result<(), JournalError> {
        let path = self.path.clone();
        self.lost_lines(folder).map_or(Ok(()), |lost| Err(JournalError::LinesLost { path, lost }))
    }

    /// Returns the extent of the journal.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn extent(&self) -> Result<JournalExtent, JournalError> {
        let extent = JournalExtent::read(&self.path, self.length, self.lines);
        extent.map_err(|error| self.unreadable(&error))
    }

    /// Returns the number of finished designs.
    pub fn done(&self) -> u64 {
        self.index.done()
    }

    /// Returns the finished designs in order, as indices of the grid.
    pub(crate) fn finished(&self) -> impl Iterator<Item = u64> {
        self.index.valid_lines().map(|(position, _)| self.designs.design(position))
    }

    /// Returns the positions of designs that are not finished.
    pub fn missing(&self) -> Vec<Range<u64>> {
        self.index.missing(self.designs.len())
    }

    /// Returns all sessions.
    pub fn sessions(&self) -> &[SessionStart] {
        &self.sessions
    }

    /// Returns the format of the tables in the last session.
    pub fn format(&self) -> Option<CsvFormat> {
        self.sessions.last().map(|session| session.csv)
    }

    /// Returns the number of reruns.
    pub fn reruns(&self) -> u64 {
        self.reruns
    }

    /// Returns the rate of the latest session.
    pub fn latest(&self) -> LatestSession {
        self.latest
    }

    /// Creates a reader of the entries.
    pub(crate) fn entries(&self) -> Result<Entries<'_>, JournalError> {
        let file = File::open(&self.path);
        let file = file.map_err(|error| self.unreadable(&error))?;
        Ok(Entries { archive: self, lines: Windows::new(file) })
    }

    /// Returns the row of an entry.
    pub fn row(&self, entry: JournalEntry) -> DesignRow {
        // Entries were checked to be in the grid when the journal was read.
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
    /// Returns the latest entry of each finished design, in order.
    pub fn in_order(mut self) -> impl Iterator<Item = Result<JournalEntry, JournalError>> {
        let offsets = self.archive.index.valid_lines();
        offsets.map(move |(_, offset)| self.at(offset))
    }

    /// Returns pairs of entries: an earlier one and its replacement.
    pub fn replaced(
        mut self,
    ) -> impl Iterator<Item = Result<(JournalEntry, JournalEntry), JournalError>> {
        let replaced = self.archive.index.replaced();
        replaced.into_iter().map(move |line| Ok((self.at(line.old)?, self.at(line.new)?)))
    }

    /// Returns every entry of the design at `position`, the first one first.
    pub fn history(&mut self, position: u64) -> Result<Vec<JournalEntry>, JournalError> {
        let offsets = self.archive.index.history(position);
        offsets.into_iter().map(|offset| self.at(offset)).collect()
    }

    /// Returns the latest entry of the design at `position`.
    pub fn last(&mut self, position: u64) -> Result<Option<JournalEntry>, JournalError> {
        self.archive.index.offset(position).map(|offset| self.at(offset)).transpose()
    }

    fn at(&mut self, offset: u64) -> Result<JournalEntry, JournalError> {
        let read = self.lines.line(offset);
        let mut bytes = read.map_err(|error| self.archive.unreadable(&error))?;
        let problem = match self.archive.seal.read(&mut bytes) {
            Ok(Line::Design(entry)) => return Ok(*entry),
            Ok(Line::Session(_)) => "the line of a design is missing".to_owned(),
            Err(problem) => problem,
        };
        let reason = format!("it has changed while it was read, {problem}");
        Err(JournalError::Unreadable { path: self.archive.path.clone(), reason })
    }
}
