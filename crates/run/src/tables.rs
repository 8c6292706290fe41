//! Every table of a run, written from its journal.

pub mod changes;
pub mod run_info;
pub mod summary;

use results::columns::{self, TableLayout};
use results::{Dialect, OutputError, RunFolder, Table, row};
use sweep::Sweep;

use crate::journal::{Archive, Entry, JournalError};
use summary::Summary;

/// Writes the tables of what `archive` holds to `folder`; returns what it comes to, and their names.
/// Entries are read one by one, in the order of their designs.
pub(crate) fn write(
    archive: &Archive,
    folder: &RunFolder,
    dialect: Dialect,
) -> Result<(Summary, Vec<String>), JournalError> {
    let sweep = archive.sweep();
    let all = columns::design_columns(sweep);
    let names: Vec<_> = all.iter().map(|column| column.name).collect();
    let mut tables = Projection::create_all(folder, sweep, &names, dialect)?;
    let mut failures =
        Table::create(folder.path(), RunFolder::FAILURES, dialect, results::failure_names(sweep))?;
    let mut summary = Summary::new(names.iter().copied());
    for entry in archive.entries()?.in_order() {
        let entry = entry?;
        tables.iter_mut().try_for_each(|table| table.write(&entry))?;
        entry.failures.iter().try_for_each(|row| failures.write(row::cells(row)))?;
        summary.add(&entry);
    }
    let mut files: Vec<_> = tables.iter().map(|table| table.file.clone()).collect();
    tables.into_iter().try_for_each(|table| table.table.finish())?;
    failures.finish()?;
    files.push(RunFolder::FAILURES.to_owned());
    files.extend(changes::write(archive, folder, dialect)?);
    folder.remove_tables_but(&files);
    folder.sync();
    Ok((summary, files))
}

/// A table whose cells stand in the rows of `designs.csv`.
struct Projection {
    file: String,
    table: Table,
    places: Vec<usize>,
}

impl Projection {
    fn create_all(
        folder: &RunFolder,
        sweep: &Sweep,
        all: &[&str],
        dialect: Dialect,
    ) -> Result<Vec<Self>, OutputError> {
        let create = |table: TableLayout<_>| {
            let names: Vec<_> = table.columns.iter().map(|column| column.name).collect();
            let place = |name: &&str| all.iter().position(|other| other == name);
            let places = names.iter().filter_map(place).collect();
            let file = Table::create(folder.path(), &table.file, dialect, names)?;
            Ok(Self { file: table.file, table: file, places })
        };
        columns::tables(sweep).into_iter().map(create).collect()
    }

    fn write(&mut self, entry: &Entry) -> Result<(), OutputError> {
        let cells: Vec<_> = row::cells(&entry.row).collect();
        let cell = |place: &usize| cells.get(*place).copied().unwrap_or_default();
        self.table.write(self.places.iter().map(cell))
    }
}
