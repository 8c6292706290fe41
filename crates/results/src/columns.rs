//! The one list of columns: every table, and every explanation of a column, comes from here.

pub mod cell;
mod column;
mod failures;
mod measured_value;
mod path;
mod physical;
mod reruns;
mod samples;
mod sensitivity;
mod tilts;
mod values;

use std::borrow::Borrow;

use sweep::{Axis, Measure, Parameter, Sweep};

use crate::design::row::{DesignRow, FailureRow};
use crate::folder::{MEASURE_TABLES, RunFolder};
use measured_value::MeasuredValue;
use physical::{explain_physical, physical_columns};
use samples::SAMPLE_VALUES;
use tilts::{explain_tilt_value, tilt_columns};
use values::VALUES;

pub use cell::Cell;
pub use column::{Column, number, parameter_of};
pub use failures::failure_detail_columns;
pub use path::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_PATH, FLEXURE_SCALES, FLEXURE_STEPS, PATH,
    PunctureEvent, SCALES, STEPS, StabilityPoint,
};
pub use physical::{AREAL_MASS, physical_source};
pub use reruns::RERUN_COLUMNS;
pub use sensitivity::DERIVATIVE_COLUMNS;

/// The measured values of the designs of `sweep`.
fn values(sweep: &Sweep) -> impl Iterator<Item = &'static MeasuredValue> {
    let samples = if sweep.is_imperfect() { SAMPLE_VALUES } else { &[] };
    VALUES.iter().chain(samples)
}

/// The measured value of that name.
fn measured_value(name: &str) -> Option<&'static MeasuredValue> {
    VALUES.iter().chain(SAMPLE_VALUES).find(|value| value.name == name)
}

/// The unit of a measured value and what it is, by its name.
pub fn explain_value(name: &str) -> Option<(&'static str, &'static str)> {
    let value = measured_value(name).map(|value| (value.unit, value.meaning));
    value.or_else(|| explain_tilt_value(name)).or_else(|| explain_physical(name))
}

/// The value that the column `name` is about: of one in physical units the dimensionless value, of any other itself.
pub fn measure_name(name: &str) -> &str {
    physical_source(name).map_or(name, |(source, _)| source)
}

/// The measure that the column `name` belongs to; `None` if it is one of parameters, or of how designs were solved.
pub fn measure_of(name: &str) -> Option<Measure> {
    let tables = measured_value(measure_name(name))?.tables;
    let of = |(table, measure): &(&str, Measure)| tables.contains(table).then_some(*measure);
    MEASURE_TABLES.iter().find_map(of)
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
/// imperfections or several critical tilts have.
pub fn design_columns(sweep: &Sweep) -> Vec<Column<DesignRow>> {
    let (leading, others): (Vec<_>, Vec<_>) = values(sweep).partition(|value| value.leads());
    let mut columns = assemble(sweep, &leading, &others);
    columns.extend(tilt_columns(sweep, None));
    columns.extend(physical_columns(sweep, None));
    columns
}

fn measure_columns(sweep: &Sweep, table: &str) -> Vec<Column<DesignRow>> {
    let belongs = |value: &&MeasuredValue| value.tables.contains(&table);
    let (leading, others): (Vec<_>, Vec<_>) =
        values(sweep).filter(belongs).partition(|value| value.name == table);
    let mut columns = assemble(sweep, &leading, &others);
    columns.extend(tilt_columns(sweep, Some(table)));
    columns.extend(physical_columns(sweep, Some(table)));
    columns
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
