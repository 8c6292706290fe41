//! The search: points that fill the space, the best of them improved, and what was found.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use ranking::CriterionEnds;
use rayon::iter::{IntoParallelIterator as _, IntoParallelRefIterator as _, ParallelIterator as _};
use results::{DesignRow, Outcome};
use run::{Program, Start};

use crate::answer::{Answer, answer};
use crate::best::{Region, region};
use crate::candidate::{Candidate, SearchStage};
use crate::column::ends_over;
use crate::coverage_peaks::points_on_peaks;
use crate::error::OptimisationError;
use crate::evaluations::{Evaluations, Halt};
use crate::goal::DesignGoal;
use crate::improvement::Plan;
use crate::judge::Judge;
use crate::judgement::Judgement;
use crate::local::Search;
use crate::progress::{SearchPart, SearchProgress};
use crate::requirement_bounds::has_folded;
use crate::sampled::search::{SEEDS, Searches};
use crate::space::SpacePoint;
use crate::space_filling;

/// How a search is carried out.
#[derive(Clone, Copy, Debug)]
pub struct SearchOptions<'a> {
    /// The number of designs that are solved at a time.
    pub threads: usize,
    /// Whether results that are there are refused, used or thrown away.
    pub start: Start,
    /// Set to request a stop; what is solved so far stays in the journal.
    pub stop: &'a AtomicBool,
    /// Where the search tells how far it is.
    pub progress: &'a SearchProgress,
}

/// The outcome of a search.
#[derive(Clone, Debug)]
pub struct Found {
    /// Every design that was looked at, in an order that does not depend on the threads.
    pub history: Vec<Candidate>,
    /// The answer.
    pub answer: Answer,
    /// How many designs could not be counted on.
    pub left_out: LeftOutDesigns,
    /// The number of local searches.
    pub starts: usize,
    /// The number of regions that designs were looked at in: of choices, peaks of coverage, strips whose scales touch or do not.
    pub regions: usize,
    /// The number of evaluations, with derivatives and without.
    pub evaluations: usize,
    /// The ends between which the criteria of the fitness were rescaled.
    pub rescaled: Vec<CriterionEnds>,
}

/// Designs that could not be counted on, by the reason.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOutDesigns {
    /// Designs with a measure that has no value.
    pub failed: BTreeMap<Outcome, usize>,
    /// Designs whose surface has folded.
    pub folded: usize,
    /// Designs without a number in a column of the goal.
    pub missing: BTreeMap<String, usize>,
}

/// Searches for the best designs of `goal`, with the journal in `folder`. `None` if it was asked to stop.
///
/// # Errors
/// If the folder holds something else, the disk does not take the journal, or no design has a number in a column of the goal.
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
    // In a pool of its own: as many threads as were asked for, whatever the rest of the process uses.
    let found = pool.install(|| find(goal, &evaluations, options.progress));
    // Also of a search that was asked to stop: what it has solved is what the next one goes on from.
    evaluations.sync()?;
    match found {
        Ok(found) => {
            check_columns(&found)?;
            Ok(Some(found))
        }
        // A climb that stalls is no reason to end a search.
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
    // Solved before there is a judge: the fitness is rescaled over these.
    let rows = sample_rows(evaluations, &points, progress)?;
    let rescaled = ends(goal, rows);
    // One set of ends for all three: a fitness between other ends would be another function.
    let judges =
        [&goal.nominal(), goal, &goal.finer()].map(|goal| Judge::rescaling(goal, &rescaled));
    let [nominal, search, finer] =
        judges.each_ref().map(|judge| Search { space: &goal.space, evaluations, judge, progress });
    // A goal about parameters and mass alone meets no contact and no kink: peaks tell it nothing.
    let on_peaks = if nominal.judge.has_regions() {
        points_on_peaks(&goal.space, nominal.judge, goal.seed)
    } else {
        Vec::new()
    };
    let points = [points, on_peaks].concat();
    // Points that fill the space are in the journal by now: only those on peaks are solved here.
    let evaluate = |point| Ok(nominal.evaluate(SearchStage::Sample, &point, false)?.0);
    let mut history: Vec<Candidate> =
        points.into_par_iter().map(evaluate).collect::<Result<_, _>>()?;
    let answer = if goal.is_about_samples() {
        let searches = Searches { nominal: &nominal, sampled: &search, finer: &finer };
        searches.answer(goal, &mut history)?
    } else {
        answer(&search, &mut history, Plan::NOMINAL, goal.points)?
    };
    let left_out = LeftOutDesigns::of(&search, &history);
    let mut regions: Vec<Region> = Vec::new();
    for candidate in &history {
        let region = region(&search, candidate);
        if !regions.contains(&region) {
            regions.push(region);
        }
    }
    let (starts, evaluations) = (progress.starts(), evaluations.count());
    Ok(Found { history, answer, left_out, starts, regions: regions.len(), evaluations, rescaled })
}

/// The parts of the search for a goal, each with the solutions that it takes: of the goals in `sweeps` within a factor of two.
fn expected(goal: &DesignGoal) -> Vec<(SearchPart, f64)> {
    let (objectives, variables) = (goal.objectives.len(), goal.space.intervals().len() as f64);
    let answer = |plan: Plan, each: f64| {
        let each = variables * each;
        // A design that is improved to the end takes as many solutions as seven others.
        let climbs = (11 * plan.tasks() + 64 * plan.finalists) as f64 * each;
        // Half of the points of a front first, then those between them.
        let halves = if objectives > 1 { 2 } else { 0 };
        let front = vec![(SearchPart::Front, goal.points as f64 * 80.0 * each); halves];
        [vec![(SearchPart::Climb, climbs); objectives], front].concat()
    };
    let mut parts = vec![(SearchPart::Sample, goal.samples as f64)];
    parts.extend(answer(Plan::NOMINAL, 1.0));
    if goal.is_about_samples() {
        // Samples are punctured one by one, but neither differentiated nor bent where no requirement asks for it.
        let each = 0.25 * goal.realisations as f64;
        parts.push((SearchPart::Samples, (objectives * SEEDS) as f64 * each));
        parts.extend(answer(Plan::SAMPLED, each));
        let best = if objectives > 1 { goal.points } else { 1 } as f64;
        parts.extend([
            (SearchPart::Refine, 230.0 * variables * each),
            (SearchPart::Check, best * 500.0),
        ]);
    }
    parts
}

/// The rows of the points that fill the space.
fn sample_rows(
    evaluations: &Evaluations<'_>,
    points: &[SpacePoint],
    progress: &SearchProgress,
) -> Result<Vec<DesignRow>, Halt> {
    progress.begin(SearchPart::Sample, points.len());
    let row = |point: &SpacePoint| {
        let result = evaluations.solve(point, false)?;
        progress.step();
        Ok(evaluations.row(0, point, &result))
    };
    points.par_iter().map(row).collect()
}

/// The ends between which the criteria of the fitness are rescaled: from here on the fitness is one function.
fn ends(goal: &DesignGoal, mut rows: Vec<DesignRow>) -> Vec<CriterionEnds> {
    let Some(fitness) = &goal.fitness else { return Vec::new() };
    let judge = Judge::rescaling(&goal.nominal(), &fitness.ends);
    // A design that does not count would stretch the scale to where no search may come.
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
                // Folded at the end, it is judged as one that falls short, and counted too.
                Judgement::Judged(_) | Judgement::Nominal(_) if search.judge.wants_sound() => {
                    let row = search.evaluations.row(0, &candidate.point, &candidate.result);
                    left_out.folded += usize::from(has_folded(&row));
                }
                Judgement::Judged(_) | Judgement::Nominal(_) => {}
            }
        }
        left_out
    }
}

/// Refuses a goal with a column in which no design has a number.
fn check_columns(found: &Found) -> Result<(), OptimisationError> {
    // A column that only some designs lack is no error: they are left out, and told by its name.
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
