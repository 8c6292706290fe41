//! What solving a design again has changed.

use crate::columns::Column;

/// One value before and after a re-run.
#[derive(Clone, Debug)]
pub struct Change {
    /// Number of the design.
    pub design: String,
    /// Which rerun it was, from 1.
    pub rerun: u64,
    /// The settings before and after.
    pub settings: [String; 2],
    /// The column, empty if no value changed.
    pub column: String,
    /// The cell before and after.
    pub values: [String; 2],
}

/// The columns of `reruns.csv`.
pub static RERUN_COLUMNS: &[Column<Change>] = &[
    Column::new("design", "-", "position of the design in the grid of its sweep", |c: &Change| {
        c.design.clone().into()
    }),
    Column::new("rerun", "-", "which re-run of the design it was, from 1", |c| {
        c.rerun.to_string().into()
    }),
    Column::new("settings", "-", "settings of the re-run that are not the sweep's own", |c| {
        c.settings[1].clone().into()
    }),
    Column::new("old_settings", "-", "settings before", |c| c.settings[0].clone().into()),
    Column::new("column", "-", "column of `designs.csv` that changed, empty if none did", |c| {
        c.column.clone().into()
    }),
    Column::new("old", "as the column", "its value before", |c| c.values[0].clone().into()),
    Column::new("new", "as the column", "its value after", |c| c.values[1].clone().into()),
];
