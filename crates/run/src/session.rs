//! One session: designs solved in parallel, noted in the journal, tables written now and then.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use rayon::{ThreadPool, ThreadPoolBuilder};

use results::columns::design_columns;
use results::{Column, Dialect, Record, RunFolder, row};
use sweep::Sweep;

use crate::journal::{self, Entry, Journal};
use crate::options::Options;
use crate::progress::{Finished, News, RunError};
use crate::solve::evaluator::Workbench;
use crate::solve::workers::Jobs;
use crate::tables;
use crate::tables::run_info::Report;

/// Writing the tables takes at most one part in this many of the time of a run.
const SHARE: u32 = 20;

/// Solves designs of one sweep as entries of a journal.
pub(crate) struct Bench<'a> {
    sweep: &'a Sweep,
    columns: Vec<Column<Record>>,
    workbench: Workbench,
    /// What differs from the sweep's own settings.
    settings: String,
    rerun: u64,
    clock: Instant,
}

impl<'a> Bench<'a> {
    pub fn new(sweep: &'a Sweep, settings: String, rerun: u64, clock: Instant) -> Self {
        let workbench = Workbench::new(sweep.measures());
        Self { sweep, columns: design_columns(sweep), workbench, settings, rerun, clock }
    }

    fn solve(&self, index: u64) -> Entry {
        let begun = self.clock.elapsed();
        let grid = self.sweep.grid();
        let mut solved = self.workbench.solve(grid.number(index), &grid.case(index));
        solved.record.settings.clone_from(&self.settings);
        let cells = self.columns.iter().map(|column| column.cell(&solved.record).to_string());
        let at = self.clock.elapsed();
        Entry {
            design: index + 1,
            at: seconds(at),
            seconds: seconds(at.saturating_sub(begun)),
            rerun: self.rerun,
            row: row::join(cells),
            failures: results::failure_rows(self.sweep, &solved),
        }
    }
}

/// Seconds to the microsecond.
fn seconds(duration: Duration) -> f64 {
    (duration.as_secs_f64() * 1e6).round() / 1e6
}

/// A session of a run.
pub(crate) struct Session<'a> {
    journal: Journal,
    folder: &'a Path,
    options: &'a Options<'a>,
    report: &'a Report<'a>,
    dialect: Dialect,
    /// When the tables were written last, and how long that took.
    written: Instant,
    writing: Duration,
}

impl<'a> Session<'a> {
    /// Begins a session on `journal`, the one in `folder`.
    pub fn begin(
        mut journal: Journal,
        folder: &'a Path,
        options: &'a Options<'a>,
        report: &'a Report<'a>,
    ) -> Result<Self, RunError> {
        let dialect = dialect(&journal, options);
        journal.begin_session(journal::Session::now(options.threads, dialect))?;
        Ok(Self::idle(journal, folder, options, report))
    }

    /// What solves nothing, and leaves no trace in `journal`.
    pub fn idle(
        journal: Journal,
        folder: &'a Path,
        options: &'a Options<'a>,
        report: &'a Report<'a>,
    ) -> Self {
        let (written, writing) = (Instant::now(), Duration::ZERO);
        let dialect = dialect(&journal, options);
        Self { journal, folder, options, report, dialect, written, writing }
    }

    /// Solves `designs`, notes each in the journal, and then tells `news` of it.
    pub fn solve(
        &mut self,
        bench: &Bench<'_>,
        designs: impl Iterator<Item = u64>,
        mut news: impl FnMut(News<'_>),
    ) -> Result<(), RunError> {
        let pool = pool(self.options.threads)?;
        let grid = bench.sweep.grid();
        let last = Mutex::new(None);
        let stop = self.options.stop;
        let jobs = Jobs {
            prepare: |index| {
                let case = grid.case(index);
                let print = (case.footprint().ok(), case.coupling);
                // The slant is the fastest axis, so most neighbours share their footprint.
                let known = last.lock().is_ok_and(|mut last| last.replace(print) == Some(print));
                if !known {
                    bench.workbench.prepare(&case);
                }
            },
            solve: |index| bench.solve(index),
            stop,
        };
        jobs.run(&pool, designs, |entry| {
            if entry.failed() && self.options.fail_fast {
                stop.store(true, Ordering::Relaxed);
            }
            let shown = entry.clone();
            self.journal.append(entry)?;
            news(News::Done(&shown));
            if self.written.elapsed() > self.options.tables_every.max(self.writing * SHARE) {
                self.write_tables()?;
            }
            Ok(())
        })
    }

    fn write_tables(&mut self) -> Result<Finished, RunError> {
        let begun = Instant::now();
        self.journal.sync()?;
        let archive = self.journal.archive();
        let folder = RunFolder::new(self.folder);
        let (summary, tables) = tables::write(archive, &folder, self.dialect)?;
        self.report.write(archive, &folder, &summary)?;
        self.written = Instant::now();
        self.writing = begun.elapsed();
        let missing = archive.selection().len() - archive.done();
        Ok(Finished { summary, missing, duration: self.report.elapsed(), tables })
    }

    /// Writes the tables for the last time.
    pub fn finish(mut self) -> Result<Finished, RunError> {
        self.write_tables()
    }
}

/// How the tables are written: as asked for, as before, or plain.
fn dialect(journal: &Journal, options: &Options<'_>) -> Dialect {
    let before = journal.archive().sessions().last().map(|session| session.csv);
    options.dialect.or(before).unwrap_or_default()
}

fn pool(threads: usize) -> Result<ThreadPool, RunError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| RunError::Threads { count: threads, reason: error.to_string() })
}
