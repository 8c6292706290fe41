//! Errors that end a fit without a result.

/// Reason why a fit has no result.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// The caller stopped the fit before it converged.
    #[error("stopped before the fit converged")]
    Stopped,
    /// The number of measured points does not exceed the number of unknowns.
    #[error(
        "too few points: {points}, for {unknowns} unknowns; expected more points than unknowns"
    )]
    TooFew {
        /// Total number of points of all curves.
        points: usize,
        /// Number of unknowns.
        unknowns: usize,
    },
    /// The definition has no unknowns.
    #[error("there are no unknowns; add [variables] or offsets to a [[curve]]")]
    NoUnknowns,
    /// Profiles still found better minima after the maximum number of restarts.
    #[error(
        "the search did not converge: the sum of squares has too many local minima; narrow the ranges of [variables]"
    )]
    Unsettled,
    /// No evaluated skin within the ranges can be solved.
    #[error("no evaluated skin within the ranges can be solved; examine one with squama design")]
    Unsolvable,
}
