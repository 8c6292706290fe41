//! How criteria are rescaled, and how they make a fitness.

use std::fmt;
use std::str::FromStr;

use results::columns::Goal;

/// How the values of a criterion are rescaled from 0, the worst, to 1, the best, and what the fitness is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// As in the paper: the criterion is the value, or its inverse where small values are good (R1); the fitness is the
    /// weighted geometric mean (R3), so that whoever is worst in one criterion has none.
    #[default]
    Paper,
    /// Even steps of the value count the same; the fitness is the weighted mean (R8).
    Linear,
    /// Even ratios of the value count the same; the fitness is the weighted mean (R8).
    Log,
}

/// A text that names no scale.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} is not accepted, expected paper, linear or log")]
pub struct UnknownScale(pub String);

impl Scale {
    /// All scales.
    pub const ALL: [Self; 3] = [Self::Paper, Self::Linear, Self::Log];

    /// The name of the scale on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Linear => "linear",
            Self::Log => "log",
        }
    }

    /// The criterion that a value makes, larger being better; `None` if an inverse or a logarithm does not exist.
    pub fn criterion(self, goal: Goal, value: f64) -> Option<f64> {
        let criterion = match (self, goal) {
            // A value as it is may be zero or negative; only inverses and logarithms may not.
            (Self::Paper | Self::Linear, Goal::Maximize) => return Some(value),
            (Self::Linear, Goal::Minimize) => return Some(-value),
            (Self::Paper, Goal::Minimize) => value.recip(),
            (Self::Log, Goal::Maximize) => value.ln(),
            (Self::Log, Goal::Minimize) => -value.ln(),
        };
        // A number above 0 may have no inverse either: that of 1e-309 is infinite.
        (value > 0.0 && criterion.is_finite()).then_some(criterion)
    }

    /// The part that a rescaled criterion adds to the score of a design, once for each unit of weight.
    pub(crate) fn term(self, rescaled: f64) -> f64 {
        // Of the worst −∞, so that no other criterion makes up for it: its fitness is 0.
        if self == Self::Paper { rescaled.ln() } else { rescaled }
    }

    /// The fitness of a design by its score: the sum of weighted terms, by which designs are ordered.
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
            let criterion = |goal, value| scale.criterion(goal, value).expect("it exists");
            assert!(criterion(Goal::Maximize, 2.0) > criterion(Goal::Maximize, 1.0));
            assert!(criterion(Goal::Minimize, 1.0) > criterion(Goal::Minimize, 2.0));
            assert_eq!(scale.name().parse(), Ok(scale));
        }
        assert_eq!(Scale::Paper.criterion(Goal::Minimize, 0.0), None);
        assert_eq!(Scale::Log.criterion(Goal::Maximize, -1.0), None);
        assert_eq!(Scale::Linear.criterion(Goal::Minimize, 0.0), Some(-0.0));
    }
}
