//! Continues a run after its definition was extended by more designs.
//!
//! A longer axis, or a list of values in place of a range, changes the numbers of the solved
//! designs. The designs are therefore found in the new definition by their parameters.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use journal::{JournalError, Start};
use results::{OutputError, ResultsFolder};
use sweep::{Measure, Subset, Sweep};

use super::{Archive, Journal, JournalHeader, Line, edited};

/// Name of the rewritten journal until it replaces the old journal.
const REWRITTEN: &str = "journal.jsonl.new";

/// Rewrites the journal in `folder` if the definition in `header` contains all solved designs.
///
/// Returns a message if the journal was rewritten. Otherwise the journal does not change, and the
/// caller reports the difference of the definitions.
///
/// # Errors
///
/// If the journal is in use or damaged, or the new journal cannot be written.
pub(super) fn adopt(
    folder: &ResultsFolder,
    header: &JournalHeader,
) -> Result<Option<String>, JournalError> {
    let path = folder.journal();
    if !path.is_file() {
        return Ok(None);
    }
    // A damaged journal is reported by the caller, which opens it to continue the run.
    let Ok(found) = Archive::open(folder) else { return Ok(None) };
    if found.header().definition() == header.definition() || !is_extended(&found, header) {
        return Ok(None);
    }
    // The old journal stays locked until the new journal has replaced the old one.
    let locked = Journal::resume(&path)?;
    let archive = locked.records();
    let Ok(sweep) = Sweep::parse(header.definition(), "definition", &[]) else { return Ok(None) };
    let Some(numbers) = numbers(archive, &sweep) else { return Ok(None) };
    edited::refuse(archive, folder)?;
    archive.require_all_lines(folder)?;
    let rewritten = folder.file(REWRITTEN);
    rewrite(archive, &rewritten, header.clone(), &numbers)?;
    // The tables have the old numbers of the designs, so they are removed.
    folder.remove_results();
    fs::rename(&rewritten, &path).map_err(|error| OutputError::file(&path, &error))?;
    let count = numbers.len();
    Ok(Some(format!(
        "the definition has changed; {count} solved designs belong to both definitions and are kept"
    )))
}

/// Returns true if the definition in `header` may contain the designs of `found`.
///
/// This requires the same program and the same measures, and neither samples nor shards. If the
/// measures include derivatives, the axes must be the same, too.
fn is_extended(found: &Archive, header: &JournalHeader) -> bool {
    let all = Subset::default();
    found.header().program() == header.program()
        && (*found.header().subset(), *header.subset()) == (all, all)
        && Sweep::parse(header.definition(), "definition", &[]).is_ok_and(|sweep| {
            // The axes determine the parameters with respect to which measures are differentiated.
            let has_derivatives = sweep.measures().contains(&Measure::Sensitivity);
            sweep.measures() == found.sweep().measures()
                && (!has_derivatives || axis_keys(&sweep) == axis_keys(found.sweep()))
        })
}

fn axis_keys(sweep: &Sweep) -> BTreeSet<&'static str> {
    sweep.grid().axes().iter().map(|axis| axis.parameter().key).collect()
}

/// Returns the index of each solved design in the old and in the new grid.
///
/// Returns `None` if the new grid lacks a solved design.
fn numbers(archive: &Archive, sweep: &Sweep) -> Option<Vec<(u64, u64)>> {
    let (old, new) = (archive.sweep().grid(), sweep.grid());
    let numbers = archive.finished().map(|index| {
        let case = old.case(index);
        // Cases must be bitwise equal, so that the tables equal the tables of a new run.
        let found = new.find(&case).filter(|found| new.case(*found) == case)?;
        Some((index, found))
    });
    numbers.collect()
}

/// Writes a journal with the new numbers of the designs to `path`.
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
