//! The tables of a folder as one workbook for Excel and other spreadsheets.
//!
//! The workbook is made from the files of the folder alone, and tables are read row by row, once to see what their columns
//! hold and once to write them, so that a million designs need no more memory than a dozen. Its bytes are the same whenever
//! and wherever it is written.

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
use results::{CsvFormat, InvalidFolder, OutputError, RunFolder, VerifiedFolder, words};
use sweep::reason;

use measure_chart::MeasureChart;
use profile::ColumnProfile;
use sheet::{Guide, Sheet};
use summary::{BestValues, SummaryFacts, summary};

/// Rows that a sheet takes below its header.
const ROWS: u32 = 1_048_575;

/// The content of a workbook that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Names of its tables and how many rows each has.
    pub tables: Vec<(String, u32)>,
}

/// A table that a search, a tolerance or a fit writes, with name, unit and meaning of its columns.
#[derive(Clone, Debug)]
pub struct OtherTable {
    /// Its file.
    pub file: &'static str,
    /// Its columns.
    pub columns: Vec<(String, &'static str, &'static str)>,
}

/// Tables that do not become a workbook.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// A table is not as its run has written it.
    #[error(transparent)]
    Folder(#[from] InvalidFolder),
    /// The record of the ranking is none.
    #[error(transparent)]
    Preferences(#[from] InvalidPreferences),
    /// The folder has no table of designs.
    #[error("{}: holds no designs.csv, expected the folder of a run, a search, a tolerance or a fit", folder.display())]
    NoDesigns {
        /// The folder.
        folder: PathBuf,
    },
    /// A table cannot be read.
    #[error("{}: cannot be read ({reason}), expected a table that squama writes", file.display())]
    Unreadable {
        /// The table.
        file: PathBuf,
        /// The fault of the table, in words.
        reason: String,
    },
    /// A table is longer than a sheet.
    #[error(
        "{}: has more than {ROWS} rows, expected at most as many, because a sheet of Excel takes no more; export a smaller run, e.g. one with --sample {ROWS}",
        file.display()
    )]
    TooManyRows {
        /// The table.
        file: PathBuf,
    },
    /// The name is not that of a workbook.
    #[error("{}: a workbook needs a name that ends in .xlsx", file.display())]
    NoWorkbook {
        /// The file that was asked for.
        file: PathBuf,
    },
    /// The workbook cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Writes every table in the folder `results` to the workbook `file`: a summary, a sheet for each table, with a chart where it
/// is that of a measure, and one that explains the columns; of what is no run the `others` that are there, without a summary.
///
/// Numbers are numbers, with the digits that a person needs shown and all of them held, and everything else is text; a
/// design number is a number that shows its leading zeros. What failed is red, and the values that a table is about have a scale of colours.
///
/// # Errors
/// If there are no tables, one of them cannot be read or is longer than a sheet, or the disk does
/// not take the workbook.
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
    if !results.holds(RunFolder::DESIGNS) && others.is_empty() {
        return Err(ExportError::NoDesigns { folder: results.path().to_owned() });
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = &RunFolder::new(folder.unwrap_or(Path::new(".")));
    folder.make()?;
    // The writer of workbooks panics if the disk does not take the rows that it puts aside.
    let written = catch_unwind(AssertUnwindSafe(|| write(results, &others, folder, name)));
    written.unwrap_or_else(|panic| Err(unwritable(folder, name, &said(&*panic))))
}

fn write(
    results: &VerifiedFolder,
    others: &[OtherTable],
    folder: &RunFolder,
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
    let is_run = results.holds(RunFolder::DESIGNS);
    let all = others.iter().map(|table| table.file.to_owned());
    for file in results.tables().into_iter().chain(all) {
        let table = file.trim_end_matches(".csv").to_owned();
        let path = results.path().join(&file);
        let (profiles, values) = look_over((&path, results.file(&file)?))?;
        if file == RunFolder::DESIGNS {
            best = values;
        }
        let sheet = Sheet::new(&mut workbook, &table, &profiles).map_err(failed)?;
        let other = others.iter().find(|other| other.file == file);
        let own = other.map_or(&[][..], |other| &other.columns);
        // Checked anew, because it is read a second time.
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
        // The summary comes first, though its best values are known only after the tables.
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

/// The properties of every workbook: they hold no time of writing, so that equal tables make equal bytes.
fn properties() -> Result<DocProperties, XlsxError> {
    let epoch = ExcelDateTime::from_ymd(2000, 1, 1)?;
    Ok(DocProperties::new().set_author("squama").set_creation_datetime(&epoch))
}

/// The content of a table in a file with its path: its profiles by column, and its best values.
fn look_over((path, file): (&Path, File)) -> Result<(TableProfile, BestValues), ExportError> {
    let unreadable = |reason| ExportError::Unreadable { file: path.to_owned(), reason };
    let (format, mut csv) = open(file).map_err(|error| unreadable(reason(&error)))?;
    let header = csv.headers().map_err(|error| unreadable(words(error)))?.clone();
    let (mut columns, mut best) =
        (vec![ColumnProfile::default(); header.len()], BestValues::new(&header));
    let (mut row, mut rows) = (csv::StringRecord::new(), 0);
    while csv.read_record(&mut row).map_err(|error| unreadable(words(error)))? {
        rows += 1;
        // Before a minute goes into a sheet that cannot hold them.
        if rows > ROWS {
            return Err(ExportError::TooManyRows { file: path.to_owned() });
        }
        ColumnProfile::add(&mut columns, format, &row);
        best.add(format, &row);
    }
    Ok((TableProfile { format, header, columns }, best))
}

/// The facts about a table before it is written as a sheet.
struct TableProfile {
    format: CsvFormat,
    header: csv::StringRecord,
    columns: Vec<ColumnProfile>,
}

/// Fills a sheet with the table in a file with its path; returns its page and how many rows it has.
fn copy(
    (path, file): (&Path, File),
    mut sheet: Sheet,
    (guide, own): (&mut Guide, &[(String, &'static str, &'static str)]),
    failed: &dyn Fn(XlsxError) -> ExportError,
) -> Result<(Worksheet, u32), ExportError> {
    let unreadable = |reason| ExportError::Unreadable { file: path.to_owned(), reason };
    let (_, mut csv) = open(file).map_err(|error| unreadable(reason(&error)))?;
    let header = csv.headers().map_err(|error| unreadable(words(error)))?.clone();
    let mut row = csv::StringRecord::new();
    while csv.read_record(&mut row).map_err(|error| unreadable(words(error)))? {
        sheet.add(&row).map_err(failed)?;
    }
    guide.explain(&sheet.table, own, &header).map_err(failed)?;
    let rows = sheet.rows;
    Ok((sheet.finish().map_err(failed)?, rows))
}

fn open(file: File) -> io::Result<(CsvFormat, csv::Reader<BufReader<File>>)> {
    let mut file = BufReader::new(file);
    let (format, start) = CsvFormat::of(file.fill_buf()?);
    file.consume(start);
    Ok((format, format.reader(file)))
}

fn unwritable(folder: &RunFolder, name: &str, reason: &str) -> ExportError {
    OutputError::file(&folder.file(name), &io::Error::other(reason.to_owned())).into()
}

/// The message of a panic, in one line; of an error of the system, its own message.
fn said(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let text = text.unwrap_or("the writer of workbooks failed");
    // A panic over an error of the system quotes its message, which alone is of use.
    let message = text.split_once("message: \"").and_then(|(_, rest)| rest.split_once('"'));
    message.map_or(text, |(message, _)| message).lines().collect::<Vec<_>>().join(" ")
}
