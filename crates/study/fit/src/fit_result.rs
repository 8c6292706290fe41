//! What the curves say of the unknowns, and how surely.
//!
//! With the residuals `r` over the noise of their curves and `J = ∂r/∂p` at the least squares, `p` being shares of the ranges, the covariance
//! of `p` is `(JᵀJ)⁻¹ = V S⁻² Vᵀ` with the singular values `S` and directions `V` of `J`. Of a direction along which the curves say no more
//! than the ranges do, the unknowns that it mixes are named.

use std::sync::atomic::AtomicBool;

use nalgebra::DMatrix;
use run::{Evaluator, WorkMeter};
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use sweep::Sweep;

use crate::definition::{FitDefinition, TestCurve, Unknown};
use crate::model::ModelCurve;
use crate::search::Residuals;

/// The answer of a fit.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The unknowns, in their order.
    pub estimates: Vec<Estimate>,
    /// Correlations of the estimates, −1 to 1.
    pub correlations: Vec<Vec<f64>>,
    /// Groups of unknowns, by their numbers, of which the curves tell less than their ranges: of a group of one next to nothing, of a
    /// larger one that they cannot be told apart.
    pub untold: Vec<Vec<usize>>,
    /// The curves.
    pub curves: Vec<FittedCurve>,
    /// Skins that were solved.
    pub solutions: usize,
    /// The skin of the definition, with what was found.
    pub sweep: Sweep,
}

/// What was found of an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The unknown.
    pub unknown: Unknown,
    /// The value with the least squares.
    pub value: f64,
    /// Its 95 % confidence interval; `None` where the curves do not tell it.
    pub interval: Option<[f64; 2]>,
    /// Whether the value stands at an end of its range, so that the interval means little.
    pub at_end: bool,
}

/// A curve beside that of the skin.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedCurve {
    /// Name of its file.
    pub file: String,
    /// What its axes are.
    pub axes: [String; 2],
    /// Place, measured value, fitted value.
    pub points: Vec<[f64; 3]>,
    /// Whether its columns name units; without, it is in those of the model.
    pub is_physical: bool,
    /// Lines of its file that hold no numbers, and were left out.
    pub left_out: usize,
    /// Whether it has no point at which a skin that is pushed or bent would resist, as where signs are turned round.
    pub is_turned: bool,
    /// Standard deviation of the residuals.
    pub noise: f64,
    /// Correlation of neighbouring residuals, where it is more than chance would make it: the skin bends otherwise than its model.
    pub trend: Option<f64>,
    /// Points beyond the end of the fitted path.
    pub beyond: usize,
    /// Derivatives that are differences of whole solutions.
    pub differenced: usize,
}

/// A fit that has no answer.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// It was told to stop.
    #[error("stopped before an answer was found")]
    Stopped,
    /// There are too few points.
    #[error(
        "too few points: {points}, for {unknowns} unknowns; expected more points than unknowns"
    )]
    TooFew {
        /// Points of all curves.
        points: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// There is nothing to be found.
    #[error("nothing is sought; add [variables] or offsets to a [[curve]]")]
    NothingSought,
    /// No skin of the ranges can be solved.
    #[error("none of the skins that were tried can be solved; look at one with squama design")]
    Unsolvable,
}

/// Rounds in which the noise of several curves is found, at most; it settles in three or four.
const ROUNDS: usize = 10;
/// Change of the noise at which it has settled.
const SETTLED: f64 = 1e-3;
/// The least noise, as a part of the size of a curve: that of the solver.
const LEAST_NOISE: f64 = 1e-8;
/// A direction whose singular value is a smaller part of the largest is one of round-off.
const ROUND_OFF: f64 = 1e-6;
/// Half of an interval that is as wide as the range of its unknown, in shares of that: the curves do not tell it.
const AS_WIDE: f64 = 0.5;
/// Residuals that have nothing to do with each other are correlated by more than this over the root of their number once in 700 curves.
const BEYOND_CHANCE: f64 = 3.0;
/// Noise of which nothing is said, as a part of the largest value.
const NEGLIGIBLE: f64 = 1e-4;
/// A share that is closer to an end of its range stands there: the search stays inside by a part of the way.
const AT_END: f64 = 1e-3;

impl FitDefinition {
    /// Finds the unknowns with which the curves of the model are closest to the measured ones, until `stop` is set; tells `work`
    /// how far it is.
    ///
    /// # Errors
    /// If there are too few points, nothing is sought, no skin can be solved, or it was told to stop.
    pub fn fit(&self, stop: &AtomicBool, work: &WorkMeter) -> Result<Fitted, FitError> {
        let points = self.curves.iter().map(|curve| curve.measured.points.len()).sum();
        let unknowns = self.unknowns.len();
        if unknowns == 0 {
            return Err(FitError::NothingSought);
        }
        if points <= unknowns {
            return Err(FitError::TooFew { points, unknowns });
        }
        // Curves alone are asked of it, and no measure.
        let evaluator = Evaluator::new(&[]);
        let mut residuals = Residuals::new(self, &evaluator, (stop, work));
        let sizes = residuals.noise.clone();
        let mut shares = residuals.best()?;
        for _ in 0..ROUNDS {
            // In turns: noise weighs the curves, and the unknowns that follow leave another noise.
            let noise = residuals.noise_at(&shares, &sizes)?;
            let changed = noise
                .iter()
                .zip(&residuals.noise)
                .any(|(new, old)| (new / old - 1.0).abs() > SETTLED);
            // Also when it has settled: residuals of the answer are over the noise that is told.
            residuals.noise = noise;
            // The noise of a single curve is a factor of all residuals, which moves no minimum.
            if !changed || self.curves.len() == 1 {
                break;
            }
            shares = residuals.minimise(shares)?;
        }
        residuals.fitted(&shares)
    }
}

/// The singular values of the derivatives, the directions that belong to them as columns, and the shares of the points in them.
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

    /// The noise of each curve: the mean square of its residuals, over its points less its part in the unknowns.
    fn noise_at(&self, shares: &[f64], sizes: &[f64]) -> Result<Vec<f64>, FitError> {
        let directions = self.directions(shares)?;
        let model = self.solved(shares)?.ok_or(FitError::Unsolvable)?;
        let largest = directions.values.iter().copied().fold(0.0, f64::max);
        let mut first = 0;
        let noise = self.of_curves(&model).into_iter().zip(sizes).map(|(residuals, size)| {
            let rows = first..first + residuals.len();
            first = rows.end;
            let told =
                directions.values.iter().enumerate().filter(|(_, s)| **s > ROUND_OFF * largest);
            let taken: f64 = told
                .flat_map(|(k, _)| rows.clone().map(move |i| (i, k)))
                .map(|at| directions.points[at].powi(2))
                .sum();
            let squares: f64 = residuals.iter().map(|r| r * r).sum();
            // A short curve may be taken up whole by its own offset.
            let freedom = (residuals.len() as f64 - taken).max(1.0);
            (squares / freedom).sqrt().max(LEAST_NOISE * size)
        });
        Ok(noise.collect())
    }

    fn fitted(&self, shares: &[f64]) -> Result<Fitted, FitError> {
        let definition = self.definition;
        let count = shares.len();
        let Directions { values: sizes, unknowns: directions, points } = self.directions(shares)?;
        // Above 0: `fit` refuses curves of no more points than unknowns.
        let freedom = (points.nrows() - count) as f64;
        let t = StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |t| t.inverse_cdf(0.975));
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        // A direction of round-off has an interval that is wide, and not infinite.
        let least = (ROUND_OFF * largest).max(ROUND_OFF);
        // With `t` in it roots are halves of intervals at once; correlations do not mind.
        let spread: Vec<_> = sizes.iter().map(|size| t / size.max(least)).collect();
        let covariance = |i: usize, j: usize| -> f64 {
            (0..count).map(|k| directions[(i, k)] * directions[(j, k)] * spread[k].powi(2)).sum()
        };
        let mixed = |k: usize| -> Vec<usize> {
            (0..count).filter(|&j| directions[(j, k)].abs() * spread[k] > AS_WIDE).collect()
        };
        let mut untold: Vec<Vec<usize>> = Vec::new();
        // Several directions may mix the same unknowns.
        for group in (0..count).map(mixed) {
            if !group.is_empty() && !untold.contains(&group) {
                untold.push(group);
            }
        }
        let is_untold = |j: usize| covariance(j, j).sqrt() > AS_WIDE;
        let values = self.values(shares);
        let estimate = |(j, unknown): (usize, &Unknown)| {
            let half = covariance(j, j).sqrt() * (unknown.to - unknown.from);
            let at_end = shares[j] < AT_END || shares[j] > 1.0 - AT_END;
            let interval = [unknown.at_least_allowed(values[j] - half), values[j] + half];
            let interval = (!is_untold(j)).then_some(interval);
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
            untold,
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
                left_out: measured.left_out,
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

/// The correlation of residuals with the next ones, where there are enough and chance would hardly make it so large.
fn trend(points: &[[f64; 3]], noise: f64) -> Option<f64> {
    let residuals: Vec<_> = points.iter().map(|[_, measured, fitted]| measured - fitted).collect();
    let largest = points.iter().map(|point| point[1].abs()).fold(0.0, f64::max);
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    let products: f64 = residuals.windows(2).map(|r| r[0] * r[1]).sum();
    let correlation = products / squares;
    let chance = BEYOND_CHANCE / (points.len() as f64).sqrt();
    // What the solver leaves of exact curves has a trend, too.
    (noise > NEGLIGIBLE * largest && correlation > chance).then_some(correlation)
}
