//! Result of a fit: estimates, confidence intervals and undetermined unknowns.
//!
//! Let `r` be the residuals over the noise of their curves, `p` the unknowns scaled to their
//! ranges, and `J = ∂r/∂p` at the minimum. The covariance of `p` is `(JᵀJ)⁻¹ = V S⁻² Vᵀ`, with the
//! singular values `S` and directions `V` of `J`. Along some directions the curves may constrain
//! the unknowns less than the ranges do. The result names the unknowns in these directions.

use std::sync::atomic::AtomicBool;

use nalgebra::DMatrix;
use run::{Evaluator, WorkMeter};
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use sweep::Sweep;

use crate::definition::{FitDefinition, TestCurve, Unknown};
use crate::measured_curve::Ending;
use crate::model::ModelCurve;
use crate::search::Residuals;

/// Result of a fit.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// Estimates, in the order of the unknowns.
    pub estimates: Vec<Estimate>,
    /// Correlations of the estimates, −1 to 1.
    pub correlations: Vec<Vec<f64>>,
    /// Groups of undetermined unknowns, by index.
    ///
    /// The curves hardly depend on the unknown in a group of one. In a larger group, only
    /// combinations of the unknowns are determined.
    pub undetermined: Vec<Vec<usize>>,
    /// Measured and fitted curves.
    pub curves: Vec<FittedCurve>,
    /// Number of solved skins.
    pub solutions: usize,
    /// Design of the definition, with the estimates.
    pub sweep: Sweep,
}

/// Estimate of an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The unknown.
    pub unknown: Unknown,
    /// Value at the minimum of the sum of squares.
    pub value: f64,
    /// 95 % confidence interval; `None` if the curves do not determine the unknown.
    pub interval: Option<[f64; 2]>,
    /// True if the value is at a bound, where the interval is unreliable.
    pub at_end: bool,
}

/// A measured curve and the fitted curve.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedCurve {
    /// Name of its file.
    pub file: String,
    /// Quantities on the axes, with their units.
    pub axes: [String; 2],
    /// Displacement or curvature, measured value, fitted value.
    pub points: Vec<[f64; 3]>,
    /// True if the columns have physical units, false for units of the model.
    pub is_physical: bool,
    /// Lines that were left out: remarks, footers, and gaps in the recording.
    pub left_out: Vec<u64>,
    /// Whether the signs of the file were reversed, on both axes.
    pub reversed: [bool; 2],
    /// End of the loading branch, if the file goes on after it.
    pub ending: Option<Ending>,
    /// True if the skin resists at no point, for example because signs are reversed.
    pub is_turned: bool,
    /// Standard deviation of the residuals.
    pub noise: f64,
    /// Correlation of neighbouring residuals, if it is significant.
    ///
    /// The model then differs systematically from the skin.
    pub trend: Option<f64>,
    /// Number of points beyond the end of the fitted path.
    pub beyond: usize,
    /// Number of derivatives from differences of solutions.
    pub differenced: usize,
}

/// A fit without a result.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// The fit was stopped.
    #[error("stopped before an answer was found")]
    Stopped,
    /// There are not more points than unknowns.
    #[error(
        "too few points: {points}, for {unknowns} unknowns; expected more points than unknowns"
    )]
    TooFew {
        /// Number of points of all curves.
        points: usize,
        /// Number of unknowns.
        unknowns: usize,
    },
    /// The definition has no unknowns.
    #[error("nothing is sought; add [variables] or offsets to a [[curve]]")]
    NothingSought,
    /// No evaluated skin within the ranges can be solved.
    #[error("none of the skins that were tried can be solved; look at one with squama design")]
    Unsolvable,
}

/// Maximum number of iterations for the noise. Three or four usually suffice.
const ROUNDS: usize = 10;
/// Relative change of the noise at convergence.
const SETTLED: f64 = 1e-3;
/// Smallest noise as a fraction of the size of a curve: accuracy of the solver.
const LEAST_NOISE: f64 = 1e-8;
/// Singular values below this fraction of the largest are round-off.
const ROUND_OFF: f64 = 1e-6;
/// Half-width, as a fraction of the range, above which an unknown is undetermined.
const AS_WIDE: f64 = 0.5;
/// Significance limit for the correlation of neighbouring residuals, times √n.
///
/// Independent residuals exceed it in one of 700 curves.
const BEYOND_CHANCE: f64 = 3.0;
/// Noise below this fraction of the largest value is not reported as a trend.
const NEGLIGIBLE: f64 = 1e-4;
/// Distance at which a value counts as at its bound, as a fraction of the range.
///
/// The search keeps its iterates strictly between the bounds.
const AT_END: f64 = 1e-3;

impl FitDefinition {
    /// Fits the model curves to the measured ones.
    ///
    /// Stops early if `stop` is set, and reports progress to `work`.
    ///
    /// # Errors
    ///
    /// If there are too few points or no unknowns, if no skin can be solved, or after `stop`.
    pub fn fit(&self, stop: &AtomicBool, work: &WorkMeter) -> Result<Fitted, FitError> {
        let points = self.curves.iter().map(|curve| curve.measured.points.len()).sum();
        let unknowns = self.unknowns.len();
        if unknowns == 0 {
            return Err(FitError::NothingSought);
        }
        if points <= unknowns {
            return Err(FitError::TooFew { points, unknowns });
        }
        // No measures: only curves are computed.
        let evaluator = Evaluator::new(&[]);
        let mut residuals = Residuals::new(self, &evaluator, (stop, work));
        let sizes = residuals.noise.clone();
        let mut shares = residuals.best()?;
        for _ in 0..ROUNDS {
            // Alternate: the noise weights the curves, and new unknowns change the noise.
            let noise = residuals.noise_at(&shares, &sizes)?;
            let changed = noise
                .iter()
                .zip(&residuals.noise)
                .any(|(new, old)| (new / old - 1.0).abs() > SETTLED);
            // Store the converged noise, too: the covariance and the report use it.
            residuals.noise = noise;
            // The noise of a single curve scales all residuals and does not move the minimum.
            if !changed || self.curves.len() == 1 {
                break;
            }
            shares = residuals.minimise(shares)?;
        }
        residuals.fitted(&shares)
    }
}

/// Singular value decomposition of the Jacobian.
///
/// Contains the singular values, the directions in the space of unknowns (columns), and their
/// components at the points.
struct Directions {
    values: Vec<f64>,
    unknowns: DMatrix<f64>,
    points: DMatrix<f64>,
}

impl Residuals<'_> {
    fn directions(&self, shares: &[f64]) -> Result<Directions, FitError> {
        let model = self.solved(shares)?.ok_or(FitError::Unsolvable)?;
        let columns: Vec<f64> = (0..shares.len()).flat_map(|j| self.column(&model, j)).collect();
        let jacobian = DMatrix::from_vec(columns.len() / shares.len(), shares.len(), columns);
        let svd = jacobian.svd(true, true);
        let (points, unknowns) = svd.u.zip(svd.v_t).ok_or(FitError::Unsolvable)?;
        Ok(Directions {
            values: svd.singular_values.as_slice().to_vec(),
            unknowns: unknowns.transpose(),
            points,
        })
    }

    /// Estimates the noise of each curve from its residuals.
    ///
    /// The sum of squares is divided by the number of points minus the degrees of freedom that the
    /// unknowns take from this curve.
    fn noise_at(&self, shares: &[f64], sizes: &[f64]) -> Result<Vec<f64>, FitError> {
        let directions = self.directions(shares)?;
        let model = self.solved(shares)?.ok_or(FitError::Unsolvable)?;
        let largest = directions.values.iter().copied().fold(0.0, f64::max);
        let mut first = 0;
        let noise = self.of_curves(&model).into_iter().zip(sizes).map(|(residuals, size)| {
            let rows = first..first + residuals.len();
            first = rows.end;
            let determined =
                directions.values.iter().enumerate().filter(|(_, s)| **s > ROUND_OFF * largest);
            let taken: f64 = determined
                .flat_map(|(k, _)| rows.clone().map(move |i| (i, k)))
                .map(|at| directions.points[at].powi(2))
                .sum();
            let squares: f64 = residuals.iter().map(|r| r * r).sum();
            // At least 1: an offset may fit a short curve exactly.
            let freedom = (residuals.len() as f64 - taken).max(1.0);
            (squares / freedom).sqrt().max(LEAST_NOISE * size)
        });
        Ok(noise.collect())
    }

    fn fitted(&self, shares: &[f64]) -> Result<Fitted, FitError> {
        let definition = self.definition;
        let count = shares.len();
        let Directions { values: sizes, unknowns: directions, points } = self.directions(shares)?;
        // Positive, because `fit` requires more points than unknowns.
        let freedom = (points.nrows() - count) as f64;
        let t = StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |t| t.inverse_cdf(0.975));
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        // A lower bound keeps the intervals of directions within round-off wide, but finite.
        let least = (ROUND_OFF * largest).max(ROUND_OFF);
        // Includes `t`, so that square roots of variances are half-widths of intervals.
        // Correlations do not change.
        let spread: Vec<_> = sizes.iter().map(|size| t / size.max(least)).collect();
        let covariance = |i: usize, j: usize| -> f64 {
            (0..count).map(|k| directions[(i, k)] * directions[(j, k)] * spread[k].powi(2)).sum()
        };
        let mixed = |k: usize| -> Vec<usize> {
            (0..count).filter(|&j| directions[(j, k)].abs() * spread[k] > AS_WIDE).collect()
        };
        let mut undetermined: Vec<Vec<usize>> = Vec::new();
        // Several directions may contain the same unknowns.
        for group in (0..count).map(mixed) {
            if !group.is_empty() && !undetermined.contains(&group) {
                undetermined.push(group);
            }
        }
        let is_undetermined = |j: usize| covariance(j, j).sqrt() > AS_WIDE;
        let values = self.values(shares);
        let estimate = |(j, unknown): (usize, &Unknown)| {
            let half = covariance(j, j).sqrt() * (unknown.to - unknown.from);
            let at_end = shares[j] < AT_END || shares[j] > 1.0 - AT_END;
            let interval = [unknown.at_least_allowed(values[j] - half), values[j] + half];
            let interval = (!is_undetermined(j)).then_some(interval);
            Estimate { unknown: unknown.clone(), value: values[j], interval, at_end }
        };
        let correlation = |i: usize, j: usize| {
            let size = (covariance(i, i) * covariance(j, j)).sqrt();
            if size == 0.0 { f64::from(i == j) } else { covariance(i, j) / size }
        };
        let case = definition.case(None, &values);
        Ok(Fitted {
            estimates: definition.unknowns.iter().enumerate().map(estimate).collect(),
            correlations: (0..count)
                .map(|i| (0..count).map(|j| correlation(i, j)).collect())
                .collect(),
            curves: self.curves(shares)?,
            solutions: self.solutions(),
            sweep: definition.sweep.at(&case),
            undetermined,
        })
    }

    fn curves(&self, shares: &[f64]) -> Result<Vec<FittedCurve>, FitError> {
        let model = self.solved(shares)?.ok_or(FitError::Unsolvable)?;
        let curves = self.definition.curves.iter().zip(&*model).zip(&self.noise);
        let curve = |((curve, model), noise): ((&TestCurve, &ModelCurve), &f64)| {
            let measured = &curve.measured;
            let points = measured.points.iter().zip(&model.values);
            let axes = measured.test.axes().map(|(axis, unit)| {
                if measured.is_physical { format!("{axis}, {unit}") } else { axis.to_owned() }
            });
            let points: Vec<_> =
                points.map(|(point, value)| [point[0], point[1], *value]).collect();
            FittedCurve {
                file: measured.file.clone(),
                axes,
                is_physical: measured.is_physical,
                left_out: measured.left_out.clone(),
                reversed: measured.reversed,
                ending: curve.ending,
                is_turned: model.before == points.len() || points.iter().all(|p| p[1] <= 0.0),
                trend: trend(&points, *noise),
                points,
                noise: *noise,
                beyond: model.beyond,
                differenced: model.differenced,
            }
        };
        Ok(curves.map(curve).collect())
    }
}

/// Returns the correlation of neighbouring residuals, if it is significant.
fn trend(points: &[[f64; 3]], noise: f64) -> Option<f64> {
    let residuals: Vec<_> = points.iter().map(|[_, measured, fitted]| measured - fitted).collect();
    let largest = points.iter().map(|point| point[1].abs()).fold(0.0, f64::max);
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    let products: f64 = residuals.windows(2).map(|r| r[0] * r[1]).sum();
    let correlation = products / squares;
    let chance = BEYOND_CHANCE / (points.len() as f64).sqrt();
    // Errors of the solver have a trend, too, if the curve has no noise.
    (noise > NEGLIGIBLE * largest && correlation > chance).then_some(correlation)
}
