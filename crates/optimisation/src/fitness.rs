//! The fitness of a design (Eq. 7 of Shafiei et al. 2021): criteria, rescaled between ends that a search does not move, and weighted.
//!
//! ```text
//! f = Π s_c^w_c,    s_c = (c − worst c)/(best c − worst c),    0 where an s_c is not above 0          (O3)
//! ∂f/∂q = f Σ (w_c/s_c) ∂s_c/∂q                                                                      (O4)
//! ```

use ranking::{Criterion, Goal, Scale, Weights};
use results::columns::design_columns;
use results::{Column, DesignRow};
use sweep::{Parameter, Sweep};

use crate::number_column::{number, slopes};
use crate::slopes::Slopes;

/// The criteria of a fitness with their weights, and the ends that the goal gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct FitnessGoal {
    /// The criteria.
    pub criteria: Vec<Criterion>,
    /// Their weights.
    pub weights: Weights,
    /// The ends that the goal gives; the sample gives those of the other criteria.
    pub ends: Vec<CriterionEnds>,
}

/// The values of a column between which a criterion is rescaled.
#[derive(Clone, Debug, PartialEq)]
pub struct CriterionEnds {
    /// The column.
    pub column: String,
    /// The value of fitness 0.
    pub worst: f64,
    /// The value of fitness 1, which a design may surpass.
    pub best: f64,
}

/// Computes the fitness of designs.
pub(crate) struct Fitness {
    parts: Vec<RescaledCriterion>,
}

/// A criterion with its weight, and the criteria of the worst and of the best.
struct RescaledCriterion {
    goal: Goal,
    column: Column<DesignRow>,
    weight: f64,
    ends: Option<(f64, f64)>,
}

impl FitnessGoal {
    /// The ends of every criterion: those of the goal, and for the others the worst and the best of the `rows` that cover.
    pub(crate) fn ends_over(&self, sweep: &Sweep, rows: &[DesignRow]) -> Vec<CriterionEnds> {
        let covers = |row: &&DesignRow| row.result.coverage.is_none_or(|coverage| coverage > 0.0);
        let ends = |criterion: &Criterion| {
            let given = self.ends.iter().find(|ends| ends.column == criterion.column);
            let found = || {
                let column = column(sweep, &criterion.column)?;
                let values = rows.iter().filter(covers).filter_map(|row| number(&column, row));
                ends_of(criterion, values)
            };
            given.cloned().or_else(found)
        };
        self.criteria.iter().filter_map(ends).collect()
    }
}

/// The worst and the best of values that make a criterion.
fn ends_of(criterion: &Criterion, values: impl Iterator<Item = f64>) -> Option<CriterionEnds> {
    let made = |value: &f64| Scale::Paper.criterion(criterion.goal, *value).is_some();
    let values: Vec<f64> = values.filter(made).collect();
    let low = values.iter().copied().reduce(f64::min)?;
    let high = values.into_iter().reduce(f64::max)?;
    let (worst, best) = if criterion.goal == Goal::Maximize { (low, high) } else { (high, low) };
    Some(CriterionEnds { column: criterion.column.to_string(), worst, best })
}

fn column(sweep: &Sweep, name: &str) -> Option<Column<DesignRow>> {
    design_columns(sweep).into_iter().find(|column| column.name == name)
}

impl Fitness {
    /// The name of its column.
    pub const COLUMN: &'static str = "fitness";

    /// The meaning of its column.
    pub const MEANING: &'static str = "weighted geometric mean of the rescaled criteria (Eq. 7), by the weights and scales of the goal, which names it";

    /// The fitness by `goal` of the designs of `sweep`, with these ends of the criteria. A criterion without ends has no fitness.
    pub fn new(goal: &FitnessGoal, sweep: &Sweep, ends: &[CriterionEnds]) -> Self {
        let part = |(criterion, &weight): (&Criterion, &f64)| {
            let made = |value| Scale::Paper.criterion(criterion.goal, value);
            let ends = ends.iter().find(|ends| ends.column == criterion.column);
            let ends = ends.and_then(|ends| Some((made(ends.worst)?, made(ends.best)?)));
            let column = column(sweep, &criterion.column)?;
            Some(RescaledCriterion { goal: criterion.goal, column, weight, ends })
        };
        let weighted = goal.criteria.iter().zip(goal.weights.values());
        Self { parts: weighted.filter(|(_, weight)| **weight > 0.0).filter_map(part).collect() }
    }

    /// The fitness of a design (O3); `None` if a criterion cannot be formed.
    pub fn value(&self, row: &DesignRow) -> Option<f64> {
        let rescaled = self.parts.iter().map(|part| Some((part.weight, part.rescaled(row)?)));
        let rescaled: Vec<(f64, f64)> = rescaled.collect::<Option<_>>()?;
        let score = rescaled.iter().map(|(weight, s)| weight * s.max(0.0).ln()).sum::<f64>();
        Some(score.exp())
    }

    /// The derivatives of the fitness (O4); 0 where a design is worst or worse in a criterion.
    pub fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        let flat = Slopes { left: Some(0.0), right: Some(0.0) };
        let none = Slopes { left: None, right: None };
        let Some(fitness) = self.value(row) else { return none };
        if fitness <= 0.0 {
            return flat;
        }
        let slopes = self.parts.iter().map(|part| part.slopes(row, parameter));
        slopes.reduce(Slopes::plus).unwrap_or(none).scaled(fitness)
    }
}

impl RescaledCriterion {
    /// The criterion, 0 at the worst and 1 at the best (R2).
    fn rescaled(&self, row: &DesignRow) -> Option<f64> {
        let (worst, best) = self.ends?;
        let made = Scale::Paper.criterion(self.goal, number(&self.column, row)?)?;
        // A criterion in which all are equal does not count.
        Some(if best > worst { (made - worst) / (best - worst) } else { 1.0 })
    }

    /// The derivatives of `w ln s`.
    fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        let rate = || {
            let (worst, best) = self.ends?;
            let (value, rescaled) = (number(&self.column, row)?, self.rescaled(row)?);
            let made = if self.goal == Goal::Maximize { 1.0 } else { -value.powi(-2) };
            Some(if best > worst { self.weight * made / ((best - worst) * rescaled) } else { 0.0 })
        };
        let none = Slopes { left: None, right: None };
        rate().map_or(none, |rate| slopes(&self.column, row, parameter).scaled(rate))
    }
}

#[cfg(test)]
mod tests {
    use results::{DesignResult, DesignRow};
    use sweep::Sweep;

    use super::*;

    fn covered(sweep: &Sweep, coverage: f64) -> DesignRow {
        let (number, case) = (sweep.grid().number(0), sweep.grid().case(0));
        let result = DesignResult { coverage: Some(coverage), ..DesignResult::default() };
        DesignRow { number, case, result }
    }

    #[test]
    fn ends_are_those_of_the_goal_or_the_worst_and_best_of_what_covers() {
        let text = "name = 'x'\n[designs]\ngap_over_t = 0.5\nlength_over_t = 1\nslant_deg = 45";
        let sweep = Sweep::parse(text, "x.toml", &[]).expect("a sweep");
        let rows = [0.0, 0.2, 0.7].map(|coverage| covered(&sweep, coverage));
        let criteria = ["coverage", "gap_over_t"];
        let goal = FitnessGoal {
            criteria: criteria.map(|column| Criterion::new(column, Goal::Maximize)).to_vec(),
            weights: Weights::new(&[1.0, 3.0]).expect("weights"),
            ends: vec![CriterionEnds { column: "gap_over_t".to_owned(), worst: 0.1, best: 0.9 }],
        };
        let ends = goal.ends_over(&sweep, &rows);
        assert_eq!((ends[0].worst, ends[0].best), (0.2, 0.7));
        assert_eq!((ends[1].worst, ends[1].best), (0.1, 0.9));
        let fitness = Fitness::new(&goal, &sweep, &ends);
        // The gap is in the middle of its ends, whatever the coverage.
        let expected = |coverage: f64| coverage.powf(0.25) * 0.5_f64.powf(0.75);
        let of = |row: &DesignRow| fitness.value(row).expect("a fitness");
        assert!((of(&rows[2]) - expected(1.0)).abs() < 1e-14);
        assert!((of(&covered(&sweep, 0.45)) - expected(0.5)).abs() < 1e-14);
        assert!((of(&covered(&sweep, 1.2)) - expected(2.0)).abs() < 1e-14);
        assert_eq!([of(&rows[1]), of(&rows[0])], [0.0, 0.0]);
        assert_eq!(Fitness::new(&goal, &sweep, &[]).value(&rows[2]), None);
    }
}
