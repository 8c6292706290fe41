//! Result of a fit: estimates, confidence intervals and undetermined unknowns.
//!
//! Let `r` be the residuals divided by the noise of their curves, `p` the unknowns scaled to their
//! ranges, and `J = ∂r/∂p` at the minimum. The covariance of `p` is `(JᵀJ)⁻¹ = V S⁻² Vᵀ`, with the
//! singular values `S` and right singular vectors `V` of `J`. The correlations follow from this
//! covariance. It also predicts the profiles, from which the intervals are determined.

use std::sync::atomic::AtomicBool;

use nalgebra::DMatrix;
use run::{Evaluator, WorkMeter};
use statrs::distribution::{ChiSquared, ContinuousCDF as _, StudentsT};
use sweep::{Parameter, Sweep};

use crate::definition::{FitDefinition, Source, TestCurve, Unknown};
use crate::error::FitError;
use crate::measured_curve::{CurveEvent, CurveEventKind, MeanCurve};
use crate::model::ModelCurve;
use crate::profile::{Aborted, Interval, Profiles, is_at_bound};
use crate::search::{Minimum, Noise, Residuals};

/// Result of a fit.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// Estimates, in the order of the unknowns.
    pub estimates: Vec<Estimate>,
    /// Matrix of the correlations of the estimates, −1 to 1.
    pub correlations: Vec<Vec<f64>>,
    /// Groups of undetermined unknowns, by index.
    ///
    /// In a group of one, the curves hardly depend on the unknown. In a larger group, the curves
    /// determine only combinations of the unknowns.
    pub undetermined: Vec<Vec<usize>>,
    /// Distributions of the parameters that differ from specimen to specimen.
    pub scatter: Vec<Scatter>,
    /// Measured and fitted curves.
    pub curves: Vec<FittedCurve>,
    /// Mean curves, one for each design with several specimens.
    pub means: Vec<MeanCurve>,
    /// Number of evaluations of the model, each for all curves.
    pub solutions: usize,
    /// Number of restarts of the fit because a profile found a better minimum.
    pub restarts: usize,
    /// Definition of the design with the estimates as values of the unknowns.
    pub sweep: Sweep,
}

/// Estimate of an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The unknown.
    pub unknown: Unknown,
    /// Value at the minimum of the sum of squares.
    pub value: f64,
    /// Lower and upper end of the 95 % confidence interval.
    ///
    /// `None` for an end at which the interval extends to the bound of the range.
    pub interval: [Option<f64>; 2],
    /// True if the value is at a bound of its range.
    pub is_at_bound: bool,
    /// Indices of other unknowns that reach their bounds at an end of the interval.
    pub depends_on_range_of: Vec<usize>,
}

impl Estimate {
    /// Returns true if the curves exclude no value of the range.
    pub fn is_undetermined(&self) -> bool {
        self.interval == [None; 2]
    }
}

/// Distribution of a parameter that differs from specimen to specimen.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// Indices of the estimates of the specimens.
    pub specimens: Vec<usize>,
    /// Mean of the specimens.
    pub mean: f64,
    /// 95 % confidence interval of the mean of the population of specimens.
    pub mean_interval: [f64; 2],
    /// Standard deviation over the specimens, without the uncertainty of their estimates.
    pub deviation: f64,
    /// 95 % confidence interval of the standard deviation.
    pub deviation_interval: [f64; 2],
}

impl Scatter {
    /// Estimates the distribution from the values of specimens and their standard errors.
    fn new(
        parameter: &'static Parameter,
        specimens: Vec<usize>,
        values: &[f64],
        errors: &[f64],
    ) -> Self {
        let count = specimens.len() as f64;
        let mean = specimens.iter().map(|j| values[*j]).sum::<f64>() / count;
        let squares: f64 = specimens.iter().map(|j| (values[*j] - mean).powi(2)).sum();
        let error = specimens.iter().map(|j| errors[*j].powi(2)).sum::<f64>() / count;
        let freedom = count - 1.0;
        let half = student_quantile(freedom) * (squares / freedom / count).sqrt();
        let quantiles = ChiSquared::new(freedom)
            .map_or([f64::NAN; 2], |chi| [0.975, 0.025].map(|p| chi.inverse_cdf(p)));
        let [low, high] = quantiles.map(|quantile| squares / quantile);
        // The observed variance is the variance of the specimens plus the mean square error of the
        // estimates. Subtract this error.
        let [deviation, low, high] =
            [squares / freedom, low, high].map(|variance| (variance - error).max(0.0).sqrt());
        Self {
            parameter,
            specimens,
            mean,
            mean_interval: [mean - half, mean + half],
            deviation,
            deviation_interval: [low, high],
        }
    }
}

/// Returns the 97.5 % quantile of Student's distribution, for two-sided intervals of 95 %.
fn student_quantile(freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |t| t.inverse_cdf(0.975))
}

/// A measured curve and the fitted curve.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedCurve {
    /// Name of the file of the measured curve.
    pub file: String,
    /// Quantities on the axes, with their units.
    pub axes: [String; 2],
    /// Displacement or curvature, measured force or moment, fitted force or moment.
    pub points: Vec<[f64; 3]>,
    /// True if the columns have physical units, false for units of the model.
    pub is_physical: bool,
    /// Numbers of the lines that were left out: remarks, footers, and gaps in the recording.
    pub skipped_lines: Vec<u64>,
    /// True for each axis on which the signs of the file were reversed.
    pub reversed: [bool; 2],
    /// Events of the measured curve, e.g. first contact, reversals, holds and drops.
    pub events: Vec<CurveEvent>,
    /// True if the model carries load at no point, or no measured value is positive.
    ///
    /// The signs of the file are then probably wrong.
    pub has_suspect_signs: bool,
    /// Standard deviation of the residuals.
    pub noise: f64,
    /// Correlation of neighbouring residuals, if it is significant.
    ///
    /// The model then differs systematically from the skin.
    pub trend: Option<f64>,
    /// Factor by which the correlation of residuals widens the intervals, at least 1.
    pub widening: f64,
    /// Number of points beyond the end of the fitted path.
    pub beyond: usize,
    /// Number of derivatives that are finite differences of two solutions.
    pub differenced: usize,
}

/// Maximum number of iterations to estimate the noise. Three or four usually suffice.
const ROUNDS: usize = 10;
/// Largest relative change of the noise at convergence.
const SETTLED: f64 = 1e-3;
/// Smallest noise, as a fraction of the size of a curve: the accuracy of the solver.
const LEAST_NOISE: f64 = 1e-8;
/// Singular values below this fraction of the largest singular value are round-off.
const ROUND_OFF: f64 = 1e-6;
/// Maximum number of minima with profiles: the first minimum, and the minima after restarts.
const RESTARTS: usize = 6;
/// Correlation above which the curves determine only a combination of undetermined unknowns.
const TOGETHER: f64 = 0.9;
/// Correlation of neighbouring residuals above which it is significant, times `√n` for `n` points.
///
/// Independent residuals exceed this limit in one of 44 curves.
const BEYOND_CHANCE: f64 = 2.0;
/// Least significant difference of the mean fitted and the mean measured force before contact.
///
/// In standard errors of the measured mean.
const ABOVE_NOISE: f64 = 4.0;
/// Least significant difference of these two means, as a fraction of the largest force.
const ABOVE_TOE: f64 = 0.01;
/// Fraction of the size of a curve below which noise is not examined for correlation.
const NEGLIGIBLE: f64 = 1e-4;

impl FitDefinition {
    /// Fits the model curves to the measured ones.
    ///
    /// Stops early if `stop` is set, and reports progress to `work`.
    ///
    /// # Errors
    ///
    /// If there are too few points or no unknowns, if no skin can be solved, if the search does not
    /// converge, or if `stop` is set.
    pub fn fit(&self, stop: &AtomicBool, work: &WorkMeter) -> Result<Fitted, FitError> {
        let points = self.curves.iter().map(|curve| curve.measured.points.len()).sum();
        let unknowns = self.unknowns.len();
        if unknowns == 0 {
            return Err(FitError::NoUnknowns);
        }
        if points <= unknowns {
            return Err(FitError::TooFew { points, unknowns });
        }
        // The evaluator has no measures, because the fit needs only curves.
        let evaluator = Evaluator::new(&[]);
        let mut residuals = Residuals::new(self, &evaluator, (stop, work));
        let sizes: Vec<_> = residuals.noise.iter().map(|noise| noise.deviation).collect();
        let minimum = residuals.best()?;
        residuals.settle(minimum, &sizes)
    }
}

/// Singular value decomposition of the Jacobian.
struct Directions {
    /// Singular values.
    values: Vec<f64>,
    /// Right singular vectors in columns; the rows are unknowns.
    unknowns: DMatrix<f64>,
    /// Left singular vectors in columns; the rows are points of all curves.
    points: DMatrix<f64>,
}

impl Directions {
    fn largest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// Returns the covariance of the scaled unknowns.
    ///
    /// Singular values within round-off are replaced with a small value, so the result is finite.
    fn covariance(&self) -> DMatrix<f64> {
        let least = (ROUND_OFF * self.largest()).max(ROUND_OFF);
        let spread = self.values.iter().map(|size| size.max(least).recip());
        let mut root = self.unknowns.clone();
        for (mut column, spread) in root.column_iter_mut().zip(spread) {
            column *= spread;
        }
        &root * root.transpose()
    }
}

impl Residuals<'_> {
    /// Computes the result at a minimum, and restarts whenever a profile finds a better minimum.
    ///
    /// `sizes` are the root mean squares of the measured curves.
    fn settle(&mut self, mut minimum: Minimum, sizes: &[f64]) -> Result<Fitted, FitError> {
        for restarts in 0..RESTARTS {
            minimum = self.weight(minimum, sizes)?;
            match self.intervals(&minimum) {
                Ok((intervals, covariance)) => {
                    let fitted = self.fitted(&minimum.scaled, intervals, &covariance)?;
                    return Ok(Fitted { restarts, ..fitted });
                }
                Err(Aborted::Better(start)) => minimum = self.improve(start)?,
                Err(Aborted::Failed(error)) => return Err(error),
            }
        }
        Err(FitError::Unsettled)
    }

    /// Alternates between estimating the noise of each curve and refitting, until both converge.
    fn weight(&mut self, mut minimum: Minimum, sizes: &[f64]) -> Result<Minimum, FitError> {
        for _ in 0..ROUNDS {
            let noise = self.noise_at(&minimum.scaled, sizes)?;
            let pairs = noise.iter().zip(&self.noise);
            let changes = pairs.map(|(new, old)| (new.scale() / old.scale() - 1.0).abs());
            let has_changed = changes.fold(0.0, f64::max) > SETTLED;
            // Store the converged noise, too: the intervals use it.
            self.noise = noise;
            // The noise of a single curve scales all residuals and does not move the minimum.
            if !has_changed || self.noise.len() == 1 {
                break;
            }
            minimum = self.improve(minimum.scaled)?;
        }
        Ok(Minimum { cost: self.cost(&minimum.scaled)?, ..minimum })
    }

    /// Computes the confidence intervals of all unknowns at a minimum, and their covariance.
    fn intervals(&self, minimum: &Minimum) -> Result<(Vec<Interval>, DMatrix<f64>), Aborted> {
        let covariance = self.directions(&minimum.scaled)?.covariance();
        let curves = self.definition.curves.iter().zip(&self.noise);
        let independent = curves.map(|(c, noise)| c.measured.points.len() as f64 / noise.widening);
        let count = minimum.scaled.len();
        let freedom = (independent.sum::<f64>() - count as f64).max(1.0);
        let t = student_quantile(freedom);
        let profiles = Profiles { residuals: self, minimum, covariance: &covariance, t };
        Ok((profiles.intervals()?, covariance))
    }

    fn directions(&self, scaled: &[f64]) -> Result<Directions, FitError> {
        let model = self.solved(scaled)?.ok_or(FitError::Unsolvable)?;
        let columns: Vec<f64> = (0..scaled.len()).flat_map(|j| self.column(&model, j)).collect();
        let jacobian = DMatrix::from_vec(columns.len() / scaled.len(), scaled.len(), columns);
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
    /// The variance is the sum of squares divided by the degrees of freedom: the number of points
    /// minus this curve's share of the determined unknowns. `sizes` are the root mean squares of
    /// the measured curves.
    fn noise_at(&self, scaled: &[f64], sizes: &[f64]) -> Result<Vec<Noise>, FitError> {
        let directions = self.directions(scaled)?;
        let model = self.solved(scaled)?.ok_or(FitError::Unsolvable)?;
        let least = ROUND_OFF * directions.largest();
        let mut first = 0;
        let noise = self.of_curves(&model).into_iter().zip(sizes).map(|(residuals, size)| {
            let rows = first..first + residuals.len();
            first = rows.end;
            let determined = directions.values.iter().enumerate().filter(|(_, s)| **s > least);
            let taken: f64 = determined
                .flat_map(|(k, _)| rows.clone().map(move |i| (i, k)))
                .map(|at| directions.points[at].powi(2))
                .sum();
            let squares: f64 = residuals.iter().map(|r| r * r).sum();
            // At least 1, because an offset may fit a short curve exactly.
            let freedom = (residuals.len() as f64 - taken).max(1.0);
            let deviation = (squares / freedom).sqrt();
            // Without noise, residuals are errors of the solver, which are correlated: ignore this.
            let trend = trend(&residuals).filter(|_| deviation > NEGLIGIBLE * size);
            let widening = trend
                .map_or(1.0, |trend| ((1.0 + trend) / (1.0 - trend)).min(residuals.len() as f64));
            Noise { deviation: deviation.max(LEAST_NOISE * size), trend, widening }
        });
        Ok(noise.collect())
    }

    fn fitted(
        &self,
        scaled: &[f64],
        intervals: Vec<Interval>,
        covariance: &DMatrix<f64>,
    ) -> Result<Fitted, FitError> {
        let definition = self.definition;
        let unknowns = definition.unknowns.iter();
        let estimates: Vec<_> = unknowns
            .zip(scaled)
            .zip(intervals)
            .map(|((unknown, &scaled), interval)| Estimate {
                value: unknown.value(scaled),
                interval: interval.ends.map(|end| end.map(|end| unknown.value(end))),
                is_at_bound: is_at_bound(scaled),
                depends_on_range_of: interval.depends_on_range_of,
                unknown: unknown.clone(),
            })
            .collect();
        let count = scaled.len();
        let correlations = (0..count).map(|i| {
            (0..count)
                .map(|j| covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt())
                .collect()
        });
        let correlations: Vec<Vec<f64>> = correlations.collect();
        let values = self.values(scaled);
        let errors: Vec<_> = definition
            .unknowns
            .iter()
            .enumerate()
            .map(|(j, unknown)| (unknown.to - unknown.from) * covariance[(j, j)].sqrt())
            .collect();
        let scatter = definition.specimens().into_iter();
        let scatter = scatter.map(|(p, members)| Scatter::new(p, members, &values, &errors));
        let case = definition.case(None, &values);
        Ok(Fitted {
            undetermined: undetermined(&estimates, &correlations),
            estimates,
            correlations,
            scatter: scatter.collect(),
            curves: self.curves(scaled)?,
            means: means(&definition.curves),
            solutions: self.solutions(),
            restarts: 0,
            sweep: definition.sweep.at(&case),
        })
    }

    fn curves(&self, scaled: &[f64]) -> Result<Vec<FittedCurve>, FitError> {
        let model = self.solved(scaled)?.ok_or(FitError::Unsolvable)?;
        let curves = self.definition.curves.iter().enumerate().zip(&*model).zip(&self.noise);
        let curve =
            |(((number, curve), model), noise): (((usize, &TestCurve), &ModelCurve), &Noise)| {
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
                    skipped_lines: measured.skipped_lines.clone(),
                    reversed: measured.reversed,
                    events: self.events((number, curve), model, scaled),
                    has_suspect_signs: model.before == points.len()
                        || points.iter().all(|p| p[1] <= 0.0),
                    points,
                    noise: noise.deviation,
                    trend: noise.trend,
                    widening: noise.widening.sqrt(),
                    beyond: model.beyond,
                    differenced: model.differenced,
                }
            };
        Ok(curves.map(curve).collect())
    }

    /// Returns the events of a curve.
    ///
    /// A flat beginning counts as an approach only if the fitted displacement offset lies in its
    /// second half or, without such an offset, if the fitted curve rises before contact. Otherwise
    /// the skin is merely soft at first.
    fn events(
        &self,
        (number, curve): (usize, &TestCurve),
        model: &ModelCurve,
        scaled: &[f64],
    ) -> Vec<CurveEvent> {
        let offset = Source::Offset(number, 0);
        let offset = self.definition.unknowns.iter().position(|unknown| unknown.source == offset);
        let offset = offset.map(|j| self.values(scaled)[j]);
        let mut events = curve.events.clone();
        events.retain(|event| match (event.kind, offset, curve.loading()) {
            (CurveEventKind::Touches, Some(offset), [first, ..]) => {
                offset > first[0].midpoint(event.at)
            }
            (CurveEventKind::Touches, ..) => rises_before(curve.loading(), model, event.at),
            _ => true,
        });
        events
    }
}

/// Returns true if fitted and measured forces differ significantly before `contact`.
fn rises_before(points: &[[f64; 2]], model: &ModelCurve, contact: f64) -> bool {
    let largest = points.iter().map(|point| point[1].abs()).fold(0.0, f64::max);
    let toe = points.iter().zip(&model.values).filter(|(point, _)| point[0] <= contact);
    let toe: Vec<_> = toe.map(|(point, value)| [point[1], *value]).collect();
    let count = toe.len() as f64;
    let mean = toe.iter().map(|[force, _]| force).sum::<f64>() / count;
    let fitted = toe.iter().map(|[_, value]| value).sum::<f64>() / count;
    let squares: f64 = toe.iter().map(|[force, _]| (force - mean).powi(2)).sum();
    (fitted - mean).abs() > (ABOVE_NOISE * squares.sqrt() / count).max(ABOVE_TOE * largest)
}

/// Averages the loading branches of specimens of one design.
fn means(curves: &[TestCurve]) -> Vec<MeanCurve> {
    let mut means = Vec::new();
    for (k, first) in curves.iter().enumerate() {
        // The first curve of a design represents all of them.
        if curves[..k].iter().any(|other| first.is_alike(other)) {
            continue;
        }
        let alike = curves.iter().filter(|other| first.is_alike(other));
        let alike = alike.map(|curve| (curve.measured.file.as_str(), curve.loading().to_vec()));
        means.extend(MeanCurve::new(&alike.collect::<Vec<_>>()));
    }
    means
}

/// Groups undetermined unknowns that the curves determine only in combination.
///
/// A group contains an undetermined unknown and its strongly correlated unknowns, if these are
/// undetermined, too, or their intervals end where the first unknown reaches its bounds.
fn undetermined(estimates: &[Estimate], correlations: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for j in (0..estimates.len()).filter(|j| estimates[*j].is_undetermined()) {
        let group: Vec<_> = (0..estimates.len())
            .filter(|i| {
                let other = &estimates[*i];
                let is_open = other.is_undetermined() || other.depends_on_range_of.contains(&j);
                *i == j || (is_open && correlations[*i][j].abs() > TOGETHER)
            })
            .collect();
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    groups
}

/// Returns the correlation of neighbouring residuals, if it is significant.
fn trend(residuals: &[f64]) -> Option<f64> {
    let squares: f64 = residuals.iter().map(|r| r * r).sum();
    let products: f64 = residuals.windows(2).map(|r| r[0] * r[1]).sum();
    let correlation = products / squares;
    let chance = BEYOND_CHANCE / (residuals.len() as f64).sqrt();
    (correlation > chance).then_some(correlation)
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;

    #[test]
    fn a_better_minimum_on_a_profile_restarts_the_fit() {
        let shared = "name = 'palm'\ndesigns.length_over_t = 0.8\ndesigns.slant_deg = 60\n\
                      puncture.needle = 'guided'\npuncture.load_inset_over_t = 0.05\n";
        let truth = format!("{shared}designs.gap_over_t = 0.2\npuncture.needle_friction = 0.3\n");
        let case = Sweep::parse(&truth, "skin.toml", &[]).expect("a skin").grid().case(0);
        let evaluator = Evaluator::new(&[]);
        let places: Vec<_> = (1..=30).map(|k| 0.008 * f64::from(k)).collect();
        let curve = evaluator.force_curve(&case, &[], &places).expect("a curve");
        let mut text = "displacement,force\n".to_owned();
        for (k, (x, point)) in places.iter().zip(&curve).enumerate() {
            let force = point.as_ref().expect("a point").value;
            // Deterministic noise.
            writeln!(text, "{x},{}", force + 1e-3 * (7.0 * k as f64).sin())
                .expect("writing to a string succeeds");
        }
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("test.toml");
        std::fs::write(folder.path().join("a.csv"), text).expect("writable");
        let sought = format!(
            "{shared}[variables]\ngap_over_t = {{ from = 0.1, to = 0.6 }}\n\
             needle_friction = {{ from = 0.02, to = 0.9 }}\n[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n"
        );
        std::fs::write(&path, sought).expect("writable");
        let definition = FitDefinition::read(&path, &[]).expect("a definition");
        let (stop, work) = (AtomicBool::new(false), WorkMeter::default());
        let best = definition.fit(&stop, &work).expect("a fit");
        let mut residuals = Residuals::new(&definition, &evaluator, (&stop, &work));
        let sizes: Vec<_> = residuals.noise.iter().map(|noise| noise.deviation).collect();
        // This point is not a minimum, so any profile finds better points.
        let scaled = vec![0.9, 0.9];
        let poor = Minimum { cost: residuals.cost(&scaled).expect("a cost"), scaled };
        let settled = residuals.settle(poor, &sizes).expect("a fit");
        assert!(settled.restarts > 0);
        for (estimate, best) in settled.estimates.iter().zip(&best.estimates) {
            assert!((estimate.value / best.value - 1.0).abs() < 1e-3, "{estimate:?} {best:?}");
        }
    }
}
