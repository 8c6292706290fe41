//! The four criteria by which designs are ranked, and their weights.

use std::fmt;
use std::str::FromStr;

use sweep::number;

use crate::front::Criteria;
use crate::tetrahedral_grid::{Steps, TetrahedralGrid};

/// A criterion: a column of the tables, and which of its values are good.
#[derive(Debug, PartialEq, Eq)]
pub struct Criterion {
    /// The name of the criterion in words.
    pub name: &'static str,
    /// The column that it is made from.
    pub column: &'static str,
    /// Whether small values are good, so that the criterion is their inverse.
    pub inverse: bool,
}

/// The criteria in the order of their weights `m, n, k, l`.
pub static CRITERIA: [Criterion; 4] = [
    Criterion { name: "coverage", column: "coverage", inverse: false },
    Criterion { name: "critical force", column: "critical_force", inverse: false },
    Criterion { name: "penetration resistance", column: "penetration", inverse: true },
    Criterion { name: "flexural compliance", column: "compliance", inverse: false },
];

/// Weights of the criteria: none negative, their sum 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights([f64; 4]);

/// The sum of weights may be off by this, because not every weight is a binary fraction.
const SUM_TOLERANCE: f64 = 1e-9;

/// Weights that share out more or less than 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InvalidWeights {
    /// One of them is no number.
    #[error("\"{found}\" is not accepted, expected a number of at least 0")]
    NotANumber {
        /// The text.
        found: String,
    },
    /// One of them is negative or not finite.
    #[error("{} is out of range, expected a number of at least 0", number::text(*found))]
    OutOfRange {
        /// The weight.
        found: f64,
    },
    /// There are fewer or more.
    #[error(
        "{found} weights, expected 4: coverage, critical force, penetration resistance, flexural compliance"
    )]
    Count {
        /// The number of weights.
        found: usize,
    },
    /// The weights do not sum to 1.
    #[error("the weights sum to {}, expected 1", number::text(*sum))]
    Sum {
        /// The sum of the weights.
        sum: f64,
    },
}

impl Weights {
    /// Every criterion counts the same.
    pub const BALANCED: Self = Self([0.25; 4]);

    /// The weights under which one criterion counts alone, in the order of [`CRITERIA`].
    pub fn alone() -> impl Iterator<Item = Self> {
        (0..CRITERIA.len()).map(|own| Self(std::array::from_fn(|c| f64::from(u8::from(c == own)))))
    }

    /// Weights `m, n, k, l`.
    ///
    /// # Errors
    /// If one is negative or they do not sum to 1.
    pub fn new(weights: [f64; 4]) -> Result<Self, InvalidWeights> {
        let is_right = |weight: &f64| weight.is_finite() && *weight >= 0.0;
        if let Some(&found) = weights.iter().find(|weight| !is_right(weight)) {
            return Err(InvalidWeights::OutOfRange { found });
        }
        let sum = weights.iter().sum::<f64>();
        if (sum - 1.0).abs() > SUM_TOLERANCE {
            // Without the digits that only binary fractions have.
            return Err(InvalidWeights::Sum { sum: (sum * 1e12).round() / 1e12 });
        }
        Ok(Self(weights))
    }

    /// The weights at a node of a grid.
    pub(crate) fn at(grid: TetrahedralGrid, steps: Steps) -> Self {
        Self(grid.weights(steps))
    }

    /// The weights in the order of [`CRITERIA`].
    pub fn values(self) -> [f64; 4] {
        self.0
    }

    /// The logarithm of the fitness of a design whose rescaled criteria have the logarithms `logs`.
    ///
    /// ```text
    /// f = Π s_c^(w_c),   0⁰ = 1                                                        (R3)
    /// ```
    pub(crate) fn log_fitness(self, logs: &Criteria) -> f64 {
        let mut sum = 0.0;
        for (weight, log) in self.0.iter().zip(logs) {
            // What has no weight is ignored, even where it is as bad as can be.
            if *weight > 0.0 {
                sum += weight * log;
            }
        }
        sum
    }
}

impl FromStr for Weights {
    type Err = InvalidWeights;

    fn from_str(text: &str) -> Result<Self, InvalidWeights> {
        let read = |part: &str| {
            let error = || InvalidWeights::NotANumber { found: part.trim().to_owned() };
            part.trim().parse::<f64>().map_err(|_| error())
        };
        let weights: Vec<f64> = text.split(',').map(read).collect::<Result<_, _>>()?;
        let found = weights.len();
        Self::new(weights.try_into().map_err(|_| InvalidWeights::Count { found })?)
    }
}

impl fmt::Display for Weights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = CRITERIA.iter().zip(self.0);
        let parts = parts.map(|(c, weight)| format!("{} {}", c.name, number::text(weight)));
        f.write_str(&parts.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_share_out_one() {
        let weights = |text: &str| text.parse::<Weights>();
        assert_eq!(weights("0.25, 0.25,0.25,0.25"), Ok(Weights::BALANCED));
        assert!(weights("0.1,0.2,0.3,0.4").is_ok());
        assert!(weights("1,0,0,0").is_ok());
        let message = |text: &str| weights(text).expect_err("invalid").to_string();
        insta::assert_snapshot!(message("0.5,0.6,0,0"), @"the weights sum to 1.1, expected 1");
        insta::assert_snapshot!(message("1.5,-0.5,0,0"), @"-0.5 is out of range, expected a number of at least 0");
        insta::assert_snapshot!(message("nan,1,0,0"), @"NaN is out of range, expected a number of at least 0");
        insta::assert_snapshot!(message("0.5,0.5"), @"2 weights, expected 4: coverage, critical force, penetration resistance, flexural compliance");
        insta::assert_snapshot!(message("a,b,c,d"), @r#""a" is not accepted, expected a number of at least 0"#);
    }

    #[test]
    fn a_criterion_without_weight_is_ignored() {
        let ruined = [0.5_f64.ln(), f64::NEG_INFINITY, 0.0, 0.0];
        let fitness = |weights: [f64; 4]| Weights(weights).log_fitness(&ruined).exp();
        assert!((fitness([1.0, 0.0, 0.0, 0.0]) - 0.5).abs() < 1e-15);
        assert_eq!(fitness([0.9, 0.1, 0.0, 0.0]).to_bits(), 0);
        assert_eq!(fitness([0.0, 0.0, 1.0, 0.0]).to_bits(), 1.0_f64.to_bits());
    }
}
