//! Limit on the work of a path.

use crate::newton::Work;

/// Numbers of tangents that a path may always factorise, for a system of any size.
///
/// The first number counts from the start of the path, the second from its last progress.
const FREE_TANGENTS: [u64; 2] = [2_000, 1_000];

/// Smallest growth of the control parameter, divided by its scale, that counts as progress.
const PROGRESS: f64 = 0.01;

/// Control parameter and work of a path at its last progress, for the limit on the work.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Budget {
    /// Control parameter, divided by its scale, at the last progress.
    farthest: f64,
    /// Work of the path at the last progress.
    at_farthest: Work,
}

impl Budget {
    /// Records the control parameter and the work at a point.
    pub(super) fn advance(&mut self, progress: f64, work: Work) {
        if progress >= self.farthest + PROGRESS {
            *self = Self { farthest: progress, at_farthest: work };
        }
    }

    /// Restarts the count of work without progress, for a path that is turned back.
    pub(super) fn restart(&mut self, work: Work) {
        *self = Self { farthest: f64::NEG_INFINITY, at_farthest: work };
    }

    /// Returns true if the work exceeds `most` unknowns, or half of `most` without progress.
    ///
    /// The limit is on unknowns, not on time, so that results do not depend on the machine.
    pub(super) fn is_exceeded(&self, work: Work, most: u64) -> bool {
        let since = Work {
            tangents: work.tangents - self.at_farthest.tangents,
            unknowns: work.unknowns - self.at_farthest.unknowns,
        };
        let [of_path, of_stall] = FREE_TANGENTS;
        (work.tangents > of_path && work.unknowns > most)
            || (since.tangents > of_stall && since.unknowns > most / 2)
    }
}

#[cfg(test)]
mod tests {
    use super::{Budget, FREE_TANGENTS, PROGRESS, Work};

    const MOST: u64 = 10_000;

    #[test]
    fn a_path_without_progress_exceeds_its_budget() {
        let mut budget = Budget::default();
        let work = Work { tangents: FREE_TANGENTS[1] + 1, unknowns: MOST / 2 + 1 };
        assert!(budget.is_exceeded(work, MOST));
        budget.advance(0.5 * PROGRESS, work);
        assert!(budget.is_exceeded(work, MOST));
        budget.advance(PROGRESS, work);
        assert!(!budget.is_exceeded(work, MOST));
    }

    #[test]
    fn a_path_with_progress_ends_at_the_limit_of_the_whole_path() {
        let mut budget = Budget::default();
        let work = Work { tangents: FREE_TANGENTS[0] + 1, unknowns: MOST + 1 };
        budget.advance(PROGRESS, work);
        assert!(budget.is_exceeded(work, MOST));
    }

    #[test]
    fn few_tangents_of_a_large_system_do_not_exceed_the_budget() {
        let work = Work { tangents: FREE_TANGENTS[1], unknowns: u64::MAX };
        assert!(!Budget::default().is_exceeded(work, MOST));
    }
}
