//! Columns of tables: header, meaning, and the function that computes the cells.

use std::borrow::Cow;

use sweep::{PARAMETERS, Parameter};

use super::cell::Cell;

/// A column of a table with rows of type `R`.
pub struct Column<R> {
    /// Header of the column.
    pub name: Cow<'static, str>,
    /// Unit, or `-` for cells without a unit.
    pub unit: &'static str,
    /// Meaning of the cells, as a phrase without a full stop.
    pub meaning: &'static str,
    cell: CellSource<R>,
}

/// The function that computes the cell of a row.
///
/// Static lists of columns need function pointers, because a constant cannot contain a boxed
/// closure.
enum CellSource<R> {
    /// Column of a static list.
    Function(fn(&R) -> Cell),
    /// Column computed at run time, with captured data.
    Closure(Box<dyn Fn(&R) -> Cell + Send + Sync>),
}

impl<R> Column<R> {
    /// Creates a column with the function pointer `cell`, which computes the cell of a row.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        cell: fn(&R) -> Cell,
    ) -> Self {
        Self { name: Cow::Borrowed(name), unit, meaning, cell: CellSource::Function(cell) }
    }

    /// Creates a column with the closure `cell`, which computes the cell of a row.
    pub fn computed(
        name: Cow<'static, str>,
        unit: &'static str,
        meaning: &'static str,
        cell: impl Fn(&R) -> Cell + Send + Sync + 'static,
    ) -> Self {
        Self { name, unit, meaning, cell: CellSource::Closure(Box::new(cell)) }
    }

    /// Creates the column of a parameter.
    pub fn parameter(
        parameter: &'static Parameter,
        cell: impl Fn(&R) -> Cell + Send + Sync + 'static,
    ) -> Self {
        Self::computed(header(parameter).into(), parameter.unit, parameter.meaning, cell)
    }

    /// Returns the cell of this column in a row.
    pub fn cell(&self, row: &R) -> Cell {
        match &self.cell {
            CellSource::Function(cell) => cell(row),
            CellSource::Closure(cell) => cell(row),
        }
    }
}

/// Builds an array of columns for rows of the given type.
///
/// Each entry: header, unit, cell of a row, meaning.
#[macro_export]
macro_rules! columns {
    ($row:ty: $($name:expr, $unit:expr, |$of:pat_param| $cell:expr, $meaning:expr;)*) => {
        [$($crate::Column::<$row>::new($name, $unit, $meaning, |$of| $cell.into()),)*]
    };
}

/// Creates the column of the design number.
pub fn number<R>(cell: fn(&R) -> Cell) -> Column<R> {
    Column::new("design", "-", "position of the design in the grid of its sweep", cell)
}

/// Returns the column header of a parameter.
///
/// The header is the key, unless a measured value has the same name. For example, the solved row
/// may have more scales than the parameter `scales` requests; the column `scales` is the solved
/// number.
fn header(parameter: &Parameter) -> &'static str {
    match parameter.key {
        "scales" => "scales_asked",
        "gaps" => "gaps_asked",
        key => key,
    }
}

/// Returns true if the column `name` is a parameter that distinguishes designs.
///
/// A length in mm does not distinguish designs if the same length divided by the thickness is also
/// among the columns `headers`.
pub fn distinguishes_designs(name: &str, headers: &[String]) -> bool {
    let over_t = parameter_of(name).map(Parameter::over_t);
    over_t.is_some_and(|over_t| {
        !over_t.is_some_and(|of| headers.iter().any(|header| header == of.key))
    })
}

/// Returns the `columns` that are not parameters, without duplicates.
pub fn measures_among<'a>(columns: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut measured: Vec<&str> = Vec::new();
    for column in columns {
        if parameter_of(column).is_none() && !measured.contains(&column) {
            measured.push(column);
        }
    }
    measured
}

/// Returns the parameter with this column header.
pub fn parameter_of(name: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| header(parameter) == name)
}
