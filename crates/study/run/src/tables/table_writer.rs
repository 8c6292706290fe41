//! Writes the tables of a run from its journal, repeatedly during the run and at its end.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use journal::{JournalError, OutputError};
use rayon::iter::ParallelIterator as _;
use rayon::slice::ParallelSlice as _;
use results::columns::tables;
use results::{Contents, CsvFormat, DesignRow, ResultsFolder, failure_columns};

use super::changes;
use super::open_tables::OpenTables;
use super::ro_crate;
use super::run_info::RunInfo;
use super::summary::Summary;
use crate::options::Options;
use crate::progress::{Finished, RunError};
use crate::run_journal::{Archive, Journal};

/// Reciprocal of the largest fraction of time spent on writing tables, here 5 %.
const SHARE: u32 = 20;

/// Number of designs that one thread formats at a time.
// Large enough to be worth a task, small enough to keep the texts of a task below a megabyte.
const PORTION: usize = 32;

/// File names of tables with their SHA-256, in the order in which a reader should read them.
type WrittenTables = Vec<(String, String)>;

/// Writes the tables of one run and decides when they are due.
pub(crate) struct TableWriter<'a> {
    folder: ResultsFolder,
    format: CsvFormat,
    every: Duration,
    threads: usize,
    info: RunInfo<'a>,
    /// Time at which the tables were last written.
    written: Instant,
    /// Time that writing the tables took.
    writing: Duration,
}

impl<'a> TableWriter<'a> {
    /// Creates a writer of tables in `folder`.
    pub fn new(
        folder: ResultsFolder,
        format: CsvFormat,
        options: &Options<'_>,
        info: RunInfo<'a>,
    ) -> Self {
        let (written, writing) = (Instant::now(), Duration::ZERO);
        let Options { tables_every: every, threads, .. } = *options;
        Self { folder, format, every, threads, info, written, writing }
    }

    /// Returns true if enough time has passed to write the tables again.
    pub fn are_due(&self) -> bool {
        self.written.elapsed() > self.every.max(self.writing * SHARE)
    }

    /// Writes the tables, then `run.toml`, then `contents.toml`.
    pub fn write(&mut self, journal: &mut Journal) -> Result<Finished, RunError> {
        let begun = Instant::now();
        // Flush the journal to the disk first. Otherwise tables could contain designs that a power
        // failure removes from the journal.
        journal.sync()?;
        let archive = journal.records();
        let (summary, tables) = self.write_tables(archive)?;
        let names: Vec<_> = tables.iter().map(|(name, _)| name.clone()).collect();
        // Remove tables of an earlier run that this run does not write.
        self.folder.remove_tables_but(&names);
        let record = self.info.write(archive, &self.folder, &summary)?;
        let record = (ResultsFolder::RUN_INFO.to_owned(), record);
        let contents = self.contents(archive, tables.into_iter().chain([record]).collect())?;
        // Write `contents.toml` last, because readers accept the tables only if this file matches.
        contents.write(&self.folder)?;
        self.folder.sync();
        self.written = Instant::now();
        self.writing = begun.elapsed();
        let missing = archive.designs().len() - archive.done();
        let duration = self.info.elapsed();
        Ok(Finished { summary, missing, duration, tables: names, notes: Vec::new() })
    }

    fn contents(
        &self,
        archive: &Archive,
        files: BTreeMap<String, String>,
    ) -> Result<Contents, JournalError> {
        let (designs, done) = (archive.designs().len(), archive.done());
        let (program, journal) = (self.info.program(), archive.extent()?);
        Ok(Contents { program, designs, done, journal, files })
    }

    /// Writes the tables; returns the summary and the SHA-256 of each table.
    ///
    /// One thread reads the entries in the order of their designs; all threads format rows.
    fn write_tables(&self, archive: &Archive) -> Result<(Summary, WrittenTables), RunError> {
        let (folder, format) = (&self.folder, self.format);
        // Use a separate pool with as many threads as the run. The threads that solve designs are
        // idle while the tables are written.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build();
        let pool = pool.map_err(|error| RunError::Threads {
            count: self.threads,
            reason: error.to_string(),
        })?;
        let layouts = tables(archive.sweep());
        let failures = failure_columns(archive.sweep());
        let mut tables = OpenTables::create(folder, format, archive.sweep(), &layouts, &failures)?;
        let mut summary = Summary::new(archive.sweep());
        let mut entries = archive.entries()?.in_order().peekable();
        while entries.peek().is_some() {
            let some = entries.by_ref().take(PORTION * pool.current_num_threads());
            let rows = some.map(|entry| Ok(archive.row(entry?)));
            let rows: Vec<DesignRow> = rows.collect::<Result<_, JournalError>>()?;
            let lines = || rows.par_chunks(PORTION).map(|rows| tables.lines(rows)).collect();
            let lines: Result<Vec<_>, OutputError> = pool.install(lines);
            lines?.iter().try_for_each(|lines| tables.append(lines))?;
            for row in &rows {
                summary.add(row);
            }
        }
        let mut files = tables.finish()?;
        files.extend(changes::write(archive, folder, format)?);
        let names: Vec<_> = files.iter().map(|(name, _)| name.clone()).collect();
        ro_crate::write(archive, folder, &self.info.program(), &layouts, &names)?;
        Ok((summary, files))
    }
}
