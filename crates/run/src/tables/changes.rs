//! What solving designs again has changed.

use results::{Change, Dialect, RERUN_COLUMNS, RunFolder, Table, row};

use crate::journal::{Archive, Entry, JournalError};

/// Writes the table if there is anything to tell, and returns its name.
pub(crate) fn write(
    archive: &Archive,
    folder: &RunFolder,
    dialect: Dialect,
) -> Result<Option<String>, JournalError> {
    let mut pairs = archive.entries()?.replaced().peekable();
    if pairs.peek().is_none() {
        return Ok(None);
    }
    let names = RERUN_COLUMNS.iter().map(|column| column.name);
    let mut table = Table::create(folder.path(), RunFolder::RERUNS, dialect, names)?;
    for pair in pairs {
        let (old, new) = pair?;
        for change in changes(&archive.header().columns, &old, &new) {
            let cells = RERUN_COLUMNS.iter().map(|column| column.cell(&change).to_string());
            let cells: Vec<_> = cells.collect();
            table.write(cells.iter().map(String::as_str))?;
        }
    }
    table.finish()?;
    Ok(Some(RunFolder::RERUNS.to_owned()))
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
