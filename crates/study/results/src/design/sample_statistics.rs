//! Statistics of the imperfect rows of one design: mean and quantiles over the samples.

use serde::{Deserialize, Serialize};

use super::failure::finite;

/// Mean and quantiles of a measure over the samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// The mean.
    pub mean: f64,
    /// The 5 %, 50 % and 95 % quantiles, interpolated between the two nearest values ([`quantile_places`]).
    pub quantiles: [f64; 3],
}

/// The names of the quantiles in tables, and the shares of the samples that lie below them.
pub const QUANTILES: [(&str, f64); 3] = [("p05", 0.05), ("p50", 0.5), ("p95", 0.95)];

/// The places of a quantile among `count` values in their order, from 0: those of the two nearest values, and the part that the
/// second has (type 7 of Hyndman and Fan 1996, doi 10.1080/00031305.1996.10473566). `None` without values.
pub fn quantile_places(count: usize, share: f64) -> Option<([usize; 2], f64)> {
    let place = share * count.checked_sub(1)? as f64;
    Some(([place.floor() as usize, place.ceil() as usize], place - place.floor()))
}

/// A quantile of values in their order; `None` if there are no values, or it is not finite.
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let ([below, above], part) = quantile_places(sorted.len(), share)?;
    finite(sorted[below] + part * (sorted[above] - sorted[below]))
}

impl Statistics {
    /// The statistics of `values`; `None` if there are no values, or one of the results is not
    /// finite.
    pub fn from_values(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let [low, middle, high] = QUANTILES.map(|(_, share)| quantile(&values, share));
        // Without values this is 0/0, and so none.
        let mean = finite(values.iter().sum::<f64>() / values.len() as f64)?;
        Some(Self { mean, quantiles: [low?, middle?, high?] })
    }
}

/// The statistics of the samples of a design. Samples that failed have no part in mean and quantiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SampleStatistics {
    /// The critical force.
    pub critical_force: Option<Statistics>,
    /// The penetration.
    pub penetration: Option<Statistics>,
    /// Number of samples whose puncture has no values.
    pub puncture_failed: Option<usize>,
    /// The flexural compliance.
    pub compliance: Option<Statistics>,
    /// The range of curvatures over which the gaps of a strip close.
    pub closing_range: Option<Statistics>,
    /// Number of samples whose bending has no values.
    pub flexure_failed: Option<usize>,
}

impl SampleStatistics {
    /// Whether no samples were solved.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::Statistics;

    #[test]
    fn quantiles_lie_between_the_nearest_values() {
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
