//! The errors of a validation.

/// A validation that cannot be carried out.
#[derive(Debug, thiserror::Error)]
pub enum ValidationError {
    /// A benchmark has no result.
    #[error("benchmark: {0}")]
    Benchmark(String),
    /// A claim has no check.
    #[error("claim {0} has no check")]
    UncheckedClaim(String),
    /// The table of claims cannot be read.
    #[error(transparent)]
    Claims(#[from] csv::Error),
    /// A sweep cannot be run.
    #[error(transparent)]
    Run(#[from] run::RunError),
    /// The definition of a sweep is not valid.
    #[error(transparent)]
    Definition(#[from] sweep::InvalidDefinition),
    /// A value of an open choice cannot be set.
    #[error(transparent)]
    Setting(#[from] sweep::InvalidSetting),
    /// Results cannot be read.
    #[error(transparent)]
    Results(#[from] results::InvalidResults),
    /// The designs of the grid cannot be ranked.
    #[error(transparent)]
    Ranking(#[from] ranking::InvalidRanking),
    /// A search cannot be carried out.
    #[error(transparent)]
    Search(#[from] optimisation::OptimisationError),
    /// A search finds no design, or was stopped.
    #[error("a search between the grid points has no optimum")]
    NoOptimum,
    /// A temporary folder cannot be made.
    #[error("no temporary folder: {0}")]
    Folder(#[from] std::io::Error),
}
