//! Every table of a run, written from its journal.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::columns;
use crate::definition::Sweep;
use crate::dialect::Dialect;
use crate::failures;
use crate::journal::{Archive, Entry, JournalError};
use crate::reruns;
use crate::row;
use crate::summary::Summary;
use crate::table::Table;
use crate::whole_file::{OutputError, remove_partial, sync_folder};

/// The table of failures.
pub(crate) const FAILURES: &str = "failures.csv";

/// Writes the tables of what `archive` holds to `folder`; returns what it comes to, and their names.
/// Entries are read one by one, in the order of their designs.
pub(crate) fn write(
    archive: &Archive,
    folder: &Path,
    dialect: Dialect,
) -> Result<(Summary, Vec<String>), JournalError> {
    let sweep = archive.sweep();
    let all = columns::design_columns(sweep);
    let names: Vec<_> = all.iter().map(|column| column.name).collect();
    let mut tables = Projection::create_all(folder, sweep, &names, dialect)?;
    let mut failures = Table::create(folder, FAILURES, dialect, failures::names(sweep))?;
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
    files.push(FAILURES.to_owned());
    files.extend(reruns::write(archive, folder, dialect)?);
    remove_others(folder, &files);
    sync_folder(folder);
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
        folder: &Path,
        sweep: &Sweep,
        all: &[&str],
        dialect: Dialect,
    ) -> Result<Vec<Self>, OutputError> {
        let create = |table: columns::Table<_>| {
            let names: Vec<_> = table.columns.iter().map(|column| column.name).collect();
            let place = |name: &&str| all.iter().position(|other| other == name);
            let places = names.iter().filter_map(place).collect();
            let file = Table::create(folder, &table.file, dialect, names)?;
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

/// Names of the tables that a run of any sweep may write.
fn all_files() -> BTreeSet<String> {
    let others = ["designs.csv", FAILURES, reruns::RERUNS].map(str::to_owned);
    columns::all_files().chain(others).collect()
}

/// Removes the tables that an earlier run wrote and this one does not, because a folder describes
/// one run.
fn remove_others(folder: &Path, files: &[String]) {
    for file in all_files().iter().filter(|file| !files.contains(file)) {
        // Nearly always there is none.
        let _ = fs::remove_file(folder.join(file));
    }
}

/// Removes what a killed run left half-written.
pub(crate) fn remove_partial_files(folder: &Path) {
    let run = crate::run::RUN.to_owned();
    all_files().iter().chain([&run]).for_each(|file| remove_partial(folder, file));
}

/// Removes the tables of an earlier run.
pub(crate) fn remove_all(folder: &Path) {
    remove_others(folder, &[]);
    let _ = fs::remove_file(folder.join(crate::run::RUN));
}
