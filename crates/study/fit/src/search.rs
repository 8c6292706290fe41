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
use crate::error::FitError;
use crate::model::ModelCurve;

/// Number of points per unknown in the first sample of the ranges.
const STARTS: usize = 8;
/// Number of the best sampled points at which local searches start.
const IMPROVED: usize = 6;

/// Maximum number of steps of a local search.
///
/// A search on curves with noise takes five to ten steps.
const MOST_STEPS: u64 = 60;

/// Expected number of model evaluations in a local search, to predict the remaining work.
const EXPECTED: u64 = 12;
/// Expected number of model evaluations in a profile, to predict the remaining work.
const EXPECTED_PROFILE: u64 = 60;

/// Weighted residual at all points if the path of any curve cannot be solved.
///
/// The value exceeds all other residuals, but is finite, because the Levenberg–Marquardt solver
/// stops at infinite residuals.
const UNSOLVABLE: f64 = 1e6;

/// Scaled gradient of the sum of squares below which a search has converged.
///
/// Residuals are divided by the noise, so the sum of their squares is about the number of points.
const FLAT: f64 = 1e-7;

/// Relative change of the sum of squares in a step below which a search has converged.
///
/// The unknowns then change by about `1e-4` of their confidence intervals.
const CHANGED: f64 = 1e-9;
/// Relative change of the sum of squares below which a search for a profile point has converged.
///
/// It is larger than `CHANGED`, because profile points only locate the ends of an interval.
const CHANGED_IN_PROFILE: f64 = 1e-5;

/// Residuals of all curves, divided by the noise of each curve.
///
/// Unknowns are scaled to 0 … 1 between their bounds.
pub(crate) struct Residuals<'a> {
    pub(crate) definition: &'a FitDefinition,
    pub(crate) evaluator: &'a Evaluator,
    pub(crate) noise: Vec<Noise>,
    pub(crate) stop: &'a AtomicBool,
    /// Scaled unknowns and curves of the last evaluation. The solver usually requests their
    /// derivatives next.
    last: RefCell<Option<(Vec<f64>, Solved)>>,
    solutions: RefCell<usize>,
    /// Evaluated scaled unknowns, with the unweighted sum of squares of each curve.
    visited: RefCell<Vec<(Vec<f64>, Vec<f64>)>>,
    work: &'a WorkMeter,
    /// Progress of the current search or profile.
    piece: RefCell<Option<WorkPiece<'a>>>,
}

/// Estimated noise of a measured curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Standard deviation of the residuals.
    pub(crate) deviation: f64,
    /// Correlation of neighbouring residuals, if it is significant.
    pub(crate) trend: Option<f64>,
    /// Number of points divided by the number of independent points.
    ///
    /// It is `(1 + ρ)/(1 − ρ)` for a correlation `ρ` of neighbouring residuals, at least 1.
    pub(crate) widening: f64,
}

impl Noise {
    /// Returns the deviation by which residuals are divided.
    ///
    /// If residuals are correlated, the result exceeds the standard deviation: `n` correlated
    /// residuals determine their mean as accurately as `n/widening` independent ones.
    pub(crate) fn scale(&self) -> f64 {
        self.deviation * self.widening.sqrt()
    }
}

/// Model curves, one for each measured curve; `None` if a path cannot be solved.
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
        let profiles = EXPECTED_PROFILE * count as u64;
        work.begin((STARTS * count + 1) as u64 + EXPECTED * improved as u64 + profiles);
        // Until their noise is known, divide the residuals of each curve by the size of the curve,
        // because forces in N and moments in N mm cannot be compared.
        let noise = definition.curves.iter().map(|curve| {
            let points = &curve.measured.points;
            let squares: f64 = points.iter().map(|point| point[1].powi(2)).sum();
            let deviation = (squares / points.len() as f64).sqrt().max(f64::MIN_POSITIVE);
            Noise { deviation, trend: None, widening: 1.0 }
        });
        Self {
            definition,
            evaluator,
            noise: noise.collect(),
            stop,
            last: RefCell::default(),
            solutions: RefCell::default(),
            visited: RefCell::default(),
            work,
            piece: RefCell::default(),
        }
    }

    /// Returns the number of model evaluations so far, each for all curves.
    pub(crate) fn solutions(&self) -> usize {
        *self.solutions.borrow()
    }

    /// Converts scaled unknowns to their values.
    pub(crate) fn values(&self, scaled: &[f64]) -> Vec<f64> {
        let unknowns = self.definition.unknowns.iter().zip(scaled);
        unknowns.map(|(unknown, &scaled)| unknown.value(scaled)).collect()
    }

    /// Returns the model curves at scaled unknowns.
    ///
    /// They are computed unless the last call had the same unknowns.
    pub(crate) fn solved(&self, scaled: &[f64]) -> Result<Solved, FitError> {
        if let Some((at, solved)) = &*self.last.borrow()
            && at == scaled
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
        let model = uninterrupted(|| self.definition.model(self.evaluator, &self.values(scaled)));
        let solved = model.ok_or(FitError::Stopped)?.ok().map(Rc::new);
        if let Some(model) = &solved {
            let curves = self.of_curves(model).into_iter();
            let squares = curves.map(|of| of.iter().map(|r| r * r).sum()).collect();
            self.visited.borrow_mut().push((scaled.to_vec(), squares));
        }
        *self.last.borrow_mut() = Some((scaled.to_vec(), solved.clone()));
        Ok(solved)
    }

    /// Returns the residuals (model minus measurement) of each curve, in the unit of the curve.
    pub(crate) fn of_curves(&self, model: &[ModelCurve]) -> Vec<Vec<f64>> {
        let curves = self.definition.curves.iter().zip(model);
        let residuals = curves.map(|(curve, model)| {
            let pairs = curve.measured.points.iter().zip(&model.values);
            pairs.map(|(measured, value)| value - measured[1]).collect()
        });
        residuals.collect()
    }

    /// Returns all residuals, divided by the noise of their curves.
    fn weighted(&self, scaled: &[f64]) -> Result<Vec<f64>, FitError> {
        // If any curve has no solution, reject these unknowns for all curves.
        let Some(model) = self.solved(scaled)? else {
            let points = self.definition.curves.iter().map(|curve| curve.measured.points.len());
            return Ok(vec![UNSOLVABLE; points.sum()]);
        };
        let curves = self.of_curves(&model).into_iter().zip(&self.noise);
        Ok(curves.flat_map(|(of, noise)| of.into_iter().map(move |r| r / noise.scale())).collect())
    }

    /// Returns the derivatives of the weighted residuals with respect to one scaled unknown.
    pub(crate) fn column(&self, model: &[ModelCurve], unknown: usize) -> Vec<f64> {
        let Self { definition, noise, .. } = self;
        let range = definition.unknowns[unknown].to - definition.unknowns[unknown].from;
        let curves = model.iter().zip(noise);
        curves
            .flat_map(|(m, noise)| m.rates[unknown].iter().map(move |r| r * range / noise.scale()))
            .collect()
    }

    /// Returns the sum of the weighted squares.
    pub(crate) fn cost(&self, scaled: &[f64]) -> Result<f64, FitError> {
        Ok(self.weighted(scaled)?.iter().map(|r| r * r).sum())
    }

    /// Lists the evaluated points with a weighted sum of squares of at most `limit`.
    pub(crate) fn visited_below(&self, limit: f64) -> Vec<Minimum> {
        let mut below = Vec::new();
        for (scaled, squares) in &*self.visited.borrow() {
            let curves = squares.iter().zip(&self.noise);
            let cost = curves.map(|(squares, noise)| squares / noise.scale().powi(2)).sum();
            if cost <= limit {
                below.push(Minimum { cost, scaled: scaled.clone() });
            }
        }
        below
    }

    /// Searches for a local minimum from `start` over all unknowns, and reports progress.
    pub(crate) fn improve(&self, start: Vec<f64>) -> Result<Minimum, FitError> {
        self.with_progress(EXPECTED, || self.minimise(start, None))
    }

    /// Runs `work`, the computation of a profile, and reports its progress.
    pub(crate) fn profile<T>(&self, work: impl FnOnce() -> T) -> T {
        self.with_progress(EXPECTED_PROFILE, work)
    }

    fn with_progress<T>(&self, expected: u64, work: impl FnOnce() -> T) -> T {
        *self.piece.borrow_mut() = Some(WorkPiece::new(self.work, expected));
        let found = work();
        *self.piece.borrow_mut() = None;
        found
    }

    /// Searches for a local minimum from `start`.
    ///
    /// If `fixed` is the index of an unknown, this unknown keeps its value in `start`.
    pub(crate) fn minimise(
        &self,
        start: Vec<f64>,
        fixed: Option<usize>,
    ) -> Result<Minimum, FitError> {
        let mut free = start.clone();
        let fixed = fixed.map(|j| (j, free.remove(j)));
        if free.is_empty() {
            return Ok(Minimum { cost: self.cost(&start)?, scaled: start });
        }
        let (lower, upper) = (vec![0.0; free.len()], vec![1.0; free.len()]);
        let slice = Slice { residuals: self, fixed, lower, upper };
        let changed = if fixed.is_some() { CHANGED_IN_PROFILE } else { CHANGED };
        let solver = BoundedLevenbergMarquardt::new()
            .with_absolute_scaled_gradient_tolerance(FLAT)
            .with_relative_cost_change_tolerance(changed);
        match Executor::new(&slice, solver, PointState::new(free)).max_iter(MOST_STEPS).run() {
            Ok(found) => {
                let scaled = slice.all(found.param());
                Ok(Minimum { cost: self.cost(&scaled)?, scaled })
            }
            Err(ConstraintSolveError::Evaluation(stopped)) => Err(stopped),
            Err(_) => unreachable!("the bounds are always 0 and 1, which are valid"),
        }
    }

    /// Returns the best of several local minima.
    ///
    /// Local searches start at the best points of a space-filling sample. Several searches are
    /// needed, because the sum of squares has a kink wherever a contact state changes, and local
    /// minima beside these kinks.
    pub(crate) fn best(&self) -> Result<Minimum, FitError> {
        let count = self.definition.unknowns.len();
        let mut starts = (0..=STARTS * count)
            .map(|k| filling(k, count))
            .map(|scaled| Ok((self.cost(&scaled)?, scaled)))
            .collect::<Result<Vec<_>, FitError>>()?;
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.truncate(IMPROVED);
        let improved = starts.into_iter().map(|(_, start)| self.improve(start));
        let improved = improved.collect::<Result<Vec<_>, FitError>>()?;
        let best = improved.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        best.ok_or(FitError::NoUnknowns)
    }
}

/// A local minimum.
#[derive(Clone, Debug)]
pub(crate) struct Minimum {
    /// Sum of the weighted squares.
    pub(crate) cost: f64,
    /// Scaled unknowns.
    pub(crate) scaled: Vec<f64>,
}

/// Residuals as a function of all unknowns, or of all unknowns except a fixed one.
struct Slice<'r, 'a> {
    residuals: &'r Residuals<'a>,
    /// Index and scaled value of the fixed unknown.
    fixed: Option<(usize, f64)>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Slice<'_, '_> {
    /// Returns all scaled unknowns: the free ones, with the fixed one inserted.
    fn all(&self, free: &[f64]) -> Vec<f64> {
        let mut all = free.to_vec();
        if let Some((j, value)) = self.fixed {
            all.insert(j, value);
        }
        all
    }
}

/// Returns point `k` of Roberts's R sequence, which fills the unit cube.
///
/// `count` is the dimension. Point 0 is the centre of the cube.
fn filling(k: usize, count: usize) -> Vec<f64> {
    let root = (0..40).fold(1.5_f64, |x, _| (1.0 + x).powf(1.0 / (count as f64 + 1.0)));
    (0..count).map(|j| (0.5 + k as f64 * root.powi(-(j as i32 + 1))).fract()).collect()
}

impl Residual for &Slice<'_, '_> {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Error = FitError;

    fn residual(&self, free: &Vec<f64>) -> Result<Vec<f64>, FitError> {
        self.residuals.weighted(&self.all(free))
    }
}

impl Jacobian for &Slice<'_, '_> {
    type Jacobian = DenseMatrix;

    fn jacobian(&self, free: &Vec<f64>) -> Result<DenseMatrix, FitError> {
        let Residuals { definition, .. } = self.residuals;
        let points = definition.curves.iter().map(|curve| curve.measured.points.len()).sum();
        let columns: Vec<_> = match self.residuals.solved(&self.all(free))? {
            Some(model) => (0..definition.unknowns.len())
                .filter(|j| self.fixed.is_none_or(|(fixed, _)| *j != fixed))
                .map(|j| self.residuals.column(&model, j))
                .collect(),
            // A zero gradient ends the search. Only a starting point can be unsolvable, because the
            // Levenberg–Marquardt solver takes no step to a worse point.
            None => vec![vec![0.0; points]; free.len()],
        };
        let rows = (0..points).flat_map(|i| columns.iter().map(move |column| column[i]));
        Ok(DenseMatrix::from_row_slice(points, free.len(), &rows.collect::<Vec<_>>()))
    }
}

impl Constraints for &Slice<'_, '_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}
