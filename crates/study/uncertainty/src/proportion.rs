//! Fraction of samples with a property, and its confidence interval.

use statrs::distribution::{Beta, ContinuousCDF as _};

/// Fraction of samples with a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Proportion {
    /// Number of samples with the property.
    pub met: usize,
    /// Number of samples, at least one.
    pub of: usize,
}

/// Maximum probability that the true value is below the interval, and that it is above.
const MISS: f64 = 0.025;

impl Proportion {
    /// Returns the fraction of samples with the property, from 0 to 1.
    pub fn share(self) -> f64 {
        self.met as f64 / self.of as f64
    }

    /// Returns the 95 % confidence interval of the probability of the property.
    ///
    /// The interval contains the true probability in at least 95 % of all experiments (T5; Clopper
    /// & Pearson 1934, doi 10.1093/biomet/26.4.404).
    ///
    /// ```
    /// use uncertainty::Proportion;
    ///
    /// // All of 1,000 samples meet a requirement. The interval of the yield starts at 99.63 %.
    /// let [low, high] = Proportion { met: 1000, of: 1000 }.interval();
    /// assert!((low - 0.99632).abs() < 1e-5 && high == 1.0);
    /// ```
    pub fn interval(self) -> [f64; 2] {
        let (met, missed) = (self.met as f64, (self.of - self.met) as f64);
        // The beta distribution is undefined for the lower end if no sample has the property, and
        // for the upper end if every sample has it. These ends are 0 and 1.
        let low = quantile(met, missed + 1.0, MISS).unwrap_or(0.0);
        let high = quantile(met + 1.0, missed, 1.0 - MISS).unwrap_or(1.0);
        [low, high]
    }
}

/// Returns the quantile at probability `share` of the beta distribution with `a` and `b`.
///
/// `None` if `a` or `b` is 0.
fn quantile(a: f64, b: f64, share: f64) -> Option<f64> {
    Beta::new(a, b).ok().map(|beta| beta.inverse_cdf(share))
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{Binomial, Discrete as _};

    use super::Proportion;

    #[test]
    fn intervals_cover_the_probability_at_least_95_percent_of_the_time() {
        for samples in [10, 100, 1000] {
            for probability in [0.01, 0.3, 0.5, 0.83, 0.97, 0.999] {
                let counts = Binomial::new(probability, samples).expect("a probability");
                let covered: f64 = (0..=samples)
                    .filter(|met| {
                        let [low, high] =
                            Proportion { met: *met as usize, of: samples as usize }.interval();
                        (low..=high).contains(&probability)
                    })
                    .map(|met| counts.pmf(met))
                    .sum();
                assert!(covered >= 0.95, "{samples} {probability}: {covered}");
            }
        }
        // For many samples the width is close to the width of the normal approximation.
        let [low, high] = Proportion { met: 500, of: 1000 }.interval();
        assert!((high - low - 2.0 * 1.96 * (0.25_f64 / 1000.0).sqrt()).abs() < 0.002);
    }
}
