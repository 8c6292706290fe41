//! The columns that a goal names: those of `designs.csv`, and the fitness.

use results::{Column, DesignRow, SlopeSide};
use sweep::Parameter;

use crate::fitness::Fitness;
use crate::slopes::Slopes;

/// Step of the differences along extrapolated rows, relative to the size of the parameter.
const STEP: f64 = 1e-6;

/// A column of numbers.
pub(crate) enum NumberColumn {
    /// A column of `designs.csv`.
    Known(Column<DesignRow>),
    /// The fitness.
    Fitness(Fitness),
}

impl NumberColumn {
    pub fn name(&self) -> &str {
        match self {
            Self::Known(column) => &column.name,
            Self::Fitness(_) => Fitness::COLUMN,
        }
    }

    pub fn value(&self, row: &DesignRow) -> Option<f64> {
        match self {
            Self::Known(column) => number(column, row),
            Self::Fitness(fitness) => fitness.value(row),
        }
    }

    /// The derivatives with respect to a parameter.
    pub fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        match self {
            Self::Known(column) => slopes(column, row, parameter),
            Self::Fitness(fitness) => fitness.slopes(row, parameter),
        }
    }
}

/// The number of a row in a column.
pub(crate) fn number(column: &Column<DesignRow>, row: &DesignRow) -> Option<f64> {
    column.cell(row).number()
}

/// The derivatives of a column with respect to a parameter, from rows that are extrapolated by those of the measures.
pub(crate) fn slopes(column: &Column<DesignRow>, row: &DesignRow, parameter: &Parameter) -> Slopes {
    let on = |side| {
        let step = STEP * parameter.size(&row.case)?;
        let at = |by| number(column, &row.extrapolated_by(parameter, by, side)?);
        Some((at(step)? - at(-step)?) / (2.0 * step))
    };
    Slopes { left: on(SlopeSide::Left), right: on(SlopeSide::Right) }
}
