//! The one list of columns: every table, and every explanation of a column, comes from here.

pub mod cell;
mod path;
mod samples;
mod values;

use std::borrow::{Borrow, Cow};

use sweep::{Axis, Measure, PARAMETERS, Parameter, Sweep};

use crate::design::design_result::DesignRow;
use crate::design::failure::{FailureRow, failure_detail_columns};
use crate::folder::RunFolder;
use samples::SAMPLE_VALUES;
use values::VALUES;

pub use cell::Cell;
pub use path::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_PATH, FLEXURE_SCALES, FLEXURE_STEPS, PATH, SCALES,
    STEPS,
};

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

/// A measured value, with the tables in which it stands besides `designs.csv`.
struct MeasuredValue {
    tables: &'static [&'static str],
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    cell: fn(&DesignRow) -> Cell,
}

/// The tables of one measure, named by the value that they are about.
pub const MEASURE_TABLES: [(&str, Measure); 4] = [
    ("coverage", Measure::Coverage),
    ("critical_force", Measure::Puncture),
    ("penetration", Measure::Puncture),
    ("compliance", Measure::Flexure),
];

impl MeasuredValue {
    fn column(&self) -> Column<DesignRow> {
        Column::new(self.name, self.unit, self.meaning, self.cell)
    }

    /// Whether it is what a table of its own is about.
    fn leads(&self) -> bool {
        MEASURE_TABLES.iter().any(|(table, _)| *table == self.name)
    }
}

/// The measured values of the designs of `sweep`.
fn values(sweep: &Sweep) -> impl Iterator<Item = &'static MeasuredValue> {
    let samples = if sweep.is_imperfect() { SAMPLE_VALUES } else { &[] };
    VALUES.iter().chain(samples)
}

/// The unit of a measured value and what it is, by its name.
pub fn explain_value(name: &str) -> Option<(&'static str, &'static str)> {
    let value = VALUES.iter().chain(SAMPLE_VALUES).find(|value| value.name == name)?;
    Some((value.unit, value.meaning))
}

/// The layout of a table: the name of its file, and its columns.
pub struct TableLayout {
    /// Name of the file.
    pub file: String,
    /// Columns, from the left.
    pub columns: Vec<Column<DesignRow>>,
}

/// The tables of `sweep`: `designs.csv`, and those of the measures that it asks for.
pub fn tables(sweep: &Sweep) -> Vec<TableLayout> {
    let asked = MEASURE_TABLES.iter().filter(|(_, measure)| sweep.measures().contains(measure));
    let mut tables =
        vec![TableLayout { file: RunFolder::DESIGNS.to_owned(), columns: design_columns(sweep) }];
    tables.extend(asked.map(|(table, _)| TableLayout {
        file: RunFolder::measure_table(table),
        columns: measure_columns(sweep, table),
    }));
    tables
}

/// The columns of `designs.csv`: the same whatever is measured, but for the axes and those that only
/// imperfections have.
pub fn design_columns(sweep: &Sweep) -> Vec<Column<DesignRow>> {
    let (leading, others): (Vec<_>, Vec<_>) = values(sweep).partition(|value| value.leads());
    assemble(sweep, &leading, &others)
}

fn measure_columns(sweep: &Sweep, table: &str) -> Vec<Column<DesignRow>> {
    let belongs = |value: &&MeasuredValue| value.tables.contains(&table);
    let (leading, others): (Vec<_>, Vec<_>) =
        values(sweep).filter(belongs).partition(|value| value.name == table);
    assemble(sweep, &leading, &others)
}

/// The columns of `failures.csv`.
pub fn failure_columns(sweep: &Sweep) -> Vec<Column<FailureRow>> {
    let mut columns = geometry_columns();
    columns.extend(axis_columns(sweep));
    columns.extend(failure_detail_columns());
    columns
}

/// Number and geometry, the leading values, the axes that not every sweep has, the other values.
fn assemble(
    sweep: &Sweep,
    leading: &[&MeasuredValue],
    others: &[&MeasuredValue],
) -> Vec<Column<DesignRow>> {
    let mut columns = geometry_columns();
    columns.extend(leading.iter().map(|value| value.column()));
    columns.extend(axis_columns(sweep));
    columns.extend(others.iter().map(|value| value.column()));
    columns
}

/// The axes that every grid has.
const GEOMETRY: [&str; 3] = ["gap_over_t", "length_over_t", "slant_deg"];

/// The columns of the number of a design and of its geometry.
fn geometry_columns<R: Borrow<DesignRow>>() -> Vec<Column<R>> {
    let mut columns = vec![number(|row: &R| row.borrow().number.to_string().into())];
    columns.extend(GEOMETRY.into_iter().filter_map(Parameter::named).map(parameter_column));
    columns
}

/// The columns of the axes of `sweep` that not every grid has.
fn axis_columns<R: Borrow<DesignRow>>(sweep: &Sweep) -> impl Iterator<Item = Column<R>> {
    let axes = sweep.grid().axes().iter().map(Axis::parameter);
    axes.filter(|parameter| !GEOMETRY.contains(&parameter.key)).map(parameter_column)
}

fn parameter_column<R: Borrow<DesignRow>>(parameter: &'static Parameter) -> Column<R> {
    Column::parameter(parameter, |row, parameter| parameter.get(&row.borrow().case).into())
}
