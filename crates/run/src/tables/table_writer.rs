//! Every table of a run, written from its journal now and then.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use results::columns::tables;
use results::{
    Contents, CsvFile, CsvFormat, DERIVATIVE_COLUMNS, DerivativeRow, DesignRow, OutputError,
    RunFolder, failure_columns,
};
use sweep::Measure;

use super::changes;
use super::run_info::RunInfo;
use super::summary::Summary;
use crate::journal::{Archive, Journal, JournalError};
use crate::progress::{Finished, RunError};

/// Writing the tables takes at most one part in this many of the time of a run.
const SHARE: u32 = 20;

/// Names of tables, each with its SHA-256, in the order in which people read them.
type WrittenTables = Vec<(String, String)>;

/// Writes the tables of one run.
pub(crate) struct TableWriter<'a> {
    folder: RunFolder,
    format: CsvFormat,
    every: Duration,
    info: RunInfo<'a>,
    /// The moment at which the tables were written last, and how long that took.
    written: Instant,
    writing: Duration,
}

impl<'a> TableWriter<'a> {
    /// A writer of tables to `folder`, due `every` so often.
    pub fn new(folder: RunFolder, format: CsvFormat, every: Duration, info: RunInfo<'a>) -> Self {
        let (written, writing) = (Instant::now(), Duration::ZERO);
        Self { folder, format, every, info, written, writing }
    }

    /// Whether it is time to write the tables again.
    pub fn are_due(&self) -> bool {
        self.written.elapsed() > self.every.max(self.writing * SHARE)
    }

    /// Writes the tables of what `journal` holds, the record of the run, and last of all what they are.
    pub fn write(&mut self, journal: &mut Journal) -> Result<Finished, RunError> {
        let begun = Instant::now();
        journal.sync()?;
        let archive = journal.archive();
        let (summary, tables) = self.write_tables(archive)?;
        let names: Vec<_> = tables.iter().map(|(name, _)| name.clone()).collect();
        self.folder.remove_tables_but(&names);
        let record = self.info.write(archive, &self.folder, &summary)?;
        let record = (RunFolder::RUN_INFO.to_owned(), record);
        let contents = self.contents(archive, tables.into_iter().chain([record]).collect())?;
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
    /// one, in the order of their designs.
    fn write_tables(&self, archive: &Archive) -> Result<(Summary, WrittenTables), JournalError> {
        let (folder, format) = (&self.folder, self.format);
        let layouts = tables(archive.sweep());
        let mut designs = Vec::new();
        for layout in &layouts {
            designs.push(CsvFile::create(folder, &layout.file, format, &layout.columns)?);
        }
        let columns = failure_columns(archive.sweep());
        let mut failures = CsvFile::create(folder, RunFolder::FAILURES, format, &columns)?;
        let mut derivatives = Derivatives::create(archive, folder, format)?;
        let mut summary = Summary::default();
        for entry in archive.entries()?.in_order() {
            let row = archive.row(entry?);
            designs.iter_mut().try_for_each(|table| table.write(&row))?;
            row.failures().try_for_each(|failure| failures.write(&failure))?;
            derivatives.write(&row)?;
            summary.add(&row);
        }
        let mut files = Vec::new();
        for (layout, table) in layouts.iter().zip(designs) {
            files.push((layout.file.clone(), table.finish()?));
        }
        files.push((RunFolder::FAILURES.to_owned(), failures.finish()?));
        files.extend(derivatives.finish()?);
        files.extend(changes::write(archive, folder, format)?);
        Ok((summary, files))
    }
}

/// The table of derivatives, if the sweep asks for one.
struct Derivatives(Option<CsvFile<'static, DerivativeRow>>);

impl Derivatives {
    fn create(
        archive: &Archive,
        folder: &RunFolder,
        format: CsvFormat,
    ) -> Result<Self, OutputError> {
        if !archive.sweep().measures().contains(&Measure::Sensitivity) {
            return Ok(Self(None));
        }
        let table = CsvFile::create(folder, RunFolder::SENSITIVITY, format, DERIVATIVE_COLUMNS)?;
        Ok(Self(Some(table)))
    }

    fn write(&mut self, row: &DesignRow) -> Result<(), OutputError> {
        let Some(table) = &mut self.0 else { return Ok(()) };
        row.derivatives().try_for_each(|derivative| table.write(&derivative))
    }

    /// Puts the table in its place and returns its name and what vouches for it, if there is one.
    fn finish(self) -> Result<Option<(String, String)>, OutputError> {
        let Some(table) = self.0 else { return Ok(None) };
        Ok(Some((RunFolder::SENSITIVITY.to_owned(), table.finish()?)))
    }
}
