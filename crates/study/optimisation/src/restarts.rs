//! Restarts of a search if its local searches disagree.
//!
//! A measure such as `max_stiffness` is an extremum over a path. It jumps where the path gains or
//! loses a contact, so it is a step function of the variables with sloping steps. Derivatives
//! describe a single step, and local searches end on any of many steps. If the searches of a target
//! end at different values, restarts sample a box around the best design, centre it on the best
//! sample and shrink it. Differences over the width of the box describe the overall trend. Samples
//! are moved onto the limits that bind at the centre, because away from them the objective changes
//! more than from step to step.

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

/// Relative difference of objectives up to which searches agree.
pub(crate) const AGREED: f64 = 1e-3;

/// Relative difference of the best two searches at which restarts end.
const SETTLED: f64 = 1e-4;

/// Relative gain of a round below which the box shrinks.
const GAIN: f64 = 1e-4;

/// Number of samples in a round, per variable.
const EACH: usize = 5;

/// Expected number of evaluations of a restart per variable, for the progress of the search.
const EVALUATIONS: u64 = 100;

/// Half-widths of the first and the smallest box, as fractions of the intervals.
const WIDTHS: [f64; 2] = [0.1, 1e-5];

/// Ratio of successive half-widths.
const SHRUNK: f64 = 0.5;

/// Maximum number of rounds of a restart.
const ROUNDS: usize = 40;

/// Relative margin at the centre of a box up to which a limit binds.
const NEAR: f64 = 1e-3;

/// Margin by which samples satisfy binding limits, despite round-off.
const INSIDE: f64 = 1e-6;

/// Maximum number of steps onto limits that require a solution.
const SOLVED_STEPS: usize = 3;

/// Maximum number of steps onto limits in closed form.
const FREE_STEPS: usize = 30;

/// Agreement of the local searches for a target.
///
/// It is a measure of confidence in the best design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Number of feasible local searches: the full ones, and those that they continue.
    pub searches: usize,
    /// Number of searches with an objective within 0.1 % of the best.
    pub agreeing: usize,
    /// Relative difference between the best two; `None` for fewer than two searches.
    pub spread: Option<f64>,
}

impl Agreement {
    /// Compares searches that ended at these objectives, to be maximised.
    pub(crate) fn of(ends: &[f64]) -> Self {
        let mut ends = ends.to_vec();
        ends.sort_by(|a, b| b.total_cmp(a));
        Self {
            searches: ends.len(),
            agreeing: ends.iter().filter(|end| difference(ends[0], **end) <= AGREED).count(),
            spread: ends.get(1).map(|end| difference(ends[0], *end)),
        }
    }

    fn is_settled(self) -> bool {
        self.spread.is_some_and(|spread| spread <= SETTLED)
    }
}

/// Returns the relative difference of two objectives.
fn difference(one: f64, other: f64) -> f64 {
    let size = one.abs().max(other.abs());
    if size > 0.0 { (one - other).abs() / size } else { 0.0 }
}

/// Returns the objective of a feasible design, with the sign to be maximised.
pub(crate) fn met(search: &Search<'_>, candidate: &Candidate, target: &Target) -> Option<f64> {
    match search.merit(candidate, target) {
        Merit::Met(objective) => Some(objective),
        Merit::Short(_) | Merit::None => None,
    }
}

/// Restarts near the best design of `history` until the best two searches agree.
///
/// At most `most` times.
///
/// `ends` contains the objectives of earlier searches; objectives of restarts are appended. Returns
/// all evaluated designs.
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
        best.filter(|best| met(search, best, target).is_some() && !best.point.shares.is_empty())
    else {
        return Ok(evaluated);
    };
    for restart in 0..most {
        if Agreement::of(ends).is_settled() {
            break;
        }
        let units = restart_evaluations(best.point.shares.len()) * search.evaluation_units(target);
        // Samples of boxes, then a full search.
        search.progress.begin(SearchPart::Restart, 2, units);
        let walk = Restart { search, target, best, number: restart as u64 }.run()?;
        ends.extend(search.best(walk.iter(), target).and_then(|end| met(search, end, target)));
        evaluated.extend(walk);
    }
    Ok(evaluated)
}

/// Returns the expected number of evaluations of a restart.
pub(crate) fn restart_evaluations(variables: usize) -> u64 {
    EVALUATIONS * variables as u64 + Effort::WHOLE.evaluations
}

/// A search by samples of shrinking boxes, starting near the best design.
struct Restart<'a> {
    search: &'a Search<'a>,
    target: &'a Target,
    best: &'a Candidate,
    /// Number of the restart. Each restart draws other samples.
    number: u64,
}

impl Restart<'_> {
    /// Runs the restart, and returns all evaluated designs.
    fn run(&self) -> Result<Vec<Candidate>, Halt> {
        let Self { search, target, .. } = *self;
        search.progress.start();
        let variables = self.best.point.shares.len();
        let units = search.evaluation_units(target);
        let task = search.progress.task(EVALUATIONS * variables as u64 * units);
        let sequence = Sequence::new(variables, self.number);
        let (mut centre, mut width, mut drawn) = (self.best.clone(), WIDTHS[0], 0);
        let mut evaluated: Vec<Candidate> = Vec::new();
        for _ in 0..ROUNDS {
            let surface = BindingSurface::at(search, &centre, target)?;
            let count = EACH * variables;
            let points = (drawn + 1..=drawn + count).map(|k| {
                let shares = centre.point.shares.iter().zip(sequence.point(k));
                let shares = shares.map(|(x, u)| (x + width * (2.0 * u - 1.0)).clamp(0.0, 1.0));
                SpacePoint { shares: shares.collect(), chosen: centre.point.chosen.clone() }
            });
            let points: Vec<SpacePoint> = points.collect();
            drawn += count;
            let samples = points.into_par_iter().map(|point| surface.evaluate(search, point));
            evaluated.extend(samples.collect::<Result<Vec<_>, Halt>>()?);
            task.count(count as u64 * units);
            let is_first = drawn == count;
            let Some(top) = search.best(evaluated.iter(), target).cloned() else { break };
            let gain = match [&centre, &top].map(|design| met(search, design, target)) {
                // Count the first round as a gain. The restart begins at a sample instead of the
                // best design, so reaching the best design again is evidence.
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
        evaluated.extend(search.improve(target, &centre, Effort::WHOLE)?);
        Ok(evaluated)
    }
}

/// Surface of the binding limits of a design, linearised at the design.
struct BindingSurface {
    limits: Vec<Limit>,
    /// Pseudo-inverse of the gradients of the margins.
    ///
    /// `None` without limits, or with as many limits as variables.
    step: Option<DMatrix<f64>>,
}

impl BindingSurface {
    fn at(search: &Search<'_>, centre: &Candidate, target: &Target) -> Result<Self, Halt> {
        let mut limits = near_limits(search, centre, target, NEAR);
        // Clamping the samples to the intervals handles their ends.
        limits.retain(|limit| matches!(limit, Limit::Requirement(_) | Limit::Touch));
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

    /// Moves a point onto the surface and evaluates it.
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
            // A design without margins cannot be moved, so evaluate the unmoved point.
            let Some(margins) = margins.collect::<Option<Vec<f64>>>() else { break };
            let missing = DVector::from_iterator(margins.len(), margins.iter().map(|m| INSIDE - m));
            if missing.amax() < 0.9 * INSIDE {
                break;
            }
            for (share, by) in point.shares.iter_mut().zip((step * missing).iter()) {
                *share = (*share + by).clamp(0.0, 1.0);
            }
        }
        Ok(search.compared(stage, &point, false)?.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agreement_is_measured_from_the_best_search() {
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
