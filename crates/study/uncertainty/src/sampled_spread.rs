//! Standard deviation of a measure over solved samples.

use results::Statistics;

/// Standard deviation and other statistics of a measure over solved samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledSpread {
    /// Number of samples with a value, at least two.
    pub count: usize,
    /// Mean and quantiles of the values.
    pub statistics: Statistics,
    /// Standard deviation of the values.
    pub spread: f64,
    /// Standard error of the standard deviation (T4).
    pub spread_error: f64,
}

/// A standard deviation below this fraction of the largest value is regarded as round-off.
const ROUND_OFF: f64 = 1e-13;

impl SampledSpread {
    /// Computes the statistics of `values`; `None` for fewer than two values.
    pub fn of(values: &[f64]) -> Option<Self> {
        let count = values.len();
        let statistics = Statistics::from_values(values.to_vec()).filter(|_| count > 1)?;
        let n = count as f64;
        let [second, fourth] = [2, 4].map(|power| {
            values.iter().map(|value| (value - statistics.mean).powi(power)).sum::<f64>() / n
        });
        let variance = second * n / (n - 1.0);
        let of_variance = (fourth - variance.powi(2) * (n - 3.0) / (n - 1.0)).max(0.0) / n;
        let size = values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        // Samples follow different paths. Their round-off also affects measures that do not depend
        // on the deviations.
        let is_round_off = variance.sqrt() <= ROUND_OFF * size;
        let spread = if is_round_off { 0.0 } else { variance.sqrt() };
        let spread_error = if spread > 0.0 { of_variance.sqrt() / (2.0 * spread) } else { 0.0 };
        Some(Self { count, statistics, spread, spread_error })
    }
}

#[cfg(test)]
mod tests {
    use super::SampledSpread;

    #[test]
    fn standard_error_of_the_spread_follows_from_the_kurtosis() {
        // The kurtosis of a uniform distribution is 9/5, so the error is s √(0.8/4n).
        let values: Vec<f64> = (0..1001).map(f64::from).collect();
        let sampled = SampledSpread::of(&values).expect("values");
        assert!((sampled.spread - 1000.0 / 12.0_f64.sqrt()).abs() < 0.5);
        let expected = sampled.spread * (0.8 / 4004.0_f64).sqrt();
        assert!((sampled.spread_error / expected - 1.0).abs() < 0.01);
        assert_eq!(SampledSpread::of(&[1.0]), None);
        assert_eq!(
            SampledSpread::of(&[2.0, 2.0]).map(|s| (s.spread, s.spread_error)),
            Some((0.0, 0.0))
        );
    }
}
