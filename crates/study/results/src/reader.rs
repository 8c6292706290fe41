//! Reads the folder of a run: one row per design.

pub(crate) mod table;
mod thinning;

use std::borrow::Cow;
use std::io::{self, BufRead as _, BufReader, Read, Seek as _};
use std::path::Path;
use std::sync::Arc;

use crate::columns::{distinguishes_designs, parameter_of, physical_source};
use sweep::{Parameter, Sweep};
use text::{has_part, nearest, number, reason};

use crate::contents::verified_folder::{Completeness, InvalidFolder, TableText, VerifiedFolder};
use crate::folder::ResultsFolder;
use crate::tables::csv_format::CsvFormat;
use table::Table;
use thinning::Thinning;

/// Header of the first column of a table of designs.
const NUMBER: &str = "design";

/// The designs of a run, read from `designs.csv`.
#[derive(Clone, Debug)]
pub struct Results {
    folder: VerifiedFolder,
    file: &'static str,
    format: CsvFormat,
    table: Arc<Table>,
    /// Number of rows of the table, including rows that were left out.
    in_table: usize,
    parameters: Vec<(&'static Parameter, usize)>,
    definition: Option<Sweep>,
}

/// Error: a folder has no results, or results of another kind.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidResults {
    /// The folder contradicts its contents.
    #[error(transparent)]
    Folder(InvalidFolder),
    /// The table cannot be read.
    #[error("{file}: cannot be read ({reason}), expected the table that squama run writes")]
    Unreadable {
        /// Name of the table.
        file: String,
        /// Reason, e.g. the message of the operating system.
        reason: String,
    },
    /// The table is not a table of designs.
    #[error("{file}: the first column is {found}, expected {NUMBER}")]
    NoDesigns {
        /// Name of the table.
        file: String,
        /// Header of the first column.
        found: String,
    },
    /// A column is missing.
    #[error("{file}: there is no column {column}, {expected}")]
    NoColumn {
        /// Name of the table.
        file: String,
        /// Name of the missing column.
        column: String,
        /// Suggested columns.
        expected: String,
    },
    /// A cell does not hold a number.
    #[error("{file}: design {design}: {column}: {found} is not accepted, expected a number")]
    NotANumber {
        /// Name of the table.
        file: String,
        /// Number of the design.
        design: String,
        /// Name of the column.
        column: String,
        /// Text of the cell.
        found: String,
    },
}

impl Results {
    /// Reads the results in `folder`, which must be complete.
    ///
    /// # Errors
    ///
    /// If the folder contradicts its contents, has no table of designs, or cannot be read.
    pub fn read(folder: &Path) -> Result<Self, InvalidResults> {
        let folder = VerifiedFolder::open(folder, Completeness::Whole);
        Self::read_from(&folder.map_err(InvalidResults::Folder)?)
    }

    /// Reads the results in a verified folder.
    ///
    /// # Errors
    ///
    /// If the table of designs is missing, was changed, or cannot be read.
    pub fn read_from(folder: &VerifiedFolder) -> Result<Self, InvalidResults> {
        Self::thinned(folder, usize::MAX)
    }

    /// Reads the results in a verified folder, but only about `most` rows of a longer table.
    ///
    /// These are rows at equal distances, and the best row by each of coverage, critical force,
    /// penetration and compliance.
    ///
    /// # Errors
    ///
    /// As [`Results::read_from`].
    pub fn thinned(folder: &VerifiedFolder, most: usize) -> Result<Self, InvalidResults> {
        Self::of_table(folder, ResultsFolder::DESIGNS, most, |_| true)
    }

    /// Reads only the columns for which `is_read` returns true; all other columns are empty.
    ///
    /// All columns of a million designs take 400 MB.
    ///
    /// # Errors
    ///
    /// As [`Results::read_from`].
    pub fn with_columns(
        folder: &VerifiedFolder,
        is_read: impl Fn(&str) -> bool,
    ) -> Result<Self, InvalidResults> {
        Self::of_table(folder, ResultsFolder::DESIGNS, usize::MAX, is_read)
    }

    /// Reads another table of designs in `folder`, such as the results of a search.
    ///
    /// # Errors
    ///
    /// As [`Results::read_from`].
    pub fn of_file(folder: &VerifiedFolder, table: &'static str) -> Result<Self, InvalidResults> {
        Self::of_table(folder, table, usize::MAX, |_| true)
    }

    fn of_table(
        folder: &VerifiedFolder,
        file: &'static str,
        most: usize,
        is_read: impl Fn(&str) -> bool,
    ) -> Result<Self, InvalidResults> {
        let path = folder.path().join(file);
        let read = read_table(folder.table(file).map_err(InvalidResults::Folder)?, most, is_read);
        let (format, table, in_table) = read.map_err(|error| InvalidResults::Unreadable {
            file: path.display().to_string(),
            reason: csv_error_text(error),
        })?;
        let header = table.header();
        match header.first() {
            Some(first) if first == NUMBER => {}
            first => {
                // Debug formatting escapes line ends, so that the message has one line.
                let found = format!("{:?}", first.map_or("", String::as_str));
                return Err(InvalidResults::NoDesigns { file: path.display().to_string(), found });
            }
        }
        let parameters = header.iter().enumerate();
        // Beside `gap_over_t` a column of the gap in mm is not a second parameter.
        let parameters = parameters.filter(|(_, name)| distinguishes_designs(name, header));
        let parameters =
            parameters.filter_map(|(column, name)| Some((parameter_of(name)?, column))).collect();
        Ok(Self {
            folder: folder.clone(),
            file,
            format,
            parameters,
            table: Arc::new(table),
            in_table,
            // A table can be read without the record of its run.
            definition: definition(folder).map_err(InvalidResults::Folder)?,
        })
    }

    /// Returns the results of the designs in `rows` only.
    #[must_use]
    pub fn only(&self, rows: &[usize]) -> Self {
        Self { table: Arc::new(self.table.only(rows)), ..self.clone() }
    }

    /// Returns the path of the folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the verified folder.
    pub fn verified_folder(&self) -> &VerifiedFolder {
        &self.folder
    }

    /// Returns the CSV format of the tables.
    pub fn format(&self) -> CsvFormat {
        self.format
    }

    /// Returns the path of the table of designs as text, for messages.
    pub fn file(&self) -> String {
        self.folder().join(self.file).display().to_string()
    }

    /// Returns the sweep, if the record of the run exists.
    pub fn definition(&self) -> Option<&Sweep> {
        self.definition.as_ref()
    }

    /// Returns the number of designs.
    #[expect(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(&self) -> usize {
        self.table.length()
    }

    /// Returns the number of designs in the table, including those that [`Results::thinned`] omits.
    pub fn in_table(&self) -> usize {
        self.in_table
    }

    /// Returns the names of the columns.
    pub fn header(&self) -> &[String] {
        self.table.header()
    }

    /// Returns the cells of the table.
    pub fn table(&self) -> &Arc<Table> {
        &self.table
    }

    /// Returns the parameters that have a column.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> {
        self.parameters.iter().map(|(parameter, _)| *parameter)
    }

    /// Returns the index of a column.
    ///
    /// # Errors
    ///
    /// If there is no such column.
    pub fn column(&self, name: &str) -> Result<usize, InvalidResults> {
        self.table.column(name).ok_or_else(|| self.no_column(name))
    }

    fn no_column(&self, name: &str) -> InvalidResults {
        let known: Vec<&str> = self.header().iter().map(String::as_str).collect();
        let near = nearest(name, &known).map(|near| format!("did you mean {near}?"));
        let alike: Vec<_> = known.iter().copied().filter(|known| has_part(known, name)).collect();
        // If several names are similar, suggest all of them.
        let expected = near.unwrap_or_else(|| match alike[..] {
            [] if physical_source(name).is_some() => {
                "which needs a [material] in the definition that was run".to_owned()
            }
            [] => "expected a column name of its first line".to_owned(),
            [one] => format!("did you mean {one}?"),
            _ => format!("expected one of {}", alike.join(", ")),
        });
        InvalidResults::NoColumn { file: self.file(), column: name.to_owned(), expected }
    }

    /// Returns the number of the design in `row`, as written in the table.
    pub fn design(&self, row: usize) -> &str {
        self.table.name(row)
    }

    /// Returns the text of a parameter in a row. Empty if the parameter has no column.
    pub fn parameter(&self, row: usize, parameter: &Parameter) -> Cow<'_, str> {
        let column = self.parameters.iter().find(|(other, _)| other.key == parameter.key);
        column.map_or(Cow::default(), |(_, column)| self.text(row, *column))
    }

    /// Returns the text of a cell, in the plain CSV format.
    pub fn text(&self, row: usize, column: usize) -> Cow<'_, str> {
        self.table.text(row, column)
    }

    /// Returns the number in a cell, or `None` if the cell is empty.
    ///
    /// # Errors
    ///
    /// If the cell holds a text.
    pub fn number(&self, row: usize, column: usize) -> Result<Option<f64>, InvalidResults> {
        let number = self.table.number(row, column);
        if number.is_some() || self.table.is_empty(row, column) {
            return Ok(number);
        }
        Err(InvalidResults::NotANumber {
            file: self.file(),
            design: self.design(row).to_owned(),
            column: self.header()[column].clone(),
            found: format!("\"{}\"", self.text(row, column)),
        })
    }
}

/// Reads the sweep of a folder, if there is a record of the run.
///
/// # Errors
///
/// If the record cannot be read.
pub fn definition(folder: &VerifiedFolder) -> Result<Option<Sweep>, InvalidFolder> {
    if !folder.holds(ResultsFolder::RUN_INFO) {
        return Ok(None);
    }
    let text = folder.text(ResultsFolder::RUN_INFO)?;
    Ok(Sweep::parse(&text, ResultsFolder::RUN_INFO, &[]).ok())
}

/// Reads a table, or some of its rows and columns.
///
/// Returns the format, the cells, and the number of rows in the file.
fn read_table(
    mut file: Box<dyn TableText>,
    most: usize,
    is_read: impl Fn(&str) -> bool,
) -> Result<(CsvFormat, Table, usize), csv::Error> {
    // Counting reads the whole file once more, so count only if rows may be left out.
    let in_table = if most == usize::MAX { 0 } else { count_rows(&mut file)? };
    file.rewind()?;
    let mut file = BufReader::new(file);
    let (format, start) = CsvFormat::detect(file.fill_buf()?);
    file.consume(start);
    let mut csv = format.reader(file);
    let header: Vec<_> = csv.headers()?.iter().map(str::to_owned).collect();
    let mut kept = Thinning::new(Table::new(header, is_read), in_table, most);
    let mut count = 0;
    let mut row = csv::StringRecord::new();
    while csv.read_record(&mut row)? {
        // Convert all cells to the plain format, so that readers of cells need not distinguish
        // formats.
        if format == CsvFormat::ExcelEu || row.iter().any(|cell| CsvFormat::text(cell) != cell) {
            row = row.iter().map(|cell| plain(format, cell)).collect();
        }
        kept.visit(count, &row);
        count += 1;
    }
    Ok((format, kept.finish(), count))
}

/// Counts the rows of a table, without the header. No cell contains a line end.
fn count_rows(file: impl Read) -> io::Result<usize> {
    let mut lines = 0;
    let mut file = BufReader::new(file);
    loop {
        let bytes = file.fill_buf()?;
        let length = bytes.len();
        lines += bytes.split(|byte| *byte == b'\n').count() - 1;
        if length == 0 {
            // Subtract the header. A last line without a line end is not counted, which is
            // harmless: the count only determines how many rows are left out.
            return Ok(lines.saturating_sub(1));
        }
        file.consume(length);
    }
}

/// Converts the text of a cell in `format` to the plain format.
fn plain(format: CsvFormat, cell: &str) -> String {
    let decimal = format.number(cell).filter(|_| cell.contains(','));
    decimal.map_or_else(|| CsvFormat::text(cell).to_owned(), number::text)
}

/// Returns a one-line message for a table that cannot be read.
pub fn csv_error_text(error: csv::Error) -> String {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => reason(&error),
        csv::ErrorKind::Utf8 { .. } => "it is not UTF-8 text".to_owned(),
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            // The line number of the reader is too small at CR LF line ends. Use the record number,
            // which is the line number, because no cell contains a line end.
            let line = pos.map_or(0, |position| position.record() + 1);
            format!("line {line} has {len} cells, the first one {expected_len}")
        }
        _ => "it is not a table in CSV format".to_owned(),
    }
}
