//! From the designs that fill the space to the answer to a goal.

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

use crate::best::{BestDesign, best_design, starts};
use crate::candidate::{Candidate, Merit, Target, best};
use crate::evaluations::Halt;
use crate::front::{self, Front};
use crate::local::{Effort, Search};
use crate::meter::SearchPart;

/// The answer to a goal.
#[derive(Clone, Debug)]
pub enum Answer {
    /// The best design, of one objective.
    Optimum(Box<BestDesign>),
    /// The designs that none beats, of several.
    Front(Front),
    /// No design meets the requirements; the index in the history of the nearest, if any can be judged.
    Infeasible(Option<usize>),
}

/// How much is improved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// Designs that are improved a little, for each objective.
    pub regions: usize,
    /// Designs that are improved along derivatives after that.
    pub starts: usize,
    /// Designs that are improved to the end after that.
    pub finalists: usize,
    /// Points of a front.
    pub points: usize,
}

impl Plan {
    /// Among nominal designs.
    pub const NOMINAL: Self = Self { regions: 24, starts: 6, finalists: 3, points: 0 };
    /// Among designs that are sampled.
    pub const SAMPLED: Self = Self { regions: 6, starts: 6, finalists: 3, points: 0 };
}

/// The answer to a goal, from the designs that are known so far.
pub(crate) fn answer(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    plan: Plan,
) -> Result<Answer, Halt> {
    let mut targets: Vec<Target> = Vec::new();
    for objective in 0..search.judge.objectives() {
        let target = Target { objective, floors: Vec::new() };
        // Many a little, some more, few to the end: a few steps tell which regions are worth the rest.
        let first = starts(search, history, &target, plan.regions);
        search.meter.begin(SearchPart::Climb, first.len() + plan.starts);
        history.extend(improved(search, &target, first, Effort::PROBE)?);
        let best = starts(search, history, &target, plan.starts);
        history.extend(improved(search, &target, best, Effort::CLIMB)?);
        let best = starts(search, history, &target, plan.finalists);
        search.meter.begin(SearchPart::Finish, best.len());
        history.extend(improved(search, &target, best, Effort::WHOLE)?);
        targets.push(target);
    }
    // By any objective: without floors all targets ask for the same requirements.
    let is_feasible = |c: &Candidate| matches!(search.merit(c, &targets[0]), Merit::Met(_));
    if !history.iter().any(is_feasible) {
        return Ok(Answer::Infeasible(best(history.iter().map(|c| search.merit(c, &targets[0])))));
    }
    if targets.len() == 1 {
        let best = best_design(search, history, targets.swap_remove(0))?;
        return Ok(Answer::Optimum(Box::new(best)));
    }
    front::search(search, history, plan.points).map(Answer::Front)
}

/// The candidates that are looked at when the starts are improved, each for itself.
fn improved(
    search: &Search<'_>,
    target: &Target,
    starts: Vec<Candidate>,
    effort: Effort,
) -> Result<Vec<Candidate>, Halt> {
    // Each knows only its own start, so that what is found does not depend on which ends first.
    let walks = starts.into_par_iter().map(|start| {
        let walk = search.improve(target, &start, effort);
        search.meter.step();
        walk
    });
    Ok(walks.collect::<Result<Vec<_>, _>>()?.concat())
}
