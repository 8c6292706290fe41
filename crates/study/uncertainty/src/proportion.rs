//! Fraction of samples with a property, with its confidence interval.

use statrs::distribution::{Beta, ContinuousCDF as _};

/// Fraction of samples with a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Proportion {
    /// Number of samples with the property.
    pub met: usize,
    /// Number of samples, at least one.
    pub of: usize,
}

/// Probability that the true value lies beyond one end of the interval.
const MISS: f64 = 0.025;

impl Proportion {
    /// Returns the fraction.
    pub fn share(self) -> f64 {
        self.met as f64 / self.of as f64
    }

    /// Returns the 95 % confidence interval of the probability.
    ///
    /// Its coverage is at least 95 % (Clopper & Pearson 1934, doi 10.1093/biomet/26.4.404).
    ///
    /// ```
    /// use uncertainty::Proportion;
    ///
    /// // If all of 1,000 samples meet a requirement, at most 3.7 of a thousand do not.
    /// let [low, high] = Proportion { met: 1000, of: 1000 }.interval();
    /// assert!((low - 0.99632).abs() < 1e-5 && high == 1.0);
    /// ```
    pub fn interval(self) -> [f64; 2] {
        let (met, missed) = (self.met as f64, (self.of - self.met) as f64);
        // The beta distribution is undefined if no sample or every sample has the property. The
        // interval then ends at 0 or 1.
        let low = quantile(met, missed + 1.0, MISS).unwrap_or(0.0);
        let high = quantile(met + 1.0, missed, 1.0 - MISS).unwrap_or(1.0);
        [low, high]
    }
}

/// Returns a quantile of the beta distribution; `None` if a parameter is 0.
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
        // The coverage is not much larger for large counts.
        let [low, high] = Proportion { met: 500, of: 1000 }.interval();
        assert!((high - low - 2.0 * 1.96 * (0.25_f64 / 1000.0).sqrt()).abs() < 0.002);
    }
}
