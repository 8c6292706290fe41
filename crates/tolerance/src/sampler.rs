//! Skins that are made of designs, solved one by one.

use results::DesignRow;
use run::Evaluator;
use sweep::{Case, DesignNumber, Deviation, Measure};

use crate::draw;

/// Solves skins that are made of designs with their deviations. Skins of one number have the same random numbers, whatever the
/// design.
#[derive(Debug)]
pub struct Sampler {
    evaluator: Evaluator,
    deviations: Vec<Deviation>,
}

/// A skin that is made: the row of its values, and its deviations.
#[derive(Clone, Debug)]
pub struct MadeSkin {
    /// The skin, its case with all that deviates.
    pub row: DesignRow,
    /// The deviation of each source that all scales share; `None` of the others.
    pub deviations: Vec<Option<f64>>,
}

impl Sampler {
    /// Solves `measures` of skins with these deviations.
    pub fn new(measures: &[Measure], deviations: &[Deviation]) -> Self {
        Self { evaluator: Evaluator::new(measures), deviations: deviations.to_vec() }
    }

    /// The skin of that number, from 1, that is made of the design of `case`; `None` if no deviations are found with which
    /// there is one.
    pub fn solve(&self, number: DesignNumber, case: &Case, skin: u64) -> Option<MadeSkin> {
        let (made, deviations) = draw::sample(case, &self.deviations, skin)?;
        Some(MadeSkin { row: self.evaluator.solve_sample(number, &made, skin), deviations })
    }

    /// The case of the skin of that number but for its scatter from scale to scale; `None` if there is none.
    pub fn even_case(&self, case: &Case, skin: u64) -> Option<Case> {
        let (made, _) = draw::sample(case, &self.deviations, skin)?;
        Some(Case { imperfection: case.imperfection, ..made })
    }
}
