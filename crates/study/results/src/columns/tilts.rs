//! Columns of measures at each of several critical tilts.

use sweep::{Parameter, Scalar, Sweep, key};
use text::number;

use super::column::Column;
use super::measured_value::{MeasuredValue, TiltValue};
use super::values::VALUES;
use crate::design::row::DesignRow;

/// Returns the values measured at several tilts, grouped by table.
fn tilt_values() -> Vec<(&'static MeasuredValue, &'static TiltValue)> {
    let mut values: Vec<_> =
        VALUES.iter().filter_map(|value| Some((value, value.at_tilts.as_ref()?))).collect();
    values.sort_by_key(|(value, _)| value.first_table());
    values
}

/// Returns the columns of the values at each of several critical tilts of `sweep`.
///
/// `table` selects the columns of one measure table; `None` selects all.
pub(super) fn tilt_columns(sweep: &Sweep, table: Option<&str>) -> Vec<Column<DesignRow>> {
    let suffixes = tilt_suffixes(sweep);
    let columns = tilt_values()
        .into_iter()
        .filter(|(value, _)| table.is_none_or(|table| value.tables.contains(&table)));
    let columns = columns.flat_map(|(value, at_tilts)| {
        suffixes.iter().enumerate().map(move |(index, suffix)| {
            let name = format!("{}_at_{suffix}", value.name);
            Column::computed(name.into(), value.unit, at_tilts.meaning, move |row: &DesignRow| {
                let at = row.result.at_tilts.get(index).and_then(Option::as_ref);
                at.map(at_tilts.value).into()
            })
        })
    });
    columns.collect()
}

/// Returns the tilts of `sweep` as parts of column names, such as `5deg` or `friction_0.1`.
///
/// Empty unless the sweep has several critical tilts.
fn tilt_suffixes(sweep: &Sweep) -> Vec<String> {
    let list = |key: &str| match Parameter::named(key)?.get(sweep.grid().base()) {
        // The base value of a parameter that is an axis is meaningless.
        Scalar::List(list) if sweep.grid().axis(key).is_none() => Some(list),
        _ => None,
    };
    // Name the columns after the requested frictions, not after the tilts computed from them.
    if let Some(frictions) = list(key::NEEDLE_FRICTION) {
        let frictions = frictions.as_slice().iter();
        return frictions.map(|&f| format!("friction_{}", number::text(f))).collect();
    }
    let tilts = list(key::CRITICAL_TILT).unwrap_or_default();
    tilts.as_slice().iter().map(|&tilt| format!("{}deg", number::text(tilt))).collect()
}

/// Returns unit and meaning of the column `name`, which contains a value at one of several tilts.
pub(super) fn explain_tilt_value(name: &str) -> Option<(&'static str, &'static str)> {
    let found = tilt_values().into_iter().find(|(value, _)| {
        name.strip_prefix(value.name).is_some_and(|rest| rest.starts_with("_at_"))
    });
    found.map(|(value, at_tilts)| (value.unit, at_tilts.meaning))
}
