//! Ridge search by the bundle method, where the gradient search ends at kinks.

use super::LocalSearch;
use super::bundle::{BundleOptions, Pieces, PiecewiseSmooth, descend};
use super::linear_model::Piece;
use super::problem::LocalProblem;
use crate::candidate::SearchStage;
use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::slopes::Slopes;

/// Smallest radius, as a fraction of the intervals.
///
/// Kinks are resolved at larger distances.
const SMALLEST: f64 = 1e-6;

impl LocalSearch<'_> {
    /// Searches along the ridge through the best design.
    ///
    /// Steps are at most `reach` of the intervals, and evaluations at most `most`.
    pub(super) fn follow(&self, reach: f64, most: usize) -> Result<(), Halt> {
        // A yield is a step function, and has no tangents.
        if self.search.judge.is_yield(StatisticUse::Objective(self.target.objective)) {
            return Ok(());
        }
        // Not restricted to a coverage branch: borders of branches are ridges, and this search
        // follows them.
        let Some(problem) = LocalProblem::new(self, SearchStage::Ridge, None, None) else {
            return Ok(());
        };
        let smallest = SMALLEST.max(self.search.fineness().step).min(0.1 * reach);
        let options = BundleOptions { reach, smallest, points: most };
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
        let limits = self.limits(&evaluated).into_iter().enumerate().map(|(k, value)| Piece {
            value,
            gradient: self.limit_gradient(k, shares, &evaluated, Slopes::smooth),
        });
        let limits: Vec<Piece> = limits.collect();
        // The slack before contact in bending is not a requirement, but limits this search too.
        let met = evaluated.met && limits.iter().all(|limit| limit.value <= 1e-9);
        Ok(Some(Pieces { cost: Piece { value: cost, gradient }, limits, met }))
    }
}
