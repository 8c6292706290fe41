//! Tables as CSV files.

use std::borrow::Borrow;
use std::io;
use std::path::Path;

use crate::columns::Column;
use crate::folder::{AtomicFile, OutputError};
use crate::tables::csv_format::Dialect;

/// A table that grows row by row and appears when it is complete.
pub struct Table {
    csv: csv::Writer<AtomicFile>,
    dialect: Dialect,
}

impl Table {
    /// Begins the file `name` in `folder` with its header.
    ///
    /// # Errors
    /// If the folder or the disk does not take it.
    pub fn create<'c>(
        folder: &Path,
        name: &str,
        dialect: Dialect,
        header: impl IntoIterator<Item = &'c str>,
    ) -> Result<Self, OutputError> {
        let file = AtomicFile::create(folder, name)?;
        let path = file.path().to_owned();
        let csv = dialect.writer(file).map_err(|error| OutputError::file(&path, &error))?;
        let mut table = Self { csv, dialect };
        table.write(header)?;
        Ok(table)
    }

    /// Adds a row.
    ///
    /// # Errors
    /// If the folder or the disk does not take it.
    pub fn write<'c>(
        &mut self,
        cells: impl IntoIterator<Item = &'c str>,
    ) -> Result<(), OutputError> {
        for cell in cells {
            let written = self.csv.write_field(self.dialect.cell(cell).as_bytes());
            self.checked(written)?;
        }
        let ended = self.csv.write_record(None::<&[u8]>);
        self.checked(ended)
    }

    /// Puts the table in its place.
    ///
    /// # Errors
    /// If the folder or the disk does not take it.
    pub fn finish(mut self) -> Result<(), OutputError> {
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

/// Writes `rows` as the file `name` in `folder`.
///
/// # Errors
/// If the folder or the disk does not take it.
pub fn write_table<R>(
    folder: &Path,
    name: &str,
    columns: &[Column<R>],
    rows: &[R],
) -> Result<(), OutputError> {
    write_rows(folder, name, Dialect::Plain, columns, rows)
}

/// Writes `rows` as the file `name` in `folder`, in any dialect.
///
/// # Errors
/// If the folder or the disk does not take it.
pub fn write_rows<R>(
    folder: &Path,
    name: &str,
    dialect: Dialect,
    columns: &[Column<R>],
    rows: impl IntoIterator<Item = impl Borrow<R>>,
) -> Result<(), OutputError> {
    let header = columns.iter().map(|column| column.name);
    let mut table = Table::create(folder, name, dialect, header)?;
    for row in rows {
        let cells = columns.iter().map(|column| column.cell(row.borrow()).to_string());
        table.write(cells.collect::<Vec<_>>().iter().map(String::as_str))?;
    }
    table.finish()
}
