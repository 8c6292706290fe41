//! The climb along exact derivatives: sequential least squares (SLSQP), with one-sided derivatives at kinks.

use basin::{
    BoxBounds, ConstraintDescription, ConstraintJacobian, ConstraintSet, ConstraintSolveError,
    Constraints, CostFunction, DenseMatrix, Executor, Gradient, NoLinearConstraints,
    NoNonlinearBlock, NonlinearBlock, NonlinearBlocks, NonlinearInequalityValues,
    SelectedFirstOrderState, Slsqp,
};

use super::LocalSearch;
use super::problem::LocalProblem;
use crate::candidate::SearchStage;
use crate::evaluations::Halt;
use crate::slopes::Slopes;

/// Accuracy of constraints and objective, both about 1 in size.
const ACCURACY: f64 = 1e-11;

impl LocalSearch<'_> {
    /// Climbs from the best design; what it comes by is noted.
    pub(super) fn climb(&self) -> Result<(), Halt> {
        let Some(problem) = LocalProblem::new(self, SearchStage::Gradient) else { return Ok(()) };
        let start = SelectedFirstOrderState::new(self.best_shares());
        let solver = Slsqp::new().with_absolute_accuracy_tolerance(ACCURACY);
        let most = self.search.fineness().looks * self.best_shares().len() as u64;
        match Executor::new(problem, solver, start).max_cost_evals(most).run() {
            Err(ConstraintSolveError::Evaluation(halt)) => Err(halt),
            // The bounds and the number of constraints are as they were declared.
            Ok(_) | Err(_) => Ok(()),
        }
    }
}

impl CostFunction for LocalProblem<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Halt;

    fn cost(&self, shares: &Vec<f64>) -> Result<f64, Halt> {
        let looked = self.look(shares)?;
        Ok(looked.map_or(f64::INFINITY, |looked| self.cost_of(&looked.worth)))
    }
}

impl Gradient for LocalProblem<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, shares: &Vec<f64>) -> Result<Vec<f64>, Halt> {
        let looked = self.look(shares)?;
        let gradient = looked.and_then(|l| self.cost_gradient(shares, &l, Slopes::uphill));
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
        let none = || vec![f64::INFINITY; self.limit_count()];
        Ok(self.look(shares)?.map_or_else(none, |looked| self.limits(&looked)))
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
        let looked = self.look(shares)?;
        let row = |k| {
            let looked = looked.as_ref()?;
            self.limit_gradient(k, shares, looked, Slopes::uphill)
        };
        let none = || vec![f64::NAN; shares.len()];
        let rows = (0..self.limit_count()).flat_map(|k| row(k).unwrap_or_else(none));
        let rows: Vec<f64> = rows.collect();
        Ok(DenseMatrix::from_row_slice(self.limit_count(), shares.len(), &rows))
    }
}
