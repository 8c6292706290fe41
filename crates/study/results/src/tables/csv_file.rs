//! Writes tables as CSV files.

use std::borrow::Borrow;
use std::fmt::Write as _;
use std::io::{self, BufWriter, Write as _};

use journal::{AtomicFile, OutputError};

use super::csv_format::CsvFormat;
use crate::columns::Column;
use crate::folder::ResultsFolder;

/// Number of rows that are formatted in memory at a time.
const PORTION: usize = 1024;

/// A table that is written row by row and appears in the folder when it is complete.
pub struct CsvFile<'c, R> {
    file: BufWriter<AtomicFile>,
    format: CsvFormat,
    columns: &'c [Column<R>],
}

impl<'c, R> CsvFile<'c, R> {
    /// Starts the file `name` in `folder` and writes its header.
    ///
    /// # Errors
    ///
    /// If the folder cannot be written.
    pub fn create(
        folder: &ResultsFolder,
        name: &str,
        format: CsvFormat,
        columns: &'c [Column<R>],
    ) -> Result<Self, OutputError> {
        let file = BufWriter::with_capacity(1 << 16, folder.create(name)?);
        let mut table = Self { file, format, columns };
        let mut header = format.writer(Vec::new());
        let written = header.write_record(columns.iter().map(|column| column.name.as_ref()));
        let header = table.text(header, written)?;
        let begun = table.file.write_all(format.mark());
        table.checked(begun)?;
        table.append(&header)?;
        Ok(table)
    }

    /// Formats rows as lines of the file.
    ///
    /// # Errors
    ///
    /// If a row differs in length from the header, which cannot happen for a table of columns.
    pub fn lines(
        &self,
        rows: impl IntoIterator<Item = impl Borrow<R>>,
    ) -> Result<Vec<u8>, OutputError> {
        // Format in memory and leave the table unchanged, so that several threads can format rows.
        let mut csv = self.format.writer(Vec::new());
        let mut cell = String::new();
        let written = rows.into_iter().try_for_each(|row| {
            for column in self.columns {
                cell.clear();
                // Writing to a string cannot fail.
                let _ = write!(cell, "{}", column.cell(row.borrow()));
                csv.write_field(self.format.cell(&cell).as_bytes())?;
            }
            csv.write_record(None::<&[u8]>)
        });
        self.text(csv, written)
    }

    /// Appends lines that [`Self::lines`] formatted.
    ///
    /// # Errors
    ///
    /// If the disk cannot be written.
    pub fn append(&mut self, lines: &[u8]) -> Result<(), OutputError> {
        let written = self.file.write_all(lines);
        self.checked(written)
    }

    /// Appends a row.
    ///
    /// # Errors
    ///
    /// If the disk cannot be written.
    pub fn write(&mut self, row: &R) -> Result<(), OutputError> {
        let lines = self.lines([row])?;
        self.append(&lines)
    }

    /// Gives the complete table its final name and returns its SHA-256.
    ///
    /// # Errors
    ///
    /// If the disk cannot be written.
    pub fn finish(self) -> Result<String, OutputError> {
        let path = self.file.get_ref().path().to_owned();
        // `into_inner` writes the last bytes and reports a full disk; dropping the buffer would
        // hide this error.
        let file = self.file.into_inner();
        file.map_err(|error| OutputError::file(&path, error.error()))?.finish()
    }

    /// Returns the bytes that were written to `csv`, or the error of writing them.
    fn text(
        &self,
        csv: csv::Writer<Vec<u8>>,
        written: Result<(), csv::Error>,
    ) -> Result<Vec<u8>, OutputError> {
        let text = csv.into_inner().map_err(|error| io::Error::other(error.to_string()));
        self.checked(written.map_err(io::Error::from).and(text))
    }

    fn checked<T>(&self, result: io::Result<T>) -> Result<T, OutputError> {
        result.map_err(|error| OutputError::file(self.file.get_ref().path(), &error))
    }
}

/// Writes `rows` as the file `name` in `folder`, and returns the SHA-256 of the file.
///
/// # Errors
///
/// If the folder cannot be written.
pub fn write_rows<R>(
    folder: &ResultsFolder,
    name: &str,
    format: CsvFormat,
    columns: &[Column<R>],
    rows: impl IntoIterator<Item = impl Borrow<R>>,
) -> Result<String, OutputError> {
    let mut table = CsvFile::create(folder, name, format, columns)?;
    let mut rows = rows.into_iter().peekable();
    while rows.peek().is_some() {
        let lines = table.lines(rows.by_ref().take(PORTION))?;
        table.append(&lines)?;
    }
    table.finish()
}
