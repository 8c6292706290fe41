//! Bounded least squares by the Levenberg–Marquardt method, with exact derivatives.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};

use basin::{
    BoundedLevenbergMarquardt, BoxBounds, ConstraintDescription, ConstraintSet,
    ConstraintSolveError, Constraints, DenseMatrix, Executor, Jacobian, PointState, Residual,
};
use run::{Evaluator, WorkMeter, WorkPiece, uninterrupted};

use crate::definition::FitDefinition;
use crate::fit_result::FitError;
use crate::model::ModelCurve;

/// Number of starting points per unknown, and number of the best that are improved.
const STARTS: usize = 8;
const IMPROVED: usize = 4;

/// Maximum number of steps of a local search.
///
/// With noise, a search takes five to ten.
const MOST_STEPS: u64 = 60;

/// Expected number of solutions of a local search, to predict the remaining work.
const EXPECTED: u64 = 12;

/// Residual of a skin that cannot be solved.
///
/// It is larger than any other residual, but finite: the solver stops at infinite residuals.
const UNSOLVABLE: f64 = 1e6;

/// Gradient at convergence.
///
/// Residuals are divided by the noise, so the sum of their squares is about the number of points.
const FLAT: f64 = 1e-7;

/// Relative change of the sum of squares at convergence.
///
/// The unknowns then change by some `1e-4` of their confidence intervals.
const CHANGED: f64 = 1e-9;

/// Residuals of all curves, divided by the noise.
///
/// Unknowns are scaled to 0 … 1 between their bounds.
pub(crate) struct Residuals<'a> {
    pub(crate) definition: &'a FitDefinition,
    pub(crate) evaluator: &'a Evaluator,
    /// Standard deviation of the noise of each curve.
    pub(crate) noise: Vec<f64>,
    pub(crate) stop: &'a AtomicBool,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Last solution. Its derivatives are usually requested next.
    last: RefCell<Option<(Vec<f64>, Solved)>>,
    solutions: RefCell<usize>,
    work: &'a WorkMeter,
    /// Progress of the current local search.
    piece: RefCell<Option<WorkPiece<'a>>>,
}

/// Curves of the model; `None` if a path cannot be solved.
type Solved = Option<Rc<Vec<ModelCurve>>>;

impl<'a> Residuals<'a> {
    pub(crate) fn new(
        definition: &'a FitDefinition,
        evaluator: &'a Evaluator,
        (stop, work): (&'a AtomicBool, &'a WorkMeter),
    ) -> Self {
        let count = definition.unknowns.len();
        // With several curves, estimating the noise takes about three more searches.
        let improved = IMPROVED + if definition.curves.len() > 1 { 3 } else { 0 };
        work.begin((STARTS * count + 1) as u64 + EXPECTED * improved as u64);
        // Weight curves by their size until their noise is known, because newtons and newton
        // millimetres cannot be compared.
        let noise = definition.curves.iter().map(|curve| {
            let points = &curve.measured.points;
            let squares: f64 = points.iter().map(|point| point[1].powi(2)).sum();
            (squares / points.len() as f64).sqrt().max(f64::MIN_POSITIVE)
        });
        Self {
            definition,
            evaluator,
            noise: noise.collect(),
            stop,
            lower: vec![0.0; count],
            upper: vec![1.0; count],
            last: RefCell::default(),
            solutions: RefCell::default(),
            work,
            piece: RefCell::default(),
        }
    }

    /// Returns the number of solved skins.
    pub(crate) fn solutions(&self) -> usize {
        *self.solutions.borrow()
    }

    /// Returns the values of scaled unknowns.
    pub(crate) fn values(&self, shares: &[f64]) -> Vec<f64> {
        let unknowns = self.definition.unknowns.iter().zip(shares);
        unknowns
            .map(|(unknown, share)| unknown.from + share * (unknown.to - unknown.from))
            .collect()
    }

    /// Computes the model curves at scaled unknowns.
    pub(crate) fn solved(&self, shares: &[f64]) -> Result<Solved, FitError> {
        if let Some((at, solved)) = &*self.last.borrow()
            && at == shares
        {
            return Ok(solved.clone());
        }
        if self.stop.load(Ordering::Relaxed) {
            return Err(FitError::Stopped);
        }
        *self.solutions.borrow_mut() += 1;
        match &*self.piece.borrow() {
            Some(piece) => piece.count(1),
            None => self.work.count(1),
        }
        let model = uninterrupted(|| self.definition.model(self.evaluator, &self.values(shares)));
        let solved = model.ok_or(FitError::Stopped)?.ok().map(Rc::new);
        *self.last.borrow_mut() = Some((shares.to_vec(), solved.clone()));
        Ok(solved)
    }

    /// Returns the residuals of each curve, in its own unit.
    pub(crate) fn of_curves(&self, model: &[ModelCurve]) -> Vec<Vec<f64>> {
        let residual = |(measured, value): (&[f64; 2], &f64)| value - measured[1];
        let curves = self.definition.curves.iter().zip(model);
        let of = curves.map(|(curve, model)| {
            curve.measured.points.iter().zip(&model.values).map(residual).collect()
        });
        of.collect()
    }

    /// Returns all residuals, divided by the noise of their curves.
    fn weighted(&self, shares: &[f64]) -> Result<Vec<f64>, FitError> {
        // If one curve has no solution, the whole set of unknowns is rejected.
        let Some(model) = self.solved(shares)? else {
            let points = self.definition.curves.iter().map(|curve| curve.measured.points.len());
            return Ok(vec![UNSOLVABLE; points.sum()]);
        };
        let curves = self.of_curves(&model).into_iter().zip(&self.noise);
        Ok(curves.flat_map(|(of, noise)| of.into_iter().map(move |r| r / noise)).collect())
    }

    /// Returns one column of the Jacobian of the weighted residuals.
    pub(crate) fn column(&self, model: &[ModelCurve], unknown: usize) -> Vec<f64> {
        let Self { definition, noise, .. } = self;
        let range = definition.unknowns[unknown].to - definition.unknowns[unknown].from;
        let curves = model.iter().zip(noise);
        curves
            .flat_map(|(m, noise)| m.rates[unknown].iter().map(move |r| r * range / noise))
            .collect()
    }

    /// Searches for a local minimum from `start` and returns its scaled unknowns.
    pub(crate) fn minimise(&self, start: Vec<f64>) -> Result<Vec<f64>, FitError> {
        let solver = BoundedLevenbergMarquardt::new()
            .with_absolute_scaled_gradient_tolerance(FLAT)
            .with_relative_cost_change_tolerance(CHANGED);
        let search = Executor::new(self, solver, PointState::new(start)).max_iter(MOST_STEPS);
        *self.piece.borrow_mut() = Some(WorkPiece::new(self.work, EXPECTED));
        let found = search.run();
        *self.piece.borrow_mut() = None;
        match found {
            Ok(found) => Ok(found.param().clone()),
            Err(ConstraintSolveError::Evaluation(stopped)) => Err(stopped),
            // The bounds are always 0 and 1.
            Err(_) => unreachable!("bounds in order"),
        }
    }

    /// Returns the scaled unknowns at the best of several local minima.
    ///
    /// Local searches start at the best points of a space-filling sample. Several are needed: where
    /// the contact state changes, the sum of squares has kinks, and local minima next to them.
    pub(crate) fn best(&self) -> Result<Vec<f64>, FitError> {
        let count = self.lower.len();
        let cost = |shares: &[f64]| -> Result<f64, FitError> {
            Ok(self.weighted(shares)?.iter().map(|r| r * r).sum())
        };
        let filling = (0..=STARTS * count).map(|k| filling(k, count));
        let with_cost = |shares: Vec<f64>| Ok((cost(&shares)?, shares));
        let mut starts = filling.map(with_cost).collect::<Result<Vec<_>, FitError>>()?;
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.truncate(IMPROVED);
        let improved = starts.into_iter().map(|(_, start)| with_cost(self.minimise(start)?));
        let improved = improved.collect::<Result<Vec<_>, FitError>>()?;
        let best = improved.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(best.map_or_else(Vec::new, |(_, shares)| shares))
    }
}

/// Returns point `k` of Roberts's R sequence, which fills the unit cube.
///
/// Point 0 is the centre.
fn filling(k: usize, count: usize) -> Vec<f64> {
    let root = (0..40).fold(1.5_f64, |x, _| (1.0 + x).powf(1.0 / (count as f64 + 1.0)));
    let share = |j: usize| (0.5 + k as f64 * root.powi(-(j as i32 + 1))).fract();
    (0..count).map(share).collect()
}

impl Residual for &Residuals<'_> {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Error = FitError;

    fn residual(&self, shares: &Vec<f64>) -> Result<Vec<f64>, FitError> {
        self.weighted(shares)
    }
}

impl Jacobian for &Residuals<'_> {
    type Jacobian = DenseMatrix;

    fn jacobian(&self, shares: &Vec<f64>) -> Result<DenseMatrix, FitError> {
        let points = self.definition.curves.iter().map(|curve| curve.measured.points.len()).sum();
        let count = shares.len();
        let columns: Vec<_> = match self.solved(shares)? {
            Some(model) => (0..count).map(|j| self.column(&model, j)).collect(),
            // A zero gradient ends the search. Only starts can be unsolvable: the solver takes no
            // step to a worse point.
            None => vec![vec![0.0; points]; count],
        };
        let rows = (0..points).flat_map(|i| columns.iter().map(move |column| column[i]));
        Ok(DenseMatrix::from_row_slice(points, count, &rows.collect::<Vec<_>>()))
    }
}

impl Constraints for &Residuals<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}
