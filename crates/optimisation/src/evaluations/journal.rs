//! The journal of an optimisation: every point that was solved, a line each.
//!
//! The search itself is not written down: it does the same again, and finds what it asks for in the journal until it comes to
//! points that nobody has solved yet.

use std::ops::Range;
use std::path::Path;

use results::{Claim, DesignResult, Maker, OutputError, RunFolder};
use run::{JournalError, JournalHeader, Program, Start};
use serde::{Deserialize, Serialize};
use store::{Journal, Records};
use sweep::Subset;

/// A line of the journal behind the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum JournalLine {
    Solved(Box<SolvedLine>),
    Skins(SkinsLine),
}

/// A point that was solved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SolvedLine {
    /// Whether its measures have derivatives.
    pub differentiated: bool,
    /// The number of the skin made of its design, with the deviations of the batch; none of the design as it is drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skin: Option<u64>,
    /// Shares of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// The result.
    pub result: DesignResult,
}

/// Skins made of the design of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkinsLine {
    /// The number of the first skin.
    pub first: u64,
    /// Shares of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// The values of each skin in the columns that it is judged by.
    pub values: Vec<Vec<Option<f64>>>,
}

/// What a journal holds when it is opened.
struct Recalled {
    header: JournalHeader,
    /// The lines, until somebody takes them.
    lines: Option<Vec<JournalLine>>,
}

impl Records for Recalled {
    type Line = JournalLine;

    const KEY: &'static str = "optimisation";

    fn begin(header: JournalHeader, _length: u64, _path: &Path) -> Result<Self, String> {
        Ok(Self { header, lines: Some(Vec::new()) })
    }

    fn take(&mut self, line: JournalLine, _bytes: Range<u64>) -> Result<(), String> {
        // What is appended later is known to whoever has solved it.
        if let Some(lines) = &mut self.lines {
            lines.push(line);
        }
        Ok(())
    }

    fn header(&self) -> &JournalHeader {
        &self.header
    }

    fn is_empty(&self) -> bool {
        self.lines.as_ref().is_none_or(Vec::is_empty)
    }
}

/// A journal that is being written.
pub(super) struct EvaluationJournal(Journal<Recalled>);

impl EvaluationJournal {
    /// The journal in `folder` of the search for `goal`, and the lines that it has.
    pub fn begin(
        folder: &Path,
        goal: &str,
        program: &Program,
        start: Start,
    ) -> Result<(Self, Vec<JournalLine>), JournalError> {
        let folder = RunFolder::new(folder);
        folder.require_own(Maker::Search, start)?;
        // A file of our names that no search has written here may be the very goal that is searched for.
        Claim::check(&folder, Maker::Search)?;
        folder.make()?;
        let header = JournalHeader::new(goal.to_owned(), Subset::default(), program);
        let path = folder.file(RunFolder::EVALUATIONS);
        let mut journal = Journal::<Recalled>::begin(&path, header, start)?;
        if start == Start::Fresh {
            // An optimum of another goal must not stand beside the journal of this one.
            Claim::release(&folder, Maker::Search);
        }
        let lines = journal.records_mut().lines.take().unwrap_or_default();
        Ok((Self(journal), lines))
    }

    /// Adds a line, which then counts as solved.
    pub fn append(&mut self, line: JournalLine) -> Result<(), OutputError> {
        self.0.append(line)
    }

    /// Forces it to the disk.
    pub fn sync(&mut self) -> Result<(), OutputError> {
        self.0.sync()
    }
}
