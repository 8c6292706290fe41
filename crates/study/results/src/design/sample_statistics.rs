//! Statistics over the imperfect rows of one design: mean and quantiles.

use serde::{Deserialize, Serialize};

use super::failure::finite;

/// Mean and quantiles of a measure over the samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Mean over the samples.
    pub mean: f64,
    /// Quantiles at 5 %, 50 % and 95 %.
    ///
    /// Each quantile is interpolated between the two nearest values ([`quantile_positions`]).
    pub quantiles: [f64; 3],
}

/// Names of the quantiles in tables, and their probabilities.
pub const QUANTILES: [(&str, f64); 3] = [("p05", 0.05), ("p50", 0.5), ("p95", 0.95)];

/// Returns the two positions in `count` sorted values that determine a quantile.
///
/// The result holds the 0-based positions of the two nearest values, and the weight of the second
/// value (type 7 of Hyndman and Fan 1996, doi 10.1080/00031305.1996.10473566). `None` for a count
/// of 0.
pub fn quantile_positions(count: usize, probability: f64) -> Option<([usize; 2], f64)> {
    let position = probability * count.checked_sub(1)? as f64;
    Some(([position.floor() as usize, position.ceil() as usize], position - position.floor()))
}

/// Returns the quantile of sorted values at a probability.
///
/// `None` if there are no values, or the result is not finite.
pub fn quantile(sorted: &[f64], probability: f64) -> Option<f64> {
    let ([below, above], part) = quantile_positions(sorted.len(), probability)?;
    finite(sorted[below] + part * (sorted[above] - sorted[below]))
}

impl Statistics {
    /// Computes the statistics of `values`.
    ///
    /// `None` if there are no values, or a result is not finite.
    pub fn from_values(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let [low, middle, high] = QUANTILES.map(|(_, probability)| quantile(&values, probability));
        // Without values this is 0/0, which `finite` turns into `None`.
        let mean = finite(values.iter().sum::<f64>() / values.len() as f64)?;
        Some(Self { mean, quantiles: [low?, middle?, high?] })
    }
}

/// Statistics over the samples of a design.
///
/// Failed samples are excluded from mean and quantiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SampleStatistics {
    /// Puncture force at the critical tilt.
    pub critical_force: Option<Statistics>,
    /// Penetration.
    pub penetration: Option<Statistics>,
    /// Number of samples without puncture values.
    pub puncture_failed: Option<usize>,
    /// Flexural compliance.
    pub compliance: Option<Statistics>,
    /// Difference of the curvatures at which the last and the first gap of a strip close.
    pub closing_range: Option<Statistics>,
    /// Number of samples without bending values.
    pub flexure_failed: Option<usize>,
}

impl SampleStatistics {
    /// Returns true if no samples were solved.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::Statistics;

    #[test]
    fn quantiles_are_interpolated_between_the_nearest_values() {
        let values: Vec<f64> = (0..=20).rev().map(f64::from).collect();
        let statistics = Statistics::from_values(values).expect("values");
        assert_eq!(statistics, Statistics { mean: 10.0, quantiles: [1.0, 10.0, 19.0] });
        let statistics = Statistics::from_values(vec![3.0, 1.0]).expect("values");
        assert_eq!((statistics.mean, statistics.quantiles[1]), (2.0, 2.0));
        assert!((statistics.quantiles[0] - 1.1).abs() < 1e-15);
        assert_eq!(Statistics::from_values(Vec::new()), None);
        assert_eq!(Statistics::from_values(vec![f64::MAX, f64::MAX]), None);
        assert_eq!(
            Statistics::from_values(vec![7.0]).map(|statistics| statistics.quantiles),
            Some([7.0; 3])
        );
    }
}
