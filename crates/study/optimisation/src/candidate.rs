//! A design that was looked at in a search, and which of two is better.

use std::cmp::Ordering;
use std::sync::Arc;

use results::DesignResult;

use crate::judgement::Judgement;
use crate::space::SpacePoint;

/// The stage of a search in which a design was looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchStage {
    /// The points that fill the space.
    Sample,
    /// A step along derivatives.
    Gradient,
    /// A step along a ridge, by derivatives on both sides of it.
    Ridge,
    /// A step of the search without derivatives.
    Polish,
    /// The first look at the samples of a nominal design.
    Tolerance,
}

impl SearchStage {
    /// The stage in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Sample => "sample",
            Self::Gradient => "gradient",
            Self::Ridge => "ridge",
            Self::Polish => "polish",
            Self::Tolerance => "tolerance",
        }
    }
}

/// A design that was looked at.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The stage.
    pub stage: SearchStage,
    /// The point of the design.
    pub point: SpacePoint,
    /// The result of the design.
    pub result: Arc<DesignResult>,
    /// The verdict on it.
    pub verdict: Judgement,
}

/// The aim of a search: the objective that is to be as large as can be (turned, if it is to be small), and bounds that others must
/// keep.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// The objective.
    pub objective: usize,
    /// Objectives with the least turned value that they may have.
    pub floors: Vec<(usize, f64)>,
}

/// The merit of a design under a target, the larger the better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Merit {
    /// The design cannot be judged.
    None,
    /// The design falls short, by so much at most.
    Short(f64),
    /// The design meets everything, and has that turned objective.
    Met(f64),
}

impl Merit {
    /// Larger merits are better.
    pub fn compare(self, other: Self) -> Ordering {
        match (self, other) {
            (Self::Met(a), Self::Met(b)) => a.total_cmp(&b),
            // Turned: the smaller shortfall is the better.
            (Self::Short(a), Self::Short(b)) => b.total_cmp(&a),
            (a, b) => a.class().cmp(&b.class()),
        }
    }

    fn class(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Short(_) => 1,
            Self::Met(_) => 2,
        }
    }
}

/// The index of the best by merit; of equal ones the first.
pub(crate) fn best(merits: impl Iterator<Item = Merit>) -> Option<usize> {
    let better = |(best, merit): (usize, Merit), (index, other): (usize, Merit)| {
        if other.compare(merit) == Ordering::Greater { (index, other) } else { (best, merit) }
    };
    let judged = merits.enumerate().filter(|(_, merit)| *merit != Merit::None);
    judged.reduce(better).map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_meets_everything_is_better_than_who_does_not() {
        let merits = [Merit::None, Merit::Short(0.1), Merit::Short(0.2), Merit::Met(-5.0)];
        let best_of = |merits: &[Merit]| best(merits.iter().copied());
        assert_eq!(best_of(&merits), Some(3));
        assert_eq!(best_of(&merits[..3]), Some(1));
        assert_eq!(best_of(&merits[..1]), None);
        assert_eq!(best_of(&[Merit::Met(1.0), Merit::Met(2.0), Merit::Met(2.0)]), Some(1));
    }
}
