//! Improves known designs: short searches in many regions, full searches from the best.

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

use crate::best::starts;
use crate::candidate::{Candidate, Target};
use crate::evaluations::Halt;
use crate::local::{Effort, Search};

/// Numbers of local searches for a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// Short searches, one per region.
    pub regions: usize,
    /// Gradient searches after the short ones.
    pub starts: usize,
    /// Full searches after the gradient searches.
    pub finalists: usize,
}

impl Plan {
    /// Plan for nominal designs.
    pub const NOMINAL: Self = Self { regions: 24, starts: 6, finalists: 3 };
    /// Plan for sampled designs.
    pub const SAMPLED: Self = Self { regions: 6, starts: 6, finalists: 3 };

    /// Returns the plan for a point of a front: its ends are known, so few regions are near the
    /// best.
    pub fn of_a_point(self) -> Self {
        Self { finalists: 2, ..self }
    }

    /// Returns the plan for a point between others; their searches have left good designs in every
    /// region.
    pub fn between_points(self) -> Self {
        Self { regions: 0, finalists: 1, ..self }
    }

    /// Returns the maximum number of local searches.
    pub fn tasks(self) -> usize {
        self.regions + self.starts + self.finalists
    }
}

/// Improves the best designs in `history` for a target, and returns all evaluated designs.
pub(crate) fn improved(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    plan: Plan,
) -> Result<Vec<Candidate>, Halt> {
    let mut evaluated: Vec<Candidate> = Vec::new();
    // Successive halving: a few steps show which regions are worth a longer search.
    let stages = [
        (plan.regions, Effort::PROBE),
        (plan.starts, Effort::CLIMB),
        (plan.finalists, Effort::WHOLE),
    ];
    for (count, effort) in stages {
        // Each search knows its own start alone, so results are independent of the order of
        // completion.
        let starts = starts(search, history.iter().chain(&evaluated), target, count);
        let walks = starts.into_par_iter().map(|start| {
            let walk = search.improve(target, &start, effort);
            search.progress.step();
            walk
        });
        let walks: Vec<_> = walks.collect::<Result<_, _>>()?;
        evaluated.extend(walks.into_iter().flatten());
    }
    Ok(evaluated)
}
