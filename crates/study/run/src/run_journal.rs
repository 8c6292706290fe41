//! Journal of a run: one line per finished design.
//!
//! The tables are written from it. The first line is the header, every session starts with a line
//! of its own, and the other lines are designs in the order of completion. A design that was solved
//! again has several lines with the number of their rerun; the largest number counts. The crate
//! `journal` documents the guarantees.

mod archive;
mod edited;
mod entry;
mod extension;
mod index;

use journal::{JournalError, Program, Start};
use results::{Maker, ResultsFolder};
use sweep::{Subset, Sweep};

pub(crate) use archive::Entries;
pub use archive::{Archive, LatestSession};
pub use entry::{JournalEntry, Line, SessionStart};

/// The header of a journal of designs.
pub type JournalHeader = journal::JournalHeader<Subset>;

/// The journal of a run, open for writing.
pub(crate) type Journal = journal::Journal<Archive>;

/// Creates the header of the journal for `subset` of `sweep`.
pub(crate) fn header(sweep: &Sweep, subset: Subset, program: &Program) -> JournalHeader {
    JournalHeader::new(sweep.to_toml(), subset, program)
}

/// Creates or continues the journal in `folder` for the run in `header`.
///
/// # Errors
///
/// If the journal is in use, damaged or of another run, or exists and `start` is `New`.
pub(crate) fn begin(
    folder: &ResultsFolder,
    header: JournalHeader,
    start: Start,
) -> Result<Journal, JournalError> {
    folder.require_own(Maker::Run, start)?;
    let adopted = if start == Start::Resume { extension::adopt(folder, &header)? } else { None };
    let mut journal = Journal::begin(&folder.journal(), header, start)?;
    if let Some(note) = adopted {
        journal.note(note);
    }
    // After a fresh start the journal has no lines to check.
    if start == Start::Fresh { Ok(journal) } else { checked(journal, folder) }
}

/// Continues the existing journal in `folder` with any definition.
///
/// # Errors
///
/// If there is no journal, or it is in use or damaged.
pub(crate) fn resume(folder: &ResultsFolder) -> Result<Journal, JournalError> {
    checked(Journal::resume(&folder.journal())?, folder)
}

/// Checks the journal against the tables in `folder`.
///
/// Adds a message about lost lines.
fn checked(mut journal: Journal, folder: &ResultsFolder) -> Result<Journal, JournalError> {
    edited::refuse(journal.records(), folder)?;
    if let Some(lost) = journal.records().lost_lines(folder) {
        journal.note(format!("{}: {lost}", folder.journal().display()));
    }
    Ok(journal)
}
