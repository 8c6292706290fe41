//! Running a sweep: every design solved, every table written.

use std::path::Path;
use std::time::Instant;

use results::RunFolder;
use sweep::{Part, Selection, Sweep};

use crate::journal::{Header, Journal, Start};
use crate::options::{Options, Program};
use crate::progress::{Finished, News, RunError};
use crate::session::{Bench, Session};
use crate::tables::run_info::Report;

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
    Selection::new(sweep.grid().len(), part)?;
    let place = RunFolder::new(folder);
    place.make()?;
    let journal = Journal::begin(folder, Header::new(sweep, part, program), start)?;
    place.remove_partial_files();
    if journal.archive().done() == 0 {
        place.remove_results();
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
