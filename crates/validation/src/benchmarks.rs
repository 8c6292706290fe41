//! Problems with known answers.

mod frame;
mod half_space;
mod membranes;
mod paths;
mod skins;

use crate::Error;

/// A number that is known, and what comes out here.
#[derive(Clone, Debug, PartialEq)]
pub struct Benchmark {
    /// The problem and the quantity.
    pub name: String,
    /// Where the reference comes from.
    pub source: &'static str,
    /// The known value.
    pub reference: f64,
    /// Ours.
    pub ours: f64,
    /// Largest relative difference that is right; where the reference is itself an approximation, its known error.
    pub band: f64,
    /// Observed order of convergence, where meshes are refined.
    pub order: Option<f64>,
}

impl Benchmark {
    fn new(
        name: impl Into<String>,
        source: &'static str,
        [reference, ours]: [f64; 2],
        band: f64,
    ) -> Self {
        Self { name: name.into(), source, reference, ours, band, order: None }
    }

    /// The relative difference.
    pub fn difference(&self) -> f64 {
        self.ours / self.reference - 1.0
    }

    /// Whether ours lies within the band.
    pub fn holds(&self) -> bool {
        self.difference().abs() <= self.band
    }
}

/// All benchmarks.
///
/// # Errors
/// If one of them cannot be set up or has no solution.
pub fn benchmarks() -> Result<Vec<Benchmark>, Error> {
    let mut all = half_space::benchmarks()?;
    all.extend(membranes::benchmarks()?);
    all.extend(paths::benchmarks()?);
    all.extend(skins::benchmarks()?);
    Ok(all)
}
