//! Table `reruns.csv`: values that changed when designs were solved again.

use journal::JournalError;
use results::columns::{design_columns, name};
use results::{
    Cell, Column, CsvFile, CsvFormat, DesignRow, RERUN_COLUMNS, RerunChange, ResultsFolder,
};

use crate::run_journal::Archive;

/// Writes `reruns.csv`, the table of values that changed when designs were solved again.
///
/// Returns its file name and SHA-256, or `None` if no design was solved again.
pub(super) fn write(
    archive: &Archive,
    folder: &ResultsFolder,
    format: CsvFormat,
) -> Result<Option<(String, String)>, JournalError> {
    let mut pairs = archive.entries()?.replaced().peekable();
    // The file is omitted rather than empty: its absence shows that no design was solved again.
    if pairs.peek().is_none() {
        return Ok(None);
    }
    let columns = design_columns(archive.sweep());
    let mut table = CsvFile::create(folder, ResultsFolder::RERUNS, format, RERUN_COLUMNS)?;
    for pair in pairs {
        let (old, new) = pair?;
        let rerun = new.rerun;
        let rows = [archive.row(old), archive.row(new)];
        changes(&columns, rerun, &rows).iter().try_for_each(|change| table.write(change))?;
    }
    Ok(Some((ResultsFolder::RERUNS.to_owned(), table.finish()?)))
}

/// Lists each changed value of a design; if no value changed, one entry with an empty column.
fn changes(columns: &[Column<DesignRow>], rerun: u64, rows: &[DesignRow; 2]) -> Vec<RerunChange> {
    let change = |column, values| RerunChange {
        design: rows[1].number,
        rerun,
        settings: rows.each_ref().map(|row| row.result.settings.clone()),
        column,
        values,
    };
    // The settings are in columns of their own.
    let columns = columns.iter().filter(|column| column.name != name::SETTINGS);
    let values =
        columns.map(|column| (column.name.clone(), rows.each_ref().map(|row| column.cell(row))));
    let changed = values.filter(|(_, [old, new])| old != new);
    let mut changes: Vec<_> = changed.map(|(name, values)| change(name, values)).collect();
    // Reruns without changes are listed, because they show that the settings have no effect.
    if changes.is_empty() {
        changes.push(change("".into(), [Cell::Empty, Cell::Empty]));
    }
    changes
}
