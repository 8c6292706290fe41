//! Weights of the criteria.

use std::fmt;
use std::str::FromStr;

use text::number;

use crate::tetrahedral_grid::{Steps, TetrahedralGrid};

/// Maximum number of criteria of a ranking.
pub const MOST_CRITERIA: usize = 8;

/// Weights of the criteria: non-negative numbers with the sum 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    values: [f64; MOST_CRITERIA],
    count: usize,
}

/// Maximum difference between 1 and a sum of weights that counts as 1.
///
/// Decimal weights, such as 0.1, are not binary fractions, so their sum is rarely exactly 1. Such
/// weights are kept instead of being divided by their sum.
const SUM_TOLERANCE: f64 = 1e-9;

/// Error: weights are not valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InvalidWeights {
    /// A weight is not a number.
    #[error("\"{0}\" is not accepted, expected a number of at least 0")]
    NotANumber(String),
    /// A weight is negative or not finite.
    #[error("{} is out of range, expected a number of at least 0", number::text(*.0))]
    OutOfRange(f64),
    /// The numbers of weights and criteria differ.
    #[error("{found} weights, expected {}: {criteria}", criteria.split(", ").count())]
    Count {
        /// Number of weights.
        found: usize,
        /// Names of the criteria.
        criteria: String,
    },
    /// There are no weights, or more than the maximum.
    #[error("{0} weights, expected 1 to {MOST_CRITERIA}")]
    Most(usize),
    /// All weights are 0.
    #[error("at least one weight must be positive")]
    Nothing,
}

impl Weights {
    /// Equal weights of the four criteria of the paper.
    pub const BALANCED: Self =
        Self { values: [0.25, 0.25, 0.25, 0.25, 0.0, 0.0, 0.0, 0.0], count: 4 };

    /// Returns equal weights of `count` criteria.
    pub fn equal(count: usize) -> Self {
        let weight = (count.max(1) as f64).recip();
        Self { values: std::array::from_fn(|c| if c < count { weight } else { 0.0 }), count }
    }

    /// Returns, for each criterion of the paper, the weights 1 for this criterion and 0 for others.
    ///
    /// The order is the order of [`CRITERIA`](crate::CRITERIA).
    pub fn alone() -> impl Iterator<Item = Self> {
        Self::alone_among(4)
    }

    /// Returns, for each of `count` criteria, the weights 1 for this criterion and 0 for others.
    pub fn alone_among(count: usize) -> impl Iterator<Item = Self> {
        (0..count).map(move |only| {
            let values = std::array::from_fn(|c| f64::from(u8::from(c == only)));
            Self { values, count }
        })
    }

    /// Creates weights in proportion to `weights`, one for each criterion.
    ///
    /// # Errors
    ///
    /// If a weight is negative, all weights are 0, or there are more than [`MOST_CRITERIA`].
    pub fn new(weights: &[f64]) -> Result<Self, InvalidWeights> {
        if let Some(&found) = weights.iter().find(|weight| !(0.0..f64::INFINITY).contains(*weight))
        {
            return Err(InvalidWeights::OutOfRange(found));
        }
        let count = weights.len();
        if !(1..=MOST_CRITERIA).contains(&count) {
            return Err(InvalidWeights::Most(count));
        }
        let sum = weights.iter().sum::<f64>();
        if sum <= 0.0 {
            return Err(InvalidWeights::Nothing);
        }
        let scaled =
            |weight: f64| if (sum - 1.0).abs() <= SUM_TOLERANCE { weight } else { weight / sum };
        Ok(Self {
            values: std::array::from_fn(|c| weights.get(c).map_or(0.0, |weight| scaled(*weight))),
            count,
        })
    }

    /// Returns the weights at a node of a grid.
    pub(crate) fn at(grid: TetrahedralGrid, steps: Steps) -> Self {
        let weights = grid.weights(steps);
        Self { values: std::array::from_fn(|c| weights.get(c).copied().unwrap_or(0.0)), count: 4 }
    }

    /// Returns the weights in the order of the criteria.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }

    /// Returns the score of a design: the sum of its terms, each multiplied by its weight.
    ///
    /// Designs are ordered by this score. Criteria without weight are ignored, even if their term
    /// is −∞. On the scale of the paper the score is the logarithm of the fitness:
    ///
    /// ```text
    /// ln f = Σ w_c ln s_c,   0⁰ = 1                                                    (R3)
    /// ```
    pub(crate) fn score(&self, terms: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (weight, term) in self.values().iter().zip(terms) {
            // Skip a weight of 0, because 0 · (−∞) is NaN.
            if *weight > 0.0 {
                sum += weight * term;
            }
        }
        sum
    }
}

impl FromStr for Weights {
    type Err = InvalidWeights;

    fn from_str(text: &str) -> Result<Self, InvalidWeights> {
        let weights: Vec<f64> = text
            .split(',')
            .map(|part| {
                part.trim()
                    .parse::<f64>()
                    .map_err(|_| InvalidWeights::NotANumber(part.trim().to_owned()))
            })
            .collect::<Result<_, _>>()?;
        Self::new(&weights)
    }
}

impl fmt::Display for Weights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let weights = self.values().iter().map(|weight| number::text(*weight));
        f.write_str(&weights.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_normalised() {
        let weights = |text: &str| text.parse::<Weights>();
        assert_eq!(weights("0.25, 0.25,0.25,0.25"), Ok(Weights::BALANCED));
        assert_eq!(weights("3,3,3,3"), Ok(Weights::BALANCED));
        assert_eq!(Weights::equal(4), Weights::BALANCED);
        assert_eq!(weights("0.1,0.2,0.3,0.4").expect("weights").values(), [0.1, 0.2, 0.3, 0.4]);
        assert_eq!(weights("1,3").expect("weights").values(), [0.25, 0.75]);
        let message = |text: &str| weights(text).expect_err("invalid").to_string();
        insta::assert_snapshot!(message("0,0,0,0"), @"at least one weight must be positive");
        insta::assert_snapshot!(message("1.5,-0.5,0,0"), @"-0.5 is out of range, expected a number of at least 0");
        insta::assert_snapshot!(message("nan,1,0,0"), @"NaN is out of range, expected a number of at least 0");
        insta::assert_snapshot!(message("1,1,1,1,1,1,1,1,1"), @"9 weights, expected 1 to 8");
        insta::assert_snapshot!(message("a,b,c,d"), @r#""a" is not accepted, expected a number of at least 0"#);
    }

    #[test]
    fn a_criterion_without_weight_is_ignored() {
        let mut terms = [0.0; MOST_CRITERIA];
        terms[..2].copy_from_slice(&[0.5_f64.ln(), f64::NEG_INFINITY]);
        let fitness =
            |weights: [f64; 4]| Weights::new(&weights).expect("weights").score(&terms).exp();
        assert!((fitness([1.0, 0.0, 0.0, 0.0]) - 0.5).abs() < 1e-15);
        assert_eq!(fitness([0.9, 0.1, 0.0, 0.0]).to_bits(), 0);
        assert_eq!(fitness([0.0, 0.0, 1.0, 0.0]).to_bits(), 1.0_f64.to_bits());
    }
}
