//! The journal of a run: every finished design, one line each, from which the tables are written.
//!
//! The first line names what is solved, by which program; a line of its own begins every session; the rest are designs, in the
//! order in which they were done. A design that stands there several times was solved again: its lines carry the number of their
//! rerun, and the largest counts, wherever it stands. What a journal promises of its lines is said in the crate `journal`.

mod archive;
mod edited;
mod entry;
mod index;

use journal::{JournalError, Program, Start};
use results::{Maker, ResultsFolder};
use sweep::{Subset, Sweep};

pub(crate) use archive::Entries;
pub use archive::{Archive, LatestSession};
pub use entry::{JournalEntry, Line, SessionStart};

/// The header of a journal of designs.
pub type JournalHeader = journal::JournalHeader<Subset>;

/// The journal of a run that is being written.
pub(crate) type Journal = journal::Journal<Archive>;

/// The header of the journal of `subset` of `sweep`.
pub(crate) fn header(sweep: &Sweep, subset: Subset, program: &Program) -> JournalHeader {
    JournalHeader::new(sweep.to_toml(), subset, program)
}

/// The journal in `folder` of the run that `header` describes: a new one, or the one that is there.
///
/// # Errors
/// If it is in use, damaged, of another run, or there and `start` says nothing of it.
pub(crate) fn begin(
    folder: &ResultsFolder,
    header: JournalHeader,
    start: Start,
) -> Result<Journal, JournalError> {
    folder.require_own(Maker::Run, start)?;
    let journal = Journal::begin(&folder.journal(), header, start)?;
    // Whoever starts afresh has thrown the lines away.
    if start == Start::Fresh { Ok(journal) } else { checked(journal, folder) }
}

/// The journal that is there in `folder`, to go on with whatever it is of.
///
/// # Errors
/// If there is none, or it is in use or damaged.
pub(crate) fn resume(folder: &ResultsFolder) -> Result<Journal, JournalError> {
    checked(Journal::resume(&folder.journal())?, folder)
}

/// The journal, checked against the tables in `folder` that were written from it, with a word about the lines that it has lost since.
fn checked(mut journal: Journal, folder: &ResultsFolder) -> Result<Journal, JournalError> {
    edited::refuse(journal.records(), folder)?;
    if let Some(lost) = journal.records().lost_lines(folder) {
        journal.note(format!("{}: {lost}", folder.journal().display()));
    }
    Ok(journal)
}
