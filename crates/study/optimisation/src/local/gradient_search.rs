//! Gradient search by SLSQP (sequential least-squares programming).
//!
//! At a kink the search uses the one-sided derivative of steepest ascent.

use basin::{
    BoxBounds, ConstraintDescription, ConstraintJacobian, ConstraintSet, ConstraintSolveError,
    Constraints, CostFunction, DenseMatrix, Executor, Gradient, NoLinearConstraints,
    NoNonlinearBlock, NonlinearBlock, NonlinearBlocks, NonlinearInequalityValues,
    SelectedFirstOrderState, Slsqp,
};

use sweep::Measure;

use super::problem::LocalProblem;
use super::{Effort, LocalSearch};
use crate::candidate::{Merit, SearchStage};
use crate::coverage_piece::CoveragePiece;
use crate::evaluations::Halt;
use crate::slopes::Slopes;

/// Tolerance of SLSQP on constraints and objective, which have values of about 1.
const ACCURACY: f64 = 1e-11;

/// Limits on a gradient search in several branches.
#[derive(Clone, Copy)]
struct Budget {
    /// Maximum number of coverage branches.
    pieces: usize,
    /// Number of evaluations of the whole local search at which the gradient search ends.
    last: usize,
}

impl LocalSearch<'_> {
    /// Runs a gradient search from the best design.
    ///
    /// If the search ends infeasible, a second search minimises the largest shortfall (O9). If that
    /// search ends feasible, a third search improves the objective.
    pub(super) fn gradient_search(&self, effort: Effort) -> Result<(), Halt> {
        let first = self.budget(effort);
        // If a feasible design is known, few infeasible starts are worth more evaluations.
        let is_feasible_known = matches!(self.to_beat, Merit::Met(_));
        let next = || if is_feasible_known { first } else { self.budget(effort) };
        self.search_branches(first, false)?;
        if self.is_short() {
            self.search_branches(next(), true)?;
            if !self.is_short() {
                self.search_branches(next(), false)?;
            }
        }
        Ok(())
    }

    /// Returns the budget of a gradient search that starts now.
    fn budget(&self, effort: Effort) -> Budget {
        let most = effort.gradient_evaluations * self.best_shares().len();
        Budget { pieces: effort.pieces, last: self.evaluation_count() + most }
    }

    /// Returns the number of designs that this local search has evaluated so far.
    fn evaluation_count(&self) -> usize {
        self.log.borrow().len()
    }

    /// Returns true if the best design has a valid judgement but is infeasible.
    fn is_short(&self) -> bool {
        matches!(self.best_merit(), Merit::Short(_))
    }

    /// Runs gradient searches in successive coverage branches.
    ///
    /// Another search follows if the best design is on the border of a branch that has not been
    /// searched. `is_elastic` selects the largest shortfall as the cost (O9).
    fn search_branches(&self, budget: Budget, is_elastic: bool) -> Result<(), Halt> {
        let mut visited: Vec<Option<CoveragePiece>> = Vec::new();
        while visited.len() < budget.pieces {
            // The best design may have reached the border of another branch, so determine its
            // branches again.
            let pieces = self.pieces();
            // Visit each branch only once, so that the search does not alternate between two
            // branches.
            let Some(&piece) = pieces.iter().find(|piece| !visited.contains(piece)) else { break };
            self.search_branch(piece, budget, is_elastic)?;
            visited.push(piece);
        }
        Ok(())
    }

    /// Returns the coverage branches that contain the best design.
    ///
    /// The only element is `None` if the search is not restricted to a branch.
    fn pieces(&self) -> Vec<Option<CoveragePiece>> {
        let judge = self.search.judge;
        // A goal without coverage does not need branches. With samples the search is not restricted
        // to a branch, because the samples of a design are in several branches.
        if !judge.depends_on(Measure::Coverage) || judge.samples().is_some() {
            return vec![None];
        }
        let case = self.search.space.case(&self.best.borrow().point);
        CoveragePiece::beside(&case).into_iter().map(Some).collect()
    }

    /// Runs one gradient search from the best design, restricted to the coverage branch `piece`.
    ///
    /// `is_elastic` selects the largest shortfall as the cost (O9).
    fn search_branch(
        &self,
        piece: Option<CoveragePiece>,
        budget: Budget,
        is_elastic: bool,
    ) -> Result<(), Halt> {
        let missed = match self.best_merit() {
            Merit::Short(missed) if is_elastic => Some(missed),
            // The best design is already feasible, so there is no shortfall to minimise.
            _ if is_elastic => return Ok(()),
            _ => None,
        };
        // An infinite shortfall cannot be minimised. It occurs if a requirement has no value.
        if missed.is_some_and(|missed: f64| !missed.is_finite()) {
            return Ok(());
        }
        let Some(problem) = LocalProblem::new(self, SearchStage::Gradient, piece, missed) else {
            return Ok(());
        };
        let start =
            SelectedFirstOrderState::new(self.best_shares().into_iter().chain(missed).collect());
        let solver = Slsqp::new().with_absolute_accuracy_tolerance(ACCURACY);
        let most = budget.last.saturating_sub(self.evaluation_count());
        match Executor::new(problem, solver, start).max_cost_evals(most as u64).run() {
            Err(ConstraintSolveError::Evaluation(halt)) if !matches!(halt, Halt::Stalled) => {
                Err(halt)
            }
            // The search converged or stalled. Other errors cannot occur, because bounds and number
            // of constraints match the problem.
            Ok(_) | Err(_) => Ok(()),
        }
    }
}

impl CostFunction for LocalProblem<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Halt;

    fn cost(&self, shares: &Vec<f64>) -> Result<f64, Halt> {
        let evaluated = self.evaluate(shares)?;
        // A design without a valid judgement is worse than all other designs.
        Ok(evaluated.map_or(f64::INFINITY, |evaluated| match self.missed(shares) {
            Some(missed) => missed,
            None => self.cost_of(&evaluated.worth),
        }))
    }
}

impl Gradient for LocalProblem<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, shares: &Vec<f64>) -> Result<Vec<f64>, Halt> {
        if self.is_elastic {
            return Ok((1..=shares.len()).map(|k| f64::from(k == shares.len())).collect());
        }
        let evaluated = self.evaluate(shares)?;
        // Without derivatives the gradient is NaN, at which SLSQP stops.
        let gradient = evaluated.and_then(|l| self.cost_gradient(shares, &l, Slopes::uphill));
        Ok(gradient.unwrap_or_else(|| vec![f64::NAN; shares.len()]))
    }
}

impl Constraints for LocalProblem<'_> {
    type Set = ConstraintSet<
        BoxBounds<Vec<f64>>,
        NoLinearConstraints,
        NonlinearBlocks<NoNonlinearBlock, NonlinearBlock>,
    >;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new()
            .with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
            .with_nonlinear_inequalities(self.limit_count())
    }
}

impl NonlinearInequalityValues for LocalProblem<'_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Halt;

    fn nonlinear_inequalities(
        &self,
        shares: &Vec<f64>,
    ) -> Result<Vec<f64>, ConstraintSolveError<Halt>> {
        // A design without a valid judgement violates each limit.
        let mut limits = self.evaluate(shares)?.map_or_else(
            || vec![f64::INFINITY; self.limit_count()],
            |evaluated| self.limits(&evaluated),
        );
        let asked = limits.iter_mut().take(self.asked_count());
        asked.for_each(|limit| *limit -= self.missed(shares).unwrap_or(0.0));
        Ok(limits)
    }
}

impl ConstraintJacobian for LocalProblem<'_> {
    type Param = Vec<f64>;
    type Jacobian = DenseMatrix;
    type Error = Halt;

    fn constraint_jacobian(
        &self,
        shares: &Vec<f64>,
    ) -> Result<DenseMatrix, ConstraintSolveError<Halt>> {
        let evaluated = self.evaluate(shares)?;
        let rows = (0..self.limit_count()).map(|k| {
            let mut row = self.limit_gradient(k, shares, evaluated.as_ref()?, Slopes::uphill)?;
            row.extend(self.missed(shares).map(|_| -f64::from(k < self.asked_count())));
            Some(row)
        });
        let rows = rows.flat_map(|row| row.unwrap_or_else(|| vec![f64::NAN; shares.len()]));
        let rows: Vec<f64> = rows.collect();
        Ok(DenseMatrix::from_row_slice(self.limit_count(), shares.len(), &rows))
    }
}
