//! The one list of columns: every table, and every explanation of a column, comes from here.

mod builders;
pub mod cell;
mod column;
mod derived_columns;
mod failures;
pub(crate) mod measured_value;
pub mod name;
mod path;
mod reruns;
mod sensitivity;
mod tilts;
pub(crate) mod values;

use std::borrow::Borrow;

use sweep::{Axis, Measure, Parameter, Role, Sweep, key};

use crate::design::row::{DesignRow, FailureRow};
use crate::folder::{MEASURE_TABLES, ResultsFolder};
use crate::quantity::Quantity;
use derived_columns::{COLUMNS, ValueColumn};
use tilts::{explain_tilt_value, tilt_columns};
use values::VALUES;

pub use cell::Cell;
pub use column::{Column, number, parameter_of, tells_apart};
pub use failures::failure_detail_columns;
pub use measured_value::{Goal, MeasuredValue, Shown};
pub use path::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_SCALES, FLEXURE_STEPS, LOADED_PLACES, PunctureEvent,
    SCALES, STEPS, StabilityPoint, flexure_path_columns, path_columns, tip_force_columns,
};
pub use reruns::RERUN_COLUMNS;
pub use sensitivity::DERIVATIVE_COLUMNS;

/// The lengths that every skin of a thickness has in mm.
const LENGTHS_IN_MM: [&str; 4] = ["gap_mm", "length_mm", "width_mm", key::PITCH];

/// The measured value of that name.
pub fn measured_value(name: &str) -> Option<&'static MeasuredValue> {
    VALUES.iter().find(|value| value.name == name)
}

/// The unit of a measured value and what it is, by its name.
pub fn explain_value(name: &str) -> Option<(&'static str, &'static str)> {
    let column = ValueColumn::named(name).map(|column| (column.unit, column.meaning.as_ref()));
    column.or_else(|| explain_tilt_value(name))
}

/// The dimensionless value that a column in physical units is made from, by its name, and how.
pub fn physical_source(name: &str) -> Option<(&'static str, Quantity)> {
    let column = ValueColumn::named(name)?;
    Some((column.dimensionless()?.name.as_ref(), column.quantity?))
}

/// The value that the column `name` is about: of one in physical units the dimensionless value, of any other itself.
pub fn measure_name(name: &str) -> &str {
    physical_source(name).map_or(name, |(source, _)| source)
}

/// The measure that the column `name` belongs to; `None` if it is one of parameters, or of how designs were solved.
pub fn measure_of(name: &str) -> Option<Measure> {
    ValueColumn::named(name)?.value.measure()
}

/// The column that one of that name, which may be a quantile or another thing that is made from it, is about.
pub(crate) fn about(name: &str) -> Option<(&'static MeasuredValue, Option<Quantity>)> {
    let is_made_from = |column: &&ValueColumn| {
        name.strip_prefix(column.stem())
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    };
    // The longest stem, because `critical_force_per_width` begins as `critical_force` does.
    let nearest = || COLUMNS.iter().filter(is_made_from).max_by_key(|column| column.stem().len());
    let column = ValueColumn::named(name).or_else(nearest)?;
    Some((column.value, column.quantity))
}

/// Which of the values of a column are good, where that is plain.
pub fn plain_goal(name: &str) -> Option<Goal> {
    let (value, quantity) = about(name)?;
    value.good_as(quantity)
}

/// The names of the values that the table of a page shows at such a place: those of a table together.
pub fn shown(place: Shown) -> Vec<&'static str> {
    let mut values: Vec<_> = VALUES.iter().filter(|value| value.shown == place).collect();
    // Stable: within a table values keep the order of `designs.csv`.
    values.sort_by_key(|value| value.first_table());
    values.into_iter().map(|value| value.name).collect()
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
    let mut tables = vec![TableLayout {
        file: ResultsFolder::DESIGNS.to_owned(),
        columns: design_columns(sweep),
    }];
    tables.extend(asked.map(|(table, _)| TableLayout {
        file: ResultsFolder::measure_table(table),
        columns: columns(sweep, Some(table)),
    }));
    tables
}

/// The columns of `designs.csv`: the same whatever is measured, but for the axes and those that only
/// imperfections or several critical tilts have.
pub fn design_columns(sweep: &Sweep) -> Vec<Column<DesignRow>> {
    columns(sweep, None)
}

/// The columns of a table of measures, or of all: number and geometry, what tables are about, the axes that not every sweep
/// has, the other values, those at several tilts, those in physical units.
fn columns(sweep: &Sweep, table: Option<&str>) -> Vec<Column<DesignRow>> {
    let leads = |column: &ValueColumn| match table {
        Some(table) => column.name == table,
        None => column.leads(),
    };
    let standing = COLUMNS.iter().filter(|column| column.stands(sweep, table));
    let (physical, values): (Vec<_>, Vec<_>) = standing.partition(|column| column.is_physical());
    let (leading, others): (Vec<_>, Vec<_>) = values.into_iter().partition(|column| leads(column));
    let made = |columns: Vec<&'static ValueColumn>| columns.into_iter().map(ValueColumn::column);
    let mut columns = geometry_columns();
    columns.extend(made(leading));
    columns.extend(axis_columns(sweep));
    columns.extend(made(others));
    columns.extend(tilt_columns(sweep, table));
    // What a `[material]` adds stands last, so that the columns before it keep their places.
    if table.is_none() && sweep.gives(key::THICKNESS) {
        columns.extend(length_columns(sweep));
    }
    columns.extend(made(physical));
    columns
}

/// The columns of `failures.csv`.
pub fn failure_columns(sweep: &Sweep) -> Vec<Column<FailureRow>> {
    let mut columns = geometry_columns();
    columns.extend(axis_columns(sweep));
    columns.extend(failure_detail_columns());
    columns
}

/// The columns of the number of a design and of its geometry.
fn geometry_columns<R: Borrow<DesignRow>>() -> Vec<Column<R>> {
    let mut columns = vec![number(|row: &R| row.borrow().number.to_string().into())];
    columns.extend(Parameter::with(Role::Geometry).map(parameter_column));
    columns
}

/// The columns of the axes of `sweep` that not every grid has.
fn axis_columns<R: Borrow<DesignRow>>(sweep: &Sweep) -> impl Iterator<Item = Column<R>> {
    let axes = sweep.grid().axes().iter().map(Axis::parameter);
    axes.filter(|parameter| !parameter.has(Role::Geometry)).map(parameter_column)
}

/// The columns of the lengths of a skin in mm, which axes may have too; and of the width, which these are told apart by.
fn length_columns(sweep: &Sweep) -> impl Iterator<Item = Column<DesignRow>> {
    let is_axis = |parameter: &&Parameter| sweep.grid().axis(parameter.key).is_some();
    let width = Parameter::named(key::WIDTH).filter(|width| !is_axis(width)).map(parameter_column);
    let lengths = LENGTHS_IN_MM.into_iter().filter_map(Parameter::named);
    let in_mm = lengths.filter(move |parameter| !is_axis(parameter)).map(|parameter| {
        let length = |row: &DesignRow| parameter.millimetres(&row.case).into();
        Column::parameter(parameter, length)
    });
    width.into_iter().chain(in_mm)
}

fn parameter_column<R: Borrow<DesignRow>>(parameter: &'static Parameter) -> Column<R> {
    Column::parameter(parameter, |row: &R| parameter.get(&row.borrow().case).into())
}
