//! Every table of a run, written from its journal now and then.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use journal::{JournalError, OutputError};
use rayon::iter::ParallelIterator as _;
use rayon::slice::ParallelSlice as _;
use results::columns::tables;
use results::{Contents, CsvFormat, DesignRow, ResultsFolder, failure_columns};

use super::changes;
use super::open_tables::OpenTables;
use super::run_info::RunInfo;
use super::summary::Summary;
use crate::options::Options;
use crate::progress::{Finished, RunError};
use crate::run_journal::{Archive, Journal};

/// Writing the tables takes at most one part in this many of the time of a run.
// Long runs write their tables as often as one wants, and lose five per cent by it at most.
const SHARE: u32 = 20;

/// Designs whose lines one thread makes at a time.
// Enough lines for a thread to be worth waking; all portions in hand stay below a megabyte.
const PORTION: usize = 32;

/// Names of tables, each with its SHA-256, in the order in which people read them.
type WrittenTables = Vec<(String, String)>;

/// Writes the tables of one run.
pub(crate) struct TableWriter<'a> {
    folder: ResultsFolder,
    format: CsvFormat,
    every: Duration,
    threads: usize,
    info: RunInfo<'a>,
    /// The moment at which the tables were written last, and how long that took.
    written: Instant,
    writing: Duration,
}

impl<'a> TableWriter<'a> {
    /// A writer of tables to `folder`, as the options say.
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

    /// Whether it is time to write the tables again.
    pub fn are_due(&self) -> bool {
        self.written.elapsed() > self.every.max(self.writing * SHARE)
    }

    /// Writes the tables of what `journal` holds, the record of the run, and last of all what they are.
    pub fn write(&mut self, journal: &mut Journal) -> Result<Finished, RunError> {
        let begun = Instant::now();
        // The tables must not tell of designs that a loss of power takes from the journal.
        journal.sync()?;
        let archive = journal.records();
        let (summary, tables) = self.write_tables(archive)?;
        let names: Vec<_> = tables.iter().map(|(name, _)| name.clone()).collect();
        // Tables that this run does not have are those of an earlier one.
        self.folder.remove_tables_but(&names);
        let record = self.info.write(archive, &self.folder, &summary)?;
        let record = (ResultsFolder::RUN_INFO.to_owned(), record);
        let contents = self.contents(archive, tables.into_iter().chain([record]).collect())?;
        // Last of all: from here on readers take the tables for what the run wrote.
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

    /// Writes the tables; returns what the run comes to, and each with its SHA-256. Entries are read one by
    /// one, in the order of their designs; their lines are made by all threads.
    fn write_tables(&self, archive: &Archive) -> Result<(Summary, WrittenTables), RunError> {
        let (folder, format) = (&self.folder, self.format);
        // A pool of its own: the threads of the solver sleep while tables are written, and the number of threads is kept.
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
        Ok((summary, files))
    }
}
