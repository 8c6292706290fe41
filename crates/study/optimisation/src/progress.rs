//! Progress of a search, for display.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use run::WorkMeter;

/// Part of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SearchPart {
    /// Evaluating space-filling points.
    #[default]
    Sample,
    /// Local searches from the best of them.
    Climb,
    /// Searching the points of a front.
    Front,
    /// Sampling the best nominal designs.
    Samples,
    /// Local searches near the best, with more samples.
    Refine,
    /// Checking the best designs with independent samples.
    Check,
}

/// Progress of a search: written by the search, read by the display.
#[derive(Debug, Default)]
pub struct SearchProgress {
    parts: Mutex<Parts>,
    done: AtomicUsize,
    /// Largest fraction reported so far, as bits: a progress bar must not go back.
    farthest: AtomicU64,
    designs: AtomicUsize,
    starts: AtomicUsize,
    slow: WorkMeter,
}

/// Parts of a search with their expected work, and the current part.
#[derive(Debug, Default)]
struct Parts {
    expected: Vec<(SearchPart, f64)>,
    at: usize,
    /// Number of tasks in the current part.
    tasks: usize,
}

impl SearchPart {
    /// Returns the description of the part.
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
    /// Returns the current part, its finished tasks and its number of tasks.
    pub fn progress(&self) -> (SearchPart, usize, usize) {
        let parts = self.parts();
        let part = parts.expected.get(parts.at).map_or_else(SearchPart::default, |part| part.0);
        (part, self.done.load(Ordering::Relaxed).min(parts.tasks), parts.tasks)
    }

    /// Returns the completed fraction of the search, from 0 to 1, by expected work.
    pub fn share(&self) -> f64 {
        let (_, done, tasks) = self.progress();
        let parts = self.parts();
        let work = |parts: &[(SearchPart, f64)]| parts.iter().map(|part| part.1).sum::<f64>();
        let own = parts.expected.get(parts.at).map_or(0.0, |part| part.1);
        let before = work(&parts.expected[..parts.at.min(parts.expected.len())]);
        let share = (before + own * done as f64 / tasks.max(1) as f64) / work(&parts.expected);
        // Bits of positive numbers have the order of the numbers; `max` turns the NaN of zero work
        // into 0.
        let bits = share.max(0.0).to_bits();
        f64::from_bits(self.farthest.fetch_max(bits, Ordering::Relaxed).max(bits))
    }

    fn parts(&self) -> MutexGuard<'_, Parts> {
        self.parts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the number of evaluated designs.
    pub fn designs(&self) -> usize {
        self.designs.load(Ordering::Relaxed)
    }

    /// Returns the meter on which slow designs report their progress.
    pub fn slow(&self) -> &WorkMeter {
        &self.slow
    }

    /// Returns the number of local searches.
    pub fn starts(&self) -> usize {
        self.starts.load(Ordering::Relaxed)
    }

    /// Counts a local search.
    pub(crate) fn start(&self) {
        self.starts.fetch_add(1, Ordering::Relaxed);
    }

    /// Starts a search with these parts and their expected work.
    pub(crate) fn expect(&self, expected: Vec<(SearchPart, f64)>) {
        *self.parts() = Parts { expected, ..Parts::default() };
    }

    /// Starts the next part of this kind, skipping parts in between.
    ///
    /// The part has `tasks` tasks.
    pub(crate) fn begin(&self, part: SearchPart, tasks: usize) {
        let mut parts = self.parts();
        let is_next = |(k, of): (usize, &(SearchPart, f64))| k > parts.at && of.0 == part;
        // A part that repeats more often than expected, such as refills of a front, counts as the
        // last.
        let next = parts
            .expected
            .iter()
            .enumerate()
            .position(is_next)
            .or_else(|| parts.expected.iter().rposition(|of| of.0 == part));
        (parts.at, parts.tasks) = (next.unwrap_or(parts.at), tasks);
        self.done.store(0, Ordering::Relaxed);
    }

    /// Counts a finished task.
    pub(crate) fn step(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts an evaluated design.
    pub(crate) fn evaluate(&self) {
        self.designs.fetch_add(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::SearchPart::{Check, Climb, Front, Sample};
    use super::*;

    #[test]
    fn tasks_are_counted_per_part_and_the_fraction_over_all_parts() {
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
        // An unexpected repetition does not reduce the fraction.
        progress.begin(Front, 2);
        assert_eq!((progress.progress(), progress.share()), ((Front, 0, 2), 0.6));
    }
}
