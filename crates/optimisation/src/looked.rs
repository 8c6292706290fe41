//! The row of a design that was looked at, with the derivatives of what is made of it.

use results::DesignRow;
use sweep::Parameter;

use crate::made::{MadeSlope, Stake};
use crate::slopes::Slopes;

/// The row of a design that was looked at.
#[derive(Clone, Debug)]
pub(crate) struct LookedRow {
    /// The design as it is drawn.
    pub drawn: DesignRow,
    /// Derivatives of quantities over the skins that are made of it.
    pub made: Vec<MadeSlope>,
}

impl LookedRow {
    /// The derivatives of a quantity over skins; none if they are not known.
    pub fn made_slopes(&self, stake: Stake, parameter: &Parameter) -> Slopes {
        let is_it = |slope: &&MadeSlope| slope.stake == stake && slope.parameter == parameter.key;
        let none = Slopes { left: None, right: None };
        self.made.iter().find(is_it).map_or(none, |slope| slope.slopes)
    }
}
