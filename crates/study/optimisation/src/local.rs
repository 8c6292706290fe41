//! The search from one design to a better one near by: along exact derivatives, along ridges where those end at kinks, and without
//! derivatives where values jump.

mod bundle;
mod gradient_search;
mod polish;
mod problem;
mod ridge;
mod samples;

use std::cell::RefCell;

use crate::candidate::{Candidate, Merit, SearchStage, Target, best};
use crate::evaluated_row::EvaluatedRow;
use crate::evaluations::{Evaluations, Halt};
use crate::judge::Judge;
use crate::judgement::Judgement;
use crate::progress::SearchProgress;
use crate::space::{DesignSpace, SpacePoint};
use samples::SampledPoint;

/// Rounds along ridges, without derivatives, and along derivatives again, at most.
const ROUNDS: usize = 4;

/// Round-off of a share.
const ROUND_OFF: f64 = 1e-13;

/// Steps of a scaling in each of its rounds.
const STEPS: u32 = 8;

/// Rounds of a scaling.
const SCALINGS: usize = 15;

/// How fine a local search becomes before it ends.
#[derive(Clone, Copy, Debug)]
struct Fineness {
    /// A relative gain below which a round has come to its end.
    gain: f64,
    /// The smallest step without derivatives, a share of the intervals.
    step: f64,
}

impl Fineness {
    /// Among nominal designs.
    const NOMINAL: Self = Self { gain: 1e-8, step: 1e-7 };
    /// Among sampled designs, whose number of samples leaves quantiles and yields uncertain by per cents.
    const SAMPLED: Self = Self { gain: 1e-3, step: 1e-4 };
}

/// The parts that all searches share: the space, its evaluations, the judge.
pub(crate) struct Search<'a> {
    pub space: &'a DesignSpace,
    pub evaluations: &'a Evaluations<'a>,
    pub judge: &'a Judge,
    pub progress: &'a SearchProgress,
}

/// How much a local search may take.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Designs of a climb for each variable, at most: a smooth one takes fewer, and one that takes more goes to and fro across a ridge.
    pub looks: u64,
    /// Pieces of coverage that a climb goes through.
    pub pieces: usize,
    /// Rounds.
    pub rounds: usize,
    /// First step along ridges and without derivatives, a share of the intervals.
    pub reach: f64,
    /// Designs along ridges in a round, for each variable.
    pub ridge: usize,
    /// Designs without derivatives in a round, for each variable.
    pub polish: usize,
}

impl Effort {
    /// A few steps along derivatives, which tell regions that are worth more.
    pub const PROBE: Self = Self { looks: 4, pieces: 1, ..Self::CLIMB };
    /// Along derivatives alone.
    pub const CLIMB: Self =
        Self { looks: 15, pieces: 2, rounds: 0, reach: 0.0, ridge: 0, polish: 0 };
    /// To the end.
    pub const WHOLE: Self =
        Self { rounds: ROUNDS, reach: 0.06, ridge: 20, polish: 8, ..Self::CLIMB };

    /// As much as it may take where each design costs as many solutions as it has samples.
    fn on_samples(self) -> Self {
        Self {
            looks: self.looks.min(8),
            rounds: self.rounds.min(2),
            ridge: self.ridge / 2,
            polish: self.polish / 2,
            ..self
        }
    }
}

impl Search<'_> {
    /// Looks at the design at `point`.
    pub fn evaluate(
        &self,
        stage: SearchStage,
        point: &SpacePoint,
        differentiated: bool,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        let Self { space, evaluations, .. } = *self;
        let result = evaluations.solve(point, differentiated)?;
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

    /// The merit of a design under a target.
    pub fn merit(&self, candidate: &Candidate, target: &Target) -> Merit {
        self.merit_within(candidate, target, 0.0)
    }

    /// The merit of a design that may miss requirements and floors by the part `slack` of their limits.
    pub fn merit_within(&self, candidate: &Candidate, target: &Target, slack: f64) -> Merit {
        let Judgement::Judged(worth) = &candidate.verdict else { return Merit::None };
        let turned = |k: usize| self.judge.sign(k) * worth.objectives[k];
        let short = target.floors.iter().map(|&(k, floor)| (floor - turned(k)) / floor_size(floor));
        let floors = short.fold(0.0, f64::max);
        let is_met = worth.met || worth.shortfall() < slack;
        // A floor is kept but for round-off, as a requirement is.
        if is_met && floors <= slack.max(1e-9) {
            return Merit::Met(
                self.judge.sign(target.objective) * worth.compared[target.objective],
            );
        }
        Merit::Short(worth.shortfall().max(floors).max(f64::MIN_POSITIVE))
    }

    /// The best design for a target among those that differ from `start` in intervals that only scale it, one after the other.
    pub fn scaled(
        &self,
        target: &Target,
        start: &Candidate,
        scaling: &[usize],
    ) -> Result<Candidate, Halt> {
        let mut best = start.clone();
        for &j in scaling {
            let (mut from, mut to) = (0.0, 1.0);
            // Each round leaves two of the steps round the best: fifteen rounds come to round-off of the shares.
            for _ in 0..SCALINGS {
                let step = (to - from) / f64::from(STEPS);
                for k in 0..=STEPS {
                    let mut point = best.point.clone();
                    point.shares[j] = (from + step * f64::from(k)).min(1.0);
                    // Without derivatives: a scaling only compares values, and all its designs share one solution.
                    let evaluated = self.evaluate(SearchStage::Gradient, &point, false)?.0;
                    if self.merit(&evaluated, target).compare(self.merit(&best, target)).is_gt() {
                        best = evaluated;
                    }
                }
                (from, to) = (best.point.shares[j] - step, best.point.shares[j] + step);
                (from, to) = (from.max(0.0), to.min(1.0));
            }
        }
        Ok(best)
    }

    fn fineness(&self) -> Fineness {
        if self.judge.samples().is_some() { Fineness::SAMPLED } else { Fineness::NOMINAL }
    }

    /// The best of some designs under a target.
    pub fn best<'c>(
        &self,
        candidates: impl Iterator<Item = &'c Candidate> + Clone,
        target: &Target,
    ) -> Option<&'c Candidate> {
        let index = best(candidates.clone().map(|candidate| self.merit(candidate, target)))?;
        candidates.into_iter().nth(index)
    }

    /// Improves `start` for `target`, its choices held; returns every design that was looked at, `start` not among them.
    pub fn improve(
        &self,
        target: &Target,
        start: &Candidate,
        effort: Effort,
    ) -> Result<Vec<Candidate>, Halt> {
        self.progress.start();
        let walk = LocalSearch {
            search: self,
            target,
            best: RefCell::new(start.clone()),
            log: RefCell::default(),
        };
        // Choices are held by every local search: without intervals there is nothing to move.
        if start.point.shares.is_empty() {
            return Ok(Vec::new());
        }
        let effort = if self.judge.samples().is_some() { effort.on_samples() } else { effort };
        let (mut reach, variables) = (effort.reach, start.point.shares.len());
        walk.climb(effort)?;
        for _ in 0..effort.rounds {
            let before = walk.best_merit();
            // Ridges first: tangents tell the way along them, which polls hardly find, since they know no direction
            // better than another.
            walk.follow(reach, effort.ridge * variables)?;
            walk.polish(reach, effort.polish * variables)?;
            if !gained(before, walk.best_merit(), self.fineness().gain) {
                break;
            }
            walk.climb(effort)?;
            reach *= 0.3;
        }
        Ok(walk.log.take())
    }
}

/// The size of a floor, which shortfalls are relative to.
pub(crate) fn floor_size(floor: f64) -> f64 {
    if floor == 0.0 { 1.0 } else { floor.abs() }
}

/// Whether a merit has become better by more than a part `gain` of it.
fn gained(before: Merit, after: Merit, gain: f64) -> bool {
    match (before, after) {
        (Merit::Met(before), Merit::Met(after)) => after - before > gain * before.abs(),
        (Merit::Short(before), Merit::Short(after)) => before - after > gain * before,
        // From short to met, or from nothing to short, is a gain whatever its size.
        _ => before != after,
    }
}

/// A local search that is under way.
struct LocalSearch<'a> {
    search: &'a Search<'a>,
    target: &'a Target,
    best: RefCell<Candidate>,
    log: RefCell<Vec<Candidate>>,
}

impl LocalSearch<'_> {
    /// The design at `shares` of the intervals, with the choices of the start.
    fn at(
        &self,
        stage: SearchStage,
        shares: &[f64],
        differentiated: bool,
    ) -> Result<(Candidate, EvaluatedRow), Halt> {
        let chosen = self.best.borrow().point.chosen.clone();
        // An end that is missed by round-off is meant: tables show 60, not 59.99999999999999.
        let ended = |share: &f64| match *share {
            share if share < ROUND_OFF => 0.0,
            share if share > 1.0 - ROUND_OFF => 1.0,
            share => share,
        };
        let shares = shares.iter().map(ended).collect();
        let evaluated =
            self.search.evaluate(stage, &SpacePoint { shares, chosen }, differentiated)?;
        self.note(&evaluated.0);
        Ok(evaluated)
    }

    fn note(&self, candidate: &Candidate) {
        let is_known = |other: &Candidate| other.point == candidate.point;
        // Cost, gradient and limits of one place are asked for one after the other, and each looks at it: it is noted
        // once.
        if self.log.borrow().iter().rev().take(3).any(is_known) {
            return;
        }
        self.log.borrow_mut().push(candidate.clone());
        let merit = self.search.merit(candidate, self.target);
        if merit.compare(self.best_merit()).is_gt() {
            *self.best.borrow_mut() = candidate.clone();
        }
    }

    fn best_merit(&self) -> Merit {
        self.search.merit(&self.best.borrow(), self.target)
    }

    fn best_shares(&self) -> Vec<f64> {
        self.best.borrow().point.shares.clone()
    }
}
