//! From designs that are known to better ones: many regions are tried a little, the best of them to the end.

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

use crate::best::starts;
use crate::candidate::{Candidate, Target};
use crate::evaluations::Halt;
use crate::local::{Effort, Search};

/// How many designs are improved for a target, each for itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// Designs that are improved a little.
    pub regions: usize,
    /// Designs that are improved along derivatives after that.
    pub starts: usize,
    /// Designs that are improved to the end after that.
    pub finalists: usize,
}

impl Plan {
    /// Among nominal designs.
    pub const NOMINAL: Self = Self { regions: 24, starts: 6, finalists: 3 };
    /// Among designs that are sampled.
    pub const SAMPLED: Self = Self { regions: 6, starts: 6, finalists: 3 };

    /// For a point of a front: the ends of the front are known by then, and few regions come near the best.
    pub fn of_a_point(self) -> Self {
        Self { finalists: 2, ..self }
    }

    /// For a point between others, whose searches have left good designs in every region.
    pub fn between_points(self) -> Self {
        Self { regions: 0, finalists: 1, ..self }
    }

    /// Designs that are improved, at most.
    pub fn tasks(self) -> usize {
        self.regions + self.starts + self.finalists
    }
}

/// The designs that are looked at when the best of those in `history` are improved for a target.
pub(crate) fn improved(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    plan: Plan,
) -> Result<Vec<Candidate>, Halt> {
    let mut evaluated: Vec<Candidate> = Vec::new();
    // Many a little, some more, few to the end: a few steps tell which regions are worth the rest.
    let stages = [
        (plan.regions, Effort::PROBE),
        (plan.starts, Effort::CLIMB),
        (plan.finalists, Effort::WHOLE),
    ];
    for (count, effort) in stages {
        // Each knows only its own start, so that what is found does not depend on which ends first.
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
