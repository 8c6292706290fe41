//! Samples of designs, solved one by one.

use results::DesignRow;
use run::Evaluator;
use sweep::{Case, DesignNumber, Deviation, Measure};

use crate::draw;

/// Draws and solves samples of designs. Samples of the same number have the same random numbers in every design.
#[derive(Debug)]
pub struct Sampler {
    evaluator: Evaluator,
    deviations: Vec<Deviation>,
}

/// A solved sample: the row of its values, and its deviations.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The values of the sample; its case has the deviations.
    pub row: DesignRow,
    /// The batch deviation of each source; `None` for a source without one.
    pub deviations: Vec<Option<f64>>,
}

impl Sampler {
    /// Creates a sampler that solves `measures` of samples with these deviations.
    pub fn new(measures: &[Measure], deviations: &[Deviation]) -> Self {
        Self { evaluator: Evaluator::new(measures), deviations: deviations.to_vec() }
    }

    /// Solves a sample, counted from 1, of the design of `case`; `None` if no drawn deviations are within the bounds of the parameters.
    pub fn solve(&self, number: DesignNumber, case: &Case, sample: u64) -> Option<Sample> {
        let (made, deviations) = draw::sample(case, &self.deviations, sample)?;
        Some(Sample { row: self.evaluator.solve_sample(number, &made, sample), deviations })
    }

    /// The case of a sample without its scatter from scale to scale; `None` if there is no such sample.
    pub fn even_case(&self, case: &Case, sample: u64) -> Option<Case> {
        let (made, _) = draw::sample(case, &self.deviations, sample)?;
        // Derivatives are those of even rows: what scatters is left to the values.
        Some(Case { imperfection: case.imperfection, ..made })
    }
}
