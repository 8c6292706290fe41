//! Columns that a goal can refer to: the columns of `designs.csv`, and the fitness.

use ranking::{CriterionEnds, FitnessGoal, RescaledCriterion};
use results::columns::design_columns;
use results::{Column, DesignRow};
use sweep::{Parameter, Sweep};

use crate::slopes::Slopes;

/// A column of numbers, computed from the row of a nominal design.
pub(crate) enum NumberColumn {
    /// A column of `designs.csv`.
    Table(Column<DesignRow>),
    /// Fitness (O3), computed from the columns of its criteria.
    Fitness(Vec<(Column<DesignRow>, RescaledCriterion)>),
}

impl NumberColumn {
    /// Name of the fitness column.
    pub const FITNESS: &'static str = "fitness";

    /// Returns the column `name` of `designs.csv`; `None` if there is no such column.
    pub fn named(sweep: &Sweep, name: &str) -> Option<Self> {
        known(sweep, name).map(Self::Table)
    }

    /// Creates the fitness column. `ends` are the worst and the best value of each criterion.
    ///
    /// The column is empty if these values are missing for a weighted criterion.
    pub fn fitness(goal: &FitnessGoal, sweep: &Sweep, ends: &[CriterionEnds]) -> Self {
        let parts = goal.rescaled(ends);
        let parts = parts.filter_map(|(of, part)| Some((known(sweep, &of.column)?, part)));
        Self::Fitness(parts.collect())
    }

    /// Returns the name of the column.
    pub fn name(&self) -> &str {
        match self {
            Self::Table(column) => &column.name,
            Self::Fitness(_) => Self::FITNESS,
        }
    }

    /// Returns the value of the column in `row`; `None` for an empty cell.
    pub fn value(&self, row: &DesignRow) -> Option<f64> {
        match self {
            Self::Table(column) => column.cell(row).number(),
            Self::Fitness(parts) => {
                let parts = parts.iter().map(|(column, of)| of.part(column.cell(row).number()?));
                parts.sum::<Option<f64>>().map(f64::exp)
            }
        }
    }

    /// Returns the one-sided derivatives of the column with respect to `parameter`.
    pub fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        match self {
            Self::Table(column) => slopes(column, row, parameter),
            Self::Fitness(parts) => match self.value(row) {
                None => Slopes::UNKNOWN,
                // A criterion is at its worst value or worse, so the fitness is 0 nearby, too.
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

/// Returns the column `name` of `designs.csv` of the sweep.
fn known(sweep: &Sweep, name: &str) -> Option<Column<DesignRow>> {
    design_columns(sweep).into_iter().find(|column| column.name == name)
}

/// Differentiates a column with respect to `parameter` by finite differences.
///
/// Neighbouring rows are not solved, but extrapolated by the known derivatives of the measures.
fn slopes(column: &Column<DesignRow>, row: &DesignRow, parameter: &Parameter) -> Slopes {
    Slopes::between(parameter.size(&row.case), |by, side| {
        column.cell(&row.extrapolated_by(parameter, by, side)?).number()
    })
}

/// Returns the worst and the best value of each criterion of the fitness.
///
/// The goal may state both values of a criterion. Otherwise they are the worst and the best value
/// in those `rows` that cover the substrate.
pub(crate) fn ends_over(
    goal: &FitnessGoal,
    sweep: &Sweep,
    rows: &[DesignRow],
) -> Vec<CriterionEnds> {
    // Omit designs with a coverage of 0, as a ranking does.
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
