//! The reasons why a path ends.

use crate::newton::NewtonFailure;

/// The reason why a path ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Termination {
    /// The control parameter reached its target.
    #[error("reached")]
    Reached,
    /// The load, which only pushes, came back to zero.
    #[error("unloaded")]
    Unloaded,
    /// Newton's iteration did not converge at the smallest step.
    #[error("no convergence")]
    NoConvergence,
    /// The tangent is singular: the path has no single continuation.
    #[error("singular tangent")]
    Singular,
    /// The limit on the number of equilibria was hit.
    #[error("too many points")]
    TooManyPoints,
    /// Constraints change sides again and again at one point, without the path moving on.
    #[error("cycling constraints")]
    Cycling,
    /// At an event no set of changes of constraints and their companions leads on, of all that pivoting comes to: there is no path on
    /// which the control parameter, or anything else, changes slowly.
    #[error("jumps")]
    Jumps,
    /// A residual is no longer a finite number.
    #[error("not finite")]
    NotFinite,
}

impl Termination {
    /// Whether Newton's method or the search for a way on has failed, for which the mechanics may have a reason.
    pub fn is_numerical(self) -> bool {
        matches!(self, Self::NoConvergence | Self::Singular | Self::Cycling | Self::NotFinite)
    }
}

impl From<NewtonFailure> for Termination {
    fn from(failure: NewtonFailure) -> Self {
        match failure {
            NewtonFailure::Singular(_) => Self::Singular,
            NewtonFailure::NotFinite => Self::NotFinite,
            NewtonFailure::TooManyIterations => Self::NoConvergence,
        }
    }
}
