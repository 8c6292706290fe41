//! The columns that a goal names of a design as it is drawn: those of `designs.csv`, and the fitness.

use results::{Column, DesignRow, SlopeSide};
use sweep::Parameter;

use crate::fitness::Fitness;
use crate::judge::{RequiredColumn, excess, margin_rate};
use crate::made::MadeQuantity;
use crate::slopes::Slopes;

/// Step of the differences along extrapolated rows, relative to the size of the parameter.
const STEP: f64 = 1e-6;

/// A column of numbers.
pub(crate) enum NumberColumn {
    /// A column of `designs.csv`.
    Known(Column<DesignRow>),
    /// The fitness.
    Fitness(Fitness),
    /// How far a design is within these bounds, in place of a yield where only what is drawn is known.
    Margin(Vec<RequiredColumn<NumberColumn>>),
}

impl NumberColumn {
    pub fn name(&self) -> &str {
        match self {
            Self::Known(column) => &column.name,
            Self::Fitness(_) => Fitness::COLUMN,
            Self::Margin(_) => MadeQuantity::MARGIN,
        }
    }

    pub fn value(&self, row: &DesignRow) -> Option<f64> {
        match self {
            Self::Known(column) => number(column, row),
            Self::Fitness(fitness) => fitness.value(row),
            Self::Margin(bounds) => tightest(bounds, row).map(|(_, margin)| margin),
        }
    }

    /// The derivatives with respect to a parameter.
    pub fn slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        match self {
            Self::Known(column) => slopes(column, row, parameter),
            Self::Fitness(fitness) => fitness.slopes(row, parameter),
            Self::Margin(bounds) => {
                let none = Slopes { left: None, right: None };
                tightest(bounds, row).map_or(none, |(k, _)| bounds[k].margin_slopes(row, parameter))
            }
        }
    }
}

/// The bound that a design is least within, and how far, relative to the limit; `None` if there is none, or a value is missing.
fn tightest(bounds: &[RequiredColumn<NumberColumn>], row: &DesignRow) -> Option<(usize, f64)> {
    let margin = |bound: &RequiredColumn<NumberColumn>| {
        Some(-excess(&bound.requirement, bound.column.value(row)?))
    };
    let margins: Vec<f64> = bounds.iter().map(margin).collect::<Option<_>>()?;
    (0..).zip(margins).min_by(|one, other| one.1.total_cmp(&other.1))
}

impl RequiredColumn<NumberColumn> {
    /// The derivatives of how far a design is within the bound, relative to the limit.
    pub fn margin_slopes(&self, row: &DesignRow, parameter: &Parameter) -> Slopes {
        self.column.slopes(row, parameter).scaled(margin_rate(&self.requirement))
    }
}

/// The number of a row in a column.
pub(crate) fn number(column: &Column<DesignRow>, row: &DesignRow) -> Option<f64> {
    column.cell(row).number()
}

/// The derivatives of a column with respect to a parameter, from rows that are extrapolated by those of the measures.
pub(crate) fn slopes(column: &Column<DesignRow>, row: &DesignRow, parameter: &Parameter) -> Slopes {
    let at = |by, side| number(column, &row.extrapolated_by(parameter, by, side)?);
    slopes_of(parameter.size(&row.case), at)
}

/// The derivatives of a value that is known where a parameter of that size differs `by` so much, on each side.
pub(crate) fn slopes_of(size: Option<f64>, at: impl Fn(f64, SlopeSide) -> Option<f64>) -> Slopes {
    let on = |side| {
        let step = STEP * size?;
        Some((at(step, side)? - at(-step, side)?) / (2.0 * step))
    };
    Slopes { left: on(SlopeSide::Left), right: on(SlopeSide::Right) }
}
