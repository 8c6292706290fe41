//! Solves a design and returns its journal entry.

use std::time::{Duration, Instant};

use sweep::{Grid, Sweep};

use super::evaluator::Evaluator;
use super::work::{WorkMeter, work_of};
use crate::run_journal::JournalEntry;

/// Solves designs of one sweep and returns their journal entries.
pub(crate) struct Task<'a> {
    sweep: &'a Sweep,
    evaluator: Evaluator,
    /// Settings that differ from the settings of the run, empty except in a rerun.
    settings: String,
    rerun: u64,
    clock: Instant,
    work: &'a WorkMeter,
}

impl<'a> Task<'a> {
    /// Creates the task for the designs of `sweep` in rerun number `rerun`, 0 for a run.
    ///
    /// `clock` is the start of the session. The task reports its progress to `work`.
    pub fn new(
        sweep: &'a Sweep,
        settings: String,
        rerun: u64,
        clock: Instant,
        work: &'a WorkMeter,
    ) -> Self {
        let evaluator = Evaluator::new(sweep.measures());
        Self { sweep, evaluator, settings, rerun, clock, work }
    }

    /// Sets the expected work of `designs`, given by their indices, in the work meter.
    pub fn measure(&self, designs: impl Iterator<Item = u64>) {
        let work = |index| work_of(&self.grid().case(index), self.sweep.measures());
        // The sum saturates, because 10⁹ designs with many samples may exceed 2⁶⁴ paths.
        self.work.begin(designs.map(work).fold(0, u64::saturating_add));
    }

    /// Returns the grid of the sweep.
    pub fn grid(&self) -> &'a Grid {
        self.sweep.grid()
    }

    /// Solves design `index` and returns its journal entry.
    pub fn solve(&self, index: u64) -> JournalEntry {
        let begun = self.clock.elapsed();
        let grid = self.grid();
        let number = grid.number(index);
        let solve = || self.evaluator.row_metered(number, &grid.case(index), self.work);
        let mut result = self.work.track(&format!("design {number}"), solve).result;
        result.settings.clone_from(&self.settings);
        let at = self.clock.elapsed();
        let seconds = seconds(at.saturating_sub(begun));
        JournalEntry {
            design: index + 1,
            rerun: self.rerun,
            at: self::seconds(at),
            seconds,
            result,
        }
    }
}

/// Rounds seconds to microseconds.
fn seconds(duration: Duration) -> f64 {
    // More digits are not significant and would lengthen a journal line by a tenth.
    (duration.as_secs_f64() * 1e6).round() / 1e6
}
