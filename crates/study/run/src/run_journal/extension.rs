//! Continues a run with a definition that has more designs than before.
//!
//! A longer axis, or a list in place of an equal range, renumbers the solved designs. They are
//! therefore matched to the new definition by their parameters.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use journal::{JournalError, Start};
use results::{OutputError, ResultsFolder};
use sweep::{Measure, Subset, Sweep};

use super::{Archive, Journal, JournalHeader, Line, edited};

/// File in which the journal is rewritten.
const REWRITTEN: &str = "journal.jsonl.new";

/// Rewrites the journal in `folder` for the definition in `header`.
///
/// Only if the definition contains all solved designs.
///
/// Returns a message if it did. Otherwise the journal stays, and the caller reports the difference.
///
/// # Errors
///
/// If the journal is in use or damaged, or the new one cannot be written.
pub(super) fn adopt(
    folder: &ResultsFolder,
    header: &JournalHeader,
) -> Result<Option<String>, JournalError> {
    let path = folder.journal();
    if !path.is_file() {
        return Ok(None);
    }
    // The caller reports a damaged journal when it continues the run.
    let Ok(found) = Archive::open(folder) else { return Ok(None) };
    if found.header().definition() == header.definition() || !is_extended(&found, header) {
        return Ok(None);
    }
    // Locked until the new journal has replaced it.
    let locked = Journal::resume(&path)?;
    let archive = locked.records();
    let Ok(sweep) = Sweep::parse(header.definition(), "definition", &[]) else { return Ok(None) };
    let Some(numbers) = numbers(archive, &sweep) else { return Ok(None) };
    edited::refuse(archive, folder)?;
    archive.require_all_lines(folder)?;
    let rewritten = folder.file(REWRITTEN);
    rewrite(archive, &rewritten, header.clone(), &numbers)?;
    // The tables number the designs as the old journal does.
    folder.remove_results();
    fs::rename(&rewritten, &path).map_err(|error| OutputError::file(&path, &error))?;
    let count = numbers.len();
    Ok(Some(format!(
        "the definition has changed; {count} solved designs belong to both definitions and are kept"
    )))
}

/// Returns true if only the axes and the name differ.
fn is_extended(found: &Archive, header: &JournalHeader) -> bool {
    let all = Subset::default();
    found.header().program() == header.program()
        && (*found.header().subset(), *header.subset()) == (all, all)
        && Sweep::parse(header.definition(), "definition", &[]).is_ok_and(|sweep| {
            // Derivatives are taken with respect to the parameters of the definition.
            let has_derivatives = sweep.measures().contains(&Measure::Sensitivity);
            sweep.measures() == found.sweep().measures()
                && (!has_derivatives || axis_keys(&sweep) == axis_keys(found.sweep()))
        })
}

fn axis_keys(sweep: &Sweep) -> BTreeSet<&'static str> {
    sweep.grid().axes().iter().map(|axis| axis.parameter().key).collect()
}

/// Returns the indices of the solved designs in the old and in the new grid.
///
/// `None` if the new grid lacks one.
fn numbers(archive: &Archive, sweep: &Sweep) -> Option<Vec<(u64, u64)>> {
    let (old, new) = (archive.sweep().grid(), sweep.grid());
    let numbers = archive.finished().map(|index| {
        let case = old.case(index);
        // Require bitwise equal cases, so that a fresh run would give the same tables.
        let found = new.find(&case).filter(|found| new.case(*found) == case)?;
        Some((index, found))
    });
    numbers.collect()
}

/// Writes the journal with the new numbers to `path`.
fn rewrite(
    archive: &Archive,
    path: &Path,
    header: JournalHeader,
    numbers: &[(u64, u64)],
) -> Result<(), JournalError> {
    let mut journal = Journal::begin(path, header, Start::Fresh)?;
    for session in archive.sessions() {
        journal.append(Line::Session(session.clone()))?;
    }
    let mut entries = archive.entries()?;
    for (old, new) in numbers {
        let Some(position) = archive.designs().position(*old) else { continue };
        for mut entry in entries.history(position)? {
            entry.design = new + 1;
            journal.append(Line::Design(Box::new(entry)))?;
        }
    }
    journal.sync()?;
    Ok(())
}
