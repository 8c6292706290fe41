//! The search: points that fill the space, the best of them improved, and what was found.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};
use results::{DesignRow, Outcome};
use run::{Program, Start};

use crate::candidate::{Candidate, Merit, SearchStage, Target};
use crate::error::OptimisationError;
use crate::evaluations::{Evaluations, Halt};
use crate::front;
use crate::goal::DesignGoal;
use crate::judge::{Judge, Judgement, has_folded};
use crate::local::{Effort, Search};
use crate::price::{Binding, bindings};
use crate::sample;

/// Designs that are improved along derivatives for each objective.
const STARTS: usize = 12;

/// Designs that are improved to the end after that.
const FINALISTS: usize = 3;

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
}

/// The answer to a goal.
#[derive(Clone, Debug)]
pub enum Answer {
    /// The best design, of one objective.
    Optimum(Box<BestDesign>),
    /// The designs that none beats, of several, in the order of the first objective.
    Front(Vec<BestDesign>),
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
    let judge = Judge::new(goal);
    let search = Search { space: &goal.space, evaluations: &evaluations, judge: &judge };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build();
    let pool = pool.map_err(|error| OptimisationError::Threads {
        count: options.threads,
        reason: error.to_string(),
    })?;
    match pool.install(|| find(goal, &search)) {
        Ok(found) => {
            check_columns(&found)?;
            Ok(Some(found))
        }
        Err(Halt::Interrupted) => Ok(None),
        Err(Halt::Output(error)) => Err(error.into()),
    }
}

fn find(goal: &DesignGoal, search: &Search<'_>) -> Result<Found, Halt> {
    let points = sample::points(search.space, goal.samples, goal.seed);
    let look = |point| Ok(search.look(SearchStage::Sample, &point, false)?.0);
    let mut history: Vec<Candidate> = points.into_par_iter().map(look).collect::<Result<_, _>>()?;
    let mut targets: Vec<Target> = Vec::new();
    for objective in 0..search.judge.objectives() {
        let target = Target { objective, floors: Vec::new() };
        let first = starts(search, &history, &target, STARTS);
        let climbed = improved(search, &target, first, Effort::CLIMB)?;
        history.extend(climbed);
        let best = starts(search, &history, &target, FINALISTS);
        history.extend(improved(search, &target, best, Effort::WHOLE)?);
        targets.push(target);
    }
    let is_feasible = |c: &Candidate| matches!(search.merit(c, &targets[0]), Merit::Met(_));
    let answer = if !history.iter().any(is_feasible) {
        Answer::Infeasible(nearest(search, &history, &targets[0]))
    } else if targets.len() == 1 {
        Answer::Optimum(Box::new(best_design(search, &history, targets.swap_remove(0))?))
    } else {
        let targets = front::search(search, &mut history, goal.points)?;
        Answer::Front(front::designs(search, &history, &targets)?)
    };
    let left_out = LeftOutDesigns::of(search, &history);
    Ok(Found { history, answer, left_out, evaluations: search.evaluations.count() })
}

/// The best designs for a target that are apart from each other, as starts of local searches.
fn starts(
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
    let walks = starts.into_par_iter().map(|start| search.improve(target, &start, effort));
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
    Ok(BestDesign { candidate: best, row, target, bindings })
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
                Judgement::Judged(_) if search.judge.wants_sound() => {
                    let row = search.evaluations.row(0, &candidate.point, &candidate.result);
                    left_out.folded += usize::from(has_folded(&row));
                }
                Judgement::Judged(_) => {}
            }
        }
        left_out
    }
}

/// Refuses a goal with a column in which no design has a number.
fn check_columns(found: &Found) -> Result<(), OptimisationError> {
    let is_judged = |c: &Candidate| matches!(c.verdict, Judgement::Judged(_) | Judgement::Folded);
    if found.history.iter().any(is_judged) {
        return Ok(());
    }
    let designs = found.history.len();
    found.left_out.missing.keys().next().map_or(Ok(()), |column| {
        Err(OptimisationError::NoValue { column: column.clone(), designs })
    })
}
