//! Journals that somebody has changed and sealed again: every checksum holds, and the results are not those of the run.

use std::fs::File;
use std::io::{BufRead as _, BufReader};

use results::columns::{design_columns, name};
use results::{Contents, CsvFormat, JournalExtent, RunFolder};
use store::{JournalError, sha256_of};

use super::archive::Archive;

/// Refuses the journal in `folder` if a design in it is not what the table of designs says that was written from it.
///
/// Nothing is compared as long as the journal begins as it did then. Lines that were removed, doubled or swapped change no design.
pub(super) fn refuse(archive: &Archive, folder: &RunFolder) -> Result<(), JournalError> {
    let Some(contents) = Contents::stated_in(folder) else { return Ok(()) };
    let stated = &contents.journal;
    let found = JournalExtent::of(&folder.journal(), stated.bytes, stated.lines);
    if found.is_ok_and(|found| found == *stated) {
        return Ok(());
    }
    let Some((format, table)) = table(folder, &contents) else { return Ok(()) };
    let (columns, grid) = (design_columns(archive.sweep()), archive.sweep().grid());
    let settings = columns.iter().position(|column| column.name == name::SETTINGS);
    let is_whole = archive.lost_lines(folder).is_none();
    let mut entries = archive.entries()?;
    for record in table.into_records().filter_map(Result::ok) {
        let index = record.get(0).and_then(|number| grid.parse_number(number).ok());
        let position = index.and_then(|index| archive.designs().position(index));
        // What stands behind what the tables were written from may be a rerun that they know nothing of.
        let old = position.filter(|position| archive.stands_before(*position, stated.bytes));
        let Some(entry) = old.map(|position| entries.last(position)).transpose()?.flatten() else {
            continue;
        };
        let row = archive.row(entry);
        let cells = columns.iter().map(|column| column.cell(&row).to_string());
        // A rerun that was lost with the end of the journal has left the result before it, with the settings of that.
        if !is_whole
            && settings.is_some_and(|place| record.get(place) != Some(row.result.settings.as_str()))
        {
            continue;
        }
        let is_same = cells.zip(&record).all(|(cell, written)| format.cell(&cell) == written);
        if !is_same {
            let (path, design) = (folder.journal(), row.number.to_string());
            return Err(JournalError::Edited { path, design });
        }
    }
    Ok(())
}

/// The table of designs in `folder`, if it is as it was written.
fn table(
    folder: &RunFolder,
    contents: &Contents,
) -> Option<(CsvFormat, csv::Reader<BufReader<File>>)> {
    let path = folder.file(RunFolder::DESIGNS);
    let stated = contents.files.get(RunFolder::DESIGNS)?;
    (sha256_of(File::open(&path).ok()?).ok()? == *stated).then_some(())?;
    let mut file = BufReader::new(File::open(path).ok()?);
    let (format, start) = CsvFormat::of(file.fill_buf().ok()?);
    file.consume(start);
    Some((format, format.reader(file)))
}
