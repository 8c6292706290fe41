//! Scales on which criteria are rescaled and combined into a fitness.

use std::fmt;
use std::str::FromStr;

use results::columns::Goal;

/// Defines how criteria are rescaled from 0 (worst) to 1 (best) and combined into a fitness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Scale of the paper: the criterion is the value, or its inverse if it is minimised (R1).
    ///
    /// The fitness is the weighted geometric mean (R3), so a design that is the worst in any
    /// criterion with a positive weight has the fitness 0.
    #[default]
    Paper,
    /// Linear in the value; the fitness is the weighted mean (R8).
    Linear,
    /// Linear in the logarithm of the value; the fitness is the weighted mean (R8).
    Log,
}

/// Error: a text is not the name of a scale.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} is not accepted, expected paper, linear or log")]
pub struct UnknownScale(pub String);

impl Scale {
    /// All scales.
    pub const ALL: [Self; 3] = [Self::Paper, Self::Linear, Self::Log];

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Linear => "linear",
            Self::Log => "log",
        }
    }

    /// Returns the criterion of a value of a column; larger criteria are better.
    ///
    /// `None` if the required inverse or logarithm of the value does not exist.
    pub fn criterion(self, goal: Goal, value: f64) -> Option<f64> {
        let criterion = match (self, goal) {
            // Only inverses and logarithms require positive values.
            (Self::Paper | Self::Linear, Goal::Maximize) => return Some(value),
            (Self::Linear, Goal::Minimize) => return Some(-value),
            (Self::Paper, Goal::Minimize) => value.recip(),
            (Self::Log, Goal::Maximize) => value.ln(),
            (Self::Log, Goal::Minimize) => -value.ln(),
        };
        // The inverse of a small positive number may overflow, as for 1e-309.
        (value > 0.0 && criterion.is_finite()).then_some(criterion)
    }

    /// Returns the term of a rescaled criterion in the score, without its weight.
    pub(crate) fn term(self, rescaled: f64) -> f64 {
        // On the scale of the paper the term is −∞ at the worst value, so that the fitness is 0
        // for any values of the other criteria.
        if self == Self::Paper { rescaled.ln() } else { rescaled }
    }

    /// Returns the fitness of a design from its score, the sum of weighted terms.
    pub(crate) fn fitness(self, score: f64) -> f64 {
        if self == Self::Paper { score.exp() } else { score }
    }
}

impl FromStr for Scale {
    type Err = UnknownScale;

    fn from_str(text: &str) -> Result<Self, UnknownScale> {
        let known = Self::ALL.into_iter().find(|scale| scale.name() == text);
        known.ok_or_else(|| UnknownScale(text.to_owned()))
    }
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_criteria_are_better_on_every_scale() {
        for scale in Scale::ALL {
            for (goal, better, worse) in [(Goal::Maximize, 2.0, 1.0), (Goal::Minimize, 1.0, 2.0)] {
                let [better, worse] =
                    [better, worse].map(|value| scale.criterion(goal, value).expect("criterion"));
                assert!(better > worse, "{scale:?}");
            }
            assert_eq!(scale.name().parse(), Ok(scale));
        }
        assert_eq!(Scale::Paper.criterion(Goal::Minimize, 0.0), None);
        assert_eq!(Scale::Log.criterion(Goal::Maximize, -1.0), None);
        assert_eq!(Scale::Linear.criterion(Goal::Minimize, 0.0), Some(-0.0));
    }
}
