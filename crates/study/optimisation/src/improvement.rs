//! Improves known designs by local searches.
//!
//! Short searches start in many regions. Full searches start from the best designs so far.

use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

use crate::best::starts;
use crate::candidate::{Candidate, Merit, Target};
use crate::evaluations::Halt;
use crate::local::{Effort, Search};
use crate::restarts::met;

/// Distance, as a fraction of the ranges of the variables, below which two starts are duplicates.
const DISTINCT: f64 = 1e-3;

/// Maximum number of gradient searches from other designs, if a design near the best is known.
const ELSEWHERE: usize = 2;

/// Numbers of local searches for a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// Number of short searches, which start in different regions if possible.
    pub regions: usize,
    /// Number of gradient searches, which follow the short searches.
    pub starts: usize,
    /// Number of full searches, which follow the gradient searches.
    pub finalists: usize,
    /// Maximum number of restarts if the full searches disagree.
    pub restarts: usize,
}

impl Plan {
    /// Plan for nominal designs.
    pub const NOMINAL: Self = Self { regions: 24, starts: 6, finalists: 3, restarts: 6 };
    /// Plan for nominal designs from which searches over samples start.
    pub const STARTS: Self = Self { restarts: 0, ..Self::NOMINAL };
    /// Plan for designs with samples.
    ///
    /// Restarts would be too expensive. Also, the uncertainty of quantiles exceeds the jumps of an
    /// objective.
    pub const SAMPLED: Self = Self { regions: 6, ..Self::STARTS };

    /// Plan for a search that continues with tighter limits, when the best regions are known.
    pub const AGAIN: Self = Self { regions: 0, starts: 3, finalists: 2, restarts: 0 };

    /// Returns the plan for one of the first points of a front.
    ///
    /// Two full searches suffice, because good designs near the ends of the front are known.
    pub fn of_a_point(self) -> Self {
        Self { finalists: 2, ..self }
    }

    /// Returns the plan for a point of a front between known points.
    ///
    /// Short searches are unnecessary, because the searches for the neighbouring points have found
    /// good designs in each region.
    pub fn between_points(self) -> Self {
        Self { regions: 0, finalists: 1, ..self }
    }

    /// Returns the expected number of evaluations for one target.
    pub fn evaluations(self) -> u64 {
        let Self { regions, starts, finalists, .. } = self;
        (regions + starts) as u64 * Effort::GRADIENT.evaluations
            + finalists as u64 * Effort::WHOLE.evaluations
    }

    /// Returns the maximum number of local searches for one target, without restarts.
    pub fn tasks(self) -> usize {
        self.regions + self.starts + self.finalists
    }
}

/// Result of the local searches for a target.
pub(crate) struct Improved {
    /// All evaluated designs, in the order of the searches.
    pub evaluated: Vec<Candidate>,
    /// Objectives of the designs found by the full searches, and of the starts of these searches.
    ///
    /// Objectives to be minimised change sign. Infeasible designs are omitted.
    pub ends: Vec<f64>,
}

/// Improves the best designs in `history` for `target`.
pub(crate) fn improved(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    plan: Plan,
) -> Result<Improved, Halt> {
    improved_from(search, history, target, plan, None)
}

/// Improves the best designs in `history` for `target`, and the design `near`, if given.
///
/// `near` is probably close to the best design. If it is given, fewer gradient searches start from
/// other designs.
pub(crate) fn improved_from(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    plan: Plan,
    near: Option<&Candidate>,
) -> Result<Improved, Halt> {
    let (mut evaluated, mut ends): (Vec<Candidate>, Vec<f64>) = (Vec::new(), Vec::new());
    // Successive halving: a few steps in each region show which regions deserve longer searches.
    let full = if near.is_some() { Effort::NEAR } else { Effort::WHOLE };
    let stages =
        [(plan.regions, Effort::PROBE), (plan.starts, Effort::GRADIENT), (plan.finalists, full)];
    for (count, effort) in stages {
        // The results do not depend on the order in which parallel searches end, because each
        // search depends on its start only.
        let known = history.iter().chain(&evaluated);
        let is_met = |candidate: &Candidate| met(search, candidate, target).is_some();
        let any_met = known.clone().any(is_met);
        // A full search has no merit to beat: it converges even to a worse design, so that the
        // agreement of the full searches can be judged.
        let best = if effort.rounds == 0 { search.best(known.clone(), target) } else { None };
        let to_beat = best.map_or(Merit::None, |best| search.merit(best, target));
        // Full searches start only from feasible designs, if there are any. Gradient searches also
        // start from infeasible designs, and may become feasible.
        let known = known.filter(|c| effort.rounds == 0 || !any_met || is_met(c));
        let near = near.filter(|_| effort.rounds == 0 && count > 0);
        let count = if near.is_some() { count.min(ELSEWHERE) } else { count };
        let starts = starts(search, known, target, count);
        let starts = distinct(near.cloned().into_iter().chain(starts).collect());
        let searches = starts.par_iter().map(|start| {
            // If some designs are feasible, a search from an infeasible design gets a few steps
            // only.
            let effort = if any_met && !is_met(start) { Effort::PROBE } else { effort };
            let designs = search.improve(target, start, effort, to_beat)?;
            let best = search.best(designs.iter().chain([start]), target);
            let end = best.and_then(|best| met(search, best, target));
            Ok((designs, end))
        });
        let searches: Vec<_> = searches.collect::<Result<_, Halt>>()?;
        // Only the searches of the last stage converge, so `ends` is replaced in each stage. The
        // starts of the last stage count too, because a gradient search has found each of them.
        let both = starts.iter().zip(&searches);
        let both = both.flat_map(|(start, (_, end))| [met(search, start, target), *end]);
        ends = both.flatten().collect();
        evaluated.extend(searches.into_iter().flat_map(|(designs, _)| designs));
    }
    Ok(Improved { evaluated, ends })
}

/// Drops starts that are very close to an earlier start.
///
/// Two such starts may lie in different regions, on opposite sides of a common border. Searches
/// from both starts would find the same design.
fn distinct(starts: Vec<Candidate>) -> Vec<Candidate> {
    let mut kept: Vec<Candidate> = Vec::new();
    for start in starts {
        if kept.iter().all(|earlier| earlier.point.distance(&start.point) >= DISTINCT) {
            kept.push(start);
        }
    }
    kept
}
