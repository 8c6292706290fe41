//! Putting the shards of a sweep together.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use results::{CsvFormat, RunFolder};
use sweep::{SubsetDesigns, Sweep};

use crate::journal::{
    self, Archive, Entries, Journal, JournalEntry, JournalError, SessionStart, Start,
};
use crate::options::{Options, Program};
use crate::progress::{Finished, RunError};
use crate::run::Run;
use crate::solve::work::WorkMeter;
use crate::tables::run_info::RunInfo;

/// The advice to shards that do not belong together.
const ALIKE: &str = "shards of one sweep by one program";

/// Shards that cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// No folder of a shard was given.
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
        /// Number of the design.
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
    /// The results after the merger.
    pub finished: Finished,
    /// The number of designs that the merger brought.
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
    format: Option<CsvFormat>,
    program: &Program,
) -> Result<Merged, MergeError> {
    let clock = Instant::now();
    let out = RunFolder::new(out);
    let sources = open(folders, &out)?;
    let header = sources[0].archive.header().clone().of_all_shards();
    out.make().map_err(RunError::from)?;
    let mut journal = Journal::begin(&out, header, Start::Resume)?;
    out.remove_partial_files();
    let formats = [journal.archive(), &sources[0].archive].map(Archive::format);
    let format = formats.into_iter().fold(format, Option::or);
    let added = gather(&mut journal, &sources, &out, format.unwrap_or_default())?;
    let archive = journal.archive();
    let (sweep, missing) =
        (archive.sweep().clone(), numbers(archive.designs(), &archive.missing()));
    let (stop, work) = (AtomicBool::new(false), WorkMeter::default());
    let options = Options {
        threads: 1,
        format,
        fail_fast: false,
        tables_every: Duration::MAX,
        stop: &stop,
        work: &work,
    };
    let info = RunInfo::new(program, &options, clock);
    let finished = Run::new(journal, out, &options, info).finish()?;
    Ok(Merged { finished, added, missing, sweep })
}

/// The results of one folder.
struct ShardResults {
    folder: RunFolder,
    archive: Archive,
}

/// Opens the folders other than `out`, all of one sweep.
fn open(folders: &[PathBuf], out: &RunFolder) -> Result<Vec<ShardResults>, MergeError> {
    let same = |folder: &&PathBuf| match (folder.canonicalize(), out.path().canonicalize()) {
        (Ok(folder), Ok(out)) => folder == out,
        _ => false,
    };
    let mut sources: Vec<ShardResults> = Vec::new();
    for folder in folders.iter().filter(|folder| !same(folder)).map(RunFolder::new) {
        if journal::in_use(&folder) {
            return Err(JournalError::InUse { folder: folder.path().to_owned() }.into());
        }
        let archive = Archive::open(&folder)?;
        if let Some(first) = sources.first() {
            let wanted = first.archive.header().clone().of_all_shards();
            let header = archive.header().clone().of_all_shards();
            header.require(&wanted, &folder.journal(), ALIKE)?;
        }
        sources.push(ShardResults { folder, archive });
    }
    if sources.is_empty() { Err(MergeError::Nothing) } else { Ok(sources) }
}

/// Appends to `journal` what it lacks; returns how many designs that were.
fn gather(
    journal: &mut Journal,
    sources: &[ShardResults],
    out: &RunFolder,
    format: CsvFormat,
) -> Result<u64, MergeError> {
    let designs = journal.archive().designs().clone();
    let mut readers = Vec::new();
    for source in sources {
        readers.push((source, source.archive.entries()?));
    }
    // As it was: what is appended now belongs to other designs.
    let before = Archive::open(out)?;
    let mut there = before.entries()?;
    let mut added = 0;
    for position in 0..designs.len() {
        let known = there.last(position)?;
        let best = choose(designs.design(position), known, &mut readers, out)?;
        if added == 0 && !best.is_empty() {
            journal.begin_session(SessionStart::now(1, format)).map_err(RunError::from)?;
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
    there: Option<JournalEntry>,
    readers: &mut [(&ShardResults, Entries<'_>)],
    out: &RunFolder,
) -> Result<Vec<JournalEntry>, MergeError> {
    let known = there.as_ref().map(|entry| entry.rerun);
    let mut best = there.map(|entry| (entry, out.path()));
    let mut added = Vec::new();
    for (source, entries) in readers {
        let Some(position) = source.archive.designs().position(index) else { continue };
        let Some(entry) = entries.last(position)? else { continue };
        match &best {
            Some((other, first)) if other.rerun == entry.rerun && other.result != entry.result => {
                let (first, second) = (first.to_path_buf(), source.folder.path().to_owned());
                return Err(MergeError::Conflict { design: entry.design, first, second });
            }
            Some((other, _)) if other.rerun >= entry.rerun => {}
            _ => {
                added = entries.history(position)?;
                best = Some((entry, source.folder.path()));
            }
        }
    }
    added.retain(|entry| known.is_none_or(|known| entry.rerun > known));
    Ok(added)
}

/// The numbers of the designs at some positions.
fn numbers(
    designs: &SubsetDesigns,
    positions: &[std::ops::Range<u64>],
) -> Vec<std::ops::RangeInclusive<u64>> {
    let mut numbers: Vec<std::ops::RangeInclusive<u64>> = Vec::new();
    for position in positions.iter().cloned().flatten() {
        let number = designs.design(position) + 1;
        match numbers.last_mut() {
            Some(last) if last.end() + 1 == number => *last = *last.start()..=number,
            _ => numbers.push(number..=number),
        }
    }
    numbers
}
