//! Confidence intervals by profile likelihood.
//!
//! The profile of an unknown is the minimum of the weighted sum of squares over all other unknowns,
//! as a function of this unknown. Its interval contains the values at which the profile is at most
//! `t²` above the minimum, where `t` is the 97.5 % quantile of Student's distribution. Unlike
//! intervals from the covariance, such an interval may be one-sided or open. For example, the
//! interval of a gap that never closes has no upper end: the curve is the same for all wider gaps.

use nalgebra::DMatrix;

use crate::error::FitError;
use crate::search::{Minimum, Residuals};

/// Ratio of successive distances from the estimate at which the profile is sampled.
const OUTWARD: f64 = 1.5;
/// Height of a profile at which its sampling stops, as a multiple of `t`.
///
/// The height is the square root of the rise above the minimum. Beyond this height the profile is
/// not expected to fall to another minimum.
const FAR: f64 = 4.0;
/// Bounds of the first distance from the estimate that is sampled, as fractions of the range.
const FIRST: [f64; 2] = [1e-9, 0.06];
/// Maximum number of fits to locate an end of an interval.
const MOST_STEPS: usize = 12;
/// Accepted error of the square root of the rise at an interval end, as a fraction of `t`.
const ACCURACY: f64 = 0.02;
/// Accuracy of an interval end, as a fraction of its distance from the estimate.
const NEAR: f64 = 0.01;
/// Maximum number of passes that move interval ends outwards to points of other profiles.
const MOST_PASSES: usize = 4;
/// Decrease of the weighted sum of squares below the minimum that restarts the fit.
const BETTER: f64 = 0.05;
/// Distance from a bound within which a value counts as at the bound, as a fraction of the range.
///
/// The search never reaches a bound: its iterates stay strictly between the bounds.
pub(crate) const AT_BOUND: f64 = 1e-3;

/// Computes profiles of the weighted sum of squares around a minimum.
pub(crate) struct Profiles<'r, 'a> {
    pub(crate) residuals: &'r Residuals<'a>,
    pub(crate) minimum: &'r Minimum,
    /// Covariance of the scaled unknowns, computed from the derivatives. It predicts the profiles.
    pub(crate) covariance: &'r DMatrix<f64>,
    /// 97.5 % quantile of Student's distribution.
    pub(crate) t: f64,
}

/// Confidence interval of a scaled unknown.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interval {
    /// Lower and upper end; `None` if the interval extends to the bound of the range.
    pub(crate) ends: [Option<f64>; 2],
    /// Indices of other unknowns that reach a bound of their range at an end of the interval.
    pub(crate) depends_on_range_of: Vec<usize>,
}

/// Reason why a profile was not completed.
pub(crate) enum Aborted {
    /// The profile found better scaled unknowns, from which the fit must restart.
    Better(Vec<f64>),
    Failed(FitError),
}

impl From<FitError> for Aborted {
    fn from(error: FitError) -> Self {
        Self::Failed(error)
    }
}

/// A point of a profile.
#[derive(Clone, Debug)]
struct ProfilePoint {
    /// Scaled value of the fixed unknown.
    at: f64,
    /// Scaled values of all unknowns.
    scaled: Vec<f64>,
    /// Weighted sum of squares above the minimum.
    rise: f64,
}

impl Profiles<'_, '_> {
    /// Computes the intervals of all unknowns.
    pub(crate) fn intervals(&self) -> Result<Vec<Interval>, Aborted> {
        let count = self.minimum.scaled.len();
        let mut ends: Vec<[Option<ProfilePoint>; 2]> = Vec::new();
        for j in 0..count {
            let minimum = self.minimum_point(j);
            let [low, high] =
                self.residuals.profile(|| [0, 1].map(|side| self.end(j, side, &minimum)));
            ends.push([low?, high?]);
        }
        // A profile may miss a minimum that the profile of another unknown has found.
        for _ in 0..MOST_PASSES {
            let mut has_changed = false;
            for (j, ends) in ends.iter_mut().enumerate() {
                for (side, end) in ends.iter_mut().enumerate() {
                    let Some(last) = end else { continue };
                    let Some(beyond) = self.visited_beyond(j, side, last.at) else { continue };
                    *end = self.residuals.profile(|| self.end(j, side, &beyond))?;
                    has_changed = true;
                }
            }
            if !has_changed {
                break;
            }
        }
        Ok(ends.iter().enumerate().map(|(j, ends)| self.interval(j, ends)).collect())
    }

    /// Returns the interval of unknown `j` between `ends`.
    fn interval(&self, j: usize, ends: &[Option<ProfilePoint>; 2]) -> Interval {
        let mut depends_on_range_of = Vec::new();
        for end in ends.iter().flatten() {
            let others = (0..end.scaled.len()).filter(|i| *i != j);
            depends_on_range_of.extend(
                others.filter(|&i| {
                    is_at_bound(end.scaled[i]) && !is_at_bound(self.minimum.scaled[i])
                }),
            );
        }
        depends_on_range_of.sort_unstable();
        depends_on_range_of.dedup();
        Interval {
            ends: ends.each_ref().map(|end| end.as_ref().map(|end| end.at)),
            depends_on_range_of,
        }
    }

    /// Returns the minimum as a point of the profile of unknown `j`.
    fn minimum_point(&self, j: usize) -> ProfilePoint {
        let scaled = self.minimum.scaled.clone();
        ProfilePoint { at: scaled[j], scaled, rise: 0.0 }
    }

    /// Returns the farthest evaluated point beyond `end` that belongs to the interval.
    ///
    /// The interval is for unknown `j`; `side` is 0 at its lower end and 1 at its upper end.
    fn visited_beyond(&self, j: usize, side: usize, end: f64) -> Option<ProfilePoint> {
        let direction = if side == 0 { -1.0 } else { 1.0 };
        let tolerance = NEAR * (end - self.minimum.scaled[j]).abs();
        let limit = self.minimum.cost + self.t.powi(2);
        let mut farthest: Option<ProfilePoint> = None;
        for Minimum { cost, scaled } in self.residuals.visited_below(limit) {
            let at = scaled[j];
            let is_farther = farthest.as_ref().is_none_or(|last| direction * (at - last.at) > 0.0);
            if is_farther && direction * (at - end) > tolerance {
                farthest = Some(ProfilePoint { at, scaled, rise: cost - self.minimum.cost });
            }
        }
        farthest
    }

    /// Locates the lower (`side` 0) or upper (`side` 1) end of the interval of unknown `j`.
    ///
    /// `None` if the interval extends to the bound. `from` is a point within the interval.
    fn end(
        &self,
        j: usize,
        side: usize,
        from: &ProfilePoint,
    ) -> Result<Option<ProfilePoint>, Aborted> {
        let (start, bound) = (from.at, side as f64);
        let direction = 2.0 * bound - 1.0;
        let limit = self.t.powi(2);
        let mut inner = from.clone();
        let mut outer: Option<ProfilePoint> = None;
        // Continue beyond the first point outside of the interval: the sum of squares has kinks
        // and may fall below the limit again.
        let half = self.t * self.covariance[(j, j)].sqrt();
        let mut distance = half.clamp(FIRST[0], FIRST[1]);
        let mut last = inner.clone();
        while last.at != bound && last.rise < FAR.powi(2) * limit {
            last = self.at(j, (start + distance * direction).clamp(0.0, 1.0), &last)?;
            distance *= OUTWARD;
            if last.rise <= limit {
                (inner, outer) = (last.clone(), None);
            } else if outer.is_none() {
                outer = Some(last.clone());
            }
        }
        // Without a point outside of the interval, the interval extends to the bound.
        let Some(mut outer) = outer else { return Ok(None) };
        for _ in 0..MOST_STEPS {
            // Near a minimum, the square root of the rise is proportional to the distance, so
            // interpolate the root linearly.
            let [inside, outside] = [&inner, &outer].map(|point| point.rise.max(0.0).sqrt());
            let fraction = ((self.t - inside) / (outside - inside)).clamp(0.1, 0.9);
            let guess = inner.at + fraction * (outer.at - inner.at);
            let found = self.at(j, guess, &inner)?;
            let is_accurate = (found.rise.max(0.0).sqrt() - self.t).abs() < ACCURACY * self.t;
            if found.rise <= limit {
                inner = found.clone();
            } else {
                outer = found.clone();
            }
            if is_accurate {
                return Ok(Some(found));
            }
            if (outer.at - inner.at).abs() < NEAR * (outer.at - self.minimum.scaled[j]).abs() {
                break;
            }
        }
        Ok(Some(outer))
    }

    /// Fits the other unknowns with unknown `j` fixed at `at`, starting from profile point `from`.
    fn at(&self, j: usize, at: f64, from: &ProfilePoint) -> Result<ProfilePoint, Aborted> {
        let mut start = from.scaled.clone();
        let moved = (at - from.at) / self.covariance[(j, j)];
        for (i, scaled) in start.iter_mut().enumerate() {
            // Far from the minimum the prediction is unreliable, so limit its step.
            let step = (moved * self.covariance[(i, j)]).clamp(-0.25, 0.25);
            *scaled = (*scaled + step).clamp(AT_BOUND, 1.0 - AT_BOUND);
        }
        start[j] = at;
        let found = self.residuals.minimise(start, Some(j))?;
        let rise = found.cost - self.minimum.cost;
        if rise < -BETTER {
            return Err(Aborted::Better(found.scaled));
        }
        Ok(ProfilePoint { at, scaled: found.scaled, rise })
    }
}

/// Returns true if a scaled value is at a bound of its range.
pub(crate) fn is_at_bound(scaled: f64) -> bool {
    !(AT_BOUND..=1.0 - AT_BOUND).contains(&scaled)
}
