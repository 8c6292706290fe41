//! Search for designs with a required yield, by sampling and discarding.
//!
//! Of `N` samples, a yield `y` lets `⌊(1 − y)N⌋` miss a requirement. Around a design, the search
//! linearises the excess of every sample over every requirement with the derivatives of the nominal
//! design, and discards the samples that are most expensive to keep. The step `d` solves a linear
//! program, in which `e_k` is the largest excess over requirement `k` among the kept samples:
//!
//! ```text
//! min ∇f·d    subject to    e_k + ∇c_k·d ≤ 0,    |d| ≤ r                                 (O11)
//! ```
//!
//! This is the scenario approach with discarded constraints (Campi & Garatti 2011, doi
//! 10.1007/s10957-010-9754-6). A gradient search by the sample at the quantile alone zigzags
//! instead, because another sample decides after almost every step.

use super::LocalSearch;
use super::bundle::distance;
use super::linear_model::{Cut, Model};
use super::problem::LocalProblem;
use crate::candidate::{Merit, SearchStage};
use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::sample::needed;
use crate::slopes::Slopes;

/// First trust radius, as a fraction of the intervals.
const REACH: f64 = 0.1;

/// Trust radius at which the search ends.
const SMALLEST: f64 = 1e-3;

/// Predicted gain at which the search ends, for a cost of about 1.
///
/// It is less than the uncertainty of the cost at which a few hundred samples reach a yield.
const GAIN: f64 = 2e-3;

/// Predicted gain up to which a search that stalls has converged.
///
/// It stalls where other samples have to be discarded after every step.
const STALLED_GAIN: f64 = 1e-2;

/// Fraction of the predicted gain from which a step is accepted.
const ENOUGH: f64 = 0.1;

/// Fraction of the predicted gain from which the radius grows.
const PLENTY: f64 = 0.5;

/// Cost of one unit of excess. Costs and excesses are scaled to about 1.
const PENALTY: f64 = 10.0;

/// Least and largest margin of steps to limits.
const MARGINS: [f64; 2] = [1e-6, 1e-3];

/// Margin over the excess at the start of a step, and its growth after a rejected step.
///
/// The samples at the limits have other derivatives than the nominal design, so without a margin
/// each step leaves about a quarter of the excess.
const OVERSHOOT: [f64; 2] = [0.5, 4.0];

/// Excess of the deciding sample from which the linear model is not used.
///
/// Such samples have usually jumped, as the compliance does at contact.
const FAR: f64 = 0.5;

/// Number of rounds in which samples are discarded.
const ROUNDS: usize = 10;

impl LocalSearch<'_> {
    /// Returns the index of the requirement of a yield, if there is one.
    pub(super) fn required_yield(&self) -> Option<usize> {
        let judge = self.search.judge;
        judge.uses().find_map(|(of, _)| match of {
            StatisticUse::Requirement(k) => judge.is_yield(of).then_some(k),
            StatisticUse::Objective(_) => None,
        })
    }

    /// Improves the best design with at most `most` evaluations.
    ///
    /// Returns true if it converged: no step promises a gain.
    pub(super) fn yield_search(&self, required: usize, most: usize) -> Result<bool, Halt> {
        let Some(problem) = LocalProblem::new(self, SearchStage::Gradient, None, None) else {
            return Ok(false);
        };
        let [mut radius, mut overshoot] = [REACH, OVERSHOOT[0]];
        let mut centre = self.best_shares();
        let Some(mut model) = YieldModel::at(self, &problem, &centre, required)? else {
            return Ok(false);
        };
        if model.excess() > FAR {
            return Ok(false);
        }
        let mut gain = f64::INFINITY;
        for _ in 0..most {
            let Some(step) = model.step(&centre, radius, overshoot) else { break };
            gain = model.merit() - step.merit;
            if gain <= GAIN && model.excess() <= 0.0 {
                return Ok(true);
            }
            let next = YieldModel::at(self, &problem, &step.to, required)?;
            let gained =
                next.as_ref().map_or(f64::NEG_INFINITY, |next| model.merit() - next.merit());
            let reached = distance(&centre, &step.to);
            let is_nearly_met = model.excess() > 0.0 && model.excess() < MARGINS[1];
            match next {
                Some(next)
                    if gained >= ENOUGH * gain || (is_nearly_met && next.excess() <= 0.0) =>
                {
                    (centre, model, overshoot) = (step.to, next, OVERSHOOT[0]);
                    if gained >= PLENTY * gain && reached > 0.9 * radius {
                        radius *= 2.0;
                    }
                }
                // A larger margin instead of a smaller step, up to the largest margin.
                _ if is_nearly_met && overshoot * model.excess() < MARGINS[1] => {
                    overshoot *= OVERSHOOT[1];
                }
                _ => radius = 0.3 * reached.min(radius),
            }
            if radius < SMALLEST {
                break;
            }
        }
        Ok(gain <= STALLED_GAIN && matches!(self.best_merit(), Merit::Met(_)))
    }
}

/// Cost, limits and samples of a design, with derivatives by the fractions of the intervals.
struct YieldModel {
    cost: (f64, Vec<f64>),
    /// Excess over each limit of the nominal design, and its gradient.
    limits: Vec<(f64, Vec<f64>)>,
    /// Gradient of the excess over each requirement of the samples.
    gradients: Vec<Vec<f64>>,
    /// Excess of each sample over each requirement.
    samples: Vec<Vec<f64>>,
    /// Excess of the sample that decides the yield.
    deciding: f64,
    /// Number of samples that may be discarded.
    discards: usize,
}

/// End of a step, and the predicted merit.
struct Step {
    to: Vec<f64>,
    merit: f64,
}

impl YieldModel {
    /// Evaluates the design at `shares`; `None` if it cannot be judged or lacks derivatives.
    fn at(
        walk: &LocalSearch<'_>,
        problem: &LocalProblem<'_>,
        shares: &[f64],
        required: usize,
    ) -> Result<Option<Self>, Halt> {
        let Some(evaluated) = problem.evaluate(shares)? else { return Ok(None) };
        let judge = walk.search.judge;
        let Some(samples) = judge.samples() else { return Ok(None) };
        let excesses = problem.limits(&evaluated);
        let mut limits = Vec::new();
        for (k, &excess) in excesses.iter().enumerate().filter(|(k, _)| *k != required) {
            let gradient = problem.limit_gradient(k, shares, &evaluated, Slopes::uphill);
            let Some(gradient) = gradient else { return Ok(None) };
            limits.push((excess, gradient));
        }
        let bounds = &samples.bounds.all;
        let gradients = bounds.iter().map(|bound| {
            let rate = bound.requirement.margin_rate();
            let row = &evaluated.row.nominal;
            problem.falling(shares, |p| bound.column.slopes(row, p).scaled(rate), Slopes::uphill)
        });
        let gradient = problem.cost_gradient(shares, &evaluated, Slopes::uphill);
        let (Some(gradients), Some(gradient)) = (gradients.collect::<Option<_>>(), gradient) else {
            return Ok(None);
        };
        let point = walk.point(shares);
        let values = walk.search.evaluations.samples(&point, 1, samples.count, samples)?;
        let excess = |values: &Vec<Option<f64>>| {
            let both = bounds.iter().zip(values);
            both.map(|(bound, value)| -bound.requirement.counted_margin(*value)).collect()
        };
        let requirement = judge.requirements().nth(required);
        Ok(Some(Self {
            cost: (problem.cost_of(&evaluated.worth), gradient),
            limits,
            gradients,
            samples: values.0.iter().map(excess).collect(),
            deciding: excesses[required],
            discards: requirement.map_or(0, |requirement| needed(requirement, samples.count)),
        }))
    }

    /// Returns the largest excess over a limit; at most 0 for a feasible design.
    fn excess(&self) -> f64 {
        self.limits.iter().map(|limit| limit.0).fold(self.deciding, f64::max)
    }

    fn merit(&self) -> f64 {
        self.cost.0 + PENALTY * self.excess().max(0.0)
    }

    /// Returns the best step within `radius`, with the best samples to discard.
    ///
    /// `None` if more samples lack a value than may be discarded.
    fn step(&self, centre: &[f64], radius: f64, overshoot: f64) -> Option<Step> {
        let mut kept: Vec<usize> = (0..self.samples.len()).collect();
        // A sample without a value cannot be kept.
        kept.retain(|sample| self.samples[*sample].iter().all(|excess| excess.is_finite()));
        let mut left = (self.discards + kept.len()).checked_sub(self.samples.len())?;
        let margin = (overshoot * self.excess()).clamp(MARGINS[0], MARGINS[1]);
        let each = left.div_ceil(ROUNDS).max(1);
        while left > 0 {
            // The requirement for which all discards left would gain most. The next few samples
            // alone may gain nothing, because others have the same excess.
            let gains = (0..self.gradients.len()).filter_map(|k| {
                Some((self.solve(centre, radius, margin, &self.without(&kept, k, left))?.merit, k))
            });
            let (_, k) = gains.min_by(|a, b| a.0.total_cmp(&b.0))?;
            kept = self.without(&kept, k, each.min(left));
            left -= each.min(left);
        }
        self.solve(centre, radius, margin, &kept)
    }

    /// Returns `kept` without the `count` samples of the largest excess over requirement `k`.
    fn without(&self, kept: &[usize], k: usize, count: usize) -> Vec<usize> {
        let mut sorted = kept.to_vec();
        sorted.sort_by(|a, b| self.samples[*b][k].total_cmp(&self.samples[*a][k]));
        sorted.split_off(count)
    }

    /// Solves the linear program with the `kept` samples.
    fn solve(&self, centre: &[f64], radius: f64, margin: f64, kept: &[usize]) -> Option<Step> {
        let largest = |k: usize| kept.iter().map(|s| self.samples[*s][k]).fold(f64::MIN, f64::max);
        let rows: Vec<(f64, &[f64])> = self
            .limits
            .iter()
            .map(|(excess, gradient)| (*excess, gradient.as_slice()))
            .chain(self.gradients.iter().enumerate().map(|(k, g)| (largest(k), g.as_slice())))
            .collect();
        // First the least excess within the radius, then the least cost with this excess.
        let worst = rows.iter().map(|(excess, _)| *excess).fold(-margin, f64::max);
        let mut excess = worst;
        if worst > -margin {
            let mut model = Model::new(centre, radius, worst);
            for (excess, gradient) in &rows {
                model.push(Cut::Cost, gradient, worst - excess);
            }
            excess = model.step().map_or(worst, |(_, gain)| (worst - gain).max(-margin));
        }
        let mut model = Model::new(centre, radius, 0.0);
        model.push(Cut::Cost, &self.cost.1, 0.0);
        for (value, gradient) in &rows {
            model.push(Cut::Limit, gradient, excess - value);
        }
        let (to, gain) = model.step()?;
        Some(Step { to, merit: self.cost.0 - gain + PENALTY * excess.max(0.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples with the limits `x ≤ 0.5` and `y ≤ 0.5`: five have 0.1 less for `x`, five others 0.1
    /// less for `y`. The cost falls by 1 with `x` and by 10 with `y`.
    fn model(discards: usize) -> YieldModel {
        let excess = |sample: usize| match sample {
            0..5 => vec![0.1, 0.0],
            5..10 => vec![0.0, 0.1],
            _ => vec![0.0, 0.0],
        };
        YieldModel {
            cost: (0.0, vec![-1.0, -10.0]),
            limits: Vec::new(),
            gradients: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
            samples: (0..50).map(excess).collect(),
            deciding: 0.1,
            discards,
        }
    }

    #[test]
    fn samples_that_cost_most_are_discarded() {
        for (discards, to) in [(0, [0.4, 0.4]), (5, [0.4, 0.5]), (10, [0.5, 0.5])] {
            let step = model(discards).step(&[0.5, 0.5], 0.2, 0.5).expect("a step");
            // Steps aim at 0.001 inside the limits.
            assert!(distance(&step.to, &to.map(|x| x - 1e-3)) < 1e-6, "{discards}: {:?}", step.to);
        }
    }

    #[test]
    fn samples_without_a_value_are_discarded_first() {
        let mut model = model(5);
        for sample in 10..13 {
            model.samples[sample][1] = f64::INFINITY;
        }
        // Only two of the five samples that limit `y` can be discarded, which moves no limit.
        let step = model.step(&[0.5, 0.5], 0.2, 0.5).expect("a step");
        assert!(distance(&step.to, &[0.399, 0.399]) < 1e-6, "{:?}", step.to);
        model.discards = 2;
        assert!(model.step(&[0.5, 0.5], 0.2, 0.5).is_none(), "too many samples lack a value");
    }
}
