//! Runs a search: evaluates space-filling points, improves the best, and collects the results.

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
    /// Number of threads, i.e. of designs that are solved at the same time.
    pub threads: usize,
    /// States whether existing results are refused, continued or discarded.
    pub start: Start,
    /// Flag that another thread sets to `true` to request a stop.
    ///
    /// The journal then contains all designs solved so far.
    pub stop: &'a AtomicBool,
    /// Progress, which the search updates.
    pub progress: &'a SearchProgress,
}

/// Result of a search.
#[derive(Clone, Debug)]
pub struct Found {
    /// All evaluated designs. Their order does not depend on the number of threads.
    pub history: Vec<Candidate>,
    /// Answer to the goal: best design, front, or nearest infeasible design.
    pub answer: Answer,
    /// Counts of designs without a valid judgement.
    pub unjudged: UnjudgedDesigns,
    /// Number of local searches.
    pub starts: usize,
    /// Number of regions with at least one evaluated design.
    ///
    /// A region is a combination of choices, coverage peak, and contact or no contact in bending.
    pub regions: usize,
    /// Number of evaluations, with and without derivatives.
    pub evaluations: usize,
    /// Ends between which the criteria of the fitness were rescaled.
    pub rescaled: Vec<CriterionEnds>,
    /// Requirements with the limits of the last search.
    ///
    /// With `confirm = true` they may be tighter than the limits of the goal.
    pub searched: Vec<Requirement>,
    /// Requirements that samples of the nearest design miss; empty if a design is feasible.
    pub missed: Vec<MissedRequirement>,
    /// Rounding of the best design; `None` if the goal does not request it.
    pub rounding: Option<Rounding>,
}

/// Counts of designs without a valid judgement, by reason.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnjudgedDesigns {
    /// Number of designs with a failed measure, by outcome.
    pub failed: BTreeMap<Outcome, usize>,
    /// Number of designs with a folded surface.
    pub folded: usize,
    /// Number of designs without a value in a column of the goal, by column.
    pub missing: BTreeMap<String, usize>,
}

/// Searches for the best designs of `goal`. The journal of the search is in `folder`.
///
/// Returns `None` if a stop was requested.
///
/// # Errors
///
/// If the folder contains other results, the journal cannot be written, or a column of the goal is
/// empty for all designs.
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
    // Use a separate pool with the requested number of threads. The global pool of the process may
    // have another number.
    let found = pool.install(|| find(goal, &evaluations, options.progress));
    // Flush the journal also after a stop request, because the next session continues from it.
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

/// Runs all parts of a search, and returns its result.
fn find(
    goal: &DesignGoal,
    evaluations: &Evaluations<'_>,
    progress: &SearchProgress,
) -> Result<Found, Halt> {
    progress.expect(expected(goal));
    let points = space_filling::points(&goal.space, goal.samples, goal.seed);
    // Solve these designs before the judge is created: the criteria of the fitness are rescaled
    // between the worst and best values of these designs.
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
    // Solve the best designs again with all columns. The search computed only columns of the goal.
    answer.best_mut().par_iter_mut().try_for_each(|best| {
        best.row = evaluations.reported_row(&best.candidate.point)?;
        Ok(())
    })?;
    let judge = Judge::rescaling(&limits.tightened, &rescaled);
    let search = Search { judge: &judge, ..nominal };
    let unjudged = UnjudgedDesigns::of(&search, &history);
    Ok(Found {
        regions: region_count(&search, &history),
        history,
        answer,
        unjudged,
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
    // Coverage peaks do not matter for a goal that contains only parameters and masses.
    let on_peaks = if nominal.judge.has_regions() {
        points_on_peaks(nominal.space, nominal.judge, seed)
    } else {
        Vec::new()
    };
    nominal.progress.begin(SearchPart::Sample, on_peaks.len(), on_peaks.len() as u64);
    let known = points.len();
    // Space-filling points have been solved, so only points on peaks count as work.
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

/// Counts the regions of the space that contain designs of `history`.
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

/// Maximum number of further searches, each with tightened limits.
const TIGHTER: usize = 3;

/// A goal with the limits of the user, and with the tightened limits of the search.
struct Limits<'a> {
    /// Goal with the limits of the user.
    goal: &'a DesignGoal,
    /// Goal with the limits of the search.
    tightened: DesignGoal,
    /// Ends between which the criteria of a fitness are rescaled.
    rescaled: &'a [CriterionEnds],
}

impl Limits<'_> {
    /// Searches nominal designs for the answer to the goal.
    ///
    /// With `confirm = true`, limits are tightened and the search is repeated until the best design
    /// passes its checks, at most `TIGHTER` times.
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

    /// Judges the designs in `history` by the limits of `goal`, and continues the search from them.
    ///
    /// The search evaluates nominal designs only.
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

    /// Searches designs with samples for the answer, like [`Self::nominal_answer`].
    ///
    /// `first` is the answer by nominal designs.
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
            // Search nominal designs again, because known designs may miss the tightened limits.
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

    /// Runs one search over samples with the current limits, starting from the answer `first`.
    fn sampled(
        &self,
        search: &Search<'_>,
        history: &mut Vec<Candidate>,
        first: Answer,
        plan: Plan,
    ) -> Result<Answer, Halt> {
        let goal = &self.tightened;
        // All judges must rescale the criteria of the fitness alike, otherwise their values differ.
        let judges = [&goal.nominal(), goal, &goal.finer()]
            .map(|goal| Judge::rescaling(goal, self.rescaled));
        let [nominal, sampled, finer] = judges.each_ref().map(|judge| Search { judge, ..*search });
        let searches = Searches { nominal: &nominal, sampled: &sampled, finer: &finer };
        searches.answer(goal, history, first, plan)
    }

    /// Returns the sentence that states why `best` is best; `None` if the reason is unknown.
    fn reason(&self, search: &Search<'_>, best: &BestDesign) -> Result<Option<String>, Halt> {
        let goal = &self.tightened;
        // A yield has no multiplier, so use multipliers of the requirements on columns.
        let Some(confirmation) = best.confirmation.as_ref().filter(|_| goal.requires_yield())
        else {
            return Ok(reason(goal, best, &best.bindings, false));
        };
        let goal = goal.nominal();
        let judge = Judge::rescaling(&goal, self.rescaled);
        let search = Search { judge: &judge, ..*search };
        let bindings =
            price::limits_of_samples(&search, &best.candidate, &best.target, &confirmation.missed)?;
        Ok(reason(&goal, best, &bindings, true))
    }

    /// Replaces `best` by its rounded design, if the goal requests rounding.
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
    ///
    /// Empty if a design is feasible, or if the nearest design has no samples.
    fn missed(
        &self,
        search: &Search<'_>,
        history: &[Candidate],
        answer: &Answer,
    ) -> Result<Vec<MissedRequirement>, Halt> {
        let Answer::Infeasible(Some(nearest)) = answer else { return Ok(Vec::new()) };
        let Candidate { point, verdict, .. } = &history[*nearest];
        let judge = Judge::rescaling(&self.tightened, self.rescaled);
        // The nearest design may be a nominal design without samples.
        let judge = judge.samples().filter(|_| matches!(verdict, Judgement::Judged(_)));
        let Some(judge) = judge else { return Ok(Vec::new()) };
        let samples = search.evaluations.samples(point, 1, judge.count, judge)?;
        Ok(judge.missed(&samples))
    }

    /// Checks an optimum, and tightens limits that the checks contradict.
    ///
    /// Returns the goal with the previous limits if a limit changed, otherwise `None`.
    fn tighten(&mut self, answer: &mut Answer) -> Option<DesignGoal> {
        let Answer::Optimum(best) = answer else { return None };
        self.goal.confirm.then_some(())?;
        best.checks = DesignChecks::solve(self.goal, &best.row.case);
        let before = self.tightened.clone();
        contradiction::tighten(&mut self.tightened, self.goal, best).then_some(before)
    }
}

/// Estimates the work of each part of a search. The unit is the work for a space-filling point.
fn expected(goal: &DesignGoal) -> Vec<(SearchPart, u64)> {
    let mut parts = vec![(SearchPart::Sample, goal.samples as u64)];
    if !goal.is_about_samples() {
        parts.extend(expected_answer(goal, Plan::NOMINAL, 0, goal.points));
        return parts;
    }
    let (count, objectives) = (goal.samples_per_design, goal.objectives.len());
    parts.extend(expected_answer(goal, Plan::STARTS, 0, goal.points.min(NOMINAL_POINTS)));
    parts.push((SearchPart::Samples, (objectives * SEEDS * count) as u64));
    parts.extend(expected_answer(goal, Plan::SAMPLED, count, goal.points));
    if objectives == 1 {
        let each = Effort::WHOLE.evaluations * evaluation_units(goal.finer().samples_per_design);
        parts.push((SearchPart::Refine, REFINED as u64 * each));
    }
    let best = if objectives > 1 { goal.points } else { 1 };
    parts.push((SearchPart::Check, (best * FRESH) as u64));
    parts
}

/// Estimates the work of a search for an optimum, or for a front of `points` designs.
///
/// `samples` is the number of samples of each design.
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
        // Local searches for the maximum stiffness seldom agree, so restarts are expected. For
        // other objectives restarts are rare.
        if &*objective.column == name::MAX_STIFFNESS {
            let restart = (SearchPart::Restart, restart_evaluations(variables) * each);
            parts.extend(iter::repeat_n(restart, plan.restarts));
        }
    }
    if goal.objectives.len() > 1 {
        // The first half of the points is searched from many designs, the second half from
        // neighbouring points.
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

/// Determines the ends between which the criteria of the fitness are rescaled.
///
/// `rows` are the designs at the space-filling points. Returns an empty list if the goal does not
/// use the fitness.
fn ends(goal: &DesignGoal, mut rows: Vec<DesignRow>) -> Vec<CriterionEnds> {
    let Some(fitness) = &goal.fitness else { return Vec::new() };
    let judge = Judge::rescaling(&goal.nominal(), &fitness.ends);
    // Use complete, unfolded designs only: other designs may have values that a search cannot
    // reach.
    rows.retain(|row| judge.is_whole(row));
    ends_over(fitness, goal.space.sweep(), &rows)
}

impl UnjudgedDesigns {
    /// Counts the designs of `history` without a valid judgement.
    fn of(search: &Search<'_>, history: &[Candidate]) -> Self {
        let mut unjudged = Self::default();
        for candidate in history {
            match &candidate.verdict {
                Judgement::Failed(outcome) => *unjudged.failed.entry(*outcome).or_default() += 1,
                Judgement::Missing(column) => {
                    *unjudged.missing.entry(column.clone()).or_default() += 1;
                }
                Judgement::Folded => unjudged.folded += 1,
                // A design that is folded at the end of its path is judged as infeasible. Count it
                // as folded, too.
                Judgement::Judged(_) | Judgement::Nominal(_)
                    if search.judge.requires_unfolded() =>
                {
                    let row = search.evaluations.row(0, &candidate.point, &candidate.result);
                    unjudged.folded += usize::from(has_folded(&row));
                }
                Judgement::Judged(_) | Judgement::Nominal(_) => {}
            }
        }
        unjudged
    }
}

/// Returns an error if a column of the goal is empty for all designs.
fn check_columns(found: &Found) -> Result<(), OptimisationError> {
    // A column that is empty for some designs is no error. `unjudged` counts these designs.
    let is_unjudged =
        |c: &Candidate| matches!(c.verdict, Judgement::Failed(_) | Judgement::Missing(_));
    if !found.history.iter().all(is_unjudged) {
        return Ok(());
    }
    let designs = found.history.len();
    found.unjudged.missing.keys().next().map_or(Ok(()), |column| {
        Err(OptimisationError::NoValue { column: column.clone(), designs })
    })
}
