//! Fitness of a design (Eq. 7 of Shafiei et al. 2021) with fixed worst and best values.
//!
//! The criteria `c` are rescaled to `s_c` and weighted by `w_c`. Unlike in a ranking, the worst and
//! best values do not depend on the other designs.
//!
//! ```text
//! f = Π s_c^w_c,    s_c = (c − worst c)/(best c − worst c),    0 if an s_c is not positive    (O3)
//! ∂f/∂q = f Σ (w_c/s_c) ∂s_c/∂q                                                              (O4)
//! ```

use results::columns::Goal;

use crate::criterion::Criterion;
use crate::scale::Scale;
use crate::weights::Weights;

/// Criteria of a fitness, with their weights and the worst and best values that the goal gives.
#[derive(Clone, Debug, PartialEq)]
pub struct FitnessGoal {
    /// Criteria.
    pub criteria: Vec<Criterion>,
    /// Weights of the criteria.
    pub weights: Weights,
    /// Worst and best values that the goal gives; the search samples the values of other criteria.
    pub ends: Vec<CriterionEnds>,
}

/// The worst and the best value of a column, between which its criterion is rescaled.
#[derive(Clone, Debug, PartialEq)]
pub struct CriterionEnds {
    /// Column name.
    pub column: String,
    /// Value at which the rescaled criterion is 0.
    pub worst: f64,
    /// Value at which the rescaled criterion is 1. A design may be better than this value.
    pub best: f64,
}

/// Direction and weight of a criterion, and its values at the worst and the best end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RescaledCriterion {
    goal: Goal,
    weight: f64,
    /// Criterion at the worst and at the best value of the column; `None` if these are unknown.
    ends: Option<(f64, f64)>,
}

impl CriterionEnds {
    /// Returns the worst and the best of `values`, which are values of the column of `criterion`.
    ///
    /// `None` if no value can be converted to a criterion (R1).
    pub fn of(criterion: &Criterion, values: impl Iterator<Item = f64>) -> Option<Self> {
        // Ignore values that give no criterion, such as a penetration of 0, which has no inverse.
        let (low, high) = values
            .filter(|value| Scale::Paper.criterion(criterion.goal, *value).is_some())
            .map(|value| (value, value))
            .reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))?;
        let (worst, best) =
            if criterion.goal == Goal::Maximize { (low, high) } else { (high, low) };
        Some(Self { column: criterion.column.to_string(), worst, best })
    }
}

impl FitnessGoal {
    /// Returns the criteria with a positive weight, rescaled between `ends`.
    pub fn rescaled(
        &self,
        ends: &[CriterionEnds],
    ) -> impl Iterator<Item = (&Criterion, RescaledCriterion)> {
        let weighted = self.criteria.iter().zip(self.weights.values());
        // Ignore criteria without weight (R3), even if they have no ends or no value.
        weighted.filter(|(_, weight)| **weight > 0.0).map(|(criterion, &weight)| {
            let goal = criterion.goal;
            let ends = ends.iter().find(|ends| ends.column == criterion.column);
            let ends = ends.and_then(|ends| {
                let [worst, best] =
                    [ends.worst, ends.best].map(|end| Scale::Paper.criterion(goal, end));
                Some((worst?, best?))
            });
            (criterion, RescaledCriterion { goal, weight, ends })
        })
    }
}

impl RescaledCriterion {
    /// Returns the rescaled criterion of `value`: 0 at the worst end, 1 at the best (R2).
    ///
    /// `None` if the ends are unknown, or if `value` cannot be converted to a criterion (R1).
    fn of(&self, value: f64) -> Option<f64> {
        Some(rescaled(Scale::Paper.criterion(self.goal, value)?, self.ends?))
    }

    /// Returns the term `w ln s` of the logarithm of the fitness, for a value of the column.
    pub fn part(&self, value: f64) -> Option<f64> {
        // The term is −∞ at and beyond the worst end, so that the fitness is 0 (O3).
        Some(self.weight * self.of(value)?.max(0.0).ln())
    }

    /// Returns the derivative of [`Self::part`] with respect to the value.
    ///
    /// The derivative is 0 if both ends are equal, because the rescaled criterion is then always 1.
    pub fn rate(&self, value: f64) -> Option<f64> {
        let (worst, best) = self.ends?;
        // Callers never differentiate where `rescaled` is 0, because the fitness is 0 there.
        let rescaled = self.of(value)?;
        // The criterion of a minimised column is the inverse of its value (R1).
        let slope = if self.goal == Goal::Maximize { 1.0 } else { -value.powi(-2) };
        Some(if best > worst { self.weight * slope / ((best - worst) * rescaled) } else { 0.0 })
    }
}

/// Rescales a value linearly: 0 for the smallest value `low`, 1 for the largest value `high` (R2).
///
/// Returns 1 if `low` and `high` are equal, so that the criterion does not change the fitness.
pub(crate) fn rescaled(value: f64, (low, high): (f64, f64)) -> f64 {
    if high > low { (value - low) / (high - low) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fitness_exceeds_one_beyond_the_best_end_and_is_zero_beyond_the_worst() {
        let criterion = Criterion::new("coverage", Goal::Maximize);
        let found = CriterionEnds::of(&criterion, [0.2, 0.7, 0.4].into_iter()).expect("ends");
        assert_eq!((found.worst, found.best), (0.2, 0.7));
        let goal = FitnessGoal {
            criteria: vec![criterion, Criterion::new("gap_over_t", Goal::Minimize)],
            weights: Weights::new(&[1.0, 3.0]).expect("weights"),
            ends: vec![CriterionEnds { column: "gap_over_t".to_owned(), worst: 1.0, best: 0.5 }],
        };
        let ends = [found, goal.ends[0].clone()];
        let parts: Vec<RescaledCriterion> = goal.rescaled(&ends).map(|(_, part)| part).collect();
        let fitness = |coverage: f64, gap: f64| {
            (parts[0].part(coverage).expect("a part") + parts[1].part(gap).expect("a part")).exp()
        };
        // The inverse of the gap, 1.5, is halfway between 1 (worst) and 2 (best).
        let gap = 1.0 / 1.5;
        for (coverage, rescaled) in [(0.7, 1.0_f64), (0.45, 0.5), (1.2, 2.0)] {
            let expected = rescaled.powf(0.25) * 0.5_f64.powf(0.75);
            assert!((fitness(coverage, gap) - expected).abs() < 1e-14);
        }
        assert_eq!([fitness(0.2, gap), fitness(0.1, gap)], [0.0, 0.0]);
        let rate = (parts[1].part(gap + 1e-6).expect("a part")
            - parts[1].part(gap - 1e-6).expect("a part"))
            / 2e-6;
        assert!((parts[1].rate(gap).expect("a rate") - rate).abs() < 1e-8);
        assert!(goal.rescaled(&[]).all(|(_, part)| part.part(0.5).is_none()));
    }
}
