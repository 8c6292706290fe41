//! Local search: gradient steps, bundle steps and derivative-free steps.
//!
//! The gradient search stops at kinks, so the bundle method then follows the ridge of the kink. The
//! derivative-free search finds improvements beyond jumps. If the goal requires a yield, a search
//! by linear programs over the samples precedes the gradient search.

mod bundle;
mod certainty;
mod followed_points;
mod gradient_search;
mod linear_model;
mod polish;
mod problem;
mod ridge;
mod samples;
mod yield_search;

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use results::DesignResult;

use crate::candidate::{Candidate, Merit, SearchStage, Target, best};
use crate::evaluated_row::EvaluatedRow;
use crate::evaluations::{Evaluations, Halt, Positions};
use crate::judge::Judge;
use crate::judgement::Judgement;
use crate::progress::{SearchProgress, SearchTask};
use crate::space::{DesignSpace, SpacePoint};
use followed_points::FollowedPoints;
pub(crate) use problem::CLEAR;
use samples::SampledPoint;

/// Maximum number of rounds, each of ridge search, derivative-free search and gradient search.
const ROUNDS: usize = 4;

/// Distance from an end of an interval, as a fraction of the interval, that counts as 0.
const ROUND_OFF: f64 = 1e-13;

/// Number of grid steps in each round of a search along a scaling interval.
const STEPS: u32 = 8;

/// Number of rounds of a search along a scaling interval.
const SCALINGS: usize = 15;

/// Work of an evaluation in a local search. The unit is the work for a space-filling point.
///
/// An evaluation in a local search is more expensive, because it includes derivatives, and because
/// good designs have contacts.
const EVALUATION: u64 = 4;

/// Number of samples that need as much work as an evaluation of a nominal design.
const SAMPLES: usize = 20;

/// Returns the expected work of an evaluation of a design with this number of samples.
///
/// The unit is the work for a space-filling point.
pub(crate) fn evaluation_units(samples: usize) -> u64 {
    EVALUATION * (1 + samples / SAMPLES) as u64
}

/// Termination tolerances of a local search.
#[derive(Clone, Copy, Debug)]
struct Fineness {
    /// Relative gain in a round below which the search ends.
    gain: f64,
    /// Smallest step of the derivative-free search, as a fraction of the ranges of the variables.
    step: f64,
}

impl Fineness {
    /// Tolerances for nominal designs.
    const NOMINAL: Self = Self { gain: 1e-8, step: 1e-7 };
    /// Tolerances for designs with samples.
    ///
    /// Quantiles and yields have errors of some per cent, because the number of samples is finite.
    const SAMPLED: Self = Self { gain: 1e-3, step: 1e-4 };
}

/// Space, evaluations, judge and progress, shared by all local searches for a goal.
pub(crate) struct Search<'a> {
    pub space: &'a DesignSpace,
    pub evaluations: &'a Evaluations<'a>,
    pub judge: &'a Judge,
    pub progress: &'a SearchProgress,
}

/// Evaluation budget of a local search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Maximum number of evaluations of a gradient search in all branches, for each variable.
    ///
    /// Smooth problems need fewer evaluations. A search that has not converged after this number of
    /// evaluations zigzags across a ridge.
    pub gradient_evaluations: usize,
    /// Maximum number of evaluations of a search for a required yield.
    pub yield_evaluations: usize,
    /// Maximum number of coverage branches in a gradient search.
    pub pieces: usize,
    /// Maximum number of rounds of ridge search, derivative-free search and gradient search.
    pub rounds: usize,
    /// First step of ridge and derivative-free search, as a fraction of the variables' ranges.
    pub reach: f64,
    /// Maximum number of evaluations of the ridge search in a round, for each variable.
    pub ridge: usize,
    /// Maximum number of evaluations of the derivative-free search in a round, for each variable.
    pub polish: usize,
    /// Expected number of evaluations, for the progress display.
    pub evaluations: u64,
}

impl Effort {
    /// A few gradient steps, enough to compare regions.
    pub const PROBE: Self =
        Self { gradient_evaluations: 4, yield_evaluations: 5, pieces: 1, ..Self::GRADIENT };
    /// A gradient search without ridge search and derivative-free search.
    pub const GRADIENT: Self = Self {
        gradient_evaluations: 15,
        yield_evaluations: 15,
        pieces: 2,
        rounds: 0,
        reach: 0.0,
        ridge: 0,
        polish: 0,
        evaluations: 8,
    };
    /// Full local search, to convergence.
    pub const WHOLE: Self = Self {
        rounds: ROUNDS,
        reach: 0.06,
        ridge: 20,
        polish: 8,
        evaluations: 35,
        ..Self::GRADIENT
    };

    /// Local search from a design that is probably close to the best design.
    ///
    /// This search omits the derivative-free search beyond jumps, because other local searches
    /// start on both sides of a jump.
    pub const NEAR: Self =
        Self { rounds: 2, reach: 0.01, polish: 0, evaluations: 25, ..Self::WHOLE };

    /// Returns a smaller budget for designs with samples.
    ///
    /// Each evaluation then needs one solution for each sample.
    fn on_samples(self) -> Self {
        Self {
            gradient_evaluations: self.gradient_evaluations.min(8),
            rounds: self.rounds.min(2),
            ridge: self.ridge / 2,
            polish: self.polish / 2,
            ..self
        }
    }
}

impl Search<'_> {
    /// Evaluates the design at `point`, with samples if the goal contains statistics over samples.
    ///
    /// `differentiated` requests derivatives with respect to the variables.
    pub fn evaluate(
        &self,
        stage: SearchStage,
        point: &SpacePoint,
        differentiated: bool,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        self.evaluate_at(stage, point, differentiated, Positions::All)
    }

    /// Evaluates the design at `point` like [`Self::evaluate`], for comparison with other designs.
    ///
    /// Only the load positions that the comparison needs are solved.
    pub fn compared(
        &self,
        stage: SearchStage,
        point: &SpacePoint,
        differentiated: bool,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        let positions = self.evaluations.compared_positions(point);
        self.evaluate_at(stage, point, differentiated, positions)
    }

    /// Evaluates the design at `point` like [`Self::evaluate`], at the load positions `positions`.
    fn evaluate_at(
        &self,
        stage: SearchStage,
        point: &SpacePoint,
        differentiated: bool,
        positions: Positions,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        let result = self.evaluations.solve(point, differentiated, positions)?;
        self.judged(stage, point, result, differentiated)
    }

    /// Judges the design at `point` by its nominal `result` and by its samples.
    ///
    /// The samples are solved if they are needed and unknown.
    fn judged(
        &self,
        stage: SearchStage,
        point: &SpacePoint,
        result: Arc<DesignResult>,
        differentiated: bool,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        let Self { space, evaluations, .. } = *self;
        let nominal = evaluations.row(0, point, &result);
        let judge = self.judge.samples().filter(|judge| judge.admits(&nominal));
        let samples = judge.map(|judge| evaluations.samples(point, 1, judge.count, judge));
        let samples = samples.transpose()?;
        let verdict = self.judge.verdict_with(&nominal, samples.as_deref());
        let statistics = match (judge, &samples) {
            (Some(judge), Some(samples)) if differentiated => {
                SampledPoint { space, evaluations, judge, point, samples }.slopes(self.judge)?
            }
            _ => Vec::new(),
        };
        self.progress.evaluate();
        let candidate = Candidate { stage, point: point.clone(), result, verdict };
        Ok((candidate, EvaluatedRow { nominal, statistics }))
    }

    /// Computes the gradients of the margins of those samples that decide a required yield.
    ///
    /// `k` is the index of the requirement on the yield, and `q` the index of its statistic. The
    /// yield is met if a quantile of the margins is not negative. Gradients are returned for
    /// `spread` samples on each side of this quantile.
    pub fn margin_gradients(
        &self,
        point: &SpacePoint,
        (k, q): (usize, usize),
        spread: usize,
    ) -> Result<Vec<Vec<f64>>, Halt> {
        let Self { space, evaluations, .. } = *self;
        let Some(judge) = self.judge.samples() else { return Ok(Vec::new()) };
        let Some(requirement) = self.judge.requirements().nth(k) else { return Ok(Vec::new()) };
        let samples = evaluations.samples(point, 1, judge.count, judge)?;
        let near = judge.near_deciding(q, requirement, &samples, spread);
        SampledPoint { space, evaluations, judge, point, samples: &samples }.gradients(q, &near)
    }

    /// Returns the merit of a design for `target`.
    pub fn merit(&self, candidate: &Candidate, target: &Target) -> Merit {
        self.merit_within(candidate, target, 0.0)
    }

    /// Returns the merit of a design for `target` if all limits are relaxed by `slack`.
    ///
    /// The limits are requirements and lower bounds of objectives. `slack` is relative to each
    /// limit.
    pub fn merit_within(&self, candidate: &Candidate, target: &Target, slack: f64) -> Merit {
        let Judgement::Judged(worth) = &candidate.verdict else { return Merit::None };
        let short = target.lower_bounds.iter().map(|&(k, bound)| {
            (bound - self.judge.sign(k) * worth.objectives[k]) / bound_size(bound)
        });
        let bound_shortfall = short.fold(0.0, f64::max);
        let is_met = worth.met || worth.shortfall() < slack;
        // Lower bounds of objectives tolerate round-off, as requirements do.
        if is_met && bound_shortfall <= slack.max(1e-9) {
            return Merit::Met(
                self.judge.sign(target.objective) * worth.compared[target.objective],
            );
        }
        Merit::Short(worth.shortfall().max(bound_shortfall).max(f64::MIN_POSITIVE))
    }

    /// Optimises the variables of the `scaling` intervals one after the other, from `start`.
    ///
    /// Returns the best design for `target`. Scaling intervals only change columns in physical
    /// units, so all evaluated designs share one solution.
    pub fn scaled(
        &self,
        target: &Target,
        start: &Candidate,
        scaling: &[usize],
    ) -> Result<Candidate, Halt> {
        let mut best = start.clone();
        for &j in scaling {
            let (mut from, mut to) = (0.0, 1.0);
            // Each round narrows the range to a quarter: two of eight steps, around the best
            // design. After 15 rounds the range has 4⁻¹⁵ ≈ 10⁻⁹ of its first width.
            for _ in 0..SCALINGS {
                let step = (to - from) / f64::from(STEPS);
                for k in 0..=STEPS {
                    let mut point = best.point.clone();
                    point.fractions[j] = (from + step * f64::from(k)).min(1.0);
                    // This search compares values only, so it needs no derivatives.
                    let evaluated = self.evaluate(SearchStage::Gradient, &point, false)?.0;
                    if self.merit(&evaluated, target).compare(self.merit(&best, target)).is_gt() {
                        best = evaluated;
                    }
                }
                (from, to) = (best.point.fractions[j] - step, best.point.fractions[j] + step);
                (from, to) = (from.max(0.0), to.min(1.0));
            }
        }
        Ok(best)
    }

    /// Returns the expected work of an evaluation in a local search for `target`.
    ///
    /// The unit is the work for a space-filling point.
    pub fn evaluation_units(&self, target: &Target) -> u64 {
        let units = evaluation_units(self.judge.samples().map_or(0, |judge| judge.count));
        // Searches for neighbouring points of a front share about half of their evaluations.
        if target.lower_bounds.is_empty() { units } else { units / 2 }
    }

    /// Returns the termination tolerances for the goal.
    fn fineness(&self) -> Fineness {
        if self.judge.samples().is_some() { Fineness::SAMPLED } else { Fineness::NOMINAL }
    }

    /// Returns the best of `candidates` for `target`; `None` if none has a valid judgement.
    pub fn best<'c>(
        &self,
        candidates: impl Iterator<Item = &'c Candidate> + Clone,
        target: &Target,
    ) -> Option<&'c Candidate> {
        let index = best(candidates.clone().map(|candidate| self.merit(candidate, target)))?;
        candidates.into_iter().nth(index)
    }

    /// Runs a local search for `target` from `start`.
    ///
    /// The choices (discrete variables) keep their values. A search that converges to a design with
    /// a merit clearly below `to_beat` ends early. Returns all evaluated designs except `start`.
    pub fn improve(
        &self,
        target: &Target,
        start: &Candidate,
        effort: Effort,
        to_beat: Merit,
    ) -> Result<Vec<Candidate>, Halt> {
        self.progress.start();
        let units = self.evaluation_units(target);
        let local = LocalSearch {
            search: self,
            target,
            to_beat,
            solves_all_positions: Cell::new(false),
            best: RefCell::new(start.clone()),
            log: RefCell::default(),
            ends: RefCell::new(FollowedPoints::from_start(start)),
            units,
            task: self.progress.task(effort.evaluations * units),
        };
        // Without intervals there is nothing to vary, because the choices are fixed.
        if start.point.fractions.is_empty() {
            return Ok(Vec::new());
        }
        let effort = if self.judge.samples().is_some() { effort.on_samples() } else { effort };
        local.run(effort)?;
        // A full search ends if the results at all load positions confirm its best design.
        // Otherwise the search continues and solves all load positions of each design.
        if effort.rounds > 0 && local.positions(&local.best.borrow().point) == Positions::Corners {
            local.solves_all_positions.set(true);
            let is_confirmed = local.follow_best()?;
            if !is_confirmed {
                local.run(effort)?;
            }
        }
        Ok(local.log.take())
    }
}

/// Returns the size by which a shortfall below the lower bound `bound` is divided.
pub(crate) fn bound_size(bound: f64) -> f64 {
    if bound == 0.0 { 1.0 } else { bound.abs() }
}

/// Returns true if the merit improved by more than the fraction `gain`.
fn gained(before: Merit, after: Merit, gain: f64) -> bool {
    match (before, after) {
        (Merit::Met(before), Merit::Met(after)) => after - before > gain * before.abs(),
        (Merit::Short(before), Merit::Short(after)) => before - after > gain * before,
        // The design has become feasible, or has obtained a valid judgement.
        _ => before != after,
    }
}

/// State of a local search: the best design so far, and a log of all evaluated designs.
struct LocalSearch<'a> {
    search: &'a Search<'a>,
    target: &'a Target,
    /// Merit of a known design. The search ends if it converges to a design that is clearly worse.
    to_beat: Merit,
    /// True if all load positions are solved, because the corners do not represent them.
    solves_all_positions: Cell<bool>,
    best: RefCell<Candidate>,
    log: RefCell<Vec<Candidate>>,
    ends: RefCell<FollowedPoints>,
    /// Work of an evaluation; the unit is the work for a space-filling point.
    units: u64,
    task: SearchTask<'a>,
}

impl LocalSearch<'_> {
    /// Runs the gradient search, then rounds of ridge search and derivative-free search.
    ///
    /// After each of these searches that improves the design, a gradient search continues.
    fn run(&self, effort: Effort) -> Result<(), Halt> {
        let (mut reach, variables) = (effort.reach, self.best_shares().len());
        // A full search starts at the last design of a gradient search, which may be an optimum.
        if effort.rounds > 0 && self.is_certain()? {
            return Ok(());
        }
        let is_converged = self.search_by_derivatives(effort)?;
        for _ in 0..effort.rounds {
            if is_converged || self.is_certain()? {
                break;
            }
            let start = self.best_merit();
            // The ridge search precedes the direct search: tangents give the direction along the
            // ridge, and the polls of a direct search rarely have this direction.
            self.search_ridge(reach, effort.ridge * variables)?;
            if self.continue_to_optimum(start, effort)? {
                break;
            }
            let before = self.best_merit();
            if effort.polish > 0 {
                self.polish(reach, effort.polish * variables)?;
            }
            if self.continue_to_optimum(before, effort)? || !self.has_gained(start) {
                break;
            }
            reach *= 0.3;
        }
        // A design below the merit to beat is at most the start of another search, which follows it
        // from rest.
        if self.best_merit().compare(self.to_beat).is_ge() {
            self.follow_best()?;
        }
        Ok(())
    }

    /// Continues with a gradient search if the design has improved from the merit `before`.
    ///
    /// Returns true if the best design is then an optimum.
    fn continue_to_optimum(&self, before: Merit, effort: Effort) -> Result<bool, Halt> {
        Ok(self.has_gained(before) && (self.search_by_derivatives(effort)? || self.is_certain()?))
    }

    /// Returns true if the merit of the best design has clearly improved from `before`.
    fn has_gained(&self, before: Merit) -> bool {
        gained(before, self.best_merit(), self.search.fineness().gain)
    }

    /// Runs a search by derivatives from the best design.
    ///
    /// Returns true if the search converged to a design that meets a required yield.
    fn search_by_derivatives(&self, effort: Effort) -> Result<bool, Halt> {
        if let Some(required) = self.required_yield() {
            let converged = match self.yield_search(required, effort.yield_evaluations) {
                // The steps have become too small.
                Err(Halt::Stalled) => matches!(self.best_merit(), Merit::Met(_)),
                converged => converged?,
            };
            if converged {
                return Ok(true);
            }
        }
        // No yield is required, or the linear model of the yield search failed. The model fails if
        // values of samples jump.
        self.gradient_search(effort)?;
        Ok(false)
    }

    /// Evaluates the design at the fractions `shares` of the intervals, and logs it.
    ///
    /// The choices are the choices of the start.
    fn at(
        &self,
        stage: SearchStage,
        shares: &[f64],
        differentiated: bool,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        let point = self.point(shares);
        let result = self.solved(&point, differentiated)?;
        let evaluated = self.search.judged(stage, &point, result, differentiated)?;
        self.note(&evaluated.0);
        Ok(evaluated)
    }

    /// Returns the point at the fractions `shares` of the intervals, with the choices of the start.
    fn point(&self, shares: &[f64]) -> SpacePoint {
        let chosen = self.best.borrow().point.chosen.clone();
        // Set fractions near an end to this end: tables should show 60, not 59.99999999999999.
        let ended = shares.iter().map(|share| match *share {
            share if share < ROUND_OFF => 0.0,
            share if share > 1.0 - ROUND_OFF => 1.0,
            share => share,
        });
        SpacePoint { fractions: ended.collect(), chosen }
    }

    /// Solves the design at `point`, if possible starting from the path end of a similar design.
    ///
    /// The similar design is the nearest one with a path that this local search has followed from
    /// rest. Path ends of other local searches are not used, so results do not depend on the number
    /// of threads.
    fn solved(&self, point: &SpacePoint, differentiated: bool) -> Result<Arc<DesignResult>, Halt> {
        let (evaluations, positions) = (self.search.evaluations, self.positions(point));
        if !evaluations.has_ends(point) {
            return evaluations.solve(point, differentiated, positions);
        }
        if let Some(near) = self.ends.borrow().nearest(point, differentiated)
            && let Some(result) = evaluations.solve_near(point, differentiated, near, positions)?
        {
            return Ok(result);
        }
        self.ends.borrow_mut().add(point, differentiated);
        evaluations.solve(point, differentiated, positions)
    }

    /// Evaluates the design at `point`. The puncture path of the design is followed from rest.
    fn evaluate(
        &self,
        stage: SearchStage,
        point: &SpacePoint,
        differentiated: bool,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        self.search.evaluate_at(stage, point, differentiated, self.positions(point))
    }

    /// Returns the load positions at which this search solves the design at `point`.
    fn positions(&self, point: &SpacePoint) -> Positions {
        if self.solves_all_positions.get() {
            Positions::All
        } else {
            self.search.evaluations.compared_positions(point)
        }
    }

    /// Adds a design to the log, and updates the best design.
    fn note(&self, candidate: &Candidate) {
        // SLSQP requests cost, gradient and limits at one point in succession. Log the point once.
        if self.log.borrow().iter().rev().take(3).any(|other| other.point == candidate.point) {
            return;
        }
        self.task.count(self.units);
        self.log.borrow_mut().push(candidate.clone());
        let merit = self.search.merit(candidate, self.target);
        if merit.compare(self.best_merit()).is_gt() {
            *self.best.borrow_mut() = candidate.clone();
        }
    }

    /// Follows the path of the best design from rest, to verify its result.
    ///
    /// If the new result differs, it replaces the old one, and the best design of the log is
    /// verified next. Returns true if the first verified design keeps its result.
    fn follow_best(&self) -> Result<bool, Halt> {
        for count in 0.. {
            let best = self.best.borrow().clone();
            if !self.search.evaluations.has_ends(&best.point) {
                return Ok(true);
            }
            let followed = self.evaluate(best.stage, &best.point, true)?.0;
            let merits = [&best, &followed].map(|of| self.search.merit(of, self.target));
            let mut log = self.log.borrow_mut();
            for known in log.iter_mut().filter(|known| known.point == best.point) {
                *known = Candidate { stage: known.stage, ..followed.clone() };
            }
            *self.best.borrow_mut() = followed;
            if merits[0].agrees(merits[1]) {
                return Ok(count == 0);
            }
            let next = self.search.best(log.iter(), self.target);
            let Some(next) = next.filter(|next| next.point != best.point) else { break };
            *self.best.borrow_mut() = next.clone();
        }
        Ok(false)
    }

    /// Returns the merit of the best design.
    fn best_merit(&self) -> Merit {
        self.search.merit(&self.best.borrow(), self.target)
    }

    /// Returns the continuous variables of the best design, as fractions of their intervals.
    fn best_shares(&self) -> Vec<f64> {
        self.best.borrow().point.fractions.clone()
    }
}
