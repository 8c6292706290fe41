//! Least squares within bounds, by the method of Levenberg and Marquardt along exact derivatives.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};

use basin::{
    BoundedLevenbergMarquardt, BoxBounds, ConstraintDescription, ConstraintSet,
    ConstraintSolveError, Constraints, DenseMatrix, Executor, Jacobian, PointState, Residual,
};
use run::{Evaluator, WorkMeter, WorkPiece};

use crate::definition::FitDefinition;
use crate::fit_result::FitError;
use crate::model::ModelCurve;

/// Points that are looked at for each unknown, and how many of them, the best, are improved.
const STARTS: usize = 8;
const IMPROVED: usize = 4;

/// Steps of one search, at most. One with noise takes five to ten.
const MOST_STEPS: u64 = 60;

/// Skins that an improvement solves, as is expected where the work is told.
const EXPECTED: u64 = 12;

/// A residual of a skin that cannot be solved at all: worse than any that can, and no infinity, which would end the search.
const UNSOLVABLE: f64 = 1e6;

/// Largest gradient at which the search ends. Residuals are parts of the noise, so that the sum of their squares is that of its points.
const FLAT: f64 = 1e-7;

/// Change of the sum of squares, as a part of it, at which the search ends: unknowns then move by some ten-thousandths of their intervals.
const CHANGED: f64 = 1e-9;

/// Residuals of all curves, each over the noise of its curve, by shares of the ranges of the unknowns.
pub(crate) struct Residuals<'a> {
    pub(crate) definition: &'a FitDefinition,
    pub(crate) evaluator: &'a Evaluator,
    /// The noise of each curve.
    pub(crate) noise: Vec<f64>,
    pub(crate) stop: &'a AtomicBool,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// The last that was solved, since its derivatives are asked for next.
    last: RefCell<Option<(Vec<f64>, Solved)>>,
    solutions: RefCell<usize>,
    work: &'a WorkMeter,
    /// The improvement in hand.
    piece: RefCell<Option<WorkPiece<'a>>>,
}

/// The curves of the model; `None` where it has none.
type Solved = Option<Rc<Vec<ModelCurve>>>;

impl<'a> Residuals<'a> {
    pub(crate) fn new(
        definition: &'a FitDefinition,
        evaluator: &'a Evaluator,
        (stop, work): (&'a AtomicBool, &'a WorkMeter),
    ) -> Self {
        let count = definition.unknowns.len();
        // Of several curves the noise is found in some three more improvements.
        let improved = IMPROVED + if definition.curves.len() > 1 { 3 } else { 0 };
        work.begin((STARTS * count + 1) as u64 + EXPECTED * improved as u64);
        // Until residuals tell the noise, each curve counts by its size: newtons beside newton mm.
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

    /// Skins that were solved.
    pub(crate) fn solutions(&self) -> usize {
        *self.solutions.borrow()
    }

    /// The values at some shares of the ranges.
    pub(crate) fn values(&self, shares: &[f64]) -> Vec<f64> {
        let unknowns = self.definition.unknowns.iter().zip(shares);
        unknowns
            .map(|(unknown, share)| unknown.from + share * (unknown.to - unknown.from))
            .collect()
    }

    /// The curves of the model at some shares.
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
        let solved = self.definition.model(self.evaluator, &self.values(shares)).ok().map(Rc::new);
        *self.last.borrow_mut() = Some((shares.to_vec(), solved.clone()));
        Ok(solved)
    }

    /// The residuals of each curve, in its own unit.
    pub(crate) fn of_curves(&self, model: &[ModelCurve]) -> Vec<Vec<f64>> {
        let residual = |(measured, value): (&[f64; 2], &f64)| value - measured[1];
        let curves = self.definition.curves.iter().zip(model);
        let of = curves.map(|(curve, model)| {
            curve.measured.points.iter().zip(&model.values).map(residual).collect()
        });
        of.collect()
    }

    /// All residuals over the noise of their curves.
    fn weighted(&self, shares: &[f64]) -> Result<Vec<f64>, FitError> {
        // Where one curve has no solution, none counts: the skins of a fit stand together.
        let Some(model) = self.solved(shares)? else {
            let points = self.definition.curves.iter().map(|curve| curve.measured.points.len());
            return Ok(vec![UNSOLVABLE; points.sum()]);
        };
        let curves = self.of_curves(&model).into_iter().zip(&self.noise);
        Ok(curves.flat_map(|(of, noise)| of.into_iter().map(move |r| r / noise)).collect())
    }

    /// The derivatives of all residuals, over the noise, with respect to the share of one unknown.
    pub(crate) fn column(&self, model: &[ModelCurve], unknown: usize) -> Vec<f64> {
        let Self { definition, noise, .. } = self;
        let range = definition.unknowns[unknown].to - definition.unknowns[unknown].from;
        let curves = model.iter().zip(noise);
        curves
            .flat_map(|(m, noise)| m.rates[unknown].iter().map(move |r| r * range / noise))
            .collect()
    }

    /// The shares at which the sum of squares is the least that is found from `start`.
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
            // The bounds are 0 and 1.
            Err(_) => unreachable!("bounds in order"),
        }
    }

    /// The shares with the least sum of squares that is found from the best of those that fill the ranges. Where scales and needle come
    /// to rub or touch otherwise the sum has kinks, and beside them minima of their own.
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

/// The `k`-th point of a sequence that fills the unit cube of so many dimensions (Roberts's R sequence), from its middle.
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
            // Flat, which ends the search: only a start is ever asked here, no step goes there.
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
