//! How far a search is, for whoever watches it.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use run::WorkMeter;

/// A part of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SearchPart {
    /// Points that fill the space.
    #[default]
    Sample,
    /// The best of them, along derivatives.
    Climb,
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
pub struct SearchProgress {
    parts: Mutex<Parts>,
    done: AtomicUsize,
    /// The largest share that was told, as bits: a bar does not go back.
    farthest: AtomicU64,
    designs: AtomicUsize,
    starts: AtomicUsize,
    slow: WorkMeter,
}

/// The parts of a search with the work that each is expected to be, and which of them is in hand.
#[derive(Debug, Default)]
struct Parts {
    expected: Vec<(SearchPart, f64)>,
    at: usize,
    /// Tasks of the part in hand.
    tasks: usize,
}

impl SearchPart {
    /// The part in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sample => "filling the space",
            Self::Climb => "climbing from the best",
            Self::Front => "points of the front",
            Self::Samples => "first samples",
            Self::Refine => "near the best with more samples",
            Self::Check => "checking with other samples",
        }
    }
}

impl SearchProgress {
    /// The part that is in hand, how many of its tasks are done, and of how many.
    pub fn progress(&self) -> (SearchPart, usize, usize) {
        let parts = self.parts();
        let part = parts.expected.get(parts.at).map_or_else(SearchPart::default, |part| part.0);
        (part, self.done.load(Ordering::Relaxed).min(parts.tasks), parts.tasks)
    }

    /// The share of the whole search that is done, from 0 to 1, as far as its work was foreseen.
    pub fn share(&self) -> f64 {
        let (_, done, tasks) = self.progress();
        let parts = self.parts();
        let work = |parts: &[(SearchPart, f64)]| parts.iter().map(|part| part.1).sum::<f64>();
        let own = parts.expected.get(parts.at).map_or(0.0, |part| part.1);
        let before = work(&parts.expected[..parts.at.min(parts.expected.len())]);
        let share = (before + own * done as f64 / tasks.max(1) as f64) / work(&parts.expected);
        // Bits of positive numbers are in the order of the numbers; no work at all is no number.
        let bits = share.max(0.0).to_bits();
        f64::from_bits(self.farthest.fetch_max(bits, Ordering::Relaxed).max(bits))
    }

    fn parts(&self) -> MutexGuard<'_, Parts> {
        self.parts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Designs that were looked at.
    pub fn designs(&self) -> usize {
        self.designs.load(Ordering::Relaxed)
    }

    /// Where designs that take long tell how far they are.
    pub fn slow(&self) -> &WorkMeter {
        &self.slow
    }

    /// Designs from which a local search began.
    pub fn starts(&self) -> usize {
        self.starts.load(Ordering::Relaxed)
    }

    /// A local search begins.
    pub(crate) fn start(&self) {
        self.starts.fetch_add(1, Ordering::Relaxed);
    }

    /// A search of such parts begins.
    pub(crate) fn expect(&self, expected: Vec<(SearchPart, f64)>) {
        *self.parts() = Parts { expected, ..Parts::default() };
    }

    /// A part of so many tasks begins, the next of that kind. Parts in between are left out.
    pub(crate) fn begin(&self, part: SearchPart, tasks: usize) {
        let mut parts = self.parts();
        let is_next = |(k, of): (usize, &(SearchPart, f64))| k > parts.at && of.0 == part;
        // A part that comes more often than foreseen, as refills of fronts may, counts as the last.
        let last = || parts.expected.iter().rposition(|of| of.0 == part);
        let next = parts.expected.iter().enumerate().position(is_next).or_else(last);
        (parts.at, parts.tasks) = (next.unwrap_or(parts.at), tasks);
        self.done.store(0, Ordering::Relaxed);
    }

    /// A task is done.
    pub(crate) fn step(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// A design was looked at.
    pub(crate) fn evaluate(&self) {
        self.designs.fetch_add(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::SearchPart::{Check, Climb, Front, Sample};
    use super::*;

    #[test]
    fn tasks_are_counted_part_by_part_and_the_share_over_all() {
        let progress = SearchProgress::default();
        assert_eq!(progress.share(), 0.0);
        progress.expect(vec![
            (Sample, 1.0),
            (Climb, 2.0),
            (Front, 3.0),
            (Climb, 2.0),
            (Check, 2.0),
        ]);
        progress.begin(Sample, 12);
        progress.step();
        progress.evaluate();
        assert_eq!((progress.progress(), progress.designs()), ((Sample, 1, 12), 1));
        progress.begin(Climb, 4);
        progress.step();
        assert_eq!((progress.progress(), progress.share()), ((Climb, 1, 4), 0.15));
        progress.begin(Front, 1);
        assert_eq!(progress.share(), 0.3);
        progress.begin(Climb, 4);
        assert_eq!(progress.share(), 0.6);
        // A part that was not foreseen again does not lead back.
        progress.begin(Front, 2);
        assert_eq!((progress.progress(), progress.share()), ((Front, 0, 2), 0.6));
    }
}
