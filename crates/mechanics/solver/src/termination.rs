//! Reasons for the end of a path.

use crate::newton::NewtonFailure;

/// Reason for the end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Termination {
    /// The control parameter reached its target.
    #[error("reached")]
    Reached,
    /// A load that can only push returned to zero.
    #[error("unloaded")]
    Unloaded,
    /// Newton's method did not converge at the smallest step.
    #[error("no convergence")]
    NoConvergence,
    /// The tangent is singular, so the direction of the path is not unique.
    #[error("singular tangent")]
    Singular,
    /// The path reached the limit [`Settings::max_points`](crate::Settings::max_points).
    #[error("too many points")]
    TooManyPoints,
    /// The path reached the limit [`Settings::max_work`](crate::Settings::max_work).
    #[error("too much work")]
    TooMuchWork,
    /// Every active set that was evaluated at an event violates some constraint.
    #[error("cycling constraints")]
    Cycling,
    /// No outgoing branch was found at an event, or the path reversed at events too often.
    ///
    /// Without a quasi-static continuation, the real system jumps to another equilibrium.
    #[error("jumps")]
    Jumps,
    /// The path returned to earlier events too often without a larger control parameter.
    #[error("no progress")]
    NoProgress,
    /// All paths of the process were interrupted by [`interrupt_paths`](crate::interrupt_paths).
    #[error("interrupted")]
    Interrupted,
    /// A residual is not a finite number.
    #[error("not finite")]
    NotFinite,
}

impl Termination {
    /// Returns true if Newton's method or the search for an outgoing branch failed.
    ///
    /// The caller may know a mechanical reason for such a failure. The limits `TooManyPoints` and
    /// `TooMuchWork` do not count as failures, because the path could continue.
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
