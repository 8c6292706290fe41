//! Quantile of the values of samples, and its confidence interval.

use results::quantile;
use statrs::distribution::{Binomial, DiscreteCDF as _};

/// Quantile of the values of samples, and its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledQuantile {
    /// Quantile of the samples; `None` if it is not finite.
    pub value: Option<f64>,
    /// 95 % confidence interval of the true quantile.
    ///
    /// An end is `None` if there are too few samples to bound it, or if it is not finite.
    pub interval: [Option<f64>; 2],
}

/// Maximum probability that the true value is below the interval, and that it is above.
const MISS: f64 = 0.025;

impl SampledQuantile {
    /// Computes the quantile of `values` at `probability`, and its confidence interval.
    ///
    /// The interval is valid for every distribution of the values, because the number of values
    /// below the true quantile is binomial (T8; David & Nagaraja 2003, *Order Statistics*, section
    /// 7.1). The value of a failed sample is the worst value, −∞ or ∞.
    pub fn of(mut values: Vec<f64>, probability: f64) -> Self {
        values.sort_by(f64::total_cmp);
        let value = quantile(&values, probability);
        let interval = interval_indices(values.len(), probability)
            .map(|index| values.get(index?).copied().filter(|value| value.is_finite()));
        Self { value, interval }
    }
}

/// Returns the indices, in the sorted values, of the ends of the confidence interval.
///
/// The interval belongs to the quantile at `probability` of `count` values. An index is `None` if
/// there are too few values.
fn interval_indices(count: usize, probability: f64) -> [Option<usize>; 2] {
    let Ok(below) = Binomial::new(probability, count as u64) else { return [None; 2] };
    // Sorted values are counted from 1. The lower end, value `l`, is too high if fewer than `l`
    // values lie below the true quantile. The upper end, value `u`, is too low if at least `u`
    // values lie below the true quantile.
    let low = (1..=count).take_while(|&l| below.cdf(l as u64 - 1) <= MISS).last();
    let high = (1..=count).find(|&u| below.sf(u as u64 - 1) <= MISS);
    [low, high].map(|index| index.map(|from_one| from_one - 1))
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{Binomial, Discrete as _};

    use super::{SampledQuantile, interval_indices};

    #[test]
    fn intervals_cover_the_quantile_95_percent_of_the_time() {
        for (count, probability) in
            [(200, 0.05), (1000, 0.05), (1000, 0.5), (1000, 0.95), (73, 0.5)]
        {
            let [low, high] = interval_indices(count, probability)
                .map(|index| index.expect("an end of the interval") as u64 + 1);
            let below = Binomial::new(probability, count as u64).expect("a probability");
            // The interval contains the quantile if at least `low` and fewer than `high` values lie
            // below the quantile.
            let covered: f64 = (low..high).map(|k| below.pmf(k)).sum();
            assert!((0.95..0.98).contains(&covered), "{count} {probability}: {covered}");
        }
        assert_eq!(
            interval_indices(20, 0.05)[0],
            None,
            "the probability that all 20 values lie above the 5 % quantile exceeds 2.5 %"
        );
    }

    #[test]
    fn failed_samples_rank_below_all_values() {
        let mut values: Vec<f64> = (1..=99).map(f64::from).collect();
        values.push(f64::NEG_INFINITY);
        let half = SampledQuantile::of(values.clone(), 0.5);
        assert_eq!(half.value, Some(49.5));
        values.extend([f64::NEG_INFINITY; 20]);
        assert_eq!(
            SampledQuantile::of(values, 0.05),
            SampledQuantile { value: None, interval: [None, None] }
        );
    }
}
