//! Benchmarks: problems with known answers.

mod frame;
mod half_space;
mod membranes;
mod paths;
mod skins;

use anyhow::Context as _;

/// A quantity with a known value, and its value computed by squama.
#[derive(Clone, Debug, PartialEq)]
pub struct Benchmark {
    /// Names of the problem and of the quantity.
    pub name: String,
    /// The source of the reference.
    pub source: &'static str,
    /// The reference value.
    pub reference: f64,
    /// The computed value.
    pub ours: f64,
    /// The accepted relative difference. For an approximate reference, it is the known error.
    pub band: f64,
    /// The observed order of convergence, if meshes are refined.
    pub order: Option<f64>,
}

impl Benchmark {
    /// Creates a benchmark without an order of convergence.
    fn new(
        name: impl Into<String>,
        source: &'static str,
        [reference, ours]: [f64; 2],
        band: f64,
    ) -> Self {
        Self { name: name.into(), source, reference, ours, band, order: None }
    }

    /// Returns the relative difference between computed and reference value.
    pub fn difference(&self) -> f64 {
        self.ours / self.reference - 1.0
    }

    /// Returns true if the difference lies within the band.
    pub fn is_within_band(&self) -> bool {
        self.difference().abs() <= self.band
    }
}

/// Solves all benchmarks.
///
/// # Errors
/// If a benchmark is invalid or has no solution.
pub fn benchmarks() -> anyhow::Result<Vec<Benchmark>> {
    let all = [half_space::benchmarks, membranes::benchmarks, paths::benchmarks, skins::benchmarks];
    let solved = all.map(|of| of().context("benchmark")).into_iter();
    Ok(solved.collect::<anyhow::Result<Vec<_>>>()?.concat())
}
