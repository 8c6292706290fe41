//! Derivative-free search ("polish") by mesh adaptive direct search (`OrthoMADS`).
//!
//! A few steps of this search can cross jumps.

use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, ConstraintSolveError, Constraints,
    CostFunction, Executor, Mads, NoLinearConstraints, NoNonlinearConstraints, PointState,
};

use super::LocalSearch;
use crate::candidate::{Merit, SearchStage};
use crate::evaluations::Halt;

impl LocalSearch<'_> {
    /// Improves the best design by a direct search with at most `most` evaluations.
    ///
    /// The first steps have a length of at most `reach`, as a fraction of the variables' ranges. If
    /// the best design is infeasible, the search minimises the largest shortfall until a design is
    /// feasible. A second search then improves the objective and rejects infeasible designs.
    pub(super) fn polish(&self, reach: f64, most: usize) -> Result<(), Halt> {
        loop {
            let start = self.best_shares();
            let before = self.best_merit();
            // Without a valid judgement of the best design, steps cannot be compared with it.
            if before == Merit::None {
                return Ok(());
            }
            let only_short = matches!(before, Merit::Short(_));
            let barrier = Barrier {
                local: self,
                only_short,
                lower: vec![0.0; start.len()],
                upper: vec![1.0; start.len()],
            };
            let solver = Mads::new()
                .with_initial_poll_size(reach)
                .with_minimum_poll_size(self.search.fineness().step.min(0.1 * reach))
                .bounded();
            let polished = Executor::new(barrier, solver, PointState::new(start))
                .max_cost_evals(most as u64)
                .run();
            if let Err(ConstraintSolveError::Evaluation(halt)) = polished {
                return Err(halt);
            }
            // Repeat for the objective if this search has found the first feasible design.
            if !(only_short && matches!(self.best_merit(), Merit::Met(_))) {
                return Ok(());
            }
        }
    }
}

/// Problem with an extreme barrier: infeasible designs have an infinite cost.
///
/// If `only_short` is true, the cost is the largest shortfall, and infeasible designs are compared.
struct Barrier<'a> {
    local: &'a LocalSearch<'a>,
    only_short: bool,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl CostFunction for Barrier<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Halt;

    fn cost(&self, shares: &Vec<f64>) -> Result<f64, Halt> {
        // A direct search does not use derivatives, which are expensive.
        let (candidate, _) = self.local.at(SearchStage::Polish, shares, false)?;
        Ok(match self.local.search.merit(&candidate, self.local.target) {
            // A shortfall of 0 cannot be improved, so the search soon ends.
            Merit::Met(_) if self.only_short => 0.0,
            Merit::Met(objective) => -objective,
            Merit::Short(short) if self.only_short => short,
            Merit::Short(_) | Merit::None => f64::INFINITY,
        })
    }
}

impl Constraints for Barrier<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>, NoLinearConstraints, NoNonlinearConstraints>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}
