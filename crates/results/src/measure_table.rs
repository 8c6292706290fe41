//! The measures of one design: a row each, to be read from top to bottom.

use crate::columns::{Cell, Column};
use crate::design::row::DesignRow;
use crate::folder::{OutputError, RunFolder};
use crate::tables::csv_file::write_rows;
use crate::tables::csv_format::CsvFormat::Plain;

/// One measure of a design.
struct Measured<'c> {
    column: &'c Column<DesignRow>,
    value: Cell,
}

/// Writes every column of a row of `designs.csv` as a row of `measures.csv` in `folder`; returns the name of the file.
///
/// # Errors
/// If the folder or the disk does not take it.
pub fn write_measures(
    folder: &RunFolder,
    columns: &[Column<DesignRow>],
    row: &DesignRow,
) -> Result<&'static str, OutputError> {
    let measured = columns.iter().map(|column| Measured { column, value: column.cell(row) });
    write_rows(folder, RunFolder::MEASURES, Plain, &measure_columns(), measured)?;
    Ok(RunFolder::MEASURES)
}

/// The columns of `measures.csv`.
fn measure_columns<'c>() -> [Column<Measured<'c>>; 4] {
    [
        Column::new("measure", "-", "column of designs.csv", |m| m.column.name.to_string().into()),
        Column::new("value", "-", "value, in its unit", |m| m.value.clone()),
        Column::new("unit", "-", "unit, - if it has none", |m| m.column.unit.into()),
        Column::new("meaning", "-", "meaning, in half a sentence", |m| m.column.meaning.into()),
    ]
}
