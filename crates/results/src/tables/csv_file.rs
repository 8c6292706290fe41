//! Tables as CSV files, the only place where rows become cells of a file.

use std::borrow::Borrow;
use std::fmt::Write as _;
use std::io;

use super::csv_format::CsvFormat;
use crate::columns::Column;
use crate::folder::{AtomicFile, OutputError, RunFolder};

/// A table that grows row by row and appears when it is complete.
pub struct CsvFile<'c, R> {
    csv: csv::Writer<AtomicFile>,
    format: CsvFormat,
    columns: &'c [Column<R>],
    /// The text of the cell that is written.
    text: String,
}

impl<'c, R> CsvFile<'c, R> {
    /// Begins the file `name` in `folder` with its header.
    ///
    /// # Errors
    /// If the folder or the disk does not take it.
    pub fn create(
        folder: &RunFolder,
        name: &str,
        format: CsvFormat,
        columns: &'c [Column<R>],
    ) -> Result<Self, OutputError> {
        let file = folder.create(name)?;
        let path = file.path().to_owned();
        let csv = format.writer(file).map_err(|error| OutputError::file(&path, &error))?;
        let mut table = Self { csv, format, columns, text: String::new() };
        let header = table.csv.write_record(columns.iter().map(|column| column.name.as_ref()));
        table.checked(header)?;
        Ok(table)
    }

    /// Adds a row.
    ///
    /// # Errors
    /// If the disk does not take it.
    pub fn write(&mut self, row: &R) -> Result<(), OutputError> {
        for column in self.columns {
            self.text.clear();
            // Writing to a string cannot fail.
            let _ = write!(self.text, "{}", column.cell(row));
            let written = self.csv.write_field(self.format.cell(&self.text).as_bytes());
            self.checked(written)?;
        }
        let ended = self.csv.write_record(None::<&[u8]>);
        self.checked(ended)
    }

    /// Puts the table in its place and returns its SHA-256.
    ///
    /// # Errors
    /// If the disk does not take it.
    pub fn finish(mut self) -> Result<String, OutputError> {
        let flushed = self.csv.flush();
        self.checked(flushed.map_err(csv::Error::from))?;
        let path = self.csv.get_ref().path().to_owned();
        let file = self.csv.into_inner();
        file.map_err(|error| OutputError::file(&path, error.error()))?.finish()
    }

    fn checked(&self, result: Result<(), csv::Error>) -> Result<(), OutputError> {
        result
            .map_err(|error| OutputError::file(self.csv.get_ref().path(), &io::Error::from(error)))
    }
}

/// Writes `rows` as the file `name` in `folder`, in any format.
///
/// # Errors
/// If the folder or the disk does not take it.
pub fn write_rows<R>(
    folder: &RunFolder,
    name: &str,
    format: CsvFormat,
    columns: &[Column<R>],
    rows: impl IntoIterator<Item = impl Borrow<R>>,
) -> Result<String, OutputError> {
    let mut table = CsvFile::create(folder, name, format, columns)?;
    for row in rows {
        table.write(row.borrow())?;
    }
    table.finish()
}
