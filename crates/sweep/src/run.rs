//! Running a sweep: every design solved, every table written.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use crate::definition::Sweep;
use crate::dialect::Dialect;
use crate::invalid::InvalidDefinition;
use crate::journal::{Entry, Header, Journal, JournalError, Start};
use crate::report::Report;
use crate::selection::{Part, SampleTooLarge};
use crate::session::{Bench, Session};
use crate::summary::Summary;
use crate::tables;
use crate::whole_file::{self, OutputError};

/// The file that says what a run was.
pub(crate) const RUN: &str = "run.toml";

/// The program that runs a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// Its version.
    pub version: &'static str,
    /// Revision of its source.
    pub revision: &'static str,
}

/// How a sweep is run.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// How many designs are solved at a time.
    pub threads: usize,
    /// How the tables are written; if nothing is said, as they were before.
    pub dialect: Option<Dialect>,
    /// Whether the first failure ends the run.
    pub fail_fast: bool,
    /// How often the tables are written while the run goes on.
    pub tables_every: Duration,
    /// Told to end the run: designs in hand are finished and the tables written.
    pub stop: &'a AtomicBool,
}

/// A sweep that cannot run to its end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The results cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The subset is larger than the grid.
    #[error(transparent)]
    Sample(#[from] SampleTooLarge),
    /// The settings of a re-run are not right.
    #[error(transparent)]
    Definition(#[from] InvalidDefinition),
    /// The threads cannot be started.
    #[error("{count} threads cannot be started ({reason}), expected fewer")]
    Threads {
        /// How many.
        count: usize,
        /// What the system says.
        reason: String,
    },
}

/// A run that came to its end.
#[derive(Clone, Debug)]
pub struct Finished {
    /// What it comes to.
    pub summary: Summary,
    /// How many designs are not done.
    pub missing: u64,
    /// How long it took.
    pub duration: Duration,
    /// Names of the tables.
    pub tables: Vec<String>,
}

/// What a run tells while it goes on.
#[derive(Clone, Copy, Debug)]
pub enum News<'a> {
    /// It begins.
    Begun {
        /// How many designs there are.
        designs: u64,
        /// How many of them are done.
        done: u64,
    },
    /// A design is done.
    Done(&'a Entry),
}

/// Solves the designs of `part` of `sweep` that are not done yet and writes the tables to `folder`.
/// Tells `news` of each design as soon as it is done, in any order.
///
/// The tables are the same, byte by byte, for any number of threads, however often the run was
/// ended and resumed.
///
/// # Errors
/// If the folder or the disk does not take the results, there are results that `start` says nothing
/// of, or the threads cannot be started. A design that fails is a row, not an error.
pub fn run(
    sweep: &Sweep,
    part: Part,
    folder: &Path,
    start: Start,
    options: &Options<'_>,
    program: &Program,
    mut news: impl FnMut(News<'_>),
) -> Result<Finished, RunError> {
    let clock = Instant::now();
    crate::selection::Selection::new(sweep.grid().len(), part)?;
    whole_file::make_folder(folder)?;
    let journal = Journal::begin(folder, Header::new(sweep, part, program), start)?;
    tables::remove_partial_files(folder);
    if journal.archive().done() == 0 {
        tables::remove_all(folder);
    }
    let (designs, done) = (journal.archive().selection().len(), journal.archive().done());
    news(News::Begun { designs, done });
    let selection = journal.archive().selection().clone();
    let missing = journal.archive().missing();
    let designs = missing.into_iter().flatten().map(|position| selection.design(position));
    let bench = Bench::new(sweep, String::new(), 0, clock);
    let report = Report::new(program, options, clock);
    if done == selection.len() {
        return Session::idle(journal, folder, options, &report).finish();
    }
    let mut session = Session::begin(journal, folder, options, &report)?;
    session.solve(&bench, designs, news)?;
    session.finish()
}
