//! Searches for the answer to a goal: an optimum, a front or the nearest infeasible design.

use crate::best::{BestDesign, best_design};
use crate::candidate::{Candidate, Merit, Target, best};
use crate::evaluations::Halt;
use crate::front::{self, Front};
use crate::improvement::{Improved, Plan, improved};
use crate::local::Search;
use crate::progress::SearchPart;
use crate::restarts::{Agreement, restarted};

/// Answer to a goal.
#[derive(Clone, Debug)]
pub enum Answer {
    /// Best design for one objective.
    Optimum(Box<BestDesign>),
    /// Non-dominated designs for several objectives.
    Front(Front),
    /// No design meets all requirements.
    ///
    /// The value is the index, in [`Found::history`](crate::Found::history), of the design with the
    /// smallest shortfall. `None` if no design has a valid judgement.
    Infeasible(Option<usize>),
}

impl Answer {
    /// Returns the best designs: the optimum, or all points of the front.
    pub(crate) fn best_mut(&mut self) -> &mut [BestDesign] {
        match self {
            Self::Optimum(best) => std::slice::from_mut(best),
            Self::Front(front) => &mut front.designs,
            Self::Infeasible(_) => &mut [],
        }
    }
}

/// Searches for the answer to a goal, starting from the designs in `history`.
///
/// Evaluated designs are added to `history`. `plan` sets the numbers of local searches. A front has
/// at most `points` points.
pub(crate) fn answer(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    plan: Plan,
    points: usize,
) -> Result<Answer, Halt> {
    let targets =
        (0..search.judge.objectives()).map(|k| Target { objective: k, lower_bounds: Vec::new() });
    let mut targets: Vec<Target> = targets.collect();
    let mut agreement = Agreement::of(&[]);
    for target in &targets {
        let units = plan.evaluations() * search.evaluation_units(target);
        search.progress.begin(SearchPart::LocalSearches, plan.tasks(), units);
        let Improved { evaluated, mut ends } = improved(search, history, target, plan)?;
        history.extend(evaluated);
        history.extend(restarted(search, history, target, &mut ends, plan.restarts)?);
        agreement = Agreement::of(&ends);
        // Targets without lower bounds have the same feasible designs. If the search for one
        // objective finds no feasible design, searches for the other objectives are useless.
        if !history.iter().any(|c| matches!(search.merit(c, target), Merit::Met(_))) {
            let merits = history.iter().map(|candidate| search.merit(candidate, target));
            return Ok(Answer::Infeasible(best(merits)));
        }
    }
    if targets.len() == 1 {
        let best = best_design(search, history, targets.swap_remove(0))?;
        return Ok(Answer::Optimum(Box::new(BestDesign { agreement: Some(agreement), ..best })));
    }
    front::search(search, history, plan, points).map(Answer::Front)
}
