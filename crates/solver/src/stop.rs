//! The reasons why a path ends.

use std::fmt;

use crate::newton::NewtonFailure;

/// The reason why a path ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The control parameter reached its target.
    Reached,
    /// The load, which only pushes, came back to zero.
    Unloaded,
    /// Newton's iteration did not converge at the smallest step.
    NoConvergence,
    /// The tangent is singular: the path has no single continuation.
    Singular,
    /// The limit on the number of equilibria was hit.
    TooManyPoints,
    /// Constraints change sides again and again at one point, without the path moving on.
    Cycling,
    /// At an event no set of changes of constraints and their companions leads on, of all that pivoting comes to: there is no path on
    /// which the control parameter, or anything else, changes slowly.
    Jumps,
    /// A residual is no longer a finite number.
    NotFinite,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reached => "reached",
            Self::Unloaded => "unloaded",
            Self::NoConvergence => "no convergence",
            Self::Singular => "singular tangent",
            Self::TooManyPoints => "too many points",
            Self::Cycling => "cycling constraints",
            Self::Jumps => "jumps",
            Self::NotFinite => "not finite",
        })
    }
}

impl From<NewtonFailure> for Stop {
    fn from(failure: NewtonFailure) -> Self {
        match failure {
            NewtonFailure::Singular(_) => Self::Singular,
            NewtonFailure::NotFinite => Self::NotFinite,
            NewtonFailure::TooManyIterations => Self::NoConvergence,
        }
    }
}
