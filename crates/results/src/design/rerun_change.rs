//! Values that changed when a design was solved again.

use std::borrow::Cow;

use sweep::DesignNumber;

use crate::columns::{Cell, Column};

/// A row of `reruns.csv`: one value before and after a rerun.
#[derive(Clone, Debug)]
pub struct RerunChange {
    /// Number of the design.
    pub design: DesignNumber,
    /// Number of the rerun, from 1.
    pub rerun: u64,
    /// The settings before and after.
    pub settings: [String; 2],
    /// The column, empty if no value changed.
    pub column: Cow<'static, str>,
    /// The cell before and after.
    pub values: [Cell; 2],
}

/// The columns of `reruns.csv`.
pub static RERUN_COLUMNS: &[Column<RerunChange>] = &[
    Column::new("design", "-", "position of the design in the grid of its sweep", |c| {
        c.design.to_string().into()
    }),
    Column::new("rerun", "-", "which re-run of the design it was, from 1", |c| {
        c.rerun.to_string().into()
    }),
    Column::new("settings", "-", "settings of the re-run that are not the sweep's own", |c| {
        c.settings[1].clone().into()
    }),
    Column::new("old_settings", "-", "settings before", |c| c.settings[0].clone().into()),
    Column::new("column", "-", "column of `designs.csv` that changed, empty if none did", |c| {
        Cell::Text(c.column.clone())
    }),
    Column::new("old", "as the column", "its value before", |c| c.values[0].clone()),
    Column::new("new", "as the column", "its value after", |c| c.values[1].clone()),
];
