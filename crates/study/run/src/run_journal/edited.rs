//! Detects journals with edited lines that have valid checksums.

use journal::JournalError;
use results::columns::{design_columns, name};
use results::{Contents, JournalExtent, ResultsFolder, WrittenTable};

use super::archive::Archive;

/// Returns an error if a design in the journal differs from its row in `designs.csv`.
///
/// Designs are compared only if the part of the journal from which the tables were written has
/// changed. Removed, duplicated or reordered lines change no design and are no error.
pub(super) fn refuse(archive: &Archive, folder: &ResultsFolder) -> Result<(), JournalError> {
    let Some(contents) = Contents::read(folder) else { return Ok(()) };
    let stated = &contents.journal;
    let found = JournalExtent::read(&folder.journal(), stated.bytes, stated.lines);
    if found.is_ok_and(|found| found == *stated) {
        return Ok(());
    }
    let table = WrittenTable::as_stated(folder, ResultsFolder::DESIGNS, &contents.files);
    let Some(table) = table else { return Ok(()) };
    let (columns, grid) = (design_columns(archive.sweep()), archive.sweep().grid());
    let settings = columns.iter().position(|column| column.name == name::SETTINGS);
    let is_whole = archive.lost_lines(folder).is_none();
    let mut entries = archive.entries()?;
    let changed = table.changed(&columns, |record| {
        let index = record.get(0).and_then(|number| grid.parse_number(number).ok());
        let position = index.and_then(|index| archive.designs().position(index));
        // Skip lines that were added after the tables were written, because they may be reruns.
        let old = position.filter(|position| archive.is_before(*position, stated.bytes));
        let entry = old.map(|position| entries.last(position)).transpose()?.flatten();
        let row = entry.map(|entry| archive.row(entry));
        // If the line of a rerun was lost, the result before this rerun is valid again. Its
        // settings differ from the settings in the table, so it is not compared.
        Ok::<_, JournalError>(row.filter(|row| {
            is_whole || settings.is_none_or(|index| record.get(index) == Some(&row.result.settings))
        }))
    })?;
    let Some(design) = changed.into_iter().next() else { return Ok(()) };
    Err(JournalError::Edited {
        path: folder.journal(),
        line: format!("design {design}"),
        table: ResultsFolder::DESIGNS.to_owned(),
        again: "with --fresh",
    })
}
