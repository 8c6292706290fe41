//! Improves known designs by local searches.
//!
//! Short searches start in many regions, full searches from the best designs.

use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

use crate::best::starts;
use crate::candidate::{Candidate, Target};
use crate::evaluations::Halt;
use crate::local::{Effort, Search};
use crate::restarts::met;

/// Minimum distance of two distinct starts, as a fraction of the intervals.
const DISTINCT: f64 = 1e-3;

/// Number of gradient searches besides the one from a design that is probably near the best.
const ELSEWHERE: usize = 2;

/// Numbers of local searches for a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// Short searches, one per region.
    pub regions: usize,
    /// Gradient searches after the short ones.
    pub starts: usize,
    /// Full searches after the gradient searches.
    pub finalists: usize,
    /// Maximum number of restarts if the full searches disagree.
    pub restarts: usize,
}

impl Plan {
    /// Plan for nominal designs.
    pub const NOMINAL: Self = Self { regions: 24, starts: 6, finalists: 3, restarts: 6 };
    /// Plan for nominal designs at which searches of sampled designs start.
    pub const STARTS: Self = Self { restarts: 0, ..Self::NOMINAL };
    /// Plan for sampled designs.
    ///
    /// They are too expensive for restarts, and the uncertainty of their quantiles exceeds the
    /// steps of an objective that jumps.
    pub const SAMPLED: Self = Self { regions: 6, ..Self::STARTS };

    /// Plan for a search that continues with tighter limits. The best regions are known.
    pub const AGAIN: Self = Self { regions: 0, starts: 3, finalists: 2, restarts: 0 };

    /// Returns the plan for a point of a front.
    ///
    /// The ends of the front are known, so few regions are near the best.
    pub fn of_a_point(self) -> Self {
        Self { finalists: 2, ..self }
    }

    /// Returns the plan for an intermediate point of a front.
    ///
    /// No region needs a new search, because the searches for the neighbouring points have already
    /// found good designs in each.
    pub fn between_points(self) -> Self {
        Self { regions: 0, finalists: 1, ..self }
    }

    /// Returns the expected number of evaluations for a target.
    pub fn evaluations(self) -> u64 {
        let Self { regions, starts, finalists, .. } = self;
        (regions + starts) as u64 * Effort::GRADIENT.evaluations
            + finalists as u64 * Effort::WHOLE.evaluations
    }

    /// Returns the maximum number of local searches.
    pub fn tasks(self) -> usize {
        self.regions + self.starts + self.finalists
    }
}

/// Result of the local searches for a target.
pub(crate) struct Improved {
    /// All evaluated designs, in the order of the searches.
    pub evaluated: Vec<Candidate>,
    /// Objectives of the last searches and of their starts, to be maximised.
    ///
    /// Infeasible ends are omitted.
    pub ends: Vec<f64>,
}

/// Improves the best designs in `history` for a target.
pub(crate) fn improved(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    plan: Plan,
) -> Result<Improved, Halt> {
    improved_from(search, history, target, plan, None)
}

/// Improves the best designs in `history`, and a design that is probably near the best.
///
/// With such a design fewer gradient searches start elsewhere.
pub(crate) fn improved_from(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    plan: Plan,
    near: Option<&Candidate>,
) -> Result<Improved, Halt> {
    let (mut evaluated, mut ends): (Vec<Candidate>, Vec<f64>) = (Vec::new(), Vec::new());
    // Successive halving: a few steps show which regions are worth a longer search.
    let full = if near.is_some() { Effort::NEAR } else { Effort::WHOLE };
    let stages =
        [(plan.regions, Effort::PROBE), (plan.starts, Effort::GRADIENT), (plan.finalists, full)];
    for (count, effort) in stages {
        // Each search depends on its start only, so results are independent of the order of
        // completion.
        let known = history.iter().chain(&evaluated);
        let is_met = |candidate: &Candidate| met(search, candidate, target).is_some();
        let any_met = known.clone().any(is_met);
        // Gradient searches lead to feasible designs, and full searches improve them. Full searches
        // therefore start at feasible designs if there are any.
        let known = known.filter(|c| effort.rounds == 0 || !any_met || is_met(c));
        let near = near.filter(|_| effort.rounds == 0 && count > 0);
        let count = if near.is_some() { count.min(ELSEWHERE) } else { count };
        let starts = starts(search, known, target, count);
        let starts = distinct(near.cloned().into_iter().chain(starts).collect());
        let walks = starts.par_iter().map(|start| {
            // If some designs are feasible, a start that is not gets another short search.
            let effort = if any_met && !is_met(start) { Effort::PROBE } else { effort };
            let walk = search.improve(target, start, effort)?;
            let best = search.best(walk.iter().chain([start]), target);
            let end = best.and_then(|best| met(search, best, target));
            Ok((walk, end))
        });
        let walks: Vec<_> = walks.collect::<Result<_, Halt>>()?;
        // Only the last stage converges. Its starts are the ends of searches by another method, so
        // they count too.
        let both = starts.iter().zip(&walks);
        let both = both.flat_map(|(start, (_, end))| [met(search, start, target), *end]);
        ends = both.flatten().collect();
        evaluated.extend(walks.into_iter().flat_map(|(walk, _)| walk));
    }
    Ok(Improved { evaluated, ends })
}

/// Drops starts beside an earlier start.
///
/// Starts on both sides of a region border are one point, and searches from them end at the same
/// design.
fn distinct(starts: Vec<Candidate>) -> Vec<Candidate> {
    let mut kept: Vec<Candidate> = Vec::new();
    for start in starts {
        if kept.iter().all(|earlier| earlier.point.distance(&start.point) >= DISTINCT) {
            kept.push(start);
        }
    }
    kept
}
