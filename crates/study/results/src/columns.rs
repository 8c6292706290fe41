//! Columns of the tables, with their units and meanings.
//!
//! The list of measured values is in `columns/values.rs`; to add a column, start there. This module
//! selects and orders the columns of each table for a sweep.

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
use derived_columns::COLUMNS;
use tilts::{explain_tilt_value, tilt_columns};
use values::VALUES;

pub use cell::Cell;
pub use column::{Column, distinguishes_designs, measures_among, number, parameter_of};
pub use derived_columns::ValueColumn;
pub use failures::failure_detail_columns;
pub use measured_value::{Goal, MeasuredValue, Shown};
pub use path::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_SCALES, FLEXURE_STEPS, LOAD_POSITIONS,
    PunctureEvent, SCALES, STEPS, StabilityPoint, flexure_path_columns, path_columns,
    tip_force_columns,
};
pub use reruns::RERUN_COLUMNS;
pub use sensitivity::DERIVATIVE_COLUMNS;

/// Lengths in mm that are columns if a sweep gives the thickness.
const LENGTHS_IN_MM: [&str; 4] = ["gap_mm", "length_mm", "width_mm", key::PITCH];

/// Returns the measured value with this name.
pub fn measured_value(name: &str) -> Option<&'static MeasuredValue> {
    VALUES.iter().find(|value| value.name == name)
}

/// Returns unit and meaning of the column `name` of a measured value.
pub fn explain_value(name: &str) -> Option<(&'static str, &'static str)> {
    let column = ValueColumn::named(name).map(|column| (column.unit, column.meaning.as_ref()));
    column.or_else(|| explain_tilt_value(name))
}

/// Returns the dimensionless value and the quantity of a physical column.
pub fn physical_source(name: &str) -> Option<(&'static str, Quantity)> {
    let column = ValueColumn::named(name)?;
    Some((column.dimensionless()?.name.as_ref(), column.quantity?))
}

/// Returns the name of the dimensionless value of a physical column; other names are unchanged.
pub fn measure_name(name: &str) -> &str {
    physical_source(name).map_or(name, |(source, _)| source)
}

/// Returns the measure to which a column belongs.
///
/// `None` for parameters and solver information.
pub fn measure_of(name: &str) -> Option<Measure> {
    ValueColumn::named(name)?.value.measure()
}

/// Returns true if the values of a column are not valid after the surface of the substrate folds.
pub fn is_invalid_after_fold(name: &str) -> bool {
    about(name).is_some_and(|(value, _)| {
        // Values at the fold stay valid. The first failure is never after the fold, because the
        // fold is a failure mode.
        let before_fold = [name::SOUND_FORCE, name::FAILURE_FORCE, name::FIRST_FAILURE];
        let is_about_fold = before_fold.contains(&value.name) || value.name.starts_with("fold_");
        value.measure() == Some(Measure::Puncture) && !is_about_fold
    })
}

/// Returns true if [`skin::PathDetail::Critical`] omits the value of a column.
///
/// `name` may also be the name of a derived column, such as a quantile.
pub fn is_along_path(name: &str) -> bool {
    about(name).is_some_and(|(value, _)| value.is_along_path())
}

/// Returns true if the values of a column may belong to the first fold of the surface.
///
/// [`skin::PathDetail::End`] omits these values.
///
/// `name` may also be the name of a derived column, such as a quantile.
pub fn is_at_fold(name: &str) -> bool {
    about(name).is_some_and(|(value, _)| value.is_at_fold())
}

/// Returns true if a column exists only in sweeps that set the parameter `key` or an alternative.
///
/// `name` may also be the name of a derived column, such as a quantile.
pub fn needs_parameter(name: &str, key: &str) -> bool {
    about(name).is_some_and(|(value, _)| value.needs.contains(&key))
}

/// Returns the column of the failure mode, if the column `name` contains failure forces.
///
/// All outputs show force and mode together, also for quantiles and in physical units.
pub fn mode_column(name: &str) -> Option<&'static str> {
    let (value, _) = about(name)?;
    (value.name == name::FAILURE_FORCE).then_some(name::FIRST_FAILURE)
}

/// Returns the measured value of a column, and its quantity if the column has a physical unit.
///
/// `name` may also be the name of a derived column, such as a quantile.
pub(crate) fn about(name: &str) -> Option<(&'static MeasuredValue, Option<Quantity>)> {
    // Take the longest stem: `critical_force_per_width` also begins with `critical_force`.
    let column = ValueColumn::named(name).or_else(|| {
        COLUMNS
            .iter()
            .filter(|column| {
                name.strip_prefix(column.stem())
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
            })
            .max_by_key(|column| column.stem().len())
    })?;
    Some((column.value, column.quantity))
}

/// Returns whether large or small values of a column are better.
///
/// `None` if neither is generally better.
pub fn plain_goal(name: &str) -> Option<Goal> {
    let (value, quantity) = about(name)?;
    value.good_as(quantity)
}

/// Returns the values that a page shows in the position `place`, grouped by table.
pub fn shown(place: Shown) -> Vec<&'static str> {
    let mut values: Vec<_> = VALUES.iter().filter(|value| value.shown == place).collect();
    // Stable sort: values of one table keep the order of `designs.csv`.
    values.sort_by_key(|value| value.first_table());
    values.into_iter().map(|value| value.name).collect()
}

/// Layout of a table: file name and columns.
pub struct TableLayout {
    /// Name of the file in the folder.
    pub file: String,
    /// Columns, from the left.
    pub columns: Vec<Column<DesignRow>>,
}

/// Returns the layouts of `designs.csv` and of the tables of the requested measures of `sweep`.
pub fn tables(sweep: &Sweep) -> Vec<TableLayout> {
    let requested = MEASURE_TABLES.iter().filter(|(_, measure)| sweep.measures().contains(measure));
    let mut tables = vec![TableLayout {
        file: ResultsFolder::DESIGNS.to_owned(),
        columns: design_columns(sweep),
    }];
    tables.extend(requested.map(|(table, _)| TableLayout {
        file: ResultsFolder::measure_table(table),
        columns: columns(sweep, Some(table)),
    }));
    tables
}

/// Returns the columns of `designs.csv`.
///
/// The columns depend on the axes and parameters of `sweep`, but not on its measures.
pub fn design_columns(sweep: &Sweep) -> Vec<Column<DesignRow>> {
    columns(sweep, None)
}

/// Returns the columns of one measure table, or of `designs.csv` for `None`.
///
/// Order: number, geometry, leading values, axes other than the geometry, other values, values at
/// several tilts, values in physical units. In a sweep with a thickness, lengths in mm come before
/// the geometry, and values in physical units before the dimensionless values that they replace.
fn columns(sweep: &Sweep, table: Option<&str>) -> Vec<Column<DesignRow>> {
    let available = COLUMNS.iter().filter(|column| column.is_available(sweep, table));
    let (physical, values): (Vec<_>, Vec<_>) = available.partition(|column| column.is_physical());
    let (leading, others): (Vec<_>, Vec<_>) = values.into_iter().partition(|column| match table {
        Some(table) => column.name == table,
        None => column.names_a_table(),
    });
    let has_thickness = sweep.gives(key::THICKNESS);
    let (leading, after_axes, last) = if has_thickness {
        let (replaced, leading): (Vec<_>, Vec<_>) =
            leading.into_iter().partition(|column| column.has_physical_unit());
        (Vec::new(), [leading, physical, replaced].concat(), Vec::new())
    } else {
        (leading, Vec::new(), physical)
    };
    let [leading, after_axes, others, last] = [leading, after_axes, others, last]
        .map(|columns| columns.into_iter().map(ValueColumn::column));
    let has_lengths_in_mm = has_thickness && table.is_none();
    let mut columns = vec![number_column()];
    if has_lengths_in_mm {
        columns.extend(columns_in_mm(sweep));
    }
    columns.extend(geometry_columns());
    columns.extend(leading);
    columns.extend(axis_columns(sweep));
    columns.extend(after_axes);
    columns.extend(others);
    columns.extend(tilt_columns(sweep, table));
    columns.extend(last);
    if has_lengths_in_mm {
        columns.extend(width_column(sweep));
    }
    columns
}

/// Returns all columns of measured values, including columns that only some sweeps have.
pub fn value_columns() -> impl Iterator<Item = Column<DesignRow>> {
    COLUMNS.iter().map(ValueColumn::column)
}

/// Returns the columns of `failures.csv`.
pub fn failure_columns(sweep: &Sweep) -> Vec<Column<FailureRow>> {
    let mut columns = vec![number_column()];
    columns.extend(geometry_columns());
    columns.extend(axis_columns(sweep));
    columns.extend(failure_detail_columns());
    columns
}

fn number_column<R: Borrow<DesignRow>>() -> Column<R> {
    number(|row: &R| row.borrow().number.to_string().into())
}

fn geometry_columns<R: Borrow<DesignRow>>() -> impl Iterator<Item = Column<R>> {
    Parameter::with(Role::Geometry).map(parameter_column)
}

/// Returns the columns of the axes of `sweep`, except the axes of the geometry.
fn axis_columns<R: Borrow<DesignRow>>(sweep: &Sweep) -> impl Iterator<Item = Column<R>> {
    let axes = sweep.grid().axes().iter().map(Axis::parameter);
    axes.filter(|parameter| !parameter.has(Role::Geometry)).map(parameter_column)
}

/// Returns the columns of the lengths in mm that are not axes.
fn columns_in_mm(sweep: &Sweep) -> impl Iterator<Item = Column<DesignRow>> {
    let lengths = LENGTHS_IN_MM.into_iter().filter_map(Parameter::named);
    lengths.filter(|parameter| sweep.grid().axis(parameter.key).is_none()).map(|parameter| {
        Column::parameter(parameter, |row: &DesignRow| parameter.millimetres(&row.case).into())
    })
}

/// Returns the column of the width divided by the thickness, unless this parameter is an axis.
fn width_column(sweep: &Sweep) -> Option<Column<DesignRow>> {
    let width = Parameter::named(key::WIDTH)?;
    sweep.grid().axis(width.key).is_none().then(|| parameter_column(width))
}

fn parameter_column<R: Borrow<DesignRow>>(parameter: &'static Parameter) -> Column<R> {
    Column::parameter(parameter, |row: &R| parameter.get(&row.borrow().case).into())
}
