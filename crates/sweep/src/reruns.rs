//! What solving designs again has changed.

use std::path::Path;

use crate::columns::Column;
use crate::dialect::Dialect;
use crate::journal::{Archive, Entry, JournalError};
use crate::row;
use crate::table::Table;

/// The table of what re-runs have changed.
pub(crate) const RERUNS: &str = "reruns.csv";

/// One value before and after a re-run.
#[derive(Clone, Debug)]
pub struct Change {
    design: String,
    rerun: u64,
    settings: [String; 2],
    column: String,
    values: [String; 2],
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

/// Writes the table if there is anything to tell, and returns its name.
pub(crate) fn write(
    archive: &Archive,
    folder: &Path,
    dialect: Dialect,
) -> Result<Option<String>, JournalError> {
    let mut pairs = archive.entries()?.replaced().peekable();
    if pairs.peek().is_none() {
        return Ok(None);
    }
    let names = RERUN_COLUMNS.iter().map(|column| column.name);
    let mut table = Table::create(folder, RERUNS, dialect, names)?;
    for pair in pairs {
        let (old, new) = pair?;
        for change in changes(&archive.header().columns, &old, &new) {
            let cells = RERUN_COLUMNS.iter().map(|column| column.cell(&change).to_string());
            let cells: Vec<_> = cells.collect();
            table.write(cells.iter().map(String::as_str))?;
        }
    }
    table.finish()?;
    Ok(Some(RERUNS.to_owned()))
}

/// Every value that changed; one change without a column if none did.
fn changes(columns: &[String], old: &Entry, new: &Entry) -> Vec<Change> {
    let find = |entry: &Entry, name: &str| {
        let place = columns.iter().position(|column| column == name)?;
        row::cell(&entry.row, place).map(str::to_owned)
    };
    let both = |name: &str| [old, new].map(|entry| find(entry, name).unwrap_or_default());
    let change = |column: &str, values| Change {
        design: find(new, "design").unwrap_or_default(),
        rerun: new.rerun,
        settings: both("settings"),
        column: column.to_owned(),
        values,
    };
    let values = columns.iter().filter(|name| *name != "settings").map(|name| (name, both(name)));
    let changed = values.filter(|(_, [old, new])| old != new);
    let mut changes: Vec<_> = changed.map(|(name, values)| change(name, values)).collect();
    if changes.is_empty() {
        changes.push(change("", Default::default()));
    }
    changes
}
