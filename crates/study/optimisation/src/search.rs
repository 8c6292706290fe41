//! Runs a search: sample the space, improve the best samples, collect the results.

use std::collections::BTreeMap;
use std::iter;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use ranking::{CriterionEnds, Requirement};
use rayon::iter::{
    IndexedParallelIterator as _, IntoParallelIterator as _, IntoParallelRefIterator as _,
    IntoParallelRefMutIterator as _, ParallelIterator as _,
};
use results::columns::name;
use results::{DesignRow, Outcome};
use run::{Program, Start};

use crate::answer::{Answer, answer};
use crate::best::{BestDesign, Region, region};
use crate::candidate::{Candidate, SearchStage};
use crate::checks::DesignChecks;
use crate::column::ends_over;
use crate::contradiction;
use crate::coverage_peaks::points_on_peaks;
use crate::error::OptimisationError;
use crate::evaluations::{Evaluations, Halt};
use crate::goal::DesignGoal;
use crate::improvement::Plan;
use crate::judge::Judge;
use crate::judgement::Judgement;
use crate::local::{Effort, Search, evaluation_units};
use crate::price;
use crate::progress::{SearchPart, SearchProgress};
use crate::reason::reason;
use crate::requirement_bounds::has_folded;
use crate::restarts::restart_evaluations;
use crate::rounding::{self, Rounding};
use crate::sample::MissedRequirement;
use crate::sampled::confirmation::FRESH;
use crate::sampled::search::{NOMINAL_POINTS, REFINED, SEEDS, Searches};
use crate::space::SpacePoint;
use crate::space_filling;

/// Settings of a search.
#[derive(Clone, Copy, Debug)]
pub struct SearchOptions<'a> {
    /// Number of designs solved at the same time.
    pub threads: usize,
    /// Whether existing results are refused, continued or discarded.
    pub start: Start,
    /// Set to request a stop; the journal keeps every design solved so far.
    pub stop: &'a AtomicBool,
    /// Receives the progress of the search.
    pub progress: &'a SearchProgress,
}

/// The outcome of a search.
#[derive(Clone, Debug)]
pub struct Found {
    /// Every evaluated design, in an order independent of the number of threads.
    pub history: Vec<Candidate>,
    /// The answer.
    pub answer: Answer,
    /// Numbers of designs without a valid judgement.
    pub left_out: LeftOutDesigns,
    /// Number of local searches.
    pub starts: usize,
    /// Number of regions with at least one evaluated design.
    ///
    /// A region is a combination of choices, coverage peak, and contact or no contact in bending.
    pub regions: usize,
    /// Number of evaluations, with and without derivatives.
    pub evaluations: usize,
    /// Ends used to rescale the criteria of the fitness.
    pub rescaled: Vec<CriterionEnds>,
    /// Requirements with the limits of the last search; they differ from the goal if it confirms.
    pub searched: Vec<Requirement>,
    /// Requirements that samples of the nearest design miss, if no design is feasible.
    pub missed: Vec<MissedRequirement>,
    /// Rounding of the best design, if the goal wants it.
    pub rounding: Option<Rounding>,
}

/// Designs without a valid judgement, by reason.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOutDesigns {
    /// Designs that failed in some measure.
    pub failed: BTreeMap<Outcome, usize>,
    /// Designs with a folded surface.
    pub folded: usize,
    /// Designs without a number in a column of the goal, by column.
    pub missing: BTreeMap<String, usize>,
}

/// Searches for the best designs of `goal`, with the journal in `folder`.
///
/// Returns `None` if a stop was requested.
///
/// # Errors
///
/// If the folder holds other results, the journal cannot be written, or no design has a number in
/// some column of the goal.
pub fn optimise(
    goal: &DesignGoal,
    folder: &Path,
    options: &SearchOptions<'_>,
    program: &Program,
) -> Result<Option<Found>, OptimisationError> {
    let watch = (options.stop, options.progress);
    let evaluations = Evaluations::begin(goal, folder, options.start, program, watch)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build();
    let pool = pool.map_err(|error| OptimisationError::Threads {
        count: options.threads,
        reason: error.to_string(),
    })?;
    // A separate pool uses exactly the requested number of threads, whatever the rest of the
    // process uses.
    let found = pool.install(|| find(goal, &evaluations, options.progress));
    // Also after a stop request: the next session continues from these evaluations.
    evaluations.sync()?;
    match found {
        Ok(found) => {
            check_columns(&found)?;
            Ok(Some(found))
        }
        // `LocalSearch` handles stalled gradient searches, so `Stalled` is not returned here.
        Err(Halt::Interrupted | Halt::Stalled) => Ok(None),
        Err(Halt::Output(error)) => Err(error.into()),
    }
}

fn find(
    goal: &DesignGoal,
    evaluations: &Evaluations<'_>,
    progress: &SearchProgress,
) -> Result<Found, Halt> {
    progress.expect(expected(goal));
    let points = space_filling::points(&goal.space, goal.samples, goal.seed);
    // Solved before the judge exists, because the fitness is rescaled over these rows.
    let rows = sample_rows(evaluations, &points, progress)?;
    let rescaled = ends(goal, rows);
    let judge = Judge::rescaling(&goal.nominal(), &rescaled);
    let nominal = Search { space: &goal.space, evaluations, judge: &judge, progress };
    let mut history = first_candidates(&nominal, points, goal.seed)?;
    let mut limits = Limits { goal, tightened: goal.clone(), rescaled: &rescaled };
    let mut answer = limits.nominal_answer(&nominal, &mut history)?;
    if goal.is_about_samples() {
        answer = limits.sampled_answer(&nominal, &mut history, answer)?;
    }
    let missed = limits.missed(&nominal, &history, &answer)?;
    let mut rounding = None;
    if let Answer::Optimum(best) = &mut answer {
        best.reason = limits.reason(&nominal, best)?;
        rounding = limits.round(&nominal, best, &mut history)?;
        best.checks = DesignChecks::solve(goal, &best.row.case);
    }
    // The search measures only the columns of the goal.
    answer.best_mut().par_iter_mut().try_for_each(|best| {
        best.row = evaluations.reported_row(&best.candidate.point)?;
        Ok(())
    })?;
    let judge = Judge::rescaling(&limits.tightened, &rescaled);
    let search = Search { judge: &judge, ..nominal };
    let left_out = LeftOutDesigns::of(&search, &history);
    Ok(Found {
        regions: region_count(&search, &history),
        history,
        answer,
        left_out,
        starts: progress.starts(),
        evaluations: evaluations.count(),
        searched: limits.tightened.requirements,
        rescaled,
        missed,
        rounding,
    })
}

/// Evaluates the space-filling points, and points on coverage peaks.
fn first_candidates(
    nominal: &Search<'_>,
    points: Vec<SpacePoint>,
    seed: u64,
) -> Result<Vec<Candidate>, Halt> {
    // Goals about parameters and mass alone have no contacts and no kinks, so peaks do not matter.
    let on_peaks = if nominal.judge.has_regions() {
        points_on_peaks(nominal.space, nominal.judge, seed)
    } else {
        Vec::new()
    };
    nominal.progress.begin(SearchPart::Sample, on_peaks.len(), on_peaks.len() as u64);
    let known = points.len();
    // The journal holds the space-filling points already: only points on peaks are solved here.
    [points, on_peaks]
        .concat()
        .into_par_iter()
        .enumerate()
        .map(|(k, point)| {
            let _task = (k >= known).then(|| nominal.progress.task(1));
            Ok(nominal.compared(SearchStage::Sample, &point, false)?.0)
        })
        .collect()
}

/// Counts the regions of the space that hold candidates.
fn region_count(search: &Search<'_>, history: &[Candidate]) -> usize {
    let mut regions: Vec<Region> = Vec::new();
    for candidate in history {
        let region = region(search, candidate);
        if !regions.contains(&region) {
            regions.push(region);
        }
    }
    regions.len()
}

/// Number of searches with tighter limits after the first.
const TIGHTER: usize = 3;

/// The limits of the requirements in a search.
struct Limits<'a> {
    /// The goal with the limits of the user.
    goal: &'a DesignGoal,
    /// The goal with the limits of the search.
    tightened: DesignGoal,
    rescaled: &'a [CriterionEnds],
}

impl Limits<'_> {
    /// Returns the answer by nominal designs.
    ///
    /// If the goal confirms, limits are tightened until the checks of the best design pass.
    fn nominal_answer(
        &mut self,
        search: &Search<'_>,
        history: &mut Vec<Candidate>,
    ) -> Result<Answer, Halt> {
        let goal = self.goal;
        let (plan, points) = if goal.is_about_samples() {
            (Plan::STARTS, goal.points.min(NOMINAL_POINTS))
        } else {
            (Plan::NOMINAL, goal.points)
        };
        let mut best = answer(search, history, plan, points)?;
        for _ in 0..TIGHTER {
            let Some(wider) = self.tighten(&mut best) else { break };
            let next = self.nominal_again(&self.tightened, search, history, points)?;
            if matches!(next, Answer::Infeasible(_)) {
                self.tightened = wider;
                break;
            }
            best = next;
        }
        Ok(best)
    }

    /// Searches nominal designs again, with the limits of `goal`.
    fn nominal_again(
        &self,
        goal: &DesignGoal,
        search: &Search<'_>,
        history: &mut Vec<Candidate>,
        points: usize,
    ) -> Result<Answer, Halt> {
        let judge = Judge::rescaling(&goal.nominal(), self.rescaled);
        let search = Search { judge: &judge, ..*search };
        for candidate in history.iter_mut() {
            let row = search.evaluations.row(0, &candidate.point, &candidate.result);
            candidate.verdict = judge.verdict(&row);
        }
        answer(&search, history, Plan::AGAIN, points)
    }

    /// Returns the answer by sampled designs; see [`Self::nominal_answer`].
    fn sampled_answer(
        &mut self,
        search: &Search<'_>,
        history: &mut Vec<Candidate>,
        first: Answer,
    ) -> Result<Answer, Halt> {
        let nominal = history.clone();
        let mut best = self.sampled(search, history, first, Plan::SAMPLED)?;
        for _ in 0..TIGHTER {
            let Some(wider) = self.tighten(&mut best) else { break };
            let mut again = nominal.clone();
            // No known design may meet the tightened limits.
            let first = self.nominal_again(&self.tightened, search, &mut again, NOMINAL_POINTS)?;
            let next = self.sampled(search, &mut again, first, Plan::AGAIN)?;
            if matches!(next, Answer::Infeasible(_)) {
                self.tightened = wider;
                break;
            }
            (best, *history) = (next, again);
        }
        Ok(best)
    }

    fn sampled(
        &self,
        search: &Search<'_>,
        history: &mut Vec<Candidate>,
        first: Answer,
        plan: Plan,
    ) -> Result<Answer, Halt> {
        let goal = &self.tightened;
        // All three judges share one set of ends: other ends define another fitness.
        let judges = [&goal.nominal(), goal, &goal.finer()]
            .map(|goal| Judge::rescaling(goal, self.rescaled));
        let [nominal, sampled, finer] = judges.each_ref().map(|judge| Search { judge, ..*search });
        let searches = Searches { nominal: &nominal, sampled: &sampled, finer: &finer };
        searches.answer(goal, history, first, plan)
    }

    /// Returns why a best design is best, by its limits and their multipliers.
    fn reason(&self, search: &Search<'_>, best: &BestDesign) -> Result<Option<String>, Halt> {
        let goal = &self.tightened;
        // A yield has no multiplier, but the requirements that define the yield have.
        let Some(made) = best.confirmation.as_ref().filter(|_| goal.requires_yield()) else {
            return Ok(reason(goal, best, &best.bindings, false));
        };
        let goal = goal.nominal();
        let judge = Judge::rescaling(&goal, self.rescaled);
        let search = Search { judge: &judge, ..*search };
        let bindings =
            price::limits_of_samples(&search, &best.candidate, &best.target, &made.missed)?;
        Ok(reason(&goal, best, &bindings, true))
    }

    /// Rounds a best design, if the goal wants it.
    fn round(
        &self,
        search: &Search<'_>,
        best: &mut BestDesign,
        history: &mut Vec<Candidate>,
    ) -> Result<Option<Rounding>, Halt> {
        let judges = [&self.tightened, &self.tightened.finer()]
            .map(|goal| Judge::rescaling(goal, self.rescaled));
        let [coarse, finer] = judges.each_ref().map(|judge| Search { judge, ..*search });
        rounding::round(self.goal, [&coarse, &finer], best, history)
    }

    /// Returns the requirements that samples of the nearest infeasible design miss.
    fn missed(
        &self,
        search: &Search<'_>,
        history: &[Candidate],
        answer: &Answer,
    ) -> Result<Vec<MissedRequirement>, Halt> {
        let Answer::Infeasible(Some(nearest)) = answer else { return Ok(Vec::new()) };
        let Candidate { point, verdict, .. } = &history[*nearest];
        let judge = Judge::rescaling(&self.tightened, self.rescaled);
        // A nominal design has no samples.
        let judge = judge.samples().filter(|_| matches!(verdict, Judgement::Judged(_)));
        let Some(judge) = judge else { return Ok(Vec::new()) };
        let samples = search.evaluations.samples(point, 1, judge.count, judge)?;
        Ok(judge.missed(&samples))
    }

    /// Tightens the limits by the checks of an optimum.
    ///
    /// Returns the earlier limits if they changed.
    fn tighten(&mut self, answer: &mut Answer) -> Option<DesignGoal> {
        let Answer::Optimum(best) = answer else { return None };
        self.goal.confirm.then_some(())?;
        best.checks = DesignChecks::solve(self.goal, &best.row.case);
        let before = self.tightened.clone();
        contradiction::tighten(&mut self.tightened, self.goal, best).then_some(before)
    }
}

/// Estimates the units of work of each part of the search.
fn expected(goal: &DesignGoal) -> Vec<(SearchPart, u64)> {
    let mut parts = vec![(SearchPart::Sample, goal.samples as u64)];
    if !goal.is_about_samples() {
        parts.extend(expected_answer(goal, Plan::NOMINAL, 0, goal.points));
        return parts;
    }
    let (count, objectives) = (goal.realisations, goal.objectives.len());
    parts.extend(expected_answer(goal, Plan::STARTS, 0, goal.points.min(NOMINAL_POINTS)));
    parts.push((SearchPart::Samples, (objectives * SEEDS * count) as u64));
    parts.extend(expected_answer(goal, Plan::SAMPLED, count, goal.points));
    if objectives == 1 {
        let each = Effort::WHOLE.evaluations * evaluation_units(goal.finer().realisations);
        parts.push((SearchPart::Refine, REFINED as u64 * each));
    }
    let best = if objectives > 1 { goal.points } else { 1 };
    parts.push((SearchPart::Check, (best * FRESH) as u64));
    parts
}

/// Estimates the units of work of the search for an optimum or a front of `points` designs.
///
/// Each design is evaluated at `samples` samples.
fn expected_answer(
    goal: &DesignGoal,
    plan: Plan,
    samples: usize,
    points: usize,
) -> Vec<(SearchPart, u64)> {
    let variables = goal.space.intervals().len();
    let each = evaluation_units(samples);
    let mut parts = Vec::new();
    for objective in &goal.objectives {
        parts.push((SearchPart::LocalSearches, plan.evaluations() * each));
        // Local searches seldom agree on the largest slope of a path. For other objectives
        // restarts are the exception.
        if &*objective.column == name::MAX_STIFFNESS {
            let restart = (SearchPart::Restart, restart_evaluations(variables) * each);
            parts.extend(iter::repeat_n(restart, plan.restarts));
        }
    }
    if goal.objectives.len() > 1 {
        // The first half of the points is searched from many designs, the second half between
        // them.
        let half = points.div_ceil(2) as u64;
        let plans = [plan.of_a_point(), plan.between_points()];
        parts.extend(plans.map(|plan| (SearchPart::Front, half * plan.evaluations() * each / 2)));
    }
    parts
}

/// Solves the space-filling points and returns their rows.
fn sample_rows(
    evaluations: &Evaluations<'_>,
    points: &[SpacePoint],
    progress: &SearchProgress,
) -> Result<Vec<DesignRow>, Halt> {
    progress.begin(SearchPart::Sample, points.len(), points.len() as u64);
    points
        .par_iter()
        .map(|point| {
            let _task = progress.task(1);
            let positions = evaluations.compared_positions(point);
            let result = evaluations.solve(point, false, positions)?;
            Ok(evaluations.row(0, point, &result))
        })
        .collect()
}

/// Determines the ends used to rescale the criteria, which define the fitness.
fn ends(goal: &DesignGoal, mut rows: Vec<DesignRow>) -> Vec<CriterionEnds> {
    let Some(fitness) = &goal.fitness else { return Vec::new() };
    let judge = Judge::rescaling(&goal.nominal(), &fitness.ends);
    // Invalid designs would extend the ends beyond the values that a search can reach.
    rows.retain(|row| judge.is_whole(row));
    ends_over(fitness, goal.space.sweep(), &rows)
}

impl LeftOutDesigns {
    fn of(search: &Search<'_>, history: &[Candidate]) -> Self {
        let mut left_out = Self::default();
        for candidate in history {
            match &candidate.verdict {
                Judgement::Failed(outcome) => *left_out.failed.entry(*outcome).or_default() += 1,
                Judgement::Missing(column) => {
                    *left_out.missing.entry(column.clone()).or_default() += 1;
                }
                Judgement::Folded => left_out.folded += 1,
                // A design folded at the end is judged as infeasible, and counted here as folded
                // too.
                Judgement::Judged(_) | Judgement::Nominal(_)
                    if search.judge.requires_unfolded() =>
                {
                    let row = search.evaluations.row(0, &candidate.point, &candidate.result);
                    left_out.folded += usize::from(has_folded(&row));
                }
                Judgement::Judged(_) | Judgement::Nominal(_) => {}
            }
        }
        left_out
    }
}

/// Returns an error if no design has a number in some column of the goal.
fn check_columns(found: &Found) -> Result<(), OptimisationError> {
    // Designs that lack a value are left out and reported by column; only a column without any
    // value is an error.
    let is_left_out =
        |c: &Candidate| matches!(c.verdict, Judgement::Failed(_) | Judgement::Missing(_));
    if !found.history.iter().all(is_left_out) {
        return Ok(());
    }
    let designs = found.history.len();
    found.left_out.missing.keys().next().map_or(Ok(()), |column| {
        Err(OptimisationError::NoValue { column: column.clone(), designs })
    })
}
