//! Putting the shards of a sweep together.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use results::{Dialect, RunFolder};
use sweep::{Selection, Sweep};

use crate::journal::{self, Archive, Entries, Entry, Journal, JournalError, Start};
use crate::options::{Options, Program};
use crate::progress::{Finished, RunError};
use crate::session::Session;
use crate::tables::run_info::Report;

/// What is right for shards.
const ALIKE: &str = "shards of one sweep by one program";

/// Shards that cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// There is none.
    #[error("there is nothing to merge, expected the folders of shards")]
    Nothing,
    /// A journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The results cannot be written.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Two shards have different results for the same design.
    #[error("{}: design {design} is not what it is in {}, expected the same result; solve it again in one of them with squama rerun", second.display(), first.display())]
    Conflict {
        /// Its number.
        design: u64,
        /// A folder that has it.
        first: PathBuf,
        /// Another folder that has it.
        second: PathBuf,
    },
}

/// A merger that was done.
#[derive(Clone, Debug)]
pub struct Merged {
    /// What is there now.
    pub finished: Finished,
    /// How many designs the merger brought.
    pub added: u64,
    /// The designs that are in none of the shards.
    pub missing: Vec<std::ops::RangeInclusive<u64>>,
    /// The sweep.
    pub sweep: Sweep,
}

/// Puts the results in `folders`, shards of one sweep, into the folder `out`, and writes the tables of
/// the whole. What is there already stays, so that merging twice is merging once.
///
/// # Errors
/// If the folders hold results of different definitions or programs, one is in use, or the disk
/// does not take the results.
pub fn merge(
    folders: &[PathBuf],
    out: &Path,
    dialect: Option<Dialect>,
    program: &Program,
) -> Result<Merged, MergeError> {
    let clock = Instant::now();
    let sources = open(folders, out)?;
    let before = sources[0].archive.sessions().last().map(|session| session.csv);
    let header = sources[0].archive.header().clone().of_all_shards();
    let place = RunFolder::new(out);
    place.make().map_err(RunError::from)?;
    let mut journal = Journal::begin(out, header, Start::Resume)?;
    place.remove_partial_files();
    let there = journal.archive().sessions().last().map(|session| session.csv);
    let dialect = dialect.or(there).or(before).unwrap_or_default();
    let added = gather(&mut journal, &sources, out, dialect)?;
    let archive = journal.archive();
    let (sweep, missing) =
        (archive.sweep().clone(), numbers(archive.selection(), &archive.missing()));
    let (stop, tables_every) = (AtomicBool::new(false), Duration::MAX);
    let options =
        Options { threads: 1, dialect: Some(dialect), fail_fast: false, tables_every, stop: &stop };
    let report = Report::new(program, &options, clock);
    let finished = Session::idle(journal, out, &options, &report).finish()?;
    Ok(Merged { finished, added, missing, sweep })
}

/// The results of one folder.
struct Source {
    folder: PathBuf,
    archive: Archive,
}

/// Opens the folders other than `out`, all of one sweep.
fn open(folders: &[PathBuf], out: &Path) -> Result<Vec<Source>, MergeError> {
    let same = |folder: &&PathBuf| match (folder.canonicalize(), out.canonicalize()) {
        (Ok(folder), Ok(out)) => folder == out,
        _ => false,
    };
    let mut sources: Vec<Source> = Vec::new();
    for folder in folders.iter().filter(|folder| !same(folder)) {
        if journal::in_use(folder) {
            return Err(JournalError::InUse { folder: folder.clone() }.into());
        }
        let archive = Archive::open(folder)?;
        if let Some(first) = sources.first() {
            let wanted = first.archive.header().clone().of_all_shards();
            let path = RunFolder::new(folder).journal();
            archive.header().clone().of_all_shards().require(&wanted, &path, ALIKE)?;
        }
        sources.push(Source { folder: folder.clone(), archive });
    }
    if sources.is_empty() { Err(MergeError::Nothing) } else { Ok(sources) }
}

/// Appends to `journal` what it lacks; returns how many designs that were.
fn gather(
    journal: &mut Journal,
    sources: &[Source],
    out: &Path,
    dialect: Dialect,
) -> Result<u64, MergeError> {
    let selection = journal.archive().selection().clone();
    let mut readers = Vec::new();
    for source in sources {
        readers.push((source, source.archive.entries()?));
    }
    // As it was: what is appended now belongs to other designs.
    let before = Archive::open(out)?;
    let mut there = before.entries()?;
    let mut added = 0;
    for position in 0..selection.len() {
        let known = there.last(position)?;
        let best = choose(selection.design(position), known, &mut readers, out)?;
        if added == 0 && !best.is_empty() {
            journal.begin_session(journal::Session::now(1, dialect)).map_err(RunError::from)?;
        }
        added += u64::from(!best.is_empty());
        for entry in best {
            journal.append(entry).map_err(RunError::from)?;
        }
    }
    Ok(added)
}

/// The entries of the design `index` that are to be added to the one that is there.
fn choose(
    index: u64,
    there: Option<Entry>,
    readers: &mut [(&Source, Entries<'_>)],
    out: &Path,
) -> Result<Vec<Entry>, MergeError> {
    let known = there.as_ref().map(|entry| entry.rerun);
    let mut best = there.map(|entry| (entry, out.to_owned()));
    let mut added = Vec::new();
    for (source, entries) in readers {
        let Some(position) = source.archive.selection().position(index) else { continue };
        let Some(entry) = entries.last(position)? else { continue };
        match &best {
            Some((other, first)) if other.rerun == entry.rerun && other.row != entry.row => {
                let (first, second) = (first.clone(), source.folder.clone());
                return Err(MergeError::Conflict { design: entry.design, first, second });
            }
            Some((other, _)) if other.rerun >= entry.rerun => {}
            _ => {
                added = entries.history(position)?;
                best = Some((entry, source.folder.clone()));
            }
        }
    }
    added.retain(|entry| known.is_none_or(|known| entry.rerun > known));
    Ok(added)
}

/// The numbers of the designs at some positions.
pub(crate) fn numbers(
    selection: &Selection,
    positions: &[std::ops::Range<u64>],
) -> Vec<std::ops::RangeInclusive<u64>> {
    let mut numbers: Vec<std::ops::RangeInclusive<u64>> = Vec::new();
    for position in positions.iter().cloned().flatten() {
        let number = selection.design(position) + 1;
        match numbers.last_mut() {
            Some(last) if last.end() + 1 == number => *last = *last.start()..=number,
            _ => numbers.push(number..=number),
        }
    }
    numbers
}
