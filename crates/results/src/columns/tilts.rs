//! The columns of measures at tilts on the way, in runs that ask for several critical tilts.

use skin::puncture::TiltMeasures;
use sweep::{Parameter, Scalar, Sweep, number};

use super::cell::Cell;
use super::column::Column;
use crate::design::row::DesignRow;

/// A measure that is taken at several tilts.
pub(super) struct TiltValue {
    pub(super) tables: &'static [&'static str],
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
    cell: fn(&DesignRow, usize) -> Cell,
}

/// Every such measure, in the order of `designs.csv`.
pub(super) static TILT_VALUES: [TiltValue; 3] = [
    TiltValue {
        tables: &["critical_force"],
        name: "critical_force",
        unit: "E_s L t/(1-nu^2)",
        meaning: "puncture force where the tilt, or its tangent the friction, first is that of the name",
        cell: |row, index| at(row, index, |m| m.force),
    },
    TiltValue {
        tables: &["critical_force", "penetration"],
        name: "critical_displacement",
        unit: "t",
        meaning: "displacement of the punctured point where the tilt, or its tangent, first is that of the name",
        cell: |row, index| at(row, index, |m| m.displacement),
    },
    TiltValue {
        tables: &["penetration"],
        name: "penetration",
        unit: "t",
        meaning: "depth of the deepest base corner where the tilt, or its tangent, first is that of the name",
        cell: |row, index| at(row, index, |m| m.penetration),
    },
];

fn at(row: &DesignRow, index: usize, value: fn(&TiltMeasures) -> f64) -> Cell {
    row.result.at_tilts.get(index).and_then(Option::as_ref).map(value).into()
}

/// The columns at every tilt that `sweep` asks for, of the measures in a table or, with none, of all.
pub(super) fn tilt_columns(sweep: &Sweep, table: Option<&str>) -> Vec<Column<DesignRow>> {
    let belongs = |value: &&TiltValue| table.is_none_or(|table| value.tables.contains(&table));
    let values = TILT_VALUES.iter().filter(belongs);
    let column = |(index, place): (usize, &String), value: &TiltValue| {
        let name = format!("{}_at_{place}", value.name);
        Column::indexed(name, value.unit, value.meaning, index, value.cell)
    };
    let places = places(sweep);
    let columns =
        values.flat_map(|value| places.iter().enumerate().map(|place| column(place, value)));
    columns.collect()
}

/// The tilts that `sweep` asks for, as parts of names: `5deg`, or `friction_0.1`.
fn places(sweep: &Sweep) -> Vec<String> {
    let list = |key: &str| match Parameter::named(key)?.get(sweep.grid().base()) {
        Scalar::List(list) if sweep.grid().axis(key).is_none() => Some(list),
        _ => None,
    };
    let text = |&number: &f64| number::text(number);
    if let Some(frictions) = list("needle_friction") {
        let names = frictions.as_slice().iter().map(text);
        return names.map(|friction| format!("friction_{friction}")).collect();
    }
    let tilts = list("critical_tilt_deg").unwrap_or_default();
    tilts.as_slice().iter().map(text).map(|tilt| format!("{tilt}deg")).collect()
}

/// Unit and meaning of a column at a tilt, by its name.
pub(super) fn explain_tilt_value(name: &str) -> Option<(&'static str, &'static str)> {
    let is_at = |value: &&TiltValue| {
        name.strip_prefix(value.name).is_some_and(|rest| rest.starts_with("_at_"))
    };
    TILT_VALUES.iter().find(is_at).map(|value| (value.unit, value.meaning))
}
