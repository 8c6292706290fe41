//! How far a run is.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};
use std::path::Path;

use results::row;

use crate::journal::{self, Archive, Entry, JournalError};

/// How many of the slowest designs are told.
const SLOWEST: usize = 5;

/// How far a run is.
#[derive(Debug)]
pub struct Status {
    /// What its journal holds.
    pub archive: Archive,
    /// Whether a process is writing it.
    pub in_use: bool,
    /// Designs that lack a value.
    pub failed: u64,
    /// Why, by measure and reason.
    pub reasons: BTreeMap<(String, String), u64>,
    /// The slowest designs, the slowest first: their seconds and their numbers.
    pub slowest: Vec<(f64, String)>,
    /// Designs that were solved again.
    pub solved_again: u64,
}

/// A design and how long it took; the quicker is the greater.
struct Timed {
    seconds: f64,
    design: u64,
    number: String,
}

impl Status {
    /// How far the run in `folder` is; it may be going on.
    ///
    /// # Errors
    /// If there is no run, or its journal is damaged.
    pub fn of(folder: &Path) -> Result<Self, JournalError> {
        let in_use = journal::in_use(folder);
        let archive = Archive::open(folder)?;
        let mut status = Self {
            in_use,
            failed: 0,
            reasons: BTreeMap::new(),
            slowest: Vec::new(),
            solved_again: 0,
            archive,
        };
        status.count()?;
        Ok(status)
    }

    fn count(&mut self) -> Result<(), JournalError> {
        let names = results::failure_names(self.archive.sweep());
        let place = |name: &str| names.iter().position(|other| *other == name).unwrap_or_default();
        let (measure, reason) = (place("measure"), place("reason"));
        let mut slowest = BinaryHeap::new();
        for entry in self.archive.entries()?.in_order() {
            let entry = entry?;
            self.failed += u64::from(entry.failed());
            self.solved_again += u64::from(entry.rerun > 0);
            for failure in &entry.failures {
                let cell = |place| row::cell(failure, place).unwrap_or_default().to_owned();
                *self.reasons.entry((cell(measure), cell(reason))).or_default() += 1;
            }
            slowest.push(Timed::new(&entry));
            if slowest.len() > SLOWEST {
                slowest.pop();
            }
        }
        let slowest = slowest.into_sorted_vec().into_iter();
        self.slowest = slowest.map(|timed| (timed.seconds, timed.number)).collect();
        Ok(())
    }

    /// Designs that are being solved: at most one for each thread of a run that goes on.
    pub fn running(&self) -> u64 {
        let threads = self.archive.sessions().last().map_or(1, |session| session.threads as u64);
        if self.in_use { threads.min(self.not_done()) } else { 0 }
    }

    /// Designs that are neither done nor being solved.
    pub fn missing(&self) -> u64 {
        self.not_done() - self.running()
    }

    fn not_done(&self) -> u64 {
        self.archive.selection().len() - self.archive.done()
    }

    /// Designs per second of the last session.
    pub fn rate(&self) -> Option<f64> {
        let latest = self.archive.latest();
        (latest.seconds > 0.0).then(|| latest.designs as f64 / latest.seconds)
    }
}

impl Timed {
    fn new(entry: &Entry) -> Self {
        let number = row::cell(&entry.row, 0).unwrap_or_default().to_owned();
        Self { seconds: entry.seconds, design: entry.design, number }
    }
}

impl Ord for Timed {
    fn cmp(&self, other: &Self) -> Ordering {
        let quicker = other.seconds.total_cmp(&self.seconds);
        quicker.then_with(|| Reverse(other.design).cmp(&Reverse(self.design)))
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
