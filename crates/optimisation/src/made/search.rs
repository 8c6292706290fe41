//! The search among what is made: it begins at the best designs as they are drawn, of which skins are made then.

use rayon::iter::{
    IntoParallelIterator as _, IntoParallelRefMutIterator as _, ParallelIterator as _,
};

use super::estimate::report;
use crate::candidate::{Candidate, Merit, SearchStage};
use crate::evaluations::Halt;
use crate::goal::DesignGoal;
use crate::local::{Effort, Search};
use crate::meter::SearchPart;
use crate::search::{Answer, BestDesign, Plan, answer as answer_by, apart, best_design};
use crate::space::SpacePoint;

/// Points of a front of designs as they are drawn, at most: a front of skins begins there.
const DRAWN_POINTS: usize = 10;

/// Designs as they are drawn, for each objective, of which skins are made at first.
const SEEDS: usize = 16;

/// Times as many skins as of any design are made of those near the best.
const MORE: usize = 5;

/// The searches among designs as they are drawn, among those of which skins are made, and near the best of these with more skins.
#[derive(Clone, Copy)]
pub(crate) struct MadeSearches<'s> {
    pub drawn: &'s Search<'s>,
    pub made: &'s Search<'s>,
    pub finer: &'s Search<'s>,
}

impl DesignGoal {
    /// The goal with more skins of each design.
    #[must_use]
    pub fn finer(&self) -> Self {
        let mut goal = self.clone();
        goal.skins *= MORE;
        goal
    }
}

/// The answer to a goal about what is made. The history of the designs as they are drawn is part of it.
pub(crate) fn answer(
    goal: &DesignGoal,
    MadeSearches { drawn, made, finer }: MadeSearches<'_>,
    history: &mut Vec<Candidate>,
) -> Result<Answer, Halt> {
    let plan = Plan { points: goal.points.min(DRAWN_POINTS), ..Plan::DRAWN };
    let first = answer_by(drawn, history, plan)?;
    let seeds = seeds(drawn, history, &first);
    let mut is_admitted = false;
    for candidate in history.iter_mut() {
        let row = made.evaluations.row(0, &candidate.point, &candidate.result);
        candidate.verdict = made.judge.verdict(&row);
        is_admitted |= made.judge.made().is_some_and(|judge| judge.admits(&row));
    }
    if !is_admitted {
        return Ok(first);
    }
    made.meter.begin(SearchPart::Skins, seeds.len());
    let look = |point: SpacePoint| {
        let looked = made.look(SearchStage::Skins, &point, false)?.0;
        made.meter.step();
        Ok(looked)
    };
    let looked: Vec<Candidate> = seeds.into_par_iter().map(look).collect::<Result<_, _>>()?;
    history.extend(looked);
    let plan = Plan { points: goal.points, ..Plan::MADE };
    let mut answer = answer_by(made, history, plan)?;
    match &mut answer {
        Answer::Optimum(best) => {
            let is_refined = refine(finer, best, history)?;
            check(if is_refined { finer } else { made }, std::slice::from_mut(best.as_mut()))?;
        }
        Answer::Front(front) => check(made, &mut front.designs)?,
        Answer::Infeasible(_) => {}
    }
    Ok(answer)
}

/// Takes the best design to where more skins want it: one that was chosen by few looks better on them than it is. Returns whether there is
/// one near by that meets everything.
fn refine(
    finer: &Search<'_>,
    best: &mut BestDesign,
    history: &mut Vec<Candidate>,
) -> Result<bool, Halt> {
    finer.meter.begin(SearchPart::Refine, 1);
    let start = finer.look(SearchStage::Skins, &best.candidate.point, false)?.0;
    let mut looked = finer.improve(&best.target, &start, Effort::SHORT)?;
    looked.push(start);
    let is_met = |candidate| matches!(finer.merit(candidate, &best.target), Merit::Met(_));
    let is_refined = looked.iter().any(is_met);
    if is_refined {
        *best = best_design(finer, &looked, best.target.clone())?;
    }
    history.append(&mut looked);
    finer.meter.step();
    Ok(is_refined)
}

/// Adds to the best designs what other skins say of them.
fn check(search: &Search<'_>, best: &mut [BestDesign]) -> Result<(), Halt> {
    search.meter.begin(SearchPart::Check, best.len());
    best.par_iter_mut().try_for_each(|best| {
        search.meter.step();
        report(search, best)
    })
}

/// The designs of which skins are made first: the best as they are drawn, and the best of all others that are apart from each other.
fn seeds(drawn: &Search<'_>, history: &[Candidate], answer: &Answer) -> Vec<SpacePoint> {
    let best = match answer {
        Answer::Optimum(best) => std::slice::from_ref(best.as_ref()),
        Answer::Front(front) => front.designs.as_slice(),
        Answer::Infeasible(_) => &[],
    };
    let best = best.iter().map(|best| best.candidate.point.clone());
    let others = (0..drawn.judge.objectives()).flat_map(|objective| {
        let target = crate::candidate::Target { objective, floors: Vec::new() };
        apart(drawn, history, &target, SEEDS).into_iter().map(|candidate| candidate.point)
    });
    let mut seeds: Vec<SpacePoint> = Vec::new();
    for point in best.chain(others) {
        if !seeds.contains(&point) {
            seeds.push(point);
        }
    }
    seeds
}
