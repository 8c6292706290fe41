//! From the designs that fill the space to the answer to a goal.

use crate::best::{BestDesign, best_design};
use crate::candidate::{Candidate, Merit, Target, best};
use crate::evaluations::Halt;
use crate::front::{self, Front};
use crate::improvement::{Plan, improved};
use crate::local::Search;
use crate::progress::SearchPart;

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

/// The answer to a goal, from the designs that are known so far; `points` of a front.
pub(crate) fn answer(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    plan: Plan,
    points: usize,
) -> Result<Answer, Halt> {
    let targets =
        (0..search.judge.objectives()).map(|k| Target { objective: k, floors: Vec::new() });
    let mut targets: Vec<Target> = targets.collect();
    for target in &targets {
        search.progress.begin(SearchPart::Climb, plan.tasks());
        history.extend(improved(search, history, target, plan)?);
        // Without floors all targets ask for the same: what one does not find none of them does.
        let is_feasible = |c: &Candidate| matches!(search.merit(c, target), Merit::Met(_));
        if !history.iter().any(is_feasible) {
            let merits = history.iter().map(|candidate| search.merit(candidate, target));
            return Ok(Answer::Infeasible(best(merits)));
        }
    }
    if targets.len() == 1 {
        let best = best_design(search, history, targets.swap_remove(0))?;
        return Ok(Answer::Optimum(Box::new(best)));
    }
    front::search(search, history, plan, points).map(Answer::Front)
}
