//! The columns that a goal names of a nominal design: those of `designs.csv`, and the fitness.

use ranking::{CriterionEnds, FitnessGoal, RescaledCriterion};
use results::columns::design_columns;
use results::{Column, DesignRow};
use sweep::{Parameter, Sweep};

use crate::slopes::Slopes;

/// A column of numbers.
pub(crate) enum NumberColumn {
    /// A column of `designs.csv`.
    Known(Column<DesignRow>),
    /// The fitness, by the columns of its criteria (O3).
    Fitness(Vec<(Column<DesignRow>, RescaledCriterion)>),
}

impl NumberColumn {
    /// The name of the column of the fitness.
    pub const FITNESS: &'static str = "fitness";

    /// The column of `designs.csv` that has this name.
    pub fn named(sweep: &Sweep, name: &str) -> Option<Self> {
        known(sweep, name).map(Self::Known)
    }

    /// The fitness by `goal` with these ends of the criteria. Of a criterion without ends there is no fitness.
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

    /// The derivatives with respect to a parameter.
    pub fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        match self {
            Self::Known(column) => slopes(column, row, parameter),
            Self::Fitness(parts) => match self.value(row) {
                None => Slopes::UNKNOWN,
                // Where a design is worst or worse in a criterion, the fitness is 0 all round.
                Some(fitness) if fitness <= 0.0 => Slopes::FLAT,
                Some(fitness) => {
                    let part = |(column, of): &(Column<DesignRow>, RescaledCriterion)| {
                        let rate = column.cell(row).number().and_then(|value| of.rate(value));
                        let part = |rate| slopes(column, row, parameter).scaled(rate);
                        rate.map_or(Slopes::UNKNOWN, part)
                    };
                    let sum = parts.iter().map(part).reduce(Slopes::plus);
                    sum.unwrap_or(Slopes::UNKNOWN).scaled(fitness)
                }
            },
        }
    }
}

fn known(sweep: &Sweep, name: &str) -> Option<Column<DesignRow>> {
    design_columns(sweep).into_iter().find(|column| column.name == name)
}

/// The derivatives of a column, from rows that are extrapolated by those of the measures.
fn slopes(column: &Column<DesignRow>, row: &DesignRow, parameter: &Parameter) -> Slopes {
    let at = |by, side| column.cell(&row.extrapolated_by(parameter, by, side)?).number();
    Slopes::between(parameter.size(&row.case), at)
}

/// The ends of every criterion: those of the goal, and for the others the worst and the best of the `rows` that cover.
pub(crate) fn ends_over(
    goal: &FitnessGoal,
    sweep: &Sweep,
    rows: &[DesignRow],
) -> Vec<CriterionEnds> {
    // As in a ranking, which rescales between designs that cover.
    let covers = |row: &&DesignRow| row.result.coverage.is_none_or(|coverage| coverage > 0.0);
    let ends = goal.criteria.iter().filter_map(|criterion| {
        let given = goal.ends.iter().find(|ends| ends.column == criterion.column);
        let found = || {
            let column = known(sweep, &criterion.column)?;
            let values = rows.iter().filter(covers).filter_map(|row| column.cell(row).number());
            CriterionEnds::of(criterion, values)
        };
        given.cloned().or_else(found)
    });
    ends.collect()
}
