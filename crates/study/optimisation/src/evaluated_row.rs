//! The row of a design that was looked at, with the derivatives of statistics over its samples.

use results::DesignRow;
use sweep::Parameter;

use crate::slopes::Slopes;

/// What a goal uses a statistic for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StatisticUse {
    /// An objective, by its index.
    Objective(usize),
    /// A requirement, by its index.
    Requirement(usize),
}

/// The derivatives of a statistic with respect to a parameter of the design.
#[derive(Clone, Debug)]
pub(crate) struct StatisticSlopes {
    pub of: StatisticUse,
    pub parameter: &'static str,
    pub slopes: Slopes,
}

/// The row of a design that was looked at.
#[derive(Clone, Debug)]
pub(crate) struct EvaluatedRow {
    /// The nominal design.
    pub nominal: DesignRow,
    /// Derivatives of statistics over its samples.
    pub statistics: Vec<StatisticSlopes>,
}

impl EvaluatedRow {
    /// The derivatives of a statistic; none if they are not known.
    pub fn statistic_slopes(&self, of: StatisticUse, parameter: &Parameter) -> Slopes {
        let mut known = self.statistics.iter();
        let known = known.find(|known| known.of == of && known.parameter == parameter.key);
        known.map_or(Slopes::UNKNOWN, |known| known.slopes)
    }
}
