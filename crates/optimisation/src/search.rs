//! The search: points that fill the space, the best of them improved, and what was found.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use rayon::iter::{IntoParallelIterator as _, IntoParallelRefIterator as _, ParallelIterator as _};
use results::{DesignRow, Outcome};
use run::{Program, Start};

use crate::candidate::{Candidate, Merit, SearchStage, Target};
use crate::error::OptimisationError;
use crate::evaluations::{Evaluations, Halt};
use crate::fitness::CriterionEnds;
use crate::front::{self, Front};
use crate::goal::DesignGoal;
use crate::judge::{Judge, Judgement, has_folded};
use crate::local::{Effort, Search};
use crate::made::{self, MadeReport, MadeSearches};
use crate::meter::{SearchMeter, SearchPart};
use crate::price::{Binding, bindings};
use crate::sample;
use crate::space::SpacePoint;

/// A distance between two starts, a share of the intervals, at least.
const APART: f64 = 0.12;

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
    pub meter: &'a SearchMeter,
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
    /// The number of evaluations, with derivatives and without.
    pub evaluations: usize,
    /// The ends between which the criteria of the fitness were rescaled.
    pub rescaled: Vec<CriterionEnds>,
}

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

/// A best design.
#[derive(Clone, Debug)]
pub struct BestDesign {
    /// The design.
    pub candidate: Candidate,
    /// The design as a row of tables.
    pub row: DesignRow,
    /// The target of the search that found it.
    pub target: Target,
    /// The limits that keep the design from being better, and what each costs.
    pub bindings: Vec<Binding>,
    /// What other skins made of it say, if the goal is about them.
    pub made: Option<MadeReport>,
}

/// How much is improved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// Designs that are improved along derivatives for each objective.
    pub starts: usize,
    /// Designs that are improved to the end after that.
    pub finalists: usize,
    /// Points of a front.
    pub points: usize,
}

impl Plan {
    /// Among designs as they are drawn.
    pub const DRAWN: Self = Self { starts: 12, finalists: 3, points: 0 };
    /// Among designs of which skins are made.
    pub const MADE: Self = Self { starts: 6, finalists: 3, points: 0 };
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
    let evaluations = Evaluations::begin(goal, folder, options.start, program, options.stop)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build();
    let pool = pool.map_err(|error| OptimisationError::Threads {
        count: options.threads,
        reason: error.to_string(),
    })?;
    let found = pool.install(|| find(goal, &evaluations, options.meter));
    evaluations.sync()?;
    match found {
        Ok(found) => {
            check_columns(&found)?;
            Ok(Some(found))
        }
        Err(Halt::Interrupted) => Ok(None),
        Err(Halt::Output(error)) => Err(error.into()),
    }
}

fn find(
    goal: &DesignGoal,
    evaluations: &Evaluations<'_>,
    meter: &SearchMeter,
) -> Result<Found, Halt> {
    let points = sample::points(&goal.space, goal.samples, goal.seed);
    let rows = sample_rows(evaluations, &points, meter)?;
    let rescaled = ends(goal, rows);
    let [drawn, judge] = [Judge::as_drawn(goal, &rescaled), Judge::rescaling(goal, &rescaled)];
    let finer = Judge::rescaling(&goal.finer(), &rescaled);
    let by = |judge| Search { space: &goal.space, evaluations, judge, meter };
    let (drawn, search, finer) = (by(&drawn), by(&judge), by(&finer));
    let look = |point| Ok(drawn.look(SearchStage::Sample, &point, false)?.0);
    let mut history: Vec<Candidate> = points.into_par_iter().map(look).collect::<Result<_, _>>()?;
    let answer = if goal.is_about_skins() {
        let searches = MadeSearches { drawn: &drawn, made: &search, finer: &finer };
        made::answer(goal, searches, &mut history)?
    } else {
        answer(&search, &mut history, Plan { points: goal.points, ..Plan::DRAWN })?
    };
    let left_out = LeftOutDesigns::of(&search, &history);
    Ok(Found { history, answer, left_out, evaluations: evaluations.count(), rescaled })
}

/// The rows of the points that fill the space.
fn sample_rows(
    evaluations: &Evaluations<'_>,
    points: &[SpacePoint],
    meter: &SearchMeter,
) -> Result<Vec<DesignRow>, Halt> {
    meter.begin(SearchPart::Sample, points.len());
    let row = |point: &SpacePoint| {
        let result = evaluations.solve(point, false)?;
        meter.step();
        Ok(evaluations.row(0, point, &result))
    };
    points.par_iter().map(row).collect()
}

/// The ends between which the criteria of the fitness are rescaled: from here on the fitness is one function.
fn ends(goal: &DesignGoal, mut rows: Vec<DesignRow>) -> Vec<CriterionEnds> {
    let Some(fitness) = &goal.fitness else { return Vec::new() };
    let judge = Judge::as_drawn(goal, &fitness.ends);
    rows.retain(|row| judge.is_whole(row));
    fitness.ends_over(goal.space.sweep(), &rows)
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
        let first = apart(search, history, &target, plan.starts);
        search.meter.begin(SearchPart::Climb, first.len());
        history.extend(improved(search, &target, first, Effort::CLIMB)?);
        let best = apart(search, history, &target, plan.finalists);
        search.meter.begin(SearchPart::Finish, best.len());
        history.extend(improved(search, &target, best, Effort::WHOLE)?);
        targets.push(target);
    }
    let is_feasible = |c: &Candidate| matches!(search.merit(c, &targets[0]), Merit::Met(_));
    if !history.iter().any(is_feasible) {
        return Ok(Answer::Infeasible(nearest(search, history, &targets[0])));
    }
    if targets.len() == 1 {
        let best = best_design(search, history, targets.swap_remove(0))?;
        return Ok(Answer::Optimum(Box::new(best)));
    }
    front::search(search, history, plan.points).map(Answer::Front)
}

/// The best designs for a target that are apart from each other, as starts of local searches.
pub(crate) fn apart(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    count: usize,
) -> Vec<Candidate> {
    let mut order: Vec<(Merit, &Candidate)> =
        history.iter().map(|candidate| (search.merit(candidate, target), candidate)).collect();
    order.sort_by(|(a, _), (b, _)| b.compare(*a));
    let mut starts: Vec<Candidate> = Vec::new();
    for (merit, candidate) in order {
        if merit == Merit::None || starts.len() == count {
            break;
        }
        if starts.iter().all(|start| distance(start, candidate) >= APART) {
            starts.push(candidate.clone());
        }
    }
    starts
}

/// The largest difference between two designs in any interval; infinite if their choices differ.
fn distance(one: &Candidate, other: &Candidate) -> f64 {
    if one.point.chosen != other.point.chosen {
        return f64::INFINITY;
    }
    let pairs = one.point.shares.iter().zip(&other.point.shares);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The candidates that are looked at when the starts are improved, each for itself.
fn improved(
    search: &Search<'_>,
    target: &Target,
    starts: Vec<Candidate>,
    effort: Effort,
) -> Result<Vec<Candidate>, Halt> {
    let walks = starts.into_par_iter().map(|start| {
        let walk = search.improve(target, &start, effort);
        search.meter.step();
        walk
    });
    Ok(walks.collect::<Result<Vec<_>, _>>()?.concat())
}

/// The index of the design that comes nearest to the requirements.
fn nearest(search: &Search<'_>, history: &[Candidate], target: &Target) -> Option<usize> {
    crate::candidate::best(history.iter().map(|candidate| search.merit(candidate, target)))
}

/// The best of all designs that were looked at, with what keeps it from being better.
pub(crate) fn best_design(
    search: &Search<'_>,
    history: &[Candidate],
    target: Target,
) -> Result<BestDesign, Halt> {
    // Whoever asks knows that there is a design that can be judged.
    let best = search.best(history.iter(), &target).unwrap_or(&history[0]).clone();
    let row = search.evaluations.row(0, &best.point, &best.result);
    let bindings = bindings(search, &best, &target)?;
    Ok(BestDesign { candidate: best, row, target, bindings, made: None })
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
                Judgement::Judged(_) | Judgement::Drawn(_) if search.judge.wants_sound() => {
                    let row = search.evaluations.row(0, &candidate.point, &candidate.result);
                    left_out.folded += usize::from(has_folded(&row));
                }
                Judgement::Judged(_) | Judgement::Drawn(_) => {}
            }
        }
        left_out
    }
}

/// Refuses a goal with a column in which no design has a number.
fn check_columns(found: &Found) -> Result<(), OptimisationError> {
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
