//! Row of an evaluated design, and derivatives of statistics over its samples.

use results::DesignRow;
use sweep::Parameter;

use crate::slopes::Slopes;

/// Use of a statistic in a goal: as an objective or as the column of a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StatisticUse {
    /// The objective with this index.
    Objective(usize),
    /// The requirement with this index.
    Requirement(usize),
}

/// Derivatives of a statistic with respect to a design parameter.
#[derive(Clone, Debug)]
pub(crate) struct StatisticSlopes {
    /// Objective or requirement of the statistic.
    pub of: StatisticUse,
    /// Key of the parameter.
    pub parameter: &'static str,
    pub slopes: Slopes,
}

/// Row of an evaluated design, and derivatives of statistics over its samples.
#[derive(Clone, Debug)]
pub(crate) struct EvaluatedRow {
    /// Results of the nominal design.
    pub nominal: DesignRow,
    /// Derivatives of statistics over the samples of the design.
    pub statistics: Vec<StatisticSlopes>,
}

impl EvaluatedRow {
    /// Returns the derivatives of a statistic, or `Slopes::UNKNOWN` if they were not computed.
    pub fn statistic_slopes(&self, of: StatisticUse, parameter: &Parameter) -> Slopes {
        let mut known = self.statistics.iter();
        let known = known.find(|known| known.of == of && known.parameter == parameter.key);
        known.map_or(Slopes::UNKNOWN, |known| known.slopes)
    }
}
