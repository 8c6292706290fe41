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

/// Solves missing designs of `subset` of `sweep` and writes tables to `folder`.
///
/// Calls `progress` when a design is done, in any order. The tables are identical, byte by byte,
/// for any number of threads and interruptions.
///
/// # Errors
///
/// If the results cannot be written, results exist and `start` is `New`, or the threads cannot be
/// started. A design that fails is a row, not an error.
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
    // Checked first, so that an invalid subset does not create a folder.
    SubsetDesigns::new(sweep.grid().len(), subset)?;
    let folder = ResultsFolder::new(folder);
    folder.make()?;
    let journal = run_journal::begin(&folder, run_journal::header(sweep, subset, program), start)?;
    let removed = if start == Start::Fresh { Derivation::remove_all(&folder) } else { Vec::new() };
    let archive = journal.records();
    let (subset, missing) = (archive.designs().clone(), archive.missing());
    progress(Progress::Begun { designs: subset.len(), done: archive.done() });
    // Tables of an earlier run must not remain beside an empty journal.
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

/// Returns the message about removed files that were derived from earlier results.
fn removal(files: &[String]) -> Option<String> {
    let files = files.join(" ");
    (!files.is_empty())
        .then(|| format!("removed, because they were made from the earlier results: {files}"))
}

/// A run of the designs of one journal.
pub(crate) struct Run<'a> {
    journal: Journal,
    options: &'a Options<'a>,
    format: CsvFormat,
    tables: TableWriter<'a>,
}

impl<'a> Run<'a> {
    /// Creates a run of the journal in `folder`, without writing to it.
    pub fn new(
        journal: Journal,
        folder: ResultsFolder,
        options: &'a Options<'a>,
        info: RunInfo<'a>,
    ) -> Self {
        // A resumed run keeps the format of its tables by default.
        let format = options.format.or(journal.records().format()).unwrap_or_default();
        let tables = TableWriter::new(folder, format, options, info);
        Self { journal, options, format, tables }
    }

    /// Solves `designs`, appends each to the journal, and calls `progress`.
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
                    // Set by the worker that sees the failure, because the thread with the journal
                    // may be far behind. Started designs are finished, as after a signal.
                    stop.store(true, Ordering::Relaxed);
                }
                entry
            },
            |entry| self.take(entry, &mut progress),
        )
    }

    /// Appends a finished design.
    fn take(
        &mut self,
        entry: JournalEntry,
        progress: &mut impl FnMut(Progress),
    ) -> Result<(), RunError> {
        let failed = entry.result.failed();
        // The journal is written first, so a reported design survives a kill.
        self.journal.append(Line::Design(Box::new(entry)))?;
        progress(Progress::Done { failed });
        if self.tables.are_due() {
            self.tables.write(&mut self.journal)?;
        }
        Ok(())
    }

    /// Writes the tables for the last time.
    pub fn finish(mut self) -> Result<Finished, RunError> {
        let mut finished = self.tables.write(&mut self.journal)?;
        finished.notes.extend_from_slice(self.journal.notes());
        Ok(finished)
    }
}
