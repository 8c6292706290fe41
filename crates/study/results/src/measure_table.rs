//! The measures of one design as a table with one row per measure.

use journal::OutputError;
use std::borrow::Cow;

use crate::columns;
use crate::columns::{Cell, Column};
use crate::design::row::DesignRow;
use crate::folder::ResultsFolder;
use crate::tables::csv_file::write_rows;

/// A cell of `designs.csv` with name, unit and meaning of its column.
#[derive(Clone, Debug)]
pub struct DesignMeasure {
    name: Cow<'static, str>,
    value: Cell,
    unit: &'static str,
    meaning: &'static str,
}

/// Columns of `measures.csv`.
pub static MEASURE_COLUMNS: &[Column<DesignMeasure>] = &columns! { DesignMeasure:
    "measure", "-", |m| m.name.clone().into_owned(), "column of `designs.csv`";
    "value", "-", |m| m.value.clone(), "value of the measure, in the unit of the next column";
    "unit", "-", |m| m.unit, "unit of the value, `-` if it has none";
    "meaning", "-", |m| m.meaning, "meaning of the measure";
};

/// Writes every column of a row of `designs.csv` as a row of `measures.csv`.
///
/// Returns the name of the file.
///
/// # Errors
///
/// If the folder cannot be written.
pub fn write_measures(
    folder: &ResultsFolder,
    columns: &[Column<DesignRow>],
    row: &DesignRow,
) -> Result<&'static str, OutputError> {
    write_rows(
        folder,
        ResultsFolder::MEASURES,
        folder.csv_format(),
        MEASURE_COLUMNS,
        columns.iter().map(|column| DesignMeasure {
            name: column.name.clone(),
            value: column.cell(row),
            unit: column.unit,
            meaning: column.meaning,
        }),
    )?;
    Ok(ResultsFolder::MEASURES)
}
