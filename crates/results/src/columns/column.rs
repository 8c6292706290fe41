//! One column of a table: its header, its meaning, and the function that makes its cells.

use std::borrow::Cow;

use sweep::{PARAMETERS, Parameter};

use super::cell::Cell;

/// A column of a table whose rows are `R`.
pub struct Column<R> {
    /// The header of the column.
    pub name: Cow<'static, str>,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// The meaning of its cells, in half a sentence.
    pub meaning: &'static str,
    cell: CellSource<R>,
}

/// The function that makes the cell of a row.
enum CellSource<R> {
    Value(fn(&R) -> Cell),
    Parameter(&'static Parameter, fn(&R, &Parameter) -> Cell),
    Indexed(usize, fn(&R, usize) -> Cell),
}

impl<R> Column<R> {
    /// A column whose cells `cell` makes.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        cell: fn(&R) -> Cell,
    ) -> Self {
        Self { name: Cow::Borrowed(name), unit, meaning, cell: CellSource::Value(cell) }
    }

    /// One of several columns that differ by an index, from which `cell` makes the cells.
    pub fn indexed(
        name: String,
        unit: &'static str,
        meaning: &'static str,
        index: usize,
        cell: fn(&R, usize) -> Cell,
    ) -> Self {
        Self { name: name.into(), unit, meaning, cell: CellSource::Indexed(index, cell) }
    }

    /// The column of a parameter, whose cells `cell` makes.
    pub fn parameter(parameter: &'static Parameter, cell: fn(&R, &Parameter) -> Cell) -> Self {
        Self {
            name: Cow::Borrowed(header(parameter)),
            unit: parameter.unit,
            meaning: parameter.meaning,
            cell: CellSource::Parameter(parameter, cell),
        }
    }

    /// The cell of this column in a row.
    pub fn cell(&self, row: &R) -> Cell {
        match self.cell {
            CellSource::Value(cell) => cell(row),
            CellSource::Parameter(parameter, cell) => cell(row, parameter),
            CellSource::Indexed(index, cell) => cell(row, index),
        }
    }
}

/// The column of the number of a design.
pub fn number<R>(cell: fn(&R) -> Cell) -> Column<R> {
    Column::new("design", "-", "position of the design in the grid of its sweep", cell)
}

/// The header of the column of a parameter: its key, but for those that are also values. A row may have more scales than
/// were asked for, and a strip as many gaps as its length holds.
fn header(parameter: &Parameter) -> &'static str {
    match parameter.key {
        "scales" => "scales_asked",
        "gaps" => "gaps_asked",
        key => key,
    }
}

/// The parameter whose column has that header.
pub fn parameter_of(name: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| header(parameter) == name)
}
