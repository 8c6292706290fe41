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
// A static list holds functions alone: what a closure owns has no place in a constant.
enum CellSource<R> {
    /// One of a static list of columns.
    Function(fn(&R) -> Cell),
    /// One that is made, which knows what it is made from.
    Closure(Box<dyn Fn(&R) -> Cell + Send + Sync>),
}

impl<R> Column<R> {
    /// A column whose cells `cell` makes.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        cell: fn(&R) -> Cell,
    ) -> Self {
        Self { name: Cow::Borrowed(name), unit, meaning, cell: CellSource::Function(cell) }
    }

    /// A column that is made from something that `cell` knows.
    pub fn computed(
        name: Cow<'static, str>,
        unit: &'static str,
        meaning: &'static str,
        cell: impl Fn(&R) -> Cell + Send + Sync + 'static,
    ) -> Self {
        Self { name, unit, meaning, cell: CellSource::Closure(Box::new(cell)) }
    }

    /// The column of a parameter.
    pub fn parameter(
        parameter: &'static Parameter,
        cell: impl Fn(&R) -> Cell + Send + Sync + 'static,
    ) -> Self {
        Self::computed(header(parameter).into(), parameter.unit, parameter.meaning, cell)
    }

    /// The cell of this column in a row.
    pub fn cell(&self, row: &R) -> Cell {
        match &self.cell {
            CellSource::Function(cell) => cell(row),
            CellSource::Closure(cell) => cell(row),
        }
    }
}

/// The columns of a table whose rows are of the type that comes first, one after the other: header, unit, cell of a row, meaning.
#[macro_export]
macro_rules! columns {
    ($row:ty: $($name:expr, $unit:expr, |$of:pat_param| $cell:expr, $meaning:expr;)*) => {
        [$($crate::Column::<$row>::new($name, $unit, $meaning, |$of| $cell.into()),)*]
    };
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

/// Whether the column `name` of a table with these headers tells its designs apart: it is that of a parameter, and of no length in
/// mm that stands there over the thickness too.
pub fn tells_apart(name: &str, headers: &[String]) -> bool {
    let over_t = parameter_of(name).map(Parameter::over_t);
    let stands = |of: &Parameter| headers.iter().any(|header| header == of.key);
    over_t.is_some_and(|over_t| !over_t.is_some_and(stands))
}

/// The parameter whose column has that header.
pub fn parameter_of(name: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| header(parameter) == name)
}
