//! Progress of a search, for display.
//!
//! Work is counted in units. One unit is the work for a space-filling point. Only the ratios of
//! work matter, because the display measures the time for a unit.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use run::WorkMeter;

/// Part of a search that the progress display names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SearchPart {
    /// Evaluation of space-filling points.
    #[default]
    Sample,
    /// Local searches from the best space-filling points.
    LocalSearches,
    /// Restart near the best design, because the local searches disagree.
    Restart,
    /// Searches for points of a front.
    Front,
    /// First samples of the best nominal designs.
    Samples,
    /// Local searches from the best designs with more samples.
    Refine,
    /// Check of the best designs with independent samples.
    Check,
    /// Rounding of the best design.
    Round,
}

/// Progress of a search, which the search updates and the display reads.
#[derive(Debug, Default)]
pub struct SearchProgress {
    parts: Mutex<Parts>,
    /// Number of completed tasks of the current part.
    done: AtomicUsize,
    /// Completed units of the current part.
    units: AtomicU64,
    /// Number of evaluated designs.
    designs: AtomicUsize,
    /// Number of local searches.
    starts: AtomicUsize,
    slow: WorkMeter,
}

/// Parts of a search with their work in units, and the index of the current part.
#[derive(Debug, Default)]
struct Parts {
    /// Work of each part: completed work of earlier parts, expected work of the other parts.
    work: Vec<(SearchPart, u64)>,
    /// Index of the current part.
    at: usize,
    /// Number of tasks in the current part.
    tasks: usize,
}

/// Returns the total work of parts in units.
fn units(work: &[(SearchPart, u64)]) -> f64 {
    work.iter().map(|part| part.1).sum::<u64>() as f64
}

/// A task of the current part, e.g. a local search, with its expected units of work.
///
/// Units beyond the expected number are not counted. Units that are missing when the task ends are
/// added.
pub(crate) struct SearchTask<'p> {
    progress: &'p SearchProgress,
    /// Expected units that have not been counted.
    left: Cell<u64>,
}

impl SearchPart {
    /// Returns the description of the part for the display.
    pub fn description(self) -> &'static str {
        match self {
            Self::Sample => "space-filling points",
            Self::LocalSearches => "local searches from the best points",
            Self::Restart => "restarts near the best design",
            Self::Front => "points of the front",
            Self::Samples => "first samples",
            Self::Refine => "local searches with more samples",
            Self::Check => "checking with independent samples",
            Self::Round => "rounding the best design",
        }
    }
}

impl SearchProgress {
    /// Returns the current part, the number of its finished tasks and the number of its tasks.
    pub fn progress(&self) -> (SearchPart, usize, usize) {
        let parts = self.parts();
        let part = parts.work.get(parts.at).map_or_else(SearchPart::default, |part| part.0);
        (part, self.done.load(Ordering::Relaxed).min(parts.tasks), parts.tasks)
    }

    /// Returns the completed fraction of the expected work, from 0 to 1.
    ///
    /// The fraction decreases if a part starts that was not expected.
    pub fn completed_fraction(&self) -> f64 {
        let parts = self.parts();
        let current = parts.work.get(parts.at).map_or(0, |part| part.1);
        let done = units(&parts.work[..parts.at.min(parts.work.len())])
            + self.units.load(Ordering::Relaxed).min(current) as f64;
        // Without work the quotient is NaN, and `max` returns 0.
        (done / units(&parts.work)).max(0.0)
    }

    /// Locks the parts.
    fn parts(&self) -> MutexGuard<'_, Parts> {
        self.parts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the number of evaluated designs.
    pub fn designs(&self) -> usize {
        self.designs.load(Ordering::Relaxed)
    }

    /// Returns the meter that reports designs with a long solution time.
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

    /// Sets the expected parts of the search with their units of work.
    pub(crate) fn expect(&self, work: Vec<(SearchPart, u64)>) {
        *self.parts() = Parts { work, ..Parts::default() };
    }

    /// Starts the next part of kind `part` with this number of tasks and total `units` of work.
    ///
    /// Expected parts that precede this part are dropped. A part that was not expected is added.
    /// The part `Front` starts several times: expected units beyond `units` are kept for its next
    /// start.
    pub(crate) fn begin(&self, part: SearchPart, tasks: usize, units: u64) {
        let mut parts = self.parts();
        let done = self.units.swap(0, Ordering::Relaxed);
        self.done.store(0, Ordering::Relaxed);
        let at = parts.at;
        // Before the first part there is no completed part.
        let is_first = parts.tasks == 0;
        let next = if is_first { 0 } else { at + 1 };
        if let Some(current) = parts.work.get_mut(at).filter(|_| !is_first) {
            current.1 = current.1.min(done);
        }
        let ahead = parts.work.get(next..).unwrap_or_default();
        // Use an expected restart only if it directly follows the current part. Otherwise it
        // belongs to later local searches.
        let skipped = ahead.iter().position(|of| of.0 == part);
        match skipped.filter(|&skipped| part != SearchPart::Restart || skipped == 0) {
            Some(skipped) => drop(parts.work.drain(next..next + skipped)),
            None => parts.work.insert(next, (part, units)),
        }
        let expected = std::mem::replace(&mut parts.work[next].1, units);
        if part == SearchPart::Front && expected > units {
            parts.work.insert(next + 1, (part, expected - units));
        }
        (parts.at, parts.tasks) = (next, tasks);
    }

    /// Starts a task of the current part with these expected units of work.
    pub(crate) fn task(&self, units: u64) -> SearchTask<'_> {
        SearchTask { progress: self, left: Cell::new(units) }
    }

    /// Counts an evaluated design.
    pub(crate) fn evaluate(&self) {
        self.designs.fetch_add(1, Ordering::Relaxed);
    }
}

impl SearchTask<'_> {
    /// Counts completed units of work.
    pub fn count(&self, units: u64) {
        let units = units.min(self.left.get());
        self.left.set(self.left.get() - units);
        self.progress.units.fetch_add(units, Ordering::Relaxed);
    }
}

impl Drop for SearchTask<'_> {
    fn drop(&mut self) {
        self.count(u64::MAX);
        self.progress.done.fetch_add(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::SearchPart::{Check, Front, LocalSearches, Restart, Sample};
    use super::*;

    #[test]
    fn tasks_are_counted_in_the_current_part_and_units_in_all_parts() {
        let progress = SearchProgress::default();
        assert_eq!(progress.completed_fraction(), 0.0);
        progress.expect(vec![
            (Sample, 12),
            (LocalSearches, 24),
            (Front, 36),
            (LocalSearches, 24),
            (Check, 24),
        ]);
        progress.begin(Sample, 12, 12);
        drop(progress.task(1));
        progress.evaluate();
        assert_eq!((progress.progress(), progress.designs()), ((Sample, 1, 12), 1));
        assert_eq!(progress.completed_fraction(), 1.0 / 120.0);
        (0..11).for_each(|_| drop(progress.task(1)));
        progress.begin(LocalSearches, 4, 24);
        let task = progress.task(6);
        task.count(4);
        assert_eq!(
            (progress.progress(), progress.completed_fraction()),
            ((LocalSearches, 0, 4), 16.0 / 120.0)
        );
        // Units beyond the expected number are not counted.
        task.count(400);
        assert_eq!(progress.completed_fraction(), 18.0 / 120.0);
        drop(task);
        assert_eq!(
            (progress.progress(), progress.completed_fraction()),
            ((LocalSearches, 1, 4), 18.0 / 120.0)
        );
    }

    #[test]
    fn successive_parts_of_a_front_share_the_expected_units() {
        let progress = SearchProgress::default();
        progress.expect(vec![(Sample, 10), (Front, 40), (Front, 50)]);
        progress.begin(Sample, 1, 10);
        drop(progress.task(10));
        progress.begin(Front, 1, 40);
        drop(progress.task(40));
        progress.begin(Front, 1, 20);
        drop(progress.task(20));
        assert_eq!(progress.completed_fraction(), 70.0 / 100.0);
        progress.begin(Front, 1, 60);
        assert_eq!(progress.completed_fraction(), 70.0 / 130.0);
    }

    #[test]
    fn completed_fraction_adapts_to_dropped_and_unexpected_parts() {
        let progress = SearchProgress::default();
        progress.expect(vec![(Sample, 10), (LocalSearches, 40), (Restart, 50), (Check, 20)]);
        progress.begin(Sample, 1, 10);
        drop(progress.task(10));
        progress.begin(LocalSearches, 2, 40);
        drop(progress.task(20));
        // The restart is not needed and is dropped. The part of the local searches is reduced to
        // the 20 completed units.
        progress.begin(Check, 1, 20);
        assert_eq!(progress.completed_fraction(), 30.0 / 50.0);
        progress.begin(Restart, 1, 30);
        assert_eq!(progress.completed_fraction(), 30.0 / 60.0);
        // An unexpected restart does not replace the expected restart of later local searches.
        let progress = SearchProgress::default();
        progress.expect(vec![(LocalSearches, 20), (LocalSearches, 40), (Restart, 50)]);
        progress.begin(LocalSearches, 1, 20);
        drop(progress.task(20));
        progress.begin(Restart, 1, 30);
        assert_eq!(progress.completed_fraction(), 20.0 / 140.0);
    }
}
