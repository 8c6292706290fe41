//! Merges the results of shards, which each solved a part of the designs of a sweep.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use journal::{JournalError, Program, Start};
use results::{CsvFormat, ResultsFolder};
use sweep::{SubsetDesigns, Sweep};

use crate::options::Options;
use crate::progress::{Finished, RunError};
use crate::run::Run;
use crate::run_journal::{self, Archive, Entries, Journal, JournalEntry, Line, SessionStart};
use crate::solve::work::WorkMeter;
use crate::tables::run_info::RunInfo;

/// Expected input that the error message states if a folder has another definition or program.
const ALIKE: &str = "shards of one sweep by one program";

/// Reason why shards cannot be merged.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// The list of folders is empty.
    #[error("there is nothing to merge; give the folders of shards")]
    Nothing,
    /// The journal of a folder cannot be opened, or belongs to another sweep or program.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The results cannot be written.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Two shards have different results for the same design.
    #[error("{}: the result of design {design} differs from the result in {}; solve it again in one of them with squama rerun", second.display(), first.display())]
    Conflict {
        /// Number of the design.
        design: u64,
        /// Folder with a result of this design.
        first: PathBuf,
        /// Folder with a different result of this design.
        second: PathBuf,
    },
}

/// Result of a merge.
#[derive(Clone, Debug)]
pub struct Merged {
    /// Summary of the merged results.
    pub finished: Finished,
    /// Number of designs that the merge added to the output folder.
    pub added: u64,
    /// Ranges of design numbers that are in none of the shards.
    pub missing: Vec<std::ops::RangeInclusive<u64>>,
    /// Sweep to which the shards belong.
    pub sweep: Sweep,
}

/// Merges the shards in `folders` into `out`, and writes the tables of the sweep.
///
/// Results that `out` already contains stay, so a repeated merge changes nothing. If `folders`
/// contains only `out`, the tables in `out` are written again from the journal in `out`.
///
/// # Errors
///
/// If a folder has another definition or another program version, a folder is in use, or the
/// results cannot be written.
pub fn merge(
    folders: &[PathBuf],
    out: &Path,
    format: Option<CsvFormat>,
    program: &Program,
) -> Result<Merged, MergeError> {
    let clock = Instant::now();
    let out = ResultsFolder::new(out);
    let sources = open(folders, &out)?;
    if sources.is_empty() {
        return if folders.is_empty() {
            Err(MergeError::Nothing)
        } else {
            written_again(out, format, program)
        };
    }
    // All sources belong to one sweep, so their headers differ in the shard only.
    let header = sources[0].archive.header_of_all_shards();
    out.make().map_err(RunError::from)?;
    // Resuming makes repeated merges equivalent to one merge, and continues interrupted merges.
    let mut journal = run_journal::begin(&out, header, Start::Resume)?;
    // The format is the requested one, else the format in `out`, else the format of the shards.
    let formats = [journal.records(), &sources[0].archive].map(Archive::format);
    let format = formats.into_iter().fold(format, Option::or);
    let added = gather(&mut journal, &sources, &out, format.unwrap_or_default())?;
    finish(journal, out, format, added, program, clock)
}

/// Writes the tables in `out` again from its own journal.
fn written_again(
    out: ResultsFolder,
    format: Option<CsvFormat>,
    program: &Program,
) -> Result<Merged, MergeError> {
    let journal = run_journal::resume(&out)?;
    out.make().map_err(RunError::from)?;
    finish(journal, out, format, 0, program, Instant::now())
}

fn finish(
    journal: Journal,
    out: ResultsFolder,
    format: Option<CsvFormat>,
    added: u64,
    program: &Program,
    clock: Instant,
) -> Result<Merged, MergeError> {
    let archive = journal.records();
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

/// Folder of a shard with its open journal.
struct ShardResults {
    folder: ResultsFolder,
    archive: Archive,
}

/// Opens the folders other than `out`; fails unless all belong to one sweep.
fn open(folders: &[PathBuf], out: &ResultsFolder) -> Result<Vec<ShardResults>, MergeError> {
    let same = |folder: &&PathBuf| match (folder.canonicalize(), out.path().canonicalize()) {
        // Compare canonical paths, because `results/x` and `./results/x/` are the same folder.
        (Ok(folder), Ok(out)) => folder == out,
        _ => false,
    };
    let mut sources: Vec<ShardResults> = Vec::new();
    for folder in folders.iter().filter(|folder| !same(folder)).map(ResultsFolder::new) {
        // The merge of a shard in progress would silently lack its last designs.
        if journal::in_use(&folder.journal()) {
            return Err(JournalError::InUse(folder.path().to_owned()).into());
        }
        let archive = Archive::open(&folder)?;
        // A truncated copy of a journal is refused, because it looks like a smaller shard.
        archive.require_all_lines(&folder)?;
        if let Some(first) = sources.first() {
            let wanted = first.archive.header_of_all_shards();
            let header = archive.header_of_all_shards();
            header.require(&wanted, &folder.journal(), ALIKE)?;
        }
        sources.push(ShardResults { folder, archive });
    }
    Ok(sources)
}

/// Appends the designs that `journal` lacks; returns the number of designs with new entries.
fn gather(
    journal: &mut Journal,
    sources: &[ShardResults],
    out: &ResultsFolder,
    format: CsvFormat,
) -> Result<u64, MergeError> {
    let designs = journal.records().designs().clone();
    let mut readers = Vec::new();
    for source in sources {
        readers.push((source, source.archive.entries()?));
    }
    // State of `out` before the merge. Lines that are appended below belong to other designs.
    let before = Archive::open(out)?;
    // This second handle reads entries at offsets that stay valid while the journal grows.
    let mut existing = before.entries()?;
    let mut added = 0;
    let finished = sources.iter().map(|source| source.archive.finished());
    for (design, holders) in MergedDesigns::new(finished) {
        // The sample in `out` may exclude designs of a shard.
        let Some(position) = designs.position(design) else { continue };
        let known = existing.last(position)?;
        let best = choose(design, known, &mut readers, &holders, out)?;
        // A session begins with the first new design, so that a merge without new designs leaves
        // the journal unchanged.
        if added == 0 && !best.is_empty() {
            let session = Line::Session(SessionStart::now(1, format));
            journal.append(session).map_err(RunError::from)?;
        }
        added += u64::from(!best.is_empty());
        for entry in best {
            journal.append(Line::Design(Box::new(entry))).map_err(RunError::from)?;
        }
    }
    Ok(added)
}

/// Iterator over the designs of several sorted sources, in ascending order.
///
/// Yields each design once, with the indices of all sources that contain it.
struct MergedDesigns<I> {
    sources: Vec<I>,
    /// Next design of each source, with the index of the source; the smallest design is on top.
    next: BinaryHeap<Reverse<(u64, usize)>>,
}

impl<I: Iterator<Item = u64>> MergedDesigns<I> {
    fn new(sources: impl Iterator<Item = I>) -> Self {
        let mut merged = Self { sources: sources.collect(), next: BinaryHeap::new() };
        for source in 0..merged.sources.len() {
            merged.advance(source);
        }
        merged
    }

    fn advance(&mut self, source: usize) {
        let next = self.sources[source].next();
        self.next.extend(next.map(|design| Reverse((design, source))));
    }
}

impl<I: Iterator<Item = u64>> Iterator for MergedDesigns<I> {
    type Item = (u64, Vec<usize>);

    fn next(&mut self) -> Option<Self::Item> {
        let Reverse((design, _)) = *self.next.peek()?;
        let mut holders = Vec::new();
        while let Some(&Reverse((other, source))) = self.next.peek()
            && other == design
        {
            self.next.pop();
            holders.push(source);
            self.advance(source);
        }
        holders.sort_unstable();
        Some((design, holders))
    }
}

/// Returns the entries of the design with grid index `index` that the output journal lacks.
///
/// `existing` is the last entry of the design in the output journal. `holders` are the indices of
/// the readers that contain the design.
fn choose(
    index: u64,
    existing: Option<JournalEntry>,
    readers: &mut [(&ShardResults, Entries<'_>)],
    holders: &[usize],
    out: &ResultsFolder,
) -> Result<Vec<JournalEntry>, MergeError> {
    let known = existing.as_ref().map(|entry| entry.rerun);
    let mut best = existing.map(|entry| (entry, out.path()));
    let mut added = Vec::new();
    for reader in holders {
        let (source, entries) = &mut readers[*reader];
        let Some(position) = source.archive.designs().position(index) else { continue };
        let Some(entry) = entries.last(position)? else { continue };
        match &best {
            // The same rerun by one program must give equal results; otherwise neither is reliable.
            Some((other, first)) if other.rerun == entry.rerun && other.result != entry.result => {
                let (first, second) = (first.to_path_buf(), source.folder.path().to_owned());
                return Err(MergeError::Conflict { design: entry.design, first, second });
            }
            Some((other, _)) if other.rerun >= entry.rerun => {}
            _ => {
                // All reruns of the design are included, so that `reruns.csv` lists them after the
                // merge.
                added = entries.history(position)?;
                best = Some((entry, source.folder.path()));
            }
        }
    }
    // Entries that the output journal already contains are omitted.
    added.retain(|entry| known.is_none_or(|known| entry.rerun > known));
    Ok(added)
}

/// Returns the numbers of the designs at the given positions of the subset, as ranges.
fn numbers(
    designs: &SubsetDesigns,
    positions: &[std::ops::Range<u64>],
) -> Vec<std::ops::RangeInclusive<u64>> {
    let mut numbers: Vec<std::ops::RangeInclusive<u64>> = Vec::new();
    for part in positions.iter().flat_map(|range| consecutive(designs, range)) {
        match numbers.last_mut() {
            Some(last) if last.end() + 1 == *part.start() => *last = *last.start()..=*part.end(),
            _ => numbers.push(part),
        }
    }
    numbers
}

/// Returns the numbers of the designs at consecutive positions of the subset, as ranges.
///
/// If the design numbers are consecutive, too, the result is a single range.
fn consecutive(
    designs: &SubsetDesigns,
    positions: &std::ops::Range<u64>,
) -> Vec<std::ops::RangeInclusive<u64>> {
    let number = |position| designs.design(position) + 1;
    let Some(last) = positions.clone().next_back() else { return Vec::new() };
    let (first, last) = (number(positions.start), number(last));
    // A single range, because a list of up to 10⁹ designs would not fit into memory.
    if last - first == positions.end - positions.start - 1 {
        return vec![first..=last];
    }
    positions.clone().map(|position| number(position)..=number(position)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn designs_are_ordered_and_list_the_sources_that_contain_them() {
        let sources: [&[u64]; 3] = [&[1, 4, 9], &[4, 5], &[]];
        let merged = MergedDesigns::new(sources.iter().map(|source| source.iter().copied()));
        assert_eq!(
            merged.collect::<Vec<_>>(),
            [(1, vec![0]), (4, vec![0, 1]), (5, vec![1]), (9, vec![0])]
        );
    }

    #[test]
    fn missing_designs_are_reported_as_ranges() {
        let designs = SubsetDesigns::new(1_000_000_000, sweep::Subset::default()).expect("designs");
        let named = numbers(&designs, &[0..5, 6..999_999_999]);
        assert_eq!(named, [1..=5, 7..=999_999_999]);
    }
}
