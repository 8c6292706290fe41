//! Rounds a best design to sizes that can be manufactured.
//!
//! Designs with sizes that are multiples of steps form a lattice. The search evaluates the corners
//! of the lattice cell around the best design. Then it moves from the best point of the lattice to
//! a neighbour as long as the neighbour is better. The best feasible designs are checked like a
//! best design.

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

use crate::best::BestDesign;
use crate::candidate::{Candidate, Merit, SearchStage, Target, best};
use crate::checks::DesignChecks;
use crate::evaluations::Halt;
use crate::goal::DesignGoal;
use crate::judgement::Judgement;
use crate::local::{Search, evaluation_units};
use crate::progress::SearchPart;
use crate::sampled::confirmation::confirm;
use crate::space::{Interval, SpacePoint};

/// Maximum number of variables that are rounded in both directions, and changed in pairs.
const BOTH_WAYS: usize = 6;

/// Maximum number of moves on the lattice.
const MOVES: usize = 8;

/// Maximum number of rounded designs that are solved with more samples.
const FINER: usize = 12;
/// Maximum number of rounded designs that are checked with finer models.
const CHECKED: usize = 4;

/// Result of rounding a best design.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    /// Step of the lengths, in `unit`.
    pub step: f64,
    /// Unit of the step: `mm`, or `t` if the thickness in mm is unknown.
    pub unit: &'static str,
    /// Objective of the best design before rounding.
    pub exact: f64,
    /// Objective of the rounded design; `None` if no rounded design meets all requirements.
    pub rounded: Option<f64>,
}

/// Evaluated points of the lattice: for each point its factors of the steps, and its design.
type LatticePoints = Vec<(Vec<i64>, Candidate)>;

/// Replaces `best` by its rounded design if `goal` requests rounding.
///
/// `best` is unchanged if no rounded design meets all requirements. `finer` is like `search`, but
/// with more samples. Evaluated designs are added to `history`. Returns `None` without rounding.
pub(crate) fn round(
    goal: &DesignGoal,
    [search, finer]: [&Search<'_>; 2],
    best: &mut BestDesign,
    history: &mut Vec<Candidate>,
) -> Result<Option<Rounding>, Halt> {
    let (Some(step), Some(exact)) = (goal.round, objective(&best.candidate)) else {
        return Ok(None);
    };
    let thickness = goal.space.sweep().grid().case(0).material.thickness_mm;
    let unit = if thickness.is_some() { "mm" } else { "t" };
    let known = feasible_first(search, evaluated(search, best)?, &best.target);
    history.extend(known.iter().cloned());
    let mut contradicted = 0;
    for candidate in known.into_iter().filter(|c| is_met(search, c, best)).take(FINER) {
        let Some(rounded) = refined(goal, finer, best, candidate, history)? else { continue };
        if !goal.confirm || rounded.contradictions(goal).is_empty() {
            let value = objective(&rounded.candidate);
            *best = rounded;
            return Ok(Some(Rounding { step, unit, exact, rounded: value }));
        }
        contradicted += 1;
        if contradicted == CHECKED {
            break;
        }
    }
    Ok(Some(Rounding { step, unit, exact, rounded: None }))
}

/// Verifies a rounded design by more samples and by independent samples.
///
/// With `confirm = true` the checks with finer models are run, too. `None` if the design violates a
/// requirement on the larger number of samples. The design with more samples is added to `history`.
fn refined(
    goal: &DesignGoal,
    finer: &Search<'_>,
    best: &BestDesign,
    mut candidate: Candidate,
    history: &mut Vec<Candidate>,
) -> Result<Option<BestDesign>, Halt> {
    if goal.is_about_samples() {
        candidate = finer.evaluate(SearchStage::Rounded, &candidate.point, false)?.0;
        history.push(candidate.clone());
        if !is_met(finer, &candidate, best) {
            return Ok(None);
        }
    }
    let row = finer.evaluations.row(0, &candidate.point, &candidate.result);
    let confirmation = confirm(finer, &candidate.point)?;
    let mut rounded = BestDesign { candidate, row, confirmation, ..best.clone() };
    if goal.confirm {
        rounded.checks = DesignChecks::solve(goal, &rounded.row.case);
    }
    Ok(Some(rounded))
}

/// Returns true if `candidate` is feasible for the target of `best`.
fn is_met(search: &Search<'_>, candidate: &Candidate, best: &BestDesign) -> bool {
    matches!(search.merit(candidate, &best.target), Merit::Met(_))
}

/// Returns the first objective of a design; `None` without a valid judgement.
fn objective(candidate: &Candidate) -> Option<f64> {
    let Judgement::Judged(worth) = &candidate.verdict else { return None };
    worth.objectives.first().copied()
}

/// Returns the designs of the lattice sorted by merit, the best first.
fn feasible_first(search: &Search<'_>, known: LatticePoints, target: &Target) -> Vec<Candidate> {
    let mut designs: Vec<Candidate> = known.into_iter().map(|(_, candidate)| candidate).collect();
    designs.sort_by(|a, b| search.merit(b, target).compare(search.merit(a, target)));
    designs
}

/// Evaluates points of the lattice around `best`, and returns them.
fn evaluated(search: &Search<'_>, best: &BestDesign) -> Result<LatticePoints, Halt> {
    let (start, target) = (&best.candidate.point, &best.target);
    let mut known = LatticePoints::new();
    add(search, start, corners(search, start), &mut known)?;
    let mut at = best_of(search, &known, target);
    for _ in 0..MOVES {
        let Some(current) = at else { break };
        let mut next = neighbours(search, &known[current].0);
        next.retain(|factors| known.iter().all(|(other, _)| other != factors));
        add(search, start, next, &mut known)?;
        at = best_of(search, &known, target);
        if at == Some(current) {
            break;
        }
    }
    Ok(known)
}

/// Returns the index of the best evaluated point; `None` without a valid judgement.
fn best_of(search: &Search<'_>, known: &[(Vec<i64>, Candidate)], target: &Target) -> Option<usize> {
    best(known.iter().map(|(_, candidate)| search.merit(candidate, target)))
}

/// Evaluates `points` of the lattice, and adds them to `known`.
///
/// Variables that are not rounded keep the values of `start`.
fn add(
    search: &Search<'_>,
    start: &SpacePoint,
    points: Vec<Vec<i64>>,
    known: &mut LatticePoints,
) -> Result<(), Halt> {
    let units = evaluation_units(search.judge.samples().map_or(0, |judge| judge.count));
    search.progress.begin(SearchPart::Round, points.len(), points.len() as u64 * units);
    let evaluated = points.into_par_iter().map(|factors| {
        let _task = search.progress.task(units);
        let mut point = start.clone();
        for (j, interval) in search.space.intervals().iter().enumerate() {
            point.fractions[j] =
                interval.fraction_of_multiple(factors[j]).unwrap_or(point.fractions[j]);
        }
        Ok((factors, search.evaluate(SearchStage::Rounded, &point, false)?.0))
    });
    let evaluated: LatticePoints = evaluated.collect::<Result<_, Halt>>()?;
    known.extend(evaluated);
    Ok(())
}

/// Returns the corners of the lattice cell around `start`, as factors of the steps.
///
/// After `BOTH_WAYS` variables, further variables are only rounded down.
fn corners(search: &Search<'_>, start: &SpacePoint) -> Vec<Vec<i64>> {
    let mut corners: Vec<Vec<i64>> = vec![Vec::new()];
    let mut both_ways = 0;
    for (interval, fraction) in search.space.intervals().iter().zip(&start.fractions) {
        // The factor of a variable without a step is not used.
        let [below, above] = interval.multiples_around(*fraction).unwrap_or([0, 0]);
        let mut factors = vec![below];
        if above != below && both_ways < BOTH_WAYS {
            both_ways += 1;
            factors.push(above);
        }
        let mut longer = Vec::new();
        for corner in corners.iter().map(Vec::as_slice) {
            longer.extend(factors.iter().map(|factor| [corner, [*factor].as_slice()].concat()));
        }
        corners = longer;
    }
    corners
}

/// Returns the points of the lattice that differ from `at` by 1 in one or two factors.
///
/// With more than `BOTH_WAYS` rounded variables only one factor changes.
fn neighbours(search: &Search<'_>, at: &[i64]) -> Vec<Vec<i64>> {
    let ranges: Vec<_> = search.space.intervals().iter().map(Interval::multiples).collect();
    let rounded: Vec<usize> = (0..at.len()).filter(|&j| ranges[j].is_some()).collect();
    let mut moves: Vec<Vec<(usize, i64)>> = Vec::new();
    for (n, &j) in rounded.iter().enumerate() {
        moves.extend([-1, 1].map(|by| vec![(j, by)]));
        for &other in rounded.iter().skip(n + 1).filter(|_| rounded.len() <= BOTH_WAYS) {
            for by in [-1, 1] {
                moves.extend([-1, 1].map(|further| vec![(j, by), (other, further)]));
            }
        }
    }
    let mut points = Vec::new();
    for step in moves {
        let mut point = at.to_vec();
        for (j, by) in step {
            point[j] += by;
        }
        let mut ranges = ranges.iter().zip(&point);
        if ranges.all(|(range, factor)| range.as_ref().is_none_or(|all| all.contains(factor))) {
            points.push(point);
        }
    }
    points
}
