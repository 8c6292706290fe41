//! Searches sampled designs, starting from the best nominal designs.

use rayon::iter::{
    IntoParallelIterator as _, IntoParallelRefMutIterator as _, ParallelIterator as _,
};

use super::confirmation::{Confirmation, FRESH, confirm};
use crate::answer::{Answer, answer};
use crate::best::{BestDesign, best_design, starts};
use crate::candidate::{Candidate, Merit, SearchStage, Target};
use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::goal::DesignGoal;
use crate::improvement::Plan;
use crate::local::{Effort, Search};
use crate::progress::SearchPart;
use crate::space::SpacePoint;

/// Maximum points of the nominal front from which the sampled front starts.
pub(crate) const NOMINAL_POINTS: usize = 10;

/// Number of nominal designs per objective that are sampled first.
pub(crate) const SEEDS: usize = 16;

/// Number of designs refined with more samples, in different regions if possible.
pub(crate) const REFINED: usize = 2;

/// Maximum number of steps from a design that fails on independent samples.
const CONFIRMED: usize = 4;

/// Length of such a step over the length to first order.
const OVERSHOOT: f64 = 1.3;

/// Inverse of the fraction of samples with margins that such a step raises.
///
/// These samples lie next to the quantile that the yield requires, on either side.
const NEAR: usize = 10;

/// Number of projections on every gradient.
const PROJECTIONS: usize = 100;

/// Searches of nominal designs, of sampled designs, and with more samples.
#[derive(Clone, Copy)]
pub(crate) struct Searches<'s> {
    pub nominal: &'s Search<'s>,
    pub sampled: &'s Search<'s>,
    pub finer: &'s Search<'s>,
}

impl Searches<'_> {
    /// Searches for the answer to a goal about samples.
    ///
    /// `first` is the answer by nominal designs. A nominal design costs one solution, a sampled one
    /// as many as it has samples, so nominal designs provide the starts. The history includes them.
    pub fn answer(
        &self,
        goal: &DesignGoal,
        history: &mut Vec<Candidate>,
        first: Answer,
        plan: Plan,
    ) -> Result<Answer, Halt> {
        let Self { nominal, sampled, finer } = self;
        let seeds = seeds(nominal, history, &first);
        let mut is_admitted = false;
        for candidate in history.iter_mut() {
            let row = sampled.evaluations.row(0, &candidate.point, &candidate.result);
            candidate.verdict = sampled.judge.verdict(&row);
            is_admitted |= sampled.judge.samples().is_some_and(|judge| judge.admits(&row));
        }
        // If no nominal design is worth sampling, the nominal answer is final.
        if !is_admitted {
            return Ok(first);
        }
        let units = goal.realisations as u64;
        sampled.progress.begin(SearchPart::Samples, seeds.len(), seeds.len() as u64 * units);
        let evaluated: Vec<Candidate> = seeds
            .into_par_iter()
            .map(|point| {
                let _task = sampled.progress.task(units);
                Ok(sampled.evaluate(SearchStage::Tolerance, &point, false)?.0)
            })
            .collect::<Result<_, _>>()?;
        history.extend(evaluated);
        let mut answer = answer(sampled, history, plan, goal.points)?;
        match &mut answer {
            Answer::Optimum(best) => {
                let is_refined = refine(self, best, history)?;
                // Independent samples are numbered after all seen samples, and the finer search has
                // seen more.
                let search = if is_refined { finer } else { sampled };
                check(search, std::slice::from_mut(best.as_mut()))?;
                if goal.confirm {
                    confirm_another(search, best, history)?;
                }
            }
            Answer::Front(front) => check(sampled, &mut front.designs)?,
            Answer::Infeasible(_) => {}
        }
        Ok(answer)
    }
}

/// Refines the best designs with more samples.
///
/// Selection by few samples overestimates them. Returns true if a refined design is feasible.
fn refine(
    searches: &Searches<'_>,
    best: &mut BestDesign,
    history: &mut Vec<Candidate>,
) -> Result<bool, Halt> {
    let Searches { sampled, finer, .. } = searches;
    let starts = starts(sampled, history.iter(), &best.target, REFINED);
    let units = Effort::WHOLE.evaluations * finer.evaluation_units(&best.target);
    finer.progress.begin(SearchPart::Refine, starts.len(), starts.len() as u64 * units);
    let mut evaluated = Vec::new();
    for start in starts {
        let start = finer.evaluate(SearchStage::Tolerance, &start.point, false)?.0;
        // Full search: if more samples reduce the yield by a tenth, small steps seldom repair it.
        evaluated.extend(finer.improve(&best.target, &start, Effort::WHOLE)?);
        // The search does not return its start, which may be the best design.
        evaluated.push(start);
    }
    let is_refined = evaluated
        .iter()
        .any(|candidate| matches!(finer.merit(candidate, &best.target), Merit::Met(_)));
    if is_refined {
        // Among `evaluated` only, because all of these designs have more samples.
        let refined = best_design(finer, &evaluated, best.target.clone())?;
        *best = BestDesign { agreement: best.agreement, ..refined };
    }
    history.append(&mut evaluated);
    Ok(is_refined)
}

/// Moves a best design that fails on independent samples until it passes.
///
/// Each step raises the margins of the seen samples by as much as the independent samples miss. If
/// no step passes, the best design stays.
fn confirm_another(
    search: &Search<'_>,
    best: &mut BestDesign,
    history: &mut Vec<Candidate>,
) -> Result<(), Halt> {
    let mut point = best.candidate.point.clone();
    let mut made = best.confirmation.clone();
    for _ in 0..CONFIRMED {
        let Some(failed) = made.filter(|made| !made.broken.is_empty()) else { break };
        let Some(next) = safer(search, &point, &failed)? else { break };
        let candidate = search.evaluate(SearchStage::Tolerance, &next, false)?.0;
        history.push(candidate.clone());
        if !matches!(search.merit(&candidate, &best.target), Merit::Met(_)) {
            break;
        }
        made = confirm(search, &next)?;
        if made.as_ref().is_some_and(|made| made.broken.is_empty()) {
            let found = best_design(search, &[candidate], best.target.clone())?;
            *best = BestDesign { agreement: best.agreement, confirmation: made, ..found };
            break;
        }
        point = next;
    }
    Ok(())
}

/// Returns the nearest point at which the independent samples meet a yield, to first order.
///
/// The quantile of the margins that the yield requires is negative for the independent samples. The
/// step raises the margins of the seen samples next to this quantile by as much.
fn safer(
    search: &Search<'_>,
    point: &SpacePoint,
    failed: &Confirmation,
) -> Result<Option<SpacePoint>, Halt> {
    let Some(judge) = search.judge.samples() else { return Ok(None) };
    let fresh = search.evaluations.samples(point, judge.count as u64 + 1, FRESH, judge)?;
    let required: Vec<_> = search.judge.requirements().collect();
    let missed = search.judge.uses().find_map(|(of, q)| {
        let StatisticUse::Requirement(k) = of else { return None };
        let is_broken = failed.broken.iter().any(|r| r.column == required[k].column);
        let margin = judge.requirement_margin(q, required[k], &fresh)?;
        (is_broken && judge.statistics[q].is_yield() && margin < 0.0).then_some((k, q, -margin))
    });
    let Some((k, q, missing)) = missed else { return Ok(None) };
    let gradients = search.margin_gradients(point, (k, q), judge.count / NEAR)?;
    let step = least_step(&gradients, OVERSHOOT * missing, point.shares.len());
    let mut next = point.clone();
    for (share, step) in next.shares.iter_mut().zip(&step) {
        *share = (*share + step).clamp(0.0, 1.0);
    }
    Ok((next != *point && step.iter().all(|x| x.is_finite())).then_some(next))
}

/// Returns a short step along which every gradient rises by `rise`.
///
/// Computed by Kaczmarz projections.
fn least_step(gradients: &[Vec<f64>], rise: f64, variables: usize) -> Vec<f64> {
    let mut step = vec![0.0; variables];
    for _ in 0..PROJECTIONS {
        for gradient in gradients {
            let square: f64 = gradient.iter().map(|slope| slope * slope).sum();
            let risen: f64 = gradient.iter().zip(&step).map(|(slope, x)| slope * x).sum();
            if square > 0.0 && risen < rise {
                for (x, slope) in step.iter_mut().zip(gradient) {
                    *x += slope * (rise - risen) / square;
                }
            }
        }
    }
    step
}

/// Checks the best designs with independent samples.
fn check(search: &Search<'_>, best: &mut [BestDesign]) -> Result<(), Halt> {
    let units = FRESH as u64;
    search.progress.begin(SearchPart::Check, best.len(), best.len() as u64 * units);
    best.par_iter_mut().try_for_each(|best| {
        let _task = search.progress.task(units);
        best.confirmation = confirm(search, &best.candidate.point)?;
        Ok(())
    })
}

/// Selects the designs to be sampled first.
///
/// They are the best nominal designs, then others at a distance.
fn seeds(nominal: &Search<'_>, history: &[Candidate], answer: &Answer) -> Vec<SpacePoint> {
    let best = match answer {
        Answer::Optimum(best) => std::slice::from_ref(best.as_ref()),
        Answer::Front(front) => front.designs.as_slice(),
        Answer::Infeasible(_) => &[],
    };
    let best = best.iter().map(|best| best.candidate.point.clone());
    let others = (0..nominal.judge.objectives()).flat_map(|objective| {
        let target = Target { objective, floors: Vec::new() };
        starts(nominal, history, &target, SEEDS).into_iter().map(|candidate| candidate.point)
    });
    let mut seeds: Vec<SpacePoint> = Vec::new();
    for point in best.chain(others) {
        if !seeds.contains(&point) {
            seeds.push(point);
        }
    }
    seeds
}

#[cfg(test)]
mod tests {
    use super::least_step;

    #[test]
    fn a_step_increases_every_margin_equally() {
        let gradients = [vec![1.0, 0.0], vec![-0.5, 1.0]];
        let step = least_step(&gradients, 0.1, 2);
        for gradient in &gradients {
            let risen: f64 = gradient.iter().zip(&step).map(|(slope, x)| slope * x).sum();
            assert!((risen - 0.1).abs() < 1e-9, "{risen}");
        }
    }
}
