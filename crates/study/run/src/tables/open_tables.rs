//! Tables of a run while they are being written.

use results::columns::TableLayout;
use results::{
    Column, CsvFile, CsvFormat, DERIVATIVE_COLUMNS, DerivativeRow, DesignRow, FailureRow,
    OutputError, ResultsFolder,
};
use sweep::{Measure, Sweep};

/// Open files of all tables with one or more rows per design.
pub(super) struct OpenTables<'a> {
    layouts: &'a [TableLayout],
    designs: Vec<CsvFile<'a, DesignRow>>,
    failures: CsvFile<'a, FailureRow>,
    /// Table of derivatives; `None` if the sweep does not request derivatives.
    derivatives: Option<CsvFile<'static, DerivativeRow>>,
}

/// Formatted rows of several designs for each table.
pub(super) struct TableLines {
    designs: Vec<Vec<u8>>,
    failures: Vec<u8>,
    derivatives: Vec<u8>,
}

impl<'a> OpenTables<'a> {
    /// Creates the files of the tables of a sweep, with their headers.
    pub fn create(
        folder: &ResultsFolder,
        format: CsvFormat,
        sweep: &Sweep,
        layouts: &'a [TableLayout],
        failures: &'a [Column<FailureRow>],
    ) -> Result<Self, OutputError> {
        let designs = layouts
            .iter()
            .map(|layout| CsvFile::create(folder, &layout.file, format, &layout.columns))
            .collect::<Result<_, _>>()?;
        let failures = CsvFile::create(folder, ResultsFolder::FAILURES, format, failures)?;
        let derivatives =
            || CsvFile::create(folder, ResultsFolder::SENSITIVITY, format, DERIVATIVE_COLUMNS);
        // The file of derivatives is omitted if derivatives are not requested.
        let is_requested = sweep.measures().contains(&Measure::Sensitivity);
        let derivatives = is_requested.then(derivatives).transpose()?;
        Ok(Self { layouts, designs, failures, derivatives })
    }

    /// Formats the rows of several designs.
    pub fn lines(&self, rows: &[DesignRow]) -> Result<TableLines, OutputError> {
        let derivatives =
            |table: &CsvFile<_>| table.lines(rows.iter().flat_map(DesignRow::derivatives));
        Ok(TableLines {
            designs: self
                .designs
                .iter()
                .map(|table| table.lines(rows))
                .collect::<Result<_, _>>()?,
            failures: self.failures.lines(rows.iter().flat_map(DesignRow::failures))?,
            derivatives: self
                .derivatives
                .as_ref()
                .map(derivatives)
                .transpose()?
                .unwrap_or_default(),
        })
    }

    /// Appends formatted rows to every table.
    pub fn append(&mut self, lines: &TableLines) -> Result<(), OutputError> {
        for (table, lines) in self.designs.iter_mut().zip(&lines.designs) {
            table.append(lines)?;
        }
        self.failures.append(&lines.failures)?;
        self.derivatives.iter_mut().try_for_each(|table| table.append(&lines.derivatives))
    }

    /// Moves the files to their final paths; returns their names and SHA-256.
    pub fn finish(self) -> Result<Vec<(String, String)>, OutputError> {
        let mut files = Vec::new();
        for (layout, table) in self.layouts.iter().zip(self.designs) {
            files.push((layout.file.clone(), table.finish()?));
        }
        files.push((ResultsFolder::FAILURES.to_owned(), self.failures.finish()?));
        if let Some(table) = self.derivatives {
            files.push((ResultsFolder::SENSITIVITY.to_owned(), table.finish()?));
        }
        Ok(files)
    }
}
