//! Search for designs with a required yield: discards samples and keeps the others feasible.
//!
//! With a yield `y`, `⌊(1 − y)N⌋` of `N` samples may miss a requirement. Around a design, the
//! search linearises the excess of each sample over each requirement with the derivatives of the
//! nominal design, and discards those samples that restrict the objective most. The step `d` solves
//! a linear program, in which `e_k` is the largest excess of the kept samples over requirement `k`:
//!
//! ```text
//! min ∇f·d    subject to    e_k + ∇c_k·d ≤ 0,    |d| ≤ r                                 (O11)
//! ```
//!
//! This is the scenario approach with discarded constraints (Campi & Garatti 2011, doi
//! 10.1007/s10957-010-9754-6). A gradient search that uses only the sample at the quantile (O6)
//! zigzags, because another sample is at the quantile after almost every step.

use super::LocalSearch;
use super::bundle::distance;
use super::linear_model::{Cut, Model};
use super::problem::LocalProblem;
use crate::candidate::{Merit, SearchStage};
use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::sample::deciding_index;
use crate::slopes::Slopes;

/// First trust radius, as a fraction of the ranges of the variables.
const REACH: f64 = 0.1;

/// Trust radius below which the search ends, as a fraction of the ranges of the variables.
const SMALLEST: f64 = 1e-3;

/// Predicted gain at which the search ends, for a cost of about 1.
///
/// With a few hundred samples, the uncertainty of the best cost exceeds this gain.
const GAIN: f64 = 2e-3;

/// Predicted gain up to which a search that stalls counts as converged.
///
/// The search stalls if different samples must be discarded after each step.
const STALLED_GAIN: f64 = 1e-2;

/// Minimum fraction of the predicted gain for which a step is accepted.
const ENOUGH: f64 = 0.1;

/// Minimum fraction of the predicted gain for which the trust radius grows.
const PLENTY: f64 = 0.5;

/// Penalty on the cost for one unit of excess. Costs and excesses are about 1.
const PENALTY: f64 = 10.0;

/// Smallest and largest margin to the limits at which steps aim.
const MARGINS: [f64; 2] = [1e-6, 1e-3];

/// Initial ratio of the margin to the excess, and factor of this ratio after a rejected step.
///
/// Steps aim at a margin inside the limits, because samples near a limit have other derivatives
/// than the nominal design. Without a margin each step would leave about a quarter of the excess.
const OVERSHOOT: [f64; 2] = [0.5, 4.0];

/// Largest excess for which the linear model is used.
///
/// At a larger excess, a measure of the samples has usually jumped, e.g. the compliance at contact.
const FAR: f64 = 0.5;

/// Number of rounds in which samples are discarded.
const ROUNDS: usize = 10;

impl LocalSearch<'_> {
    /// Returns the index of the requirement on the yield; `None` if the goal requires no yield.
    pub(super) fn required_yield(&self) -> Option<usize> {
        let judge = self.search.judge;
        judge.uses().find_map(|(of, _)| match of {
            StatisticUse::Requirement(k) => judge.is_yield(of).then_some(k),
            StatisticUse::Objective(_) => None,
        })
    }

    /// Improves the best design with at most `most` evaluations.
    ///
    /// `required` is the index of the requirement on the yield. Returns true if the search
    /// converged, i.e. the predicted gain of the next step is negligible.
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
                // Increase the margin before the steps are shortened.
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

/// Linear model of a design: cost, limits and samples with their gradients.
///
/// Gradients are with respect to the fractions of the intervals.
struct YieldModel {
    /// Cost of the design, and its gradient.
    cost: (f64, Vec<f64>),
    /// Excess over each limit of the nominal design, and its gradient.
    limits: Vec<(f64, Vec<f64>)>,
    /// Gradient of the excess of the nominal design over each requirement on the samples.
    gradients: Vec<Vec<f64>>,
    /// Excess of each sample (first index) over each requirement (second index).
    samples: Vec<Vec<f64>>,
    /// Excess of the sample that decides the yield.
    deciding: f64,
    /// Number of samples that may be discarded.
    discards: usize,
}

/// End point of a step, and the merit that the linear model predicts there.
struct Step {
    to: Vec<f64>,
    merit: f64,
}

impl YieldModel {
    /// Evaluates the design at the fractions `shares` of the intervals, and linearises it.
    ///
    /// `required` is the index of the requirement on the yield. `None` if the design has no valid
    /// judgement or lacks derivatives.
    fn at(
        local: &LocalSearch<'_>,
        problem: &LocalProblem<'_>,
        shares: &[f64],
        required: usize,
    ) -> Result<Option<Self>, Halt> {
        let Some(evaluated) = problem.evaluate(shares)? else { return Ok(None) };
        let judge = local.search.judge;
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
        let point = local.point(shares);
        let values = local.search.evaluations.samples(&point, 1, samples.count, samples)?;
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
            discards: requirement
                .map_or(0, |requirement| deciding_index(requirement, samples.count)),
        }))
    }

    /// Returns the largest excess over a limit; at most 0 for a feasible design.
    fn excess(&self) -> f64 {
        self.limits.iter().map(|limit| limit.0).fold(self.deciding, f64::max)
    }

    /// Returns the cost with the penalty on the excess; smaller is better.
    fn merit(&self) -> f64 {
        self.cost.0 + PENALTY * self.excess().max(0.0)
    }

    /// Selects the samples to discard, and returns the best step within `radius`.
    ///
    /// `overshoot` is the ratio of the margin to the excess. `None` if more samples lack a value
    /// than may be discarded.
    fn step(&self, centre: &[f64], radius: f64, overshoot: f64) -> Option<Step> {
        let mut kept: Vec<usize> = (0..self.samples.len()).collect();
        // Discard samples without a value first.
        kept.retain(|sample| self.samples[*sample].iter().all(|excess| excess.is_finite()));
        let mut remaining = (self.discards + kept.len()).checked_sub(self.samples.len())?;
        let margin = (overshoot * self.excess()).clamp(MARGINS[0], MARGINS[1]);
        let each = remaining.div_ceil(ROUNDS).max(1);
        while remaining > 0 {
            // Find the requirement for which the merit would improve most if all remaining discards
            // were used for it. The few discards of this round alone may not improve the merit,
            // because other samples have the same excess.
            let gains = (0..self.gradients.len()).filter_map(|k| {
                Some((
                    self.solve(centre, radius, margin, &self.without(&kept, k, remaining))?.merit,
                    k,
                ))
            });
            let (_, k) = gains.min_by(|a, b| a.0.total_cmp(&b.0))?;
            kept = self.without(&kept, k, each.min(remaining));
            remaining -= each.min(remaining);
        }
        self.solve(centre, radius, margin, &kept)
    }

    /// Returns `kept` without the `count` samples that have the largest excess over requirement
    /// `k`.
    fn without(&self, kept: &[usize], k: usize, count: usize) -> Vec<usize> {
        let mut sorted = kept.to_vec();
        sorted.sort_by(|a, b| self.samples[*b][k].total_cmp(&self.samples[*a][k]));
        sorted.split_off(count)
    }

    /// Solves the linear program (O11) with the `kept` samples.
    ///
    /// The step ends at the distance `margin` inside the limits, if possible.
    fn solve(&self, centre: &[f64], radius: f64, margin: f64, kept: &[usize]) -> Option<Step> {
        let largest = |k: usize| kept.iter().map(|s| self.samples[*s][k]).fold(f64::MIN, f64::max);
        let rows: Vec<(f64, &[f64])> = self
            .limits
            .iter()
            .map(|(excess, gradient)| (*excess, gradient.as_slice()))
            .chain(self.gradients.iter().enumerate().map(|(k, g)| (largest(k), g.as_slice())))
            .collect();
        // Minimise the excess within the radius first. Then minimise the cost without a larger
        // excess.
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

    /// Returns a model of 50 samples with the requirements `x ≤ 0.5` and `y ≤ 0.5`.
    ///
    /// Five samples require `x ≤ 0.4` instead, and five others `y ≤ 0.4`. The cost is `−x − 10 y`.
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
    fn samples_that_restrict_the_objective_most_are_discarded() {
        for (discards, to) in [(0, [0.4, 0.4]), (5, [0.4, 0.5]), (10, [0.5, 0.5])] {
            let step = model(discards).step(&[0.5, 0.5], 0.2, 0.5).expect("a step");
            // Steps end at a distance of 0.001 inside the limits.
            assert!(distance(&step.to, &to.map(|x| x - 1e-3)) < 1e-6, "{discards}: {:?}", step.to);
        }
    }

    #[test]
    fn samples_without_a_value_are_discarded_first() {
        let mut model = model(5);
        for sample in 10..13 {
            model.samples[sample][1] = f64::INFINITY;
        }
        // Three of the five discards are needed for samples without a value. The other two cannot
        // remove all five samples that require `y ≤ 0.4`.
        let step = model.step(&[0.5, 0.5], 0.2, 0.5).expect("a step");
        assert!(distance(&step.to, &[0.399, 0.399]) < 1e-6, "{:?}", step.to);
        model.discards = 2;
        assert!(model.step(&[0.5, 0.5], 0.2, 0.5).is_none(), "too many samples lack a value");
    }
}
