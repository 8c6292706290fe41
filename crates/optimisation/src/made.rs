//! What is made of a design: skins with its deviations, and the quantities over them that a goal may name.
//!
//! The deviations of skin `i` are the same for every design and drawn once (common random numbers), so that quantiles and yields are
//! functions of the design like any other:
//!
//! ```text
//! yield ≥ y   ⇔   m₍ₖ₎ ≥ 0,   k = n − ⌈y n⌉ + 1                                          (O6)
//! ```
//!
//! with the margins `m₍₁₎ ≤ … ≤ m₍ₙ₎` of the skins in their order, each the least of its margins over all requirements, relative to
//! their limits. A yield is a staircase over the designs, the margin on the right is continuous.

mod estimate;
mod judge;
mod quantity;
mod search;
mod slopes;

pub use estimate::{MadeEstimate, MadeReport};
pub(crate) use judge::{MadeJudge, Skins, Stake, UsedQuantity};
pub use quantity::MadeQuantity;
pub(crate) use search::{MadeSearches, answer};
pub(crate) use slopes::MadeSlope;

use crate::goal::DesignGoal;

/// Skins of a design with which a search is checked at its end.
pub(crate) const FRESH: usize = 1000;

impl DesignGoal {
    /// The quantity over what is made that a column of this goal stands for; `None` of a column of `designs.csv` or the fitness.
    pub fn quantity(&self, column: &str) -> Option<MadeQuantity> {
        let is_made = !self.space.sweep().deviations().is_empty();
        MadeQuantity::named(column).filter(|_| is_made && !self.space.sweep().is_imperfect())
    }

    /// Whether the goal is about what is made, not only about what is drawn.
    pub fn is_about_skins(&self) -> bool {
        let objectives = self.objectives.iter().map(|objective| objective.column.as_ref());
        let required = self.requirements.iter().map(|requirement| requirement.column.as_str());
        objectives.chain(required).any(|column| self.quantity(column).is_some())
    }

    /// The goal for the design as it is drawn, that the search begins with: quantiles are those columns themselves, a yield as an
    /// objective is left for the margin, and a yield that is required for nothing.
    #[must_use]
    pub fn as_drawn(&self) -> Self {
        let mut goal = self.clone();
        for objective in &mut goal.objectives {
            match self.quantity(&objective.column) {
                Some(MadeQuantity::Quantile { column, .. }) => objective.column = column.into(),
                Some(MadeQuantity::Yield) => objective.column = MadeQuantity::MARGIN.into(),
                None => {}
            }
        }
        goal.requirements.retain_mut(|requirement| match self.quantity(&requirement.column) {
            Some(MadeQuantity::Yield) => false,
            Some(MadeQuantity::Quantile { column, .. }) => {
                requirement.column = column;
                true
            }
            None => true,
        });
        goal
    }
}
