//! Binding limits of a best design, with their multipliers.
//!
//! At an optimum of a smooth problem the gradient of the objective `o` (to be maximised) is
//! balanced by the gradients of the binding limits `g_k ≥ l_k`, each with a multiplier:
//!
//! ```text
//! ∇o + Σ μ_k ∇g_k = 0,   μ_k ≥ 0;      do/dl_k = −μ_k                                    (O1)
//! ```

use nalgebra::{DMatrix, DVector};
use sweep::{Measure, Parameter};

use crate::candidate::{Candidate, SearchStage, Target};
use crate::contact_margin::{contact_margin, contact_margin_slopes};
use crate::evaluated_row::{EvaluatedRow, StatisticUse};
use crate::evaluations::Halt;
use crate::judge::Judge;
use crate::judgement::Judgement;
use crate::local::{CLEAR, Search, bound_size};
use crate::sample::MissedRequirement;
use crate::slopes::Slopes;
use crate::space::{Interval, SpacePoint};

/// Margin, relative to the size of the limit, up to which a limit counts as binding.
const NEAR: f64 = 1e-5;

/// Like [`NEAR`], for a statistic. A search over samples converges less accurately.
const NEAR_SAMPLES: f64 = 1e-3;

/// Fraction of the gradient of the objective that multipliers may leave unbalanced.
const BALANCED: f64 = 1e-3;

/// Like [`BALANCED`], for an optimum that needs no confirmation by further searches.
const CERTAIN: f64 = 1e-5;

/// Like [`BALANCED`], for the nominal design of an optimum over samples.
///
/// This nominal design keeps a distance from the limits, so that its samples meet the limits.
const ROUGHLY: f64 = 0.2;

/// Minimum fraction of samples that miss a requirement if the requirement limits the design.
const OFTEN: f64 = 0.01;

/// A limit that binds at the best design, with its multiplier.
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    /// Limit that binds.
    pub limit: Limit,
    /// Loss of the objective for each unit by which the limit is tightened.
    ///
    /// Objective and limit are in the units of their columns. `None` for a required yield, and on a
    /// kink, where no multipliers balance the gradients.
    pub price: Option<f64>,
}

/// Kind of a limit that can bind at the best design.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// The requirement with this index.
    Requirement(usize),
    /// The lower bound of the objective with this index.
    ObjectiveBound(usize),
    /// The lower end of the interval with this index.
    Lower(usize),
    /// The upper end of the interval with this index.
    Upper(usize),
    /// First contact at the end of bending, where the compliance jumps.
    ///
    /// The distance from this limit is the logarithm (O2).
    FirstContact,
}

impl Limit {
    /// Returns true if the limit is a required yield.
    ///
    /// A yield has no multiplier, because it is a step function.
    pub(crate) fn is_yield(&self, judge: &Judge) -> bool {
        matches!(*self, Self::Requirement(k) if judge.is_yield(StatisticUse::Requirement(k)))
    }
}

/// Returns the limits that bind at the design `best` for `target`, with their multipliers.
pub(crate) fn bindings(
    search: &Search<'_>,
    best: &Candidate,
    target: &Target,
) -> Result<Vec<Binding>, Halt> {
    let limits = binding_limits(search, best, target);
    // Evaluate the best design with derivatives. The direct search and the search along scaling
    // intervals evaluate designs without derivatives.
    let (evaluated, row) = search.evaluate(SearchStage::Gradient, &best.point, true)?;
    let is_whole = matches!(evaluated.verdict, Judgement::Judged(_));
    let prices = if is_whole { prices(search, &row, target, &limits, BALANCED) } else { None };
    let prices = each(prices, limits.len());
    let bindings = limits.into_iter().zip(prices).map(|(limit, price)| {
        let price = price.filter(|_| !limit.is_yield(search.judge));
        Binding { limit, price }
    });
    Ok(bindings.collect())
}

/// Returns the limits of an optimum over samples, with approximate multipliers.
///
/// The limits are the requirements that many samples miss (`missed`), and ends of intervals. The
/// multipliers are computed at the nominal design. `nominal` is the search with the goal for
/// nominal designs.
pub(crate) fn limits_of_samples(
    nominal: &Search<'_>,
    best: &Candidate,
    target: &Target,
    missed: &[MissedRequirement],
) -> Result<Vec<Binding>, Halt> {
    let mut limits = Vec::new();
    for (k, requirement) in nominal.judge.requirements().enumerate() {
        let mut often = missed.iter().filter(|missed| missed.share >= OFTEN);
        if often.any(|missed| missed.requirement.as_ref() == Some(requirement)) {
            limits.push(Limit::Requirement(k));
        }
    }
    limits.extend(end_limits(&best.point, NEAR));
    let row = nominal.evaluate(SearchStage::Gradient, &best.point, true)?.1;
    let prices = each(prices(nominal, &row, target, &limits, ROUGHLY), limits.len());
    Ok(limits.into_iter().zip(prices).map(|(limit, price)| Binding { limit, price }).collect())
}

/// Returns one multiplier for each of `count` limits; all are `None` if `prices` is `None`.
fn each(prices: Option<Vec<f64>>, count: usize) -> Vec<Option<f64>> {
    prices.map_or_else(|| vec![None; count], |prices| prices.into_iter().map(Some).collect())
}

/// Returns the limits that bind at `best`.
fn binding_limits(search: &Search<'_>, best: &Candidate, target: &Target) -> Vec<Limit> {
    near_limits(search, best, target, NEAR)
}

/// Returns the limits with a relative margin below `nearness` at `best`.
pub(crate) fn near_limits(
    search: &Search<'_>,
    best: &Candidate,
    target: &Target,
    nearness: f64,
) -> Vec<Limit> {
    let Judgement::Judged(worth) = &best.verdict else { return Vec::new() };
    let near =
        |of| if search.judge.is_statistic(of) { NEAR_SAMPLES.max(nearness) } else { nearness };
    let requirements = worth.margins.iter().enumerate();
    let required =
        requirements.filter(|(k, margin)| **margin < near(StatisticUse::Requirement(*k)));
    let mut limits: Vec<Limit> = required.map(|(k, _)| Limit::Requirement(k)).collect();
    for &(k, bound) in &target.lower_bounds {
        let signed = search.judge.sign(k) * worth.objectives[k];
        if signed - bound < near(StatisticUse::Objective(k)) * bound_size(bound) {
            limits.push(Limit::ObjectiveBound(k));
        }
    }
    limits.extend(end_limits(&best.point, nearness));
    let case = search.space.case(&best.point);
    let touches =
        search.judge.depends_on(Measure::Flexure) && contact_margin(&case).abs() < nearness;
    limits.extend(touches.then_some(Limit::FirstContact));
    limits
}

/// Returns the ends of the variables' intervals that are near `point`.
///
/// The distance is at most the fraction `nearness` of the interval.
fn end_limits(point: &SpacePoint, nearness: f64) -> Vec<Limit> {
    let mut limits = Vec::new();
    for (j, fraction) in point.fractions.iter().enumerate() {
        if *fraction <= nearness {
            limits.push(Limit::Lower(j));
        } else if *fraction >= 1.0 - nearness {
            limits.push(Limit::Upper(j));
        }
    }
    limits
}

/// Computes the multipliers of `limits`, in units of the objective per unit of the limit.
///
/// `None` at a kink, or if the multipliers leave more than the fraction `unbalanced` of the
/// gradient of the objective.
fn prices(
    search: &Search<'_>,
    row: &EvaluatedRow,
    target: &Target,
    limits: &[Limit],
    unbalanced: f64,
) -> Option<Vec<f64>> {
    let Gradients { objective, limits: columns } = Gradients::of(search, row, target, limits)?;
    let multipliers = multipliers(&columns, &objective, unbalanced)?;
    let intervals = search.space.intervals();
    let requirements: Vec<_> = search.judge.requirements().collect();
    let per_unit = limits.iter().zip(multipliers).map(|(limit, multiplier)| match *limit {
        Limit::Requirement(k) => multiplier / requirements[k].size(),
        Limit::ObjectiveBound(_) | Limit::FirstContact => multiplier,
        Limit::Lower(j) | Limit::Upper(j) => multiplier / intervals[j].length(),
    });
    Some(per_unit.collect())
}

/// Returns an upper bound of the first-order gain that remains at the design `best`.
///
/// The gain is relative to the objective. The second value is true if the bound depends on the
/// limit of first contact in bending. `None` at a kink, or if the multipliers do not balance the
/// gradient of the objective.
pub(crate) fn first_order_gain(
    search: &Search<'_>,
    best: &Candidate,
    row: &EvaluatedRow,
    target: &Target,
) -> Option<(f64, bool)> {
    let Judgement::Judged(worth) = &best.verdict else { return None };
    let limits = binding_limits(search, best, target);
    let gradients = Gradients::of(search, row, target, &limits)?;
    let multipliers = multipliers(&gradients.limits, &gradients.objective, CERTAIN)?;
    let mut gain = 0.0;
    for (limit, price) in limits.iter().zip(&multipliers) {
        let margin = match *limit {
            Limit::Requirement(k) => worth.margins[k],
            Limit::ObjectiveBound(k) => {
                let bound = target.lower_bounds.iter().find(|(other, _)| *other == k);
                let signed = search.judge.sign(k) * worth.objectives[k];
                bound.map_or(0.0, |(_, bound)| signed - bound)
            }
            Limit::Lower(j) => best.point.fractions[j],
            Limit::Upper(j) => 1.0 - best.point.fractions[j],
            // The search keeps this distance from contact.
            Limit::FirstContact => contact_margin(&search.space.case(&best.point)) - CLEAR,
        };
        gain += price * margin.max(0.0);
    }
    let mut needed = limits.iter().zip(&multipliers).filter(|(_, price)| **price > 0.0);
    let objective = worth.objectives[target.objective].abs();
    Some((gain / objective, needed.any(|(limit, _)| *limit == Limit::FirstContact)))
}

/// Gradients of an objective and of limits, with respect to the fractions of the intervals.
struct Gradients {
    /// Gradient of the objective to be maximised.
    objective: DVector<f64>,
    /// Gradient of the margin to each limit. The margin is positive if the limit is met.
    limits: Vec<DVector<f64>>,
}

impl Gradients {
    /// Returns the gradients at a differentiated design; `None` at a kink.
    fn of(
        search: &Search<'_>,
        row: &EvaluatedRow,
        target: &Target,
        limits: &[Limit],
    ) -> Option<Self> {
        let judge = search.judge;
        let intervals = search.space.intervals();
        // The multipliers balance the gradient of the objective along all variables. A kink along
        // one variable therefore leaves all multipliers unknown.
        let objective = gradient(intervals, |p| judge.objective_slopes(target.objective, row, p))?;
        let mut columns = Vec::new();
        for limit in limits {
            columns.push(match *limit {
                Limit::Requirement(k) => gradient(intervals, |p| judge.margin_slopes(k, row, p))?,
                Limit::ObjectiveBound(k) => {
                    gradient(intervals, |p| judge.objective_slopes(k, row, p))?
                }
                Limit::Lower(j) => unit(intervals.len(), j, 1.0),
                Limit::Upper(j) => unit(intervals.len(), j, -1.0),
                Limit::FirstContact => {
                    gradient(intervals, |p| contact_margin_slopes(&row.nominal.case, p))?
                }
            });
        }
        Some(Self { objective, limits: columns })
    }
}

/// Returns a gradient with respect to the fractions of the intervals; `None` at a kink.
///
/// `slopes` returns the derivatives with respect to a parameter.
fn gradient(intervals: &[Interval], slopes: impl Fn(&Parameter) -> Slopes) -> Option<DVector<f64>> {
    let slope = intervals
        .iter()
        .map(|interval| Some(slopes(interval.parameter).smooth()? * interval.length()));
    Some(DVector::from_vec(slope.collect::<Option<_>>()?))
}

/// Returns a vector of length `count` with `sign` at index `j` and zeros elsewhere.
fn unit(count: usize, j: usize, sign: f64) -> DVector<f64> {
    let mut unit = DVector::zeros(count);
    unit[j] = sign;
    unit
}

/// Computes the non-negative multipliers that balance the gradient `objective`, by least squares.
///
/// `columns` are the gradients of the margins. Limits with a negative multiplier are dropped, and
/// their multipliers are 0. Returns `None` if the multipliers leave more than the fraction
/// `unbalanced` of the gradient.
fn multipliers(
    columns: &[DVector<f64>],
    objective: &DVector<f64>,
    unbalanced: f64,
) -> Option<Vec<f64>> {
    // Normalise the columns, so that the result does not depend on the units of the limits.
    let norms: Vec<f64> = columns.iter().map(DVector::norm).collect();
    let mut open: Vec<usize> = (0..columns.len()).filter(|&k| norms[k] > 0.0).collect();
    loop {
        let mut all = vec![0.0; columns.len()];
        let rest = if open.is_empty() {
            objective.clone()
        } else {
            let scaled: Vec<_> = open.iter().map(|&k| &columns[k] / norms[k]).collect();
            let matrix = DMatrix::from_columns(&scaled);
            // Solve by SVD, because gradients of binding limits may be linearly dependent.
            let solved = matrix.clone().svd(true, true).solve(&-objective, 1e-12).ok()?;
            let least = (0..open.len()).min_by(|&a, &b| solved[a].total_cmp(&solved[b]))?;
            // Drop only the most negative multiplier: the other multipliers may then become
            // positive.
            if solved[least] < 0.0 {
                open.remove(least);
                continue;
            }
            open.iter().zip(solved.iter()).for_each(|(&k, x)| all[k] = x / norms[k]);
            objective + matrix * solved
        };
        return (rest.norm() <= unbalanced * objective.norm()).then_some(all);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(values: [f64; 2]) -> DVector<f64> {
        DVector::from_column_slice(&values)
    }

    #[test]
    fn multipliers_balance_the_gradient() {
        // Maximise x + 2 y with x ≤ 1 and x + y ≤ 1.5. At (1, 0.5), both limits bind.
        let columns = [vector([-1.0, -1.0]), vector([1.0, 0.0])];
        let found =
            multipliers(&columns, &vector([1.0, 2.0]), BALANCED).expect("balanced multipliers");
        assert!((found[0] - 2.0).abs() < 1e-12 && (found[1] - 1.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn limits_with_negative_multipliers_are_dropped() {
        let away = [vector([1.0, 0.0]), vector([0.0, -1.0])];
        assert_eq!(multipliers(&away, &vector([1.0, 0.0]), BALANCED), None);
        let found =
            multipliers(&away, &vector([0.0, 3.0]), BALANCED).expect("balanced multipliers");
        assert_eq!(found[0], 0.0);
        assert!((found[1] - 3.0).abs() < 1e-12);
        assert_eq!(multipliers(&[], &vector([0.0, 0.0]), BALANCED), Some(vec![]));
    }
}
