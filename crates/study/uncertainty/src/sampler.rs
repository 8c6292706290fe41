//! Draws and solves samples of designs.

use results::DesignRow;
use run::{Evaluator, PunctureEnd};
use sweep::{Case, DesignNumber, Deviation, Measure};

use crate::draw;

/// Draws and solves samples of designs.
///
/// The random numbers of a sample are the same in every design.
#[derive(Debug)]
pub struct Sampler {
    evaluator: Evaluator,
    deviations: Vec<Deviation>,
}

/// A solved sample.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Row of the sample; its case includes the deviations.
    pub row: DesignRow,
    /// Batch deviation of each source; `None` for a source without one.
    pub deviations: Vec<Option<f64>>,
}

impl Sampler {
    /// Creates a sampler of `measures` under these deviations.
    pub fn new(measures: &[Measure], deviations: &[Deviation]) -> Self {
        Self::with(Evaluator::new(measures), deviations)
    }

    /// Creates a sampler that solves samples with `evaluator`.
    pub fn with(evaluator: Evaluator, deviations: &[Deviation]) -> Self {
        Self { evaluator, deviations: deviations.to_vec() }
    }

    /// Solves sample `sample`, counted from 1, of the design `case`.
    ///
    /// `None` if no deviations within the bounds of the parameters are found.
    pub fn solve(&self, number: DesignNumber, case: &Case, sample: u64) -> Option<Sample> {
        self.solve_near(number, case, sample, None)
    }

    /// Solves a sample like [`Self::solve`], from the `end` of the puncture of the design if
    /// possible.
    pub fn solve_near(
        &self,
        number: DesignNumber,
        case: &Case,
        sample: u64,
        end: Option<&PunctureEnd>,
    ) -> Option<Sample> {
        let (made, deviations) = draw::sample(case, &self.deviations, sample)?;
        let end = end.filter(|_| self.evaluator.has_ends(&made));
        let near = end.and_then(|end| self.evaluator.row_near(number, &made, &[], end));
        let row = near.unwrap_or_else(|| self.evaluator.solve_sample(number, &made, sample));
        Some(Sample { row, deviations })
    }

    /// Returns the case of a sample without scatter from scale to scale.
    ///
    /// `None` if no deviations within the bounds of the parameters are found.
    pub fn even_case(&self, case: &Case, sample: u64) -> Option<Case> {
        let (made, _) = draw::sample(case, &self.deviations, sample)?;
        // Keep the scatter of the nominal case: derivatives are computed for rows without scatter,
        // which changes only the values.
        Some(Case { imperfection: case.imperfection, ..made })
    }
}
