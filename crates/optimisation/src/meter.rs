//! How far a search is, for whoever watches it.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// A part of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SearchPart {
    /// Points that fill the space.
    #[default]
    Sample,
    /// The best of them, along derivatives.
    Climb,
    /// The best of those, to the end.
    Finish,
    /// The points of a front.
    Front,
    /// The first samples of the best nominal designs.
    Samples,
    /// More samples of designs near the best.
    Refine,
    /// Other samples of the best designs.
    Check,
}

/// How far a search is: written by the search, read by whoever watches.
#[derive(Debug, Default)]
pub struct SearchMeter {
    part: Mutex<(SearchPart, usize)>,
    done: AtomicUsize,
    designs: AtomicUsize,
    starts: AtomicUsize,
}

impl SearchPart {
    /// The part in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sample => "filling the space",
            Self::Climb => "climbing from the best",
            Self::Finish => "finishing",
            Self::Front => "points of the front",
            Self::Samples => "first samples",
            Self::Refine => "near the best with more samples",
            Self::Check => "checking with other samples",
        }
    }
}

impl SearchMeter {
    /// The part that is in hand, how many of its tasks are done, and of how many.
    pub fn progress(&self) -> (SearchPart, usize, usize) {
        let (part, tasks) = *self.part.lock().unwrap_or_else(PoisonError::into_inner);
        (part, self.done.load(Ordering::Relaxed).min(tasks), tasks)
    }

    /// Designs that were looked at.
    pub fn designs(&self) -> usize {
        self.designs.load(Ordering::Relaxed)
    }

    /// Designs from which a local search began.
    pub fn starts(&self) -> usize {
        self.starts.load(Ordering::Relaxed)
    }

    /// A local search begins.
    pub(crate) fn start(&self) {
        self.starts.fetch_add(1, Ordering::Relaxed);
    }

    /// A part of so many tasks begins.
    pub(crate) fn begin(&self, part: SearchPart, tasks: usize) {
        *self.part.lock().unwrap_or_else(PoisonError::into_inner) = (part, tasks);
        self.done.store(0, Ordering::Relaxed);
    }

    /// A task is done.
    pub(crate) fn step(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// A design was looked at.
    pub(crate) fn look(&self) {
        self.designs.fetch_add(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_are_counted_part_by_part() {
        let meter = SearchMeter::default();
        meter.begin(SearchPart::Climb, 12);
        meter.step();
        meter.look();
        assert_eq!(meter.progress(), (SearchPart::Climb, 1, 12));
        meter.begin(SearchPart::Front, 30);
        assert_eq!((meter.progress(), meter.designs()), ((SearchPart::Front, 0, 30), 1));
    }
}
