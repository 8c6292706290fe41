//! The climb along exact derivatives: sequential least squares (SLSQP), with one-sided derivatives at kinks.

use basin::{
    BoxBounds, ConstraintDescription, ConstraintJacobian, ConstraintSet, ConstraintSolveError,
    Constraints, CostFunction, DenseMatrix, Executor, Gradient, NoLinearConstraints,
    NoNonlinearBlock, NonlinearBlock, NonlinearBlocks, NonlinearInequalityValues,
    SelectedFirstOrderState, Slsqp,
};
use results::DesignResult;
use sweep::Parameter;

use super::room::{bending_room, bending_room_slopes};
use super::{LocalSearch, floor_size};
use crate::candidate::SearchStage;
use crate::evaluations::Halt;
use crate::judge::{Judgement, Worth};
use crate::looked::LookedRow;
use crate::slopes::Slopes;

/// Room that is kept before scales touch in bending.
const CLEAR: f64 = 1e-9;

/// Accuracy of constraints and objective, both about 1 in size.
const ACCURACY: f64 = 1e-11;

impl LocalSearch<'_> {
    /// Climbs from the best design; what it comes by is noted.
    pub(super) fn climb(&mut self) -> Result<(), Halt> {
        let start = self.best_shares();
        let value = match &self.best.borrow().verdict {
            Judgement::Judged(worth) => worth.objectives[self.target.objective],
            _ => return Ok(()),
        };
        let slope = Slope {
            walk: self,
            scale: if value > 0.0 { CostScale::Logarithm } else { CostScale::Linear(value.abs()) },
            stays_open: self.search.judge.bends() && is_open(&self.best.borrow().result),
            lower: vec![0.0; start.len()],
            upper: vec![1.0; start.len()],
        };
        let solver = Slsqp::new().with_absolute_accuracy_tolerance(ACCURACY);
        let climbed = Executor::new(slope, solver, SelectedFirstOrderState::new(start))
            .max_iter(self.search.fineness().iterations)
            .run();
        match climbed {
            Err(ConstraintSolveError::Evaluation(halt)) => Err(halt),
            // The bounds and the number of constraints are as they were declared.
            Ok(_) | Err(_) => Ok(()),
        }
    }
}

/// How an objective becomes a cost of about 1 in size.
#[derive(Clone, Copy)]
enum CostScale {
    /// Its logarithm: objectives vary by powers of ten.
    Logarithm,
    /// Over a size, where it is not above 0.
    Linear(f64),
}

impl CostScale {
    /// The cost of a value, and its derivative, for one that is to be small.
    fn cost(self, value: f64) -> (f64, f64) {
        match self {
            Self::Logarithm if value > 0.0 => (value.ln(), value.recip()),
            Self::Logarithm => (f64::NEG_INFINITY, f64::NAN),
            Self::Linear(size) => {
                let size = if size > 0.0 { size } else { 1.0 };
                (value / size, size.recip())
            }
        }
    }
}

/// Whether bending brings no scales into contact.
fn is_open(result: &DesignResult) -> bool {
    result.flexure.is_some_and(|flexure| flexure.measures.contact == Some(false))
}

/// The problem of a climb: the objective, turned to be small and about 1 in size, over shares of the intervals.
struct Slope<'a> {
    walk: &'a LocalSearch<'a>,
    scale: CostScale,
    /// Whether the climb stays where bending brings no scales into contact: compliances jump where it does, and no derivative tells.
    stays_open: bool,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Slope<'_> {
    fn worth(&self, shares: &[f64]) -> Result<(Option<Worth>, LookedRow), Halt> {
        let (candidate, row) = self.walk.at(SearchStage::Gradient, shares, true)?;
        match candidate.verdict {
            Judgement::Judged(worth) => Ok((Some(worth), row)),
            _ => Ok((None, row)),
        }
    }

    /// The number of constraints: requirements, then floors.
    fn count(&self) -> usize {
        let floors = self.walk.target.floors.len();
        self.walk.search.judge.requirements().count() + floors + usize::from(self.stays_open)
    }

    /// The sign of the objective.
    fn sign(&self) -> f64 {
        self.walk.search.judge.sign(self.walk.target.objective)
    }

    fn turned(&self, worth: &Worth, k: usize) -> f64 {
        self.walk.search.judge.sign(k) * worth.objectives[k]
    }

    /// The derivative of a turned value with respect to each share; not a number where there is none.
    fn gradient_of(&self, shares: &[f64], slopes: impl Fn(&Parameter) -> Slopes) -> Vec<f64> {
        let intervals = self.walk.search.space.intervals().iter().zip(shares);
        let slope = |(interval, share): (&crate::space::Interval, &f64)| {
            let Slopes { left, right } = slopes(interval.parameter);
            let slope = match *share {
                share if share <= 0.0 => right.or(left),
                share if share >= 1.0 => left.or(right),
                _ => Slopes { left, right }.uphill(),
            };
            slope.map_or(f64::NAN, |slope| slope * interval.length())
        };
        intervals.map(slope).collect()
    }
}

impl CostFunction for Slope<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Halt;

    fn cost(&self, shares: &Vec<f64>) -> Result<f64, Halt> {
        let (worth, _) = self.worth(shares)?;
        let Some(worth) = worth else { return Ok(f64::INFINITY) };
        let objective = self.walk.target.objective;
        let cost = -self.sign() * self.scale.cost(worth.objectives[objective]).0;
        // A logarithm that does not exist is no way to go, whichever sign is good.
        Ok(if cost.is_finite() { cost } else { f64::INFINITY })
    }
}

impl Gradient for Slope<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, shares: &Vec<f64>) -> Result<Vec<f64>, Halt> {
        let (worth, row) = self.worth(shares)?;
        let Some(worth) = worth else { return Ok(vec![f64::NAN; shares.len()]) };
        let objective = self.walk.target.objective;
        let judge = self.walk.search.judge;
        let slopes = |p: &Parameter| judge.objective_slopes(objective, &row, p);
        let (_, rate) = self.scale.cost(worth.objectives[objective]);
        let gradient = self.gradient_of(shares, slopes);
        Ok(gradient.into_iter().map(|slope| -slope * rate).collect())
    }
}

impl Constraints for Slope<'_> {
    type Set = ConstraintSet<
        BoxBounds<Vec<f64>>,
        NoLinearConstraints,
        NonlinearBlocks<NoNonlinearBlock, NonlinearBlock>,
    >;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new()
            .with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
            .with_nonlinear_inequalities(self.count())
    }
}

impl NonlinearInequalityValues for Slope<'_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Halt;

    fn nonlinear_inequalities(
        &self,
        shares: &Vec<f64>,
    ) -> Result<Vec<f64>, ConstraintSolveError<Halt>> {
        let (worth, row) = self.worth(shares)?;
        let Some(worth) = worth else { return Ok(vec![f64::INFINITY; self.count()]) };
        let room = self.stays_open.then(|| CLEAR - bending_room(&row.drawn.case));
        let floors = &self.walk.target.floors;
        let floors =
            floors.iter().map(|&(k, floor)| (floor - self.turned(&worth, k)) / floor_size(floor));
        Ok(worth.excess.iter().copied().chain(floors).chain(room).collect())
    }
}

impl ConstraintJacobian for Slope<'_> {
    type Param = Vec<f64>;
    type Jacobian = DenseMatrix;
    type Error = Halt;

    fn constraint_jacobian(
        &self,
        shares: &Vec<f64>,
    ) -> Result<DenseMatrix, ConstraintSolveError<Halt>> {
        let (_, row) = self.worth(shares)?;
        let judge = self.walk.search.judge;
        let mut rows: Vec<f64> = Vec::new();
        let mut add = |gradient: Vec<f64>, scale: f64| {
            rows.extend(gradient.into_iter().map(|slope| -slope * scale));
        };
        for k in 0..judge.requirements().count() {
            let slopes = |p: &Parameter| judge.margin_slopes(k, &row, p);
            add(self.gradient_of(shares, slopes), 1.0);
        }
        for &(k, floor) in &self.walk.target.floors {
            let slopes = |p: &Parameter| judge.objective_slopes(k, &row, p);
            add(self.gradient_of(shares, slopes), floor_size(floor).recip());
        }
        if self.stays_open {
            add(self.gradient_of(shares, |p| bending_room_slopes(&row.drawn.case, p)), 1.0);
        }
        Ok(DenseMatrix::from_row_slice(self.count(), shares.len(), &rows))
    }
}
