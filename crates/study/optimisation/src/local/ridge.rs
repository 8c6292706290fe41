//! Ridge search: applies the bundle method, because the gradient search stops at kinks.

use super::LocalSearch;
use super::bundle::{BundleOptions, Pieces, PiecewiseSmooth, descend};
use super::linear_model::Piece;
use super::problem::LocalProblem;
use crate::candidate::SearchStage;
use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::slopes::Slopes;

/// Smallest radius of the ball of the bundle method, as a fraction of the ranges of the variables.
///
/// At this radius, points on both sides of a kink still have clearly different tangents.
const SMALLEST: f64 = 1e-6;

impl LocalSearch<'_> {
    /// Searches along the ridge through the best design with at most `most` evaluations.
    ///
    /// The first radius is `reach`, as a fraction of the ranges of the variables.
    pub(super) fn search_ridge(&self, reach: f64, most: usize) -> Result<(), Halt> {
        // A yield is a step function, and has no tangents.
        if self.search.judge.is_yield(StatisticUse::Objective(self.target.objective)) {
            return Ok(());
        }
        // Do not restrict this search to a coverage branch: the borders of branches are ridges,
        // which it can follow.
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
        // `evaluated.met` covers requirements and lower bounds. The slack before contact in bending
        // is another limit.
        let met = evaluated.met && limits.iter().all(|limit| limit.value <= 1e-9);
        Ok(Some(Pieces { cost: Piece { value: cost, gradient }, limits, met }))
    }
}
