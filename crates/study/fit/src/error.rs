//! Errors of a fit.

/// A fit without a result.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// The fit was stopped.
    #[error("stopped before the fit converged")]
    Stopped,
    /// There are not more points than unknowns.
    #[error(
        "too few points: {points}, for {unknowns} unknowns; expected more points than unknowns"
    )]
    TooFew {
        /// Number of points of all curves.
        points: usize,
        /// Number of unknowns.
        unknowns: usize,
    },
    /// The definition has no unknowns.
    #[error("there are no unknowns; add [variables] or offsets to a [[curve]]")]
    NoUnknowns,
    /// Profiles kept finding better minima, up to the maximum number of restarts.
    #[error(
        "the search did not converge: the sum of squares has too many local minima; narrow the ranges of [variables]"
    )]
    Unsettled,
    /// No evaluated skin within the ranges can be solved.
    #[error("no evaluated skin within the ranges can be solved; examine one with squama design")]
    Unsolvable,
}
