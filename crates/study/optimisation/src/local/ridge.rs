//! The search along ridges, where the climb ends: with the pieces that were seen near by.

use super::LocalSearch;
use super::bundle::{BundleOptions, Piece, Pieces, PiecewiseSmooth, descend};
use super::problem::LocalProblem;
use crate::candidate::SearchStage;
use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::slopes::Slopes;

/// The smallest radius, a share of the intervals: kinks are told from further away than that.
const SMALLEST: f64 = 1e-6;

impl LocalSearch<'_> {
    /// Follows the ridge on which the best design stands, by steps of `reach` and less of the intervals, over at most `most` designs.
    pub(super) fn follow(&self, reach: f64, most: usize) -> Result<(), Halt> {
        // A staircase has no tangents.
        if self.search.judge.is_yield(StatisticUse::Objective(self.target.objective)) {
            return Ok(());
        }
        // In no piece of coverage: borders of pieces are ridges, and this search goes along them.
        let Some(problem) = LocalProblem::new(self, SearchStage::Ridge, None, None) else {
            return Ok(());
        };
        let smallest = SMALLEST.max(self.search.fineness().step).min(0.1 * reach);
        let options = BundleOptions { reach, smallest, places: most };
        descend(&problem, &self.best_shares(), options)
    }
}

impl PiecewiseSmooth for LocalProblem<'_> {
    type Error = Halt;

    fn pieces(&self, shares: &[f64]) -> Result<Option<Pieces>, Halt> {
        let Some(evaluated) = self.evaluate(shares)? else { return Ok(None) };
        let cost = self.cost_of(&evaluated.worth);
        if !cost.is_finite() {
            return Ok(None);
        }
        let gradient = self.cost_gradient(shares, &evaluated, Slopes::smooth);
        let limit = |(k, value)| Piece {
            value,
            gradient: self.limit_gradient(k, shares, &evaluated, Slopes::smooth),
        };
        let limits: Vec<Piece> =
            self.limits(&evaluated).into_iter().enumerate().map(limit).collect();
        // Room in bending is no requirement, and yet a limit of this search.
        let met = evaluated.met && limits.iter().all(|limit| limit.value <= 1e-9);
        Ok(Some(Pieces { cost: Piece { value: cost, gradient }, limits, met }))
    }
}
