//! Restarts a search if its local searches end at different objectives.
//!
//! A measure such as `max_stiffness` is an extremum over a path. It jumps if a contact appears on
//! the path or disappears, so it is a step function of the variables with sloping steps.
//! Derivatives describe a single step, and a local search may end on any of many steps.
//!
//! A restart therefore evaluates points in a box around the best design, centres the box on the
//! best of these points and shrinks the box. Differences across the box describe the overall trend.
//! The points are first moved onto the limits that bind at the centre. Otherwise the distance from
//! these limits would change the objective more than the jumps.

use nalgebra::{DMatrix, DVector};
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

use crate::candidate::{Candidate, Merit, SearchStage, Target};
use crate::contact_margin::{contact_margin, contact_margin_slopes};
use crate::evaluations::Halt;
use crate::judgement::Judgement;
use crate::local::{Effort, Search};
use crate::price::{Limit, near_limits};
use crate::progress::SearchPart;
use crate::slopes::Slopes;
use crate::space::SpacePoint;
use crate::space_filling::Sequence;

/// Relative difference of objectives up to which two searches agree.
pub(crate) const AGREED: f64 = 1e-3;

/// Relative difference of the best two searches up to which no further restart is needed.
const SETTLED: f64 = 1e-4;

/// Relative gain of a round below which the box shrinks.
const GAIN: f64 = 1e-4;

/// Number of points evaluated in each round of a restart, for each variable.
const EACH: usize = 5;

/// Expected number of evaluations in the boxes of a restart, for each variable.
const EVALUATIONS: u64 = 100;

/// Half-widths of the first and the smallest box, as fractions of the ranges of the variables.
const WIDTHS: [f64; 2] = [0.1, 1e-5];

/// Ratio of successive half-widths.
const SHRUNK: f64 = 0.5;

/// Maximum number of rounds of a restart.
const ROUNDS: usize = 40;

/// Relative margin at the centre of a box up to which a limit counts as binding.
const NEAR: f64 = 1e-3;

/// Relative margin to the binding limits at which moved points are placed.
///
/// With this margin the points meet the limits despite round-off.
const INSIDE: f64 = 1e-6;

/// Maximum number of steps that move a point onto limits if each step solves the design.
const SOLVED_STEPS: usize = 3;

/// Maximum number of steps that move a point onto limits that are known in closed form.
const FREE_STEPS: usize = 30;

/// Agreement of the local searches for a target, a measure of confidence in the best design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Number of local searches that ended at feasible designs.
    ///
    /// Full searches and the gradient searches that precede them count.
    pub searches: usize,
    /// Number of searches with an objective within 0.1 % of the best objective.
    pub agreeing: usize,
    /// Relative difference of the best two objectives; `None` for fewer than two searches.
    pub spread: Option<f64>,
}

impl Agreement {
    /// Compares searches that ended at the objectives `ends`, which are to be maximised.
    pub(crate) fn of(ends: &[f64]) -> Self {
        let mut ends = ends.to_vec();
        ends.sort_by(|a, b| b.total_cmp(a));
        Self {
            searches: ends.len(),
            agreeing: ends.iter().filter(|end| difference(ends[0], **end) <= AGREED).count(),
            spread: ends.get(1).map(|end| difference(ends[0], *end)),
        }
    }

    /// Returns true if the best two searches agree, so that no further restart is needed.
    fn is_settled(self) -> bool {
        self.spread.is_some_and(|spread| spread <= SETTLED)
    }
}

/// Returns the relative difference of two objectives.
fn difference(one: f64, other: f64) -> f64 {
    let size = one.abs().max(other.abs());
    if size > 0.0 { (one - other).abs() / size } else { 0.0 }
}

/// Returns the objective of a feasible design, with changed sign if it is to be minimised.
///
/// `None` for an infeasible design.
pub(crate) fn met(search: &Search<'_>, candidate: &Candidate, target: &Target) -> Option<f64> {
    match search.merit(candidate, target) {
        Merit::Met(objective) => Some(objective),
        Merit::Short(_) | Merit::None => None,
    }
}

/// Runs at most `most` restarts near the best design of `history`.
///
/// No further restart follows if the best two searches agree. `ends` contains the objectives of
/// earlier searches; objectives of restarts are appended. Returns all evaluated designs.
pub(crate) fn restarted(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    ends: &mut Vec<f64>,
    most: usize,
) -> Result<Vec<Candidate>, Halt> {
    let mut evaluated: Vec<Candidate> = Vec::new();
    let best = search.best(history.iter(), target);
    let Some(best) =
        best.filter(|best| met(search, best, target).is_some() && !best.point.fractions.is_empty())
    else {
        return Ok(evaluated);
    };
    for restart in 0..most {
        if Agreement::of(ends).is_settled() {
            break;
        }
        let units =
            restart_evaluations(best.point.fractions.len()) * search.evaluation_units(target);
        // A restart has two tasks: points in boxes, and a full local search.
        search.progress.begin(SearchPart::Restart, 2, units);
        let designs = Restart { search, target, best, number: restart as u64 }.run()?;
        ends.extend(search.best(designs.iter(), target).and_then(|end| met(search, end, target)));
        evaluated.extend(designs);
    }
    Ok(evaluated)
}

/// Returns the expected number of evaluations of a restart with this number of variables.
pub(crate) fn restart_evaluations(variables: usize) -> u64 {
    EVALUATIONS * variables as u64 + Effort::WHOLE.evaluations
}

/// A restart: evaluates points in shrinking boxes, then runs a full local search.
struct Restart<'a> {
    search: &'a Search<'a>,
    target: &'a Target,
    best: &'a Candidate,
    /// Number of the restart, which is the seed of its points.
    number: u64,
}

impl Restart<'_> {
    /// Runs the restart, and returns all evaluated designs.
    fn run(&self) -> Result<Vec<Candidate>, Halt> {
        let Self { search, target, .. } = *self;
        search.progress.start();
        let variables = self.best.point.fractions.len();
        let units = search.evaluation_units(target);
        let task = search.progress.task(EVALUATIONS * variables as u64 * units);
        let sequence = Sequence::new(variables, self.number);
        let (mut centre, mut width, mut drawn) = (self.best.clone(), WIDTHS[0], 0);
        let mut evaluated: Vec<Candidate> = Vec::new();
        for _ in 0..ROUNDS {
            let surface = BindingSurface::at(search, &centre, target)?;
            let count = EACH * variables;
            let points = (drawn + 1..=drawn + count).map(|k| {
                let fractions = centre.point.fractions.iter().zip(sequence.point(k));
                let fractions =
                    fractions.map(|(x, u)| (x + width * (2.0 * u - 1.0)).clamp(0.0, 1.0));
                SpacePoint { fractions: fractions.collect(), chosen: centre.point.chosen.clone() }
            });
            let points: Vec<SpacePoint> = points.collect();
            drawn += count;
            let samples = points.into_par_iter().map(|point| surface.evaluate(search, point));
            evaluated.extend(samples.collect::<Result<Vec<_>, Halt>>()?);
            task.count(count as u64 * units);
            let is_first = drawn == count;
            let Some(top) = search.best(evaluated.iter(), target).cloned() else { break };
            let gain = match [&centre, &top].map(|design| met(search, design, target)) {
                // Always move the box to the best point of the first round, away from the best
                // design so far. If the restart finds that design again, the design is confirmed.
                _ if is_first => f64::INFINITY,
                [Some(before), Some(after)] if after > before => difference(before, after),
                [None, Some(_)] => f64::INFINITY,
                _ => 0.0,
            };
            if gain > 0.0 {
                centre = top;
            }
            if gain < GAIN {
                width *= SHRUNK;
            }
            if width < WIDTHS[1] {
                break;
            }
        }
        drop(task);
        evaluated.extend(search.improve(target, &centre, Effort::WHOLE, Merit::None)?);
        Ok(evaluated)
    }
}

/// Surface on which the binding limits of a design are met with equality, linearised at the design.
struct BindingSurface {
    limits: Vec<Limit>,
    /// Pseudo-inverse of the gradients of the margins, which gives steps onto the surface.
    ///
    /// `None` without limits, with at least as many limits as variables, or without gradients.
    step: Option<DMatrix<f64>>,
}

impl BindingSurface {
    /// Returns the surface of the limits that bind at `centre`.
    fn at(search: &Search<'_>, centre: &Candidate, target: &Target) -> Result<Self, Halt> {
        let mut limits = near_limits(search, centre, target, NEAR);
        // Ends of intervals need no step, because points are clamped to the intervals.
        limits.retain(|limit| matches!(limit, Limit::Requirement(_) | Limit::FirstContact));
        if limits.is_empty() {
            return Ok(Self { limits, step: None });
        }
        let (_, row) = search.compared(SearchStage::Gradient, &centre.point, true)?;
        let intervals = search.space.intervals();
        let mut gradients = Vec::new();
        for limit in &limits {
            for interval in intervals {
                let Slopes { left, right } = match *limit {
                    Limit::Requirement(k) => {
                        search.judge.margin_slopes(k, &row, interval.parameter)
                    }
                    _ => contact_margin_slopes(&row.nominal.case, interval.parameter),
                };
                let Some(slope) = left.or(right) else { return Ok(Self { limits, step: None }) };
                gradients.push(slope * interval.length());
            }
        }
        if limits.len() >= intervals.len() {
            return Ok(Self { limits, step: None });
        }
        let gradients = DMatrix::from_row_slice(limits.len(), intervals.len(), &gradients);
        let step = gradients.pseudo_inverse(f64::EPSILON).ok();
        Ok(Self { limits, step })
    }

    /// Moves a point onto the surface by a few steps, and evaluates it.
    fn evaluate(&self, search: &Search<'_>, mut point: SpacePoint) -> Result<Candidate, Halt> {
        let stage = SearchStage::Polish;
        let Some(step) = &self.step else { return Ok(search.compared(stage, &point, false)?.0) };
        let is_solved = self.limits.iter().any(|limit| matches!(limit, Limit::Requirement(_)));
        for _ in 0..if is_solved { SOLVED_STEPS } else { FREE_STEPS } {
            let candidate =
                if is_solved { Some(search.compared(stage, &point, false)?.0) } else { None };
            let margins = self.limits.iter().map(|limit| match *limit {
                Limit::Requirement(k) => match &candidate.as_ref()?.verdict {
                    Judgement::Judged(worth) => Some(worth.margins[k]),
                    _ => None,
                },
                _ => Some(contact_margin(&search.space.case(&point))),
            });
            // A design without a valid judgement has no margins, so its point is not moved farther.
            let Some(margins) = margins.collect::<Option<Vec<f64>>>() else { break };
            let missing = DVector::from_iterator(margins.len(), margins.iter().map(|m| INSIDE - m));
            if missing.amax() < 0.9 * INSIDE {
                break;
            }
            for (fraction, by) in point.fractions.iter_mut().zip((step * missing).iter()) {
                *fraction = (*fraction + by).clamp(0.0, 1.0);
            }
        }
        Ok(search.compared(stage, &point, false)?.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agreement_is_relative_to_the_best_search() {
        let none = Agreement { searches: 0, agreeing: 0, spread: None };
        assert_eq!(Agreement::of(&[]), none);
        assert_eq!(Agreement::of(&[2.0]), Agreement { searches: 1, agreeing: 1, spread: None });
        let three = Agreement::of(&[-2.0, -4.0, -2.001]);
        assert_eq!((three.searches, three.agreeing), (3, 2));
        assert!((three.spread.expect("two searches") - 5e-4).abs() < 1e-6);
        assert!(!three.is_settled() && Agreement::of(&[0.0, 0.0]).is_settled());
        assert!(!Agreement::of(&[1.0]).is_settled(), "a single search is no evidence");
    }
}
