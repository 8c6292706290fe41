//! Searches designs by statistics over their samples, starting from the best nominal designs.

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

/// Maximum number of points of the nominal front from which the front over samples starts.
pub(crate) const NOMINAL_POINTS: usize = 10;

/// Number of nominal designs that are sampled first, for each objective.
pub(crate) const SEEDS: usize = 16;

/// Number of designs that are improved with more samples, in different regions if possible.
pub(crate) const REFINED: usize = 2;

/// Maximum number of steps from a design that misses a requirement on independent samples.
const CONFIRMED: usize = 4;

/// Increase of the margins at which a step to a safer design aims, divided by the missing margin.
///
/// The missing margin is the shortfall of the independent sample that decides the yield.
const OVERSHOOT: f64 = 1.3;

/// Inverse of the fraction of samples that a step considers on each side of the deciding sample.
///
/// Samples are sorted by margin. The deciding sample (O6) is at the quantile that the yield
/// requires.
const NEAR: usize = 10;

/// Number of Kaczmarz projections on each gradient.
const PROJECTIONS: usize = 100;

/// Searches with different judges.
#[derive(Clone, Copy)]
pub(crate) struct Searches<'s> {
    /// Search by nominal designs.
    pub nominal: &'s Search<'s>,
    /// Search by samples.
    pub sampled: &'s Search<'s>,
    /// Search by a larger number of samples.
    pub finer: &'s Search<'s>,
}

impl Searches<'_> {
    /// Searches for the answer to a goal with statistics over samples.
    ///
    /// `first` is the answer for nominal designs, and `history` contains these designs. A nominal
    /// design needs one solution, but a design with samples needs one solution for each sample. The
    /// search with samples therefore starts from nominal designs.
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
        // No nominal design meets the requirements on its samples, so the nominal answer is final.
        if !is_admitted {
            return Ok(first);
        }
        let units = goal.samples_per_design as u64;
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
                // Independent samples are numbered after the samples of the search. A refined
                // design was selected by the larger number of samples of the finer search.
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

/// Improves the best designs with more samples, and replaces `best` by the best result.
///
/// A design that was selected by few samples is usually overestimated. Returns false, and leaves
/// `best` unchanged, if no design is feasible with more samples.
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
        // Run a full search. If more samples reduce the yield by a tenth, small steps seldom
        // restore it.
        evaluated.extend(finer.improve(&best.target, &start, Effort::WHOLE, Merit::None)?);
        // Add the start, which may be the best design: `improve` does not return it.
        evaluated.push(start);
    }
    let is_refined = evaluated
        .iter()
        .any(|candidate| matches!(finer.merit(candidate, &best.target), Merit::Met(_)));
    if is_refined {
        // Select among `evaluated` only, because designs in `history` have fewer samples.
        let refined = best_design(finer, &evaluated, best.target.clone())?;
        *best = BestDesign { agreement: best.agreement, ..refined };
    }
    history.append(&mut evaluated);
    Ok(is_refined)
}

/// Moves a best design until independent samples meet the requirements.
///
/// Each step increases the margins of the samples of the search by the shortfall of the independent
/// samples. If no step succeeds, `best` is unchanged.
fn confirm_another(
    search: &Search<'_>,
    best: &mut BestDesign,
    history: &mut Vec<Candidate>,
) -> Result<(), Halt> {
    let mut point = best.candidate.point.clone();
    let mut confirmation = best.confirmation.clone();
    for _ in 0..CONFIRMED {
        let Some(failed) = confirmation.filter(|confirmation| !confirmation.broken.is_empty())
        else {
            break;
        };
        let Some(next) = safer(search, &point, &failed)? else { break };
        let candidate = search.evaluate(SearchStage::Tolerance, &next, false)?.0;
        history.push(candidate.clone());
        if !matches!(search.merit(&candidate, &best.target), Merit::Met(_)) {
            break;
        }
        confirmation = confirm(search, &next)?;
        if confirmation.as_ref().is_some_and(|confirmation| confirmation.broken.is_empty()) {
            let found = best_design(search, &[candidate], best.target.clone())?;
            *best = BestDesign { agreement: best.agreement, confirmation, ..found };
            break;
        }
        point = next;
    }
    Ok(())
}

/// Returns a near point at which a linear model predicts that independent samples meet the yield.
///
/// `failed` is the confirmation of the design at `point`. The independent sample that decides the
/// yield (O6) has a negative margin. The step increases the margins of the samples of the search
/// around their deciding sample by this shortfall. `None` if no yield is missed, or no step exists.
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
    let step = least_step(&gradients, OVERSHOOT * missing, point.fractions.len());
    let mut next = point.clone();
    for (fraction, step) in next.fractions.iter_mut().zip(&step) {
        *fraction = (*fraction + step).clamp(0.0, 1.0);
    }
    Ok((next != *point && step.iter().all(|x| x.is_finite())).then_some(next))
}

/// Returns a short step `d` with `g·d ≥ rise` for each gradient `g`.
///
/// The step is computed by Kaczmarz projections.
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

/// Checks the best designs with independent samples, and stores the results in the designs.
fn check(search: &Search<'_>, best: &mut [BestDesign]) -> Result<(), Halt> {
    let units = FRESH as u64;
    search.progress.begin(SearchPart::Check, best.len(), best.len() as u64 * units);
    best.par_iter_mut().try_for_each(|best| {
        let _task = search.progress.task(units);
        best.confirmation = confirm(search, &best.candidate.point)?;
        Ok(())
    })
}

/// Selects the nominal designs that are sampled first.
///
/// The designs of the nominal `answer` come first, followed by good designs in other regions.
fn seeds(nominal: &Search<'_>, history: &[Candidate], answer: &Answer) -> Vec<SpacePoint> {
    let best = match answer {
        Answer::Optimum(best) => std::slice::from_ref(best.as_ref()),
        Answer::Front(front) => front.designs.as_slice(),
        Answer::Infeasible(_) => &[],
    };
    let best = best.iter().map(|best| best.candidate.point.clone());
    let others = (0..nominal.judge.objectives()).flat_map(|objective| {
        let target = Target { objective, lower_bounds: Vec::new() };
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
    fn step_increases_every_margin_by_the_requested_amount() {
        let gradients = [vec![1.0, 0.0], vec![-0.5, 1.0]];
        let step = least_step(&gradients, 0.1, 2);
        for gradient in &gradients {
            let risen: f64 = gradient.iter().zip(&step).map(|(slope, x)| slope * x).sum();
            assert!((risen - 0.1).abs() < 1e-9, "{risen}");
        }
    }
}
