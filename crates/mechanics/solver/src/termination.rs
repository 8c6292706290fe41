//! Reasons why a path ends.

use crate::newton::NewtonFailure;

/// Reason why a path ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Termination {
    /// The control parameter reached its target.
    #[error("reached")]
    Reached,
    /// The load of a system that only pushes returned to zero.
    #[error("unloaded")]
    Unloaded,
    /// Newton's method did not converge at the smallest step.
    #[error("no convergence")]
    NoConvergence,
    /// The tangent is singular: the path has no single continuation.
    #[error("singular tangent")]
    Singular,
    /// The path reached the limit on the number of equilibria.
    #[error("too many points")]
    TooManyPoints,
    /// The path reached the limit on its work.
    #[error("too much work")]
    TooMuchWork,
    /// Constraints change sides repeatedly at one point without progress.
    #[error("cycling constraints")]
    Cycling,
    /// The event has no outgoing branch among the evaluated changes.
    ///
    /// They are changes of coupled constraints. There is no quasi-static continuation; the real
    /// system jumps.
    #[error("jumps")]
    Jumps,
    /// The path returns to the same points again and again without progress.
    #[error("no progress")]
    NoProgress,
    /// The process was asked to end ([`interrupt_paths`](crate::interrupt_paths)).
    #[error("interrupted")]
    Interrupted,
    /// A residual is not a finite number.
    #[error("not finite")]
    NotFinite,
}

impl Termination {
    /// Returns true if Newton's method or the search for an outgoing branch failed.
    ///
    /// The caller may know a mechanical reason for such a failure. Too many points or too much work
    /// are limits, and the path might have gone on.
    pub fn is_numerical(self) -> bool {
        matches!(
            self,
            Self::NoConvergence
                | Self::Singular
                | Self::Cycling
                | Self::NoProgress
                | Self::NotFinite
        )
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
