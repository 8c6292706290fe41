//! Evaluated designs, and their order by merit.

use std::cmp::Ordering;
use std::sync::Arc;

use results::DesignResult;

use crate::judgement::Judgement;
use crate::space::SpacePoint;

/// Relative difference of merits that come from two solutions of the same design.
const SAME: f64 = 1e-6;

/// Stage of a search in which a design was evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchStage {
    /// Space-filling points.
    Sample,
    /// A step of the gradient search.
    Gradient,
    /// A step of the ridge search, by derivatives on both sides of a kink.
    Ridge,
    /// A step of the derivative-free search.
    Polish,
    /// First sampling of a nominal design.
    Tolerance,
    /// A design rounded to multiples of a step.
    Rounded,
}

impl SearchStage {
    /// Returns the name of the stage in `history.csv`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Sample => "sample",
            Self::Gradient => "gradient",
            Self::Ridge => "ridge",
            Self::Polish => "polish",
            Self::Tolerance => "tolerance",
            Self::Rounded => "rounded",
        }
    }
}

/// An evaluated design.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Stage of the evaluation.
    pub stage: SearchStage,
    /// The point of the design.
    pub point: SpacePoint,
    /// The result of the design.
    pub result: Arc<DesignResult>,
    /// Judgement by the goal.
    pub verdict: Judgement,
}

/// Target of a search: an objective to maximise, with bounds on the others.
///
/// This is the ε-constraint method. Objectives to be minimised change sign.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Index of the objective.
    pub objective: usize,
    /// Lower bounds of other objectives, after the change of sign.
    pub floors: Vec<(usize, f64)>,
}

/// Merit of a design for a target; larger is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Merit {
    /// The design has no valid judgement.
    None,
    /// The design is infeasible, with this largest shortfall.
    Short(f64),
    /// The design is feasible, with this objective after the change of sign.
    Met(f64),
}

impl Merit {
    /// Compares two merits; the greater is better.
    pub fn compare(self, other: Self) -> Ordering {
        match (self, other) {
            (Self::Met(a), Self::Met(b)) => a.total_cmp(&b),
            // Reversed, because the smaller shortfall is better.
            (Self::Short(a), Self::Short(b)) => b.total_cmp(&a),
            (a, b) => a.class().cmp(&b.class()),
        }
    }

    /// Returns true if two merits of the same design differ by the accuracy of its solution only.
    pub fn agrees(self, other: Self) -> bool {
        match (self, other) {
            (Self::Met(a), Self::Met(b)) => (a - b).abs() <= SAME * a.abs(),
            (Self::Short(a), Self::Short(b)) => (a - b).abs() <= SAME,
            (a, b) => a == b,
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

/// Returns the index of the best merit; the first of equal ones.
pub(crate) fn best(merits: impl Iterator<Item = Merit>) -> Option<usize> {
    let judged = merits.enumerate().filter(|(_, merit)| *merit != Merit::None);
    judged
        .reduce(|(best, merit), (index, other)| {
            if other.compare(merit) == Ordering::Greater { (index, other) } else { (best, merit) }
        })
        .map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feasible_designs_are_better_than_infeasible_ones() {
        let merits = [Merit::None, Merit::Short(0.1), Merit::Short(0.2), Merit::Met(-5.0)];
        assert_eq!(best(merits.into_iter()), Some(3));
        assert_eq!(best(merits[..3].iter().copied()), Some(1));
        assert_eq!(best(merits[..1].iter().copied()), None);
        let equal = [Merit::Met(1.0), Merit::Met(2.0), Merit::Met(2.0)];
        assert_eq!(best(equal.into_iter()), Some(1));
    }
}
