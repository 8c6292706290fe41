//! Runs a sweep: solves its designs and writes the journal and the tables.

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Instant;

use journal::{Program, Start};
use results::{CsvFormat, Derivation, ResultsFolder};
use sweep::{Subset, SubsetDesigns, Sweep};

use crate::options::Options;
use crate::progress::{Finished, Progress, RunError};
use crate::run_journal::{self, Journal, JournalEntry, Line, SessionStart};
use crate::solve::groups::Groups;
use crate::solve::interleaved::interleaved;
use crate::solve::task::Task;
use crate::solve::workers;
use crate::tables::run_info::RunInfo;
use crate::tables::table_writer::TableWriter;

/// Solves the missing designs of `subset` of `sweep`, and writes their tables to `folder`.
///
/// Calls `progress` when a design is done, in any order. The tables are identical, byte by byte,
/// for any number of threads and interruptions.
///
/// # Errors
///
/// If the results cannot be written, if results exist and `start` is `New`, or if the threads
/// cannot be started. A design that cannot be solved is a row of the tables, not an error.
pub fn run(
    sweep: &Sweep,
    subset: Subset,
    folder: &Path,
    start: Start,
    options: &Options<'_>,
    program: &Program,
    mut progress: impl FnMut(Progress),
) -> Result<Finished, RunError> {
    let clock = Instant::now();
    // Check the subset before the folder is created, so that an invalid subset leaves no folder.
    SubsetDesigns::new(sweep.grid().len(), subset)?;
    let folder = ResultsFolder::new(folder);
    folder.make()?;
    let journal = run_journal::begin(&folder, run_journal::header(sweep, subset, program), start)?;
    let removed = if start == Start::Fresh { Derivation::remove_all(&folder) } else { Vec::new() };
    let archive = journal.records();
    let (subset, missing) = (archive.designs().clone(), archive.missing());
    progress(Progress::Begun { designs: subset.len(), done: archive.done() });
    // Without solved designs, any tables belong to an earlier run and are removed.
    if archive.done() == 0 {
        folder.remove_results();
    }
    let mut run = Run::new(journal, folder, options, RunInfo::new(program, options, clock));
    let designs = interleaved(missing).map(|position| subset.design(position));
    let mut designs = designs.peekable();
    if designs.peek().is_some() {
        let task = Task::new(sweep, String::new(), 0, clock, options.work);
        run.solve(&task, designs, progress)?;
    }
    let mut finished = run.finish()?;
    finished.notes.extend(removal(&removed));
    Ok(finished)
}

/// Returns the message that names removed files, which were derived from earlier results.
fn removal(files: &[String]) -> Option<String> {
    let files = files.join(" ");
    (!files.is_empty())
        .then(|| format!("removed, because they were made from the earlier results: {files}"))
}

/// Session that solves designs, appends their results to a journal, and writes the tables.
pub(crate) struct Run<'a> {
    journal: Journal,
    options: &'a Options<'a>,
    format: CsvFormat,
    tables: TableWriter<'a>,
}

impl<'a> Run<'a> {
    /// Creates a session for the journal in `folder`, without writing to it.
    pub fn new(
        journal: Journal,
        folder: ResultsFolder,
        options: &'a Options<'a>,
        info: RunInfo<'a>,
    ) -> Self {
        // Without a requested format, a resumed run keeps the format of its tables.
        let format = options.format.or(journal.records().format()).unwrap_or_default();
        let tables = TableWriter::new(folder, format, options, info);
        Self { journal, options, format, tables }
    }

    /// Solves `designs`, appends each of them to the journal, and calls `progress`.
    pub fn solve(
        &mut self,
        task: &Task<'_>,
        designs: impl Iterator<Item = u64> + Send + Clone,
        mut progress: impl FnMut(Progress),
    ) -> Result<(), RunError> {
        let Options { threads, stop, fail_fast, .. } = *self.options;
        self.journal.append(Line::Session(SessionStart::now(threads, self.format)))?;
        task.measure(designs.clone());
        let groups = Groups::new(task.grid(), designs);
        workers::solve(
            threads,
            stop,
            groups,
            |design| {
                let entry = task.solve(design);
                if fail_fast && entry.result.failed() {
                    // The worker that finds the failure stops the run, because the thread that
                    // writes the journal may be far behind. Started designs are still finished.
                    stop.store(true, Ordering::Relaxed);
                }
                entry
            },
            |entry| self.take(entry, &mut progress),
        )
    }

    /// Appends a finished design to the journal, and writes the tables if they are due.
    fn take(
        &mut self,
        entry: JournalEntry,
        progress: &mut impl FnMut(Progress),
    ) -> Result<(), RunError> {
        let failed = entry.result.failed();
        // The journal is written before the report, so that a reported design is never lost.
        self.journal.append(Line::Design(Box::new(entry)))?;
        progress(Progress::Done { failed });
        if self.tables.are_due() {
            self.tables.write(&mut self.journal)?;
        }
        Ok(())
    }

    /// Writes the tables at the end of the session.
    pub fn finish(mut self) -> Result<Finished, RunError> {
        let mut finished = self.tables.write(&mut self.journal)?;
        finished.notes.extend_from_slice(self.journal.notes());
        Ok(finished)
    }
}
