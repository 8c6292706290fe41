//! The tables of a folder as one workbook for Excel and other spreadsheets.
//!
//! Tables are read row by row, once to determine the types of their columns and once to write them,
//! so memory does not depend on the number of designs. Equal tables give equal bytes.

mod explanation;
mod measure_chart;
mod profile;
mod sheet;
mod summary;

use std::any::Any;
use std::fs::File;
use std::io::{self, BufRead as _, BufReader};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use rust_xlsxwriter::{DocProperties, ExcelDateTime, Workbook, Worksheet, XlsxError};

use ranking::InvalidPreferences;
use results::{
    CsvFormat, InvalidFolder, OutputError, ResultsFolder, VerifiedFolder, csv_error_text,
};
use text::reason;

use measure_chart::MeasureChart;
use profile::ColumnProfile;
use sheet::{Guide, Sheet};
use summary::{BestValues, SummaryFacts, summary};

/// Maximum number of rows of a sheet below its header.
const ROWS: u32 = 1_048_575;

/// The content of a workbook that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Name and number of rows of each table.
    pub tables: Vec<(String, u32)>,
}

/// A table of a search, tolerance analysis or fit, with explanations of its columns.
#[derive(Clone, Debug)]
pub struct OtherTable {
    /// Name of the file.
    pub file: &'static str,
    /// Name, unit and meaning of each column.
    pub columns: Vec<(String, &'static str, &'static str)>,
}

/// Errors of an export.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A table was changed after its run.
    #[error(transparent)]
    Folder(#[from] InvalidFolder),
    /// The record of the ranking is invalid.
    #[error(transparent)]
    Preferences(#[from] InvalidPreferences),
    /// The folder has no table of designs.
    #[error("{}: contains no designs.csv, expected the folder of a run, a search, a tolerance analysis or a fit", folder.display())]
    NoDesigns {
        /// The folder.
        folder: PathBuf,
    },
    /// A table cannot be read.
    #[error("{}: cannot be read ({reason}), expected a table that squama writes", file.display())]
    Unreadable {
        /// The table.
        file: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A table is longer than a sheet.
    #[error(
        "{}: has more than {ROWS} rows, the maximum of a sheet of Excel; export a smaller run, e.g. one with --sample {ROWS}",
        file.display()
    )]
    TooManyRows {
        /// The table.
        file: PathBuf,
    },
    /// The name of the file does not end in `.xlsx`.
    #[error("{}: a workbook needs a name that ends in .xlsx", file.display())]
    NoWorkbook {
        /// The requested file.
        file: PathBuf,
    },
    /// The workbook cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Writes every table in the folder `results` to the workbook `file`.
///
/// The workbook has a summary, a sheet for each table (with a chart for each measure), and an
/// explanation of the columns. For searches and analyses it has the tables in `others` and no
/// summary.
///
/// Cells hold all digits of numbers and display a few; design numbers display leading zeros; other
/// cells are text. Failures are red, and the main values of a table have a colour scale.
///
/// # Errors
/// If there are no tables, a table cannot be read or is longer than a sheet, or the workbook cannot
/// be written to the disk.
pub fn export(
    results: &VerifiedFolder,
    others: &[OtherTable],
    file: &Path,
) -> Result<Exported, ExportError> {
    let is_workbook = file.extension().is_some_and(|end| end.eq_ignore_ascii_case("xlsx"));
    let name = file.file_name().filter(|_| is_workbook).and_then(|name| name.to_str());
    let name = name.ok_or_else(|| ExportError::NoWorkbook { file: file.to_owned() })?;
    let mut others = others.to_vec();
    others.retain(|table| results.holds(table.file));
    if !results.holds(ResultsFolder::DESIGNS) && others.is_empty() {
        return Err(ExportError::NoDesigns { folder: results.path().to_owned() });
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = &ResultsFolder::new(folder.unwrap_or(Path::new(".")));
    folder.make()?;
    // The workbook library panics if it cannot write its temporary file.
    let written = catch_unwind(AssertUnwindSafe(|| write(results, &others, folder, name)));
    written.unwrap_or_else(|panic| Err(unwritable(folder, name, &panic_message(&*panic))))
}

fn write(
    results: &VerifiedFolder,
    others: &[OtherTable],
    folder: &ResultsFolder,
    name: &str,
) -> Result<Exported, ExportError> {
    let failed = |error: XlsxError| match error {
        XlsxError::IoError(error) => OutputError::file(&folder.file(name), &error).into(),
        error => unwritable(folder, name, &error.to_string()),
    };
    let mut file = folder.create(name)?;
    let mut workbook = Workbook::new();
    workbook.set_properties(&properties().map_err(failed)?);
    workbook.set_tempdir(folder.path()).map_err(failed)?;
    let mut guide = Guide::new(&mut workbook).map_err(failed)?;
    let (mut tables, mut pages, mut best) = (Vec::new(), Vec::new(), BestValues::default());
    let is_run = results.holds(ResultsFolder::DESIGNS);
    let all = others.iter().map(|table| table.file.to_owned());
    for file in results.tables().into_iter().chain(all) {
        let table = file.trim_end_matches(".csv").to_owned();
        let path = results.path().join(&file);
        let (profiles, values) = profile_of_table((&path, results.file(&file)?))?;
        if file == ResultsFolder::DESIGNS {
            best = values;
        }
        let sheet = Sheet::new(&mut workbook, &table, &profiles).map_err(failed)?;
        let other = others.iter().find(|other| other.file == file);
        let own = other.map_or(&[][..], |other| &other.columns);
        // Verify the file again, because it is read a second time.
        let file = (path.as_path(), results.file(&file)?);
        let (page, rows) = copy(file, sheet, (&mut guide, own), &failed)?;
        pages.push(page);
        tables.push((table, rows));
    }
    if let Some(held) = results.shortfall() {
        guide.note(&format!("made from {held}")).map_err(failed)?;
    }
    if is_run {
        let facts = SummaryFacts::read(results)?;
        // The summary is the first sheet, although it is filled after the tables.
        workbook.push_worksheet(summary(results, &best, &facts).map_err(failed)?);
    }
    for page in pages {
        workbook.push_worksheet(page);
    }
    workbook.push_worksheet(guide.finish().map_err(failed)?);
    workbook.save_to_writer(&mut file).map_err(failed)?;
    file.finish()?;
    folder.sync();
    Ok(Exported { tables })
}

/// Returns the document properties, without a time stamp, so that the bytes are reproducible.
fn properties() -> Result<DocProperties, XlsxError> {
    let epoch = ExcelDateTime::from_ymd(2000, 1, 1)?;
    Ok(DocProperties::new().set_author("squama").set_creation_datetime(&epoch))
}

fn unreadable(path: &Path, reason: String) -> ExportError {
    ExportError::Unreadable { file: path.to_owned(), reason }
}

/// Reads a table, and returns the profiles of its columns and its best values.
fn profile_of_table(
    (path, file): (&Path, File),
) -> Result<(TableProfile, BestValues), ExportError> {
    let (format, mut csv) = open(file).map_err(|error| unreadable(path, reason(&error)))?;
    let header = csv.headers().map_err(|error| unreadable(path, csv_error_text(error)))?.clone();
    let (mut columns, mut best) =
        (vec![ColumnProfile::default(); header.len()], BestValues::new(&header));
    let (mut row, mut rows) = (csv::StringRecord::new(), 0);
    while csv.read_record(&mut row).map_err(|error| unreadable(path, csv_error_text(error)))? {
        rows += 1;
        // Fail early, because writing a sheet of this size takes a minute.
        if rows > ROWS {
            return Err(ExportError::TooManyRows { file: path.to_owned() });
        }
        ColumnProfile::add(&mut columns, format, &row);
        best.add(format, &row);
    }
    Ok((TableProfile { format, header, columns }, best))
}

/// Facts about a table, collected before its sheet is written.
struct TableProfile {
    format: CsvFormat,
    header: csv::StringRecord,
    columns: Vec<ColumnProfile>,
}

/// Copies a table into a sheet; returns the sheet and its number of rows.
fn copy(
    (path, file): (&Path, File),
    mut sheet: Sheet,
    (guide, own): (&mut Guide, &[(String, &'static str, &'static str)]),
    failed: &dyn Fn(XlsxError) -> ExportError,
) -> Result<(Worksheet, u32), ExportError> {
    let (_, mut csv) = open(file).map_err(|error| unreadable(path, reason(&error)))?;
    let header = csv.headers().map_err(|error| unreadable(path, csv_error_text(error)))?.clone();
    let mut row = csv::StringRecord::new();
    while csv.read_record(&mut row).map_err(|error| unreadable(path, csv_error_text(error)))? {
        sheet.add(&row).map_err(failed)?;
    }
    guide.explain(&sheet.table, own, &header).map_err(failed)?;
    let rows = sheet.rows;
    Ok((sheet.finish().map_err(failed)?, rows))
}

fn open(file: File) -> io::Result<(CsvFormat, csv::Reader<BufReader<File>>)> {
    let mut file = BufReader::new(file);
    let (format, start) = CsvFormat::detect(file.fill_buf()?);
    file.consume(start);
    Ok((format, format.reader(file)))
}

fn unwritable(folder: &ResultsFolder, name: &str, reason: &str) -> ExportError {
    OutputError::file(&folder.file(name), &io::Error::other(reason.to_owned())).into()
}

/// Returns the message of a panic in one line.
///
/// If the panic quotes a system error, the result is only the message of this error.
fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let text = text.unwrap_or("the writer of workbooks failed");
    // If the panic quotes a system error, only this error helps the user.
    let message = text.split_once("message: \"").and_then(|(_, rest)| rest.split_once('"'));
    message.map_or(text, |(message, _)| message).lines().collect::<Vec<_>>().join(" ")
}
