//! Draws and solves samples of designs.

use results::DesignRow;
use run::{Evaluator, PunctureEnd};
use sweep::{Case, DesignNumber, Deviation, Measure};

use crate::draw;

/// Draws and solves samples of designs.
///
/// Sample `k` has the same random numbers in every design.
#[derive(Debug)]
pub struct Sampler {
    evaluator: Evaluator,
    deviations: Vec<Deviation>,
}

/// A solved sample.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Results of the sample; the case of this row includes the deviations.
    pub row: DesignRow,
    /// Batch deviation of each parameter; `None` if the parameter has no batch deviation.
    pub deviations: Vec<Option<f64>>,
}

impl Sampler {
    /// Creates a sampler that computes `measures` for designs with these `deviations`.
    pub fn new(measures: &[Measure], deviations: &[Deviation]) -> Self {
        Self::with(Evaluator::new(measures), deviations)
    }

    /// Creates a sampler that solves designs with these `deviations` by `evaluator`.
    pub fn with(evaluator: Evaluator, deviations: &[Deviation]) -> Self {
        Self { evaluator, deviations: deviations.to_vec() }
    }

    /// Solves sample `sample`, counted from 1, of the design `case` with this `number`.
    ///
    /// `None` if no deviations within the bounds of the parameters are found.
    pub fn solve(&self, number: DesignNumber, case: &Case, sample: u64) -> Option<Sample> {
        self.solve_near(number, case, sample, None)
    }

    /// Solves a sample like [`Self::solve`], if possible starting from a known path end.
    ///
    /// `end` is the end of the puncture path of the nominal design. A sample that cannot start
    /// there is solved from rest.
    pub fn solve_near(
        &self,
        number: DesignNumber,
        case: &Case,
        sample: u64,
        end: Option<&PunctureEnd>,
    ) -> Option<Sample> {
        let (sample_case, deviations) = draw::sample(case, &self.deviations, sample)?;
        let end = end.filter(|_| self.evaluator.has_ends(&sample_case));
        let near = end.and_then(|end| self.evaluator.row_near(number, &sample_case, &[], end));
        let row = near.unwrap_or_else(|| self.evaluator.solve_sample(number, &sample_case, sample));
        Some(Sample { row, deviations })
    }

    /// Returns the case of sample `sample` without scatter from scale to scale.
    ///
    /// `None` if no deviations within the bounds of the parameters are found.
    pub fn even_case(&self, case: &Case, sample: u64) -> Option<Case> {
        let (sample_case, _) = draw::sample(case, &self.deviations, sample)?;
        // Replace the scatter of the sample by the imperfection of `case`: derivatives are computed
        // for rows without scatter.
        Some(Case { imperfection: case.imperfection, ..sample_case })
    }
}
