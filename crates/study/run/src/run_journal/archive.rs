//! Contents of a journal of a run.

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

/// Contents of a journal: its header and sessions, and the offsets of its designs.
#[derive(Debug)]
pub struct Archive {
    path: PathBuf,
    header: JournalHeader,
    seal: Seal,
    sweep: Sweep,
    designs: SubsetDesigns,
    index: Index,
    sessions: Vec<SessionStart>,
    /// Largest number of a rerun.
    reruns: u64,
    /// Designs and duration of the latest session.
    latest: LatestSession,
    /// Number of bytes of intact lines.
    length: u64,
    /// Number of intact lines, including the header.
    lines: u64,
}

/// Number of designs and duration of the latest session, from which its rate follows.
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
                // Only the latest session counts, because the number of threads and the machine may
                // differ between sessions.
                self.latest = LatestSession::default();
                self.sessions.push(session);
            }
            Line::Design(entry) => {
                let position = self.position(&entry);
                let none = || format!("the run has no design {}", entry.design);
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
    /// Reads the journal in `folder` without locking it; a run may be writing to it.
    ///
    /// # Errors
    ///
    /// If there is no journal, or it is damaged.
    pub fn open(folder: &ResultsFolder) -> Result<Self, JournalError> {
        let path = folder.journal();
        // A journal without a complete first line counts as missing: it contains no design.
        let missing = || JournalError::Missing(folder.path().to_owned());
        if !path.exists() {
            return Err(missing());
        }
        journal::read(&path)?.ok_or_else(missing)
    }

    /// Reads a journal from `source`; `path` is used in error messages.
    ///
    /// Returns `None` if the first line is incomplete.
    ///
    /// # Errors
    ///
    /// If the journal cannot be read or is damaged.
    pub fn read_from(source: impl BufRead, path: &Path) -> Result<Option<Self>, JournalError> {
        journal::read_from(source, path)
    }

    fn position(&self, entry: &JournalEntry) -> Option<u64> {
        self.designs.position(entry.index()?)
    }

    /// Returns the header of the journal.
    pub fn header(&self) -> &JournalHeader {
        &self.header
    }

    /// Returns the header of this journal with all shards instead of its shard.
    pub(crate) fn header_of_all_shards(&self) -> JournalHeader {
        let subset = Subset { shard: None, ..*self.header.subset() };
        self.header.clone().with_subset(subset)
    }

    /// Returns the sweep in the header.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// Returns all designs of the run, finished or not, as positions in the subset.
    pub fn designs(&self) -> &SubsetDesigns {
        &self.designs
    }

    /// Describes the lines that are missing compared with the tables in `folder`.
    ///
    /// Returns `None` if the journal still has all lines from which these tables were written.
    pub(crate) fn lost_lines(&self, folder: &ResultsFolder) -> Option<String> {
        // `contents.toml` states the number of complete lines when the tables were written.
        let stated = Contents::read(folder)?.journal.lines;
        let lost = stated.checked_sub(self.lines).filter(|lost| *lost > 0)?;
        Some(format!("{lost} of the {stated} lines from which the tables were written are missing"))
    }

    /// Returns true if the valid line of the design at `position` starts in the first `bytes`
    /// bytes.
    pub(crate) fn is_before(&self, position: u64, bytes: u64) -> bool {
        self.index.offset(position).is_some_and(|offset| offset < bytes)
    }

    /// Returns an error if lines are missing compared with the tables in `folder`.
    pub(crate) fn require_all_lines(&self, folder: &ResultsFolder) -> Result<(), JournalError> {
        let path = self.path.clone();
        self.lost_lines(folder).map_or(Ok(()), |lost| Err(JournalError::LinesLost { path, lost }))
    }

    /// Returns length, number of lines and checksum of the journal.
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

    /// Returns the finished designs in ascending order, as indices of the grid.
    pub(crate) fn finished(&self) -> impl Iterator<Item = u64> {
        self.index.valid_lines().map(|(position, _)| self.designs.design(position))
    }

    /// Returns the ranges of positions of designs that are not finished.
    pub fn missing(&self) -> Vec<Range<u64>> {
        self.index.missing(self.designs.len())
    }

    /// Returns the starts of all sessions.
    pub fn sessions(&self) -> &[SessionStart] {
        &self.sessions
    }

    /// Returns the format of the tables in the latest session, or `None` without a session.
    pub fn format(&self) -> Option<CsvFormat> {
        self.sessions.last().map(|session| session.csv)
    }

    /// Returns the largest number of a rerun, or 0 without reruns.
    pub fn reruns(&self) -> u64 {
        self.reruns
    }

    /// Returns the number of designs and the duration of the latest session.
    pub fn latest(&self) -> LatestSession {
        self.latest
    }

    /// Opens the file for reading its entries.
    pub(crate) fn entries(&self) -> Result<Entries<'_>, JournalError> {
        let file = File::open(&self.path);
        let file = file.map_err(|error| self.unreadable(&error))?;
        Ok(Entries { archive: self, lines: Windows::new(file) })
    }

    /// Returns the row of the tables for an entry.
    pub fn row(&self, entry: JournalEntry) -> DesignRow {
        // An entry has an index: reading fails if an entry is not a design of the grid.
        let index = entry.index().unwrap_or_default();
        let grid = self.sweep.grid();
        DesignRow { number: grid.number(index), case: grid.case(index), result: entry.result }
    }

    fn unreadable(&self, error: &io::Error) -> JournalError {
        JournalError::Unreadable { path: self.path.clone(), reason: reason(error) }
    }
}

/// Open journal that reads entries at their offsets.
pub(crate) struct Entries<'a> {
    archive: &'a Archive,
    lines: Windows,
}

impl Entries<'_> {
    /// Returns the valid entry of each finished design, in the order of the designs.
    pub fn in_order(mut self) -> impl Iterator<Item = Result<JournalEntry, JournalError>> {
        let offsets = self.archive.index.valid_lines();
        offsets.map(move |(_, offset)| self.at(offset))
    }

    /// Returns pairs of entries of the same design: a result and the next result that replaced it.
    pub fn replaced(
        mut self,
    ) -> impl Iterator<Item = Result<(JournalEntry, JournalEntry), JournalError>> {
        let replaced = self.archive.index.replaced();
        replaced.into_iter().map(move |line| Ok((self.at(line.old)?, self.at(line.new)?)))
    }

    /// Returns every entry of the design at `position`, in the order of its reruns.
    pub fn history(&mut self, position: u64) -> Result<Vec<JournalEntry>, JournalError> {
        let offsets = self.archive.index.history(position);
        offsets.into_iter().map(|offset| self.at(offset)).collect()
    }

    /// Returns the valid entry of the design at `position`, or `None` if it is not finished.
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
        let reason = format!("the journal changed while it was read: {problem}");
        Err(JournalError::Unreadable { path: self.archive.path.clone(), reason })
    }
}
