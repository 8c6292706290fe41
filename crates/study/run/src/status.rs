//! Status of a run: numbers of finished, failed and missing designs.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};
use std::path::Path;

use journal::JournalError;
use results::{Completeness, Derivation, ResultsFolder, VerifiedFolder};
use sweep::DesignNumber;

use crate::run_journal::{Archive, JournalEntry};

/// Number of slowest designs in the status.
const SLOWEST: usize = 5;

/// Status of a run, read from its folder.
#[derive(Debug)]
pub struct RunStatus {
    /// Journal of the run.
    pub archive: Archive,
    /// True if a process is writing to the journal at the moment.
    pub in_use: bool,
    /// Number of designs that lack a requested value.
    pub failed: u64,
    /// Number of failures for each measure and reason.
    pub reasons: BTreeMap<(&'static str, &'static str), u64>,
    /// Slowest designs with their seconds, the slowest first.
    pub slowest: Vec<(f64, DesignNumber)>,
    /// Number of designs that a rerun solved again.
    pub solved_again: u64,
    /// Problems with tables or journal, one sentence each.
    pub problems: Vec<String>,
    /// Derived products, for example figures, that were made from older tables.
    pub outdated: Vec<Derivation>,
}

/// Design with its time, ordered so that the fastest design is the greatest.
struct Timed {
    seconds: f64,
    index: u64,
}

impl RunStatus {
    /// Reads the status of the run in `folder`, which may be in progress.
    ///
    /// # Errors
    ///
    /// If there is no run in `folder`, or its journal is damaged.
    pub fn read(folder: &Path) -> Result<Self, JournalError> {
        let folder = ResultsFolder::new(folder);
        // Query the lock before reading the journal. If the run ends in between, its status is "in
        // progress" instead of incomplete.
        let in_use = journal::in_use(&folder.journal());
        let archive = Archive::open(&folder)?;
        let mut status = Self {
            in_use,
            failed: 0,
            reasons: BTreeMap::new(),
            slowest: Vec::new(),
            solved_again: 0,
            problems: archive.lost_lines(&folder).into_iter().collect(),
            outdated: Vec::new(),
            archive,
        };
        status.count()?;
        status.check(&folder);
        Ok(status)
    }

    /// Compares the tables with `contents.toml`, unless a run is in progress.
    fn check(&mut self, folder: &ResultsFolder) {
        // During a run the tables are older than the journal, which is not a problem.
        if self.in_use {
            return;
        }
        match VerifiedFolder::open(folder.path(), Completeness::Partial) {
            Ok(verified) => {
                self.problems.extend(verified.problems().iter().map(ToString::to_string));
                self.problems.extend(verified.behind().map(|problem| problem.to_string()));
                self.outdated = verified.outdated();
            }
            Err(problem) => self.problems.push(problem.to_string()),
        }
    }

    fn count(&mut self) -> Result<(), JournalError> {
        let mut slowest = BinaryHeap::new();
        for entry in self.archive.entries()?.in_order() {
            let entry = entry?;
            self.failed += u64::from(entry.result.failed());
            self.solved_again += u64::from(entry.rerun > 0);
            for failure in &entry.result.failures {
                let reason = (failure.measure.key(), failure.outcome.text());
                *self.reasons.entry(reason).or_default() += 1;
            }
            // Drop the fastest of six designs, so that memory does not grow with the number of
            // designs.
            slowest.extend(Timed::new(&entry));
            if slowest.len() > SLOWEST {
                slowest.pop();
            }
        }
        let grid = self.archive.sweep().grid();
        let slowest = slowest.into_sorted_vec().into_iter();
        self.slowest = slowest.map(|timed| (timed.seconds, grid.number(timed.index))).collect();
        Ok(())
    }

    /// Returns the number of designs in progress, at most one for each thread.
    pub fn running(&self) -> u64 {
        // The journal does not record which designs have started. Each thread solves one design.
        let threads = self.archive.sessions().last().map_or(1, |session| session.threads as u64);
        if self.in_use { threads.min(self.not_done()) } else { 0 }
    }

    /// Returns the number of designs that are neither done nor in progress.
    pub fn missing(&self) -> u64 {
        self.not_done() - self.running()
    }

    fn not_done(&self) -> u64 {
        self.archive.designs().len() - self.archive.done()
    }

    /// Returns the number of designs per second in the last session, or `None` at its beginning.
    pub fn rate(&self) -> Option<f64> {
        let latest = self.archive.latest();
        (latest.seconds > 0.0).then(|| latest.designs as f64 / latest.seconds)
    }
}

impl Timed {
    fn new(entry: &JournalEntry) -> Option<Self> {
        Some(Self { seconds: entry.seconds, index: entry.index()? })
    }
}

impl Ord for Timed {
    fn cmp(&self, other: &Self) -> Ordering {
        let quicker = other.seconds.total_cmp(&self.seconds);
        quicker.then_with(|| Reverse(other.index).cmp(&Reverse(self.index)))
    }
}

impl PartialOrd for Timed {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Timed {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Timed {}
