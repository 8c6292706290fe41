//! Row of an evaluated design, with derivatives of statistics over its samples.

use results::DesignRow;
use sweep::Parameter;

use crate::slopes::Slopes;

/// Use of a statistic in a goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StatisticUse {
    /// An objective, by its index.
    Objective(usize),
    /// A requirement, by its index.
    Requirement(usize),
}

/// Derivatives of a statistic with respect to a design parameter.
#[derive(Clone, Debug)]
pub(crate) struct StatisticSlopes {
    pub of: StatisticUse,
    pub parameter: &'static str,
    pub slopes: Slopes,
}

/// Row of an evaluated design.
#[derive(Clone, Debug)]
pub(crate) struct EvaluatedRow {
    /// The nominal design.
    pub nominal: DesignRow,
    /// Derivatives of statistics over the samples of the design.
    pub statistics: Vec<StatisticSlopes>,
}

impl EvaluatedRow {
    /// Returns the derivatives of a statistic; unknown if not computed.
    pub fn statistic_slopes(&self, of: StatisticUse, parameter: &Parameter) -> Slopes {
        let mut known = self.statistics.iter();
        let known = known.find(|known| known.of == of && known.parameter == parameter.key);
        known.map_or(Slopes::UNKNOWN, |known| known.slopes)
    }
}
