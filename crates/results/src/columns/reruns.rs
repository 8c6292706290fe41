//! The columns of `reruns.csv`.

use super::cell::Cell;
use super::column::Column;
use super::name;
use crate::design::rerun_change::RerunChange;

/// The columns of `reruns.csv`.
pub static RERUN_COLUMNS: &[Column<RerunChange>] = &[
    Column::new("design", "-", "position of the design in the grid of its sweep", |c| {
        c.design.to_string().into()
    }),
    Column::new("rerun", "-", "which re-run of the design it was, from 1", |c| {
        c.rerun.to_string().into()
    }),
    Column::new(name::SETTINGS, "-", "settings of the re-run that are not the sweep's own", |c| {
        c.settings[1].clone().into()
    }),
    Column::new("old_settings", "-", "settings before", |c| c.settings[0].clone().into()),
    Column::new("column", "-", "column of `designs.csv` that changed, empty if none did", |c| {
        Cell::Text(c.column.clone())
    }),
    Column::new("old", "as the column", "its value before", |c| c.values[0].clone()),
    Column::new("new", "as the column", "its value after", |c| c.values[1].clone()),
];
