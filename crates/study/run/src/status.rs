//! The status of a run: done, failed, missing.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};
use std::path::Path;

use journal::JournalError;
use results::{Completeness, Derivation, ResultsFolder, VerifiedFolder};
use sweep::DesignNumber;

use crate::run_journal::{Archive, JournalEntry};

/// The number of slowest designs that are listed.
const SLOWEST: usize = 5;

/// The status of a run.
#[derive(Debug)]
pub struct RunStatus {
    /// The journal.
    pub archive: Archive,
    /// Whether a process is writing it.
    pub in_use: bool,
    /// Designs that lack a value.
    pub failed: u64,
    /// The number of designs that failed, by measure and reason.
    pub reasons: BTreeMap<(&'static str, &'static str), u64>,
    /// The slowest designs, the slowest first: their seconds and their numbers.
    pub slowest: Vec<(f64, DesignNumber)>,
    /// Designs that were solved again.
    pub solved_again: u64,
    /// The faults of the tables or the journal, each in one line.
    pub problems: Vec<String>,
    /// The products of the tables that are out of date.
    pub outdated: Vec<Derivation>,
}

/// A design and its time, ordered so that the fastest is the greatest.
struct Timed {
    seconds: f64,
    index: u64,
}

impl RunStatus {
    /// The status of the run in `folder`, which may be going on.
    ///
    /// # Errors
    /// If there is no run, or its journal is damaged.
    pub fn read(folder: &Path) -> Result<Self, JournalError> {
        let folder = ResultsFolder::new(folder);
        // Asked before the journal is read: a run that ends in between is told as going on, and not as short of designs.
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

    /// Checks the tables against `contents.toml`, unless another process is writing them.
    fn check(&mut self, folder: &ResultsFolder) {
        // Tables lag behind the journal while a run goes on; that is no fault.
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
            // The quickest of six goes: memory stays the same for any number of designs.
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

    /// Designs that are being solved: at most one for each thread of a run that goes on.
    pub fn running(&self) -> u64 {
        // How many designs are in hand is not written anywhere; no thread has more than one.
        let threads = self.archive.sessions().last().map_or(1, |session| session.threads as u64);
        if self.in_use { threads.min(self.not_done()) } else { 0 }
    }

    /// Designs that are neither done nor being solved.
    pub fn missing(&self) -> u64 {
        self.not_done() - self.running()
    }

    fn not_done(&self) -> u64 {
        self.archive.designs().len() - self.archive.done()
    }

    /// Designs per second of the last session.
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
