//! The columns of `reruns.csv`.

use super::cell::Cell;
use super::column::Column;
use super::name;
use crate::columns;
use crate::design::rerun_change::RerunChange;

/// The columns of `reruns.csv`.
pub static RERUN_COLUMNS: &[Column<RerunChange>] = &columns! { RerunChange:
    "design", "-", |c| c.design.to_string(), "position of the design in the grid of its sweep";
    "rerun", "-", |c| c.rerun.to_string(), "number of the rerun of the design, from 1";
    name::SETTINGS, "-", |c| c.settings[1].clone(),
        "settings of the rerun that differ from the sweep";
    "old_settings", "-", |c| c.settings[0].clone(),
        "settings before the rerun that differ from the sweep";
    "column", "-", |c| Cell::Text(c.column.clone()),
        "column of `designs.csv` with a changed value, empty if no value changed";
    "old", "as the column", |c| c.values[0].clone(), "value of that column before the rerun";
    "new", "as the column", |c| c.values[1].clone(), "value of that column after the rerun";
};
