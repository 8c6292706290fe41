//! Evaluated designs, and their order by merit.

use std::cmp::Ordering;
use std::sync::Arc;

use results::DesignResult;

use crate::judgement::Judgement;
use crate::space::SpacePoint;

/// Relative difference up to which the merits of two solutions of one design agree.
const SAME: f64 = 1e-6;

/// Stage of a search in which a design was evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchStage {
    /// Initial design: a space-filling point, or a point on a coverage peak.
    Sample,
    /// Step of the gradient search.
    Gradient,
    /// Step of the ridge search (a bundle method), which follows kinks.
    Ridge,
    /// Step of the derivative-free search, or a point of a restart.
    Polish,
    /// First evaluation of a design with samples, or with more samples.
    Tolerance,
    /// Design rounded to multiples of a step.
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
    /// Stage of the search in which the design was evaluated.
    pub stage: SearchStage,
    /// Point of the design in the space of the variables.
    pub point: SpacePoint,
    /// Result of the nominal design.
    pub result: Arc<DesignResult>,
    /// Judgement by the goal.
    pub verdict: Judgement,
}

/// Target of a local search: one objective to maximise, with lower bounds on other objectives.
///
/// Targets with lower bounds are the problems of the ε-constraint method for fronts. The sign of
/// objectives to be minimised is changed, so that larger values are better.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Index of the objective to maximise.
    pub objective: usize,
    /// Index and lower bound of each bounded objective, after the change of sign.
    pub lower_bounds: Vec<(usize, f64)>,
}

/// Merit of a design for a target; larger is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Merit {
    /// The design has no valid judgement, e.g. because a measure failed.
    None,
    /// The design is infeasible. The value is its largest shortfall, relative to the limits.
    Short(f64),
    /// The design is feasible. The value is its objective, after the change of sign.
    Met(f64),
}

impl Merit {
    /// Compares two merits; the better merit is the greater.
    pub fn compare(self, other: Self) -> Ordering {
        match (self, other) {
            (Self::Met(a), Self::Met(b)) => a.total_cmp(&b),
            // The order is reversed, because the smaller shortfall is better.
            (Self::Short(a), Self::Short(b)) => b.total_cmp(&a),
            (a, b) => a.class().cmp(&b.class()),
        }
    }

    /// Returns true if two merits of one design agree within the accuracy of the solver.
    pub fn agrees(self, other: Self) -> bool {
        match (self, other) {
            (Self::Met(a), Self::Met(b)) => (a - b).abs() <= SAME * a.abs(),
            (Self::Short(a), Self::Short(b)) => (a - b).abs() <= SAME,
            (a, b) => a == b,
        }
    }

    /// Returns a number for the kind of merit; a better kind has a larger number.
    fn class(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Short(_) => 1,
            Self::Met(_) => 2,
        }
    }
}

/// Returns the index of the best merit, or the first index if several merits are equal.
///
/// `None` if no design has a valid judgement.
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
