//! What squama reproduces, and why a reader may believe it.
//!
//! | Item | Role |
//! |---|---|
//! | [`benchmarks()`], [`Benchmark`] | problems with known answers |
//! | [`claims()`], [`Claim`], [`CheckedClaim`] | what the paper reports, and what comes out here |
//! | [`sensitivity()`], [`Sensitivity`], [`Headlines`] | how far the headline results depend on what the paper leaves open |
//! | [`Search`], [`Scored`] | every combination of open choices, by how many claims it reproduces |
//! | [`Validation`] | all of it, and the page that says so |
//!
//! ```
//! for benchmark in validation::benchmarks()? {
//!     assert!(benchmark.holds(), "{}: {}", benchmark.name, benchmark.ours);
//! }
//! # Ok::<(), validation::Error>(())
//! ```

mod benchmarks;
mod claims;
mod page;
mod search;
mod sensitivity;
mod study;

use sweep::Sweep;

pub use benchmarks::{Benchmark, benchmarks};
pub use claims::{CheckedClaim, Claim, Finding, Verdict, claims};
pub use search::{Scored, Search};
pub use sensitivity::{CouplingEffect, Headlines, Sensitivity, sensitivity};
use study::Study;

/// The sweeps on which claims are checked: the paper's 720 designs with either meaning of the length.
const SWEEPS: [&str; 2] = ["name = \"paper\"", "name = \"paper-as-written\"\nscale.base = \"2L\""];

/// A validation that cannot be carried out.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A benchmark has no result.
    #[error("benchmark: {0}")]
    Benchmark(String),
    /// A claim has no check.
    #[error("claim {0} has no check")]
    UncheckedClaim(String),
    /// The table of claims is none.
    #[error(transparent)]
    Claims(#[from] csv::Error),
    /// A sweep cannot be run.
    #[error(transparent)]
    Run(#[from] run::RunError),
    /// A definition is not right.
    #[error(transparent)]
    Definition(#[from] sweep::InvalidDefinition),
    /// Results cannot be read.
    #[error(transparent)]
    Results(#[from] results::InvalidResults),
    /// There is no temporary folder.
    #[error("no temporary folder: {0}")]
    Folder(#[from] std::io::Error),
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Validation {
    /// Benchmarks.
    pub benchmarks: Vec<Benchmark>,
    /// Claims of the paper.
    pub claims: Vec<CheckedClaim>,
    /// What the headline results depend on.
    pub sensitivity: Vec<Sensitivity>,
    /// What the paper's simplified coupling through the substrate does to the measures.
    pub coupling: Vec<CouplingEffect>,
}

impl Validation {
    /// Solves the benchmarks and both sweeps.
    ///
    /// # Errors
    /// If a benchmark has no result or the temporary folder does not take the tables.
    pub fn run() -> Result<Self, Error> {
        let benchmarks = benchmarks()?;
        let study = |text: &str| Study::run(Sweep::parse(text, "paper", &[])?);
        let [paper, as_written] = [study(SWEEPS[0])?, study(SWEEPS[1])?];
        let claims = claims::check([&paper, &as_written])?;
        let (sensitivity, coupling) = sensitivity()?;
        Ok(Self { benchmarks, claims, sensitivity, coupling })
    }

    /// Whether every benchmark lies within its band.
    pub fn holds(&self) -> bool {
        self.benchmarks.iter().all(Benchmark::holds)
    }
}
