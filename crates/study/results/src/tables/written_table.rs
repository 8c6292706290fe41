//! Compares an existing table with rows that are computed again from the journal.
//!
//! A journal may be edited, and its checksums renewed. The edit is detected because the tables were
//! written from the original lines.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead as _, BufReader};

use csv::StringRecord;
use journal::sha256_of;

use super::csv_format::CsvFormat;
use crate::columns::Column;
use crate::folder::ResultsFolder;

/// A table that an earlier command wrote, opened for comparison.
pub struct WrittenTable {
    format: CsvFormat,
    rows: csv::Reader<BufReader<File>>,
}

impl WrittenTable {
    /// Opens the table `name` in `folder`. `None` if it does not exist or cannot be read.
    pub fn open(folder: &ResultsFolder, name: &str) -> Option<Self> {
        let path = folder.file(name);
        // Open only regular files, because opening a named pipe may never return.
        path.is_file().then_some(())?;
        let mut file = BufReader::new(File::open(path).ok()?);
        let (format, start) = CsvFormat::detect(file.fill_buf().ok()?);
        file.consume(start);
        Some(Self { format, rows: format.reader(file) })
    }

    /// Opens the table `name` in `folder` if its SHA-256 agrees with the recorded one in `stated`.
    pub fn as_stated(
        folder: &ResultsFolder,
        name: &str,
        stated: &BTreeMap<String, String>,
    ) -> Option<Self> {
        let table = Self::open(folder, name)?;
        let digest = sha256_of(File::open(folder.file(name)).ok()?).ok()?;
        (stated.get(name) == Some(&digest)).then_some(table)
    }

    /// Returns the first cell of every row that differs from its recomputed row.
    ///
    /// `row` recomputes the row of a record; `None` excludes the record from the comparison.
    ///
    /// # Errors
    ///
    /// If a row cannot be computed.
    pub fn changed<R, E>(
        self,
        columns: &[Column<R>],
        mut row: impl FnMut(&StringRecord) -> Result<Option<R>, E>,
    ) -> Result<Vec<String>, E> {
        let mut changed = Vec::new();
        for record in self.rows.into_records().filter_map(Result::ok) {
            let Some(row) = row(&record)? else { continue };
            let cells = columns.iter().map(|column| column.cell(&row).to_string());
            if !cells.zip(&record).all(|(cell, written)| self.format.cell(&cell) == written) {
                changed.push(record[0].to_owned());
            }
        }
        Ok(changed)
    }
}
