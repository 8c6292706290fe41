//! Journal of a run: one line for each finished design, from which the tables are written.
//!
//! The first line is the header. Each session begins with a line of its own. The other lines are
//! designs in the order in which they were finished. A design that was solved again has several
//! lines, each with the number of its rerun; the line with the largest number counts. The crate
//! `journal` documents which lines survive interruptions.

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

/// Header of a journal of designs.
pub type JournalHeader = journal::JournalHeader<Subset>;

/// Journal of a run, open for writing.
pub(crate) type Journal = journal::Journal<Archive>;

/// Creates the header of a journal for `subset` of `sweep`, solved by `program`.
pub(crate) fn header(sweep: &Sweep, subset: Subset, program: &Program) -> JournalHeader {
    JournalHeader::new(sweep.to_toml(), subset, program)
}

/// Creates or continues the journal in `folder` for the run that `header` describes.
///
/// # Errors
///
/// If the journal is in use, damaged or of another run, or if it exists and `start` is `New`.
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
    // With `Fresh` the journal is new, so there are no lines to check.
    if start == Start::Fresh { Ok(journal) } else { checked(journal, folder) }
}

/// Continues the existing journal in `folder`, with the definition in its header.
///
/// # Errors
///
/// If there is no journal, or it is in use or damaged.
pub(crate) fn resume(folder: &ResultsFolder) -> Result<Journal, JournalError> {
    checked(Journal::resume(&folder.journal())?, folder)
}

/// Compares the journal with the tables in `folder`.
///
/// Edited lines are an error; for lost lines a message is added to the notes of the journal.
fn checked(mut journal: Journal, folder: &ResultsFolder) -> Result<Journal, JournalError> {
    edited::refuse(journal.records(), folder)?;
    if let Some(lost) = journal.records().lost_lines(folder) {
        journal.note(format!("{}: {lost}", folder.journal().display()));
    }
    Ok(journal)
}
