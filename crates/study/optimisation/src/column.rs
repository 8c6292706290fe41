//! Columns that a goal may name: the columns of `designs.csv`, and the fitness.

use ranking::{CriterionEnds, FitnessGoal, RescaledCriterion};
use results::columns::design_columns;
use results::{Column, DesignRow};
use sweep::{Parameter, Sweep};

use crate::slopes::Slopes;

/// A column of numbers.
pub(crate) enum NumberColumn {
    /// A column of `designs.csv`.
    Known(Column<DesignRow>),
    /// Fitness, from the columns of its criteria (O3).
    Fitness(Vec<(Column<DesignRow>, RescaledCriterion)>),
}

impl NumberColumn {
    /// Name of the fitness column.
    pub const FITNESS: &'static str = "fitness";

    /// Returns the column of `designs.csv` with this name.
    pub fn named(sweep: &Sweep, name: &str) -> Option<Self> {
        known(sweep, name).map(Self::Known)
    }

    /// Creates the fitness with these ends.
    ///
    /// It has no value if a weighted criterion has no ends.
    pub fn fitness(goal: &FitnessGoal, sweep: &Sweep, ends: &[CriterionEnds]) -> Self {
        let parts = goal.rescaled(ends);
        let parts = parts.filter_map(|(of, part)| Some((known(sweep, &of.column)?, part)));
        Self::Fitness(parts.collect())
    }

    pub fn name(&self) -> &str {
        match self {
            Self::Known(column) => &column.name,
            Self::Fitness(_) => Self::FITNESS,
        }
    }

    pub fn value(&self, row: &DesignRow) -> Option<f64> {
        match self {
            Self::Known(column) => column.cell(row).number(),
            Self::Fitness(parts) => {
                let parts = parts.iter().map(|(column, of)| of.part(column.cell(row).number()?));
                parts.sum::<Option<f64>>().map(f64::exp)
            }
        }
    }

    /// Returns the derivatives with respect to a parameter.
    pub fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        match self {
            Self::Known(column) => slopes(column, row, parameter),
            Self::Fitness(parts) => match self.value(row) {
                None => Slopes::UNKNOWN,
                // At or beyond the worst end of a criterion the fitness is locally 0.
                Some(fitness) if fitness <= 0.0 => Slopes::FLAT,
                Some(fitness) => {
                    let sum = parts
                        .iter()
                        .map(|(column, of)| {
                            let rate = column.cell(row).number().and_then(|value| of.rate(value));
                            rate.map_or(Slopes::UNKNOWN, |rate| {
                                slopes(column, row, parameter).scaled(rate)
                            })
                        })
                        .reduce(Slopes::plus);
                    sum.unwrap_or(Slopes::UNKNOWN).scaled(fitness)
                }
            },
        }
    }
}

fn known(sweep: &Sweep, name: &str) -> Option<Column<DesignRow>> {
    design_columns(sweep).into_iter().find(|column| column.name == name)
}

/// Differentiates a column numerically.
///
/// The rows are extrapolated by the derivatives of measures.
fn slopes(column: &Column<DesignRow>, row: &DesignRow, parameter: &Parameter) -> Slopes {
    Slopes::between(parameter.size(&row.case), |by, side| {
        column.cell(&row.extrapolated_by(parameter, by, side)?).number()
    })
}

/// Returns the ends of every criterion.
///
/// They are given by the goal, or are the worst and best value of the `rows` with coverage.
pub(crate) fn ends_over(
    goal: &FitnessGoal,
    sweep: &Sweep,
    rows: &[DesignRow],
) -> Vec<CriterionEnds> {
    // As in a ranking, which rescales over designs with coverage.
    let ends = goal.criteria.iter().filter_map(|criterion| {
        let given = goal.ends.iter().find(|ends| ends.column == criterion.column);
        given.cloned().or_else(|| {
            let column = known(sweep, &criterion.column)?;
            let values = rows
                .iter()
                .filter(|row| row.result.coverage.is_none_or(|coverage| coverage > 0.0))
                .filter_map(|row| column.cell(row).number());
            CriterionEnds::of(criterion, values)
        })
    });
    ends.collect()
}
