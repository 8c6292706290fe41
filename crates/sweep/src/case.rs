//! Everything that one design of a sweep is solved with.

use skin::flexure;
use skin::puncture;
use skin::{Base, Common, Design, Imperfection};
use substrate::Coupling;

/// One design with everything that it is solved with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The geometry.
    pub design: Design,
    /// The contact law and the solver's settings, of puncture and bending.
    pub common: Common,
    /// What the puncture depends on besides.
    pub puncture: puncture::Parameters,
    /// What bending depends on besides.
    pub flexure: flexure::Parameters,
    /// Which neighbours of a scale the substrate couples it with.
    pub coupling: Coupling,
    /// How far gaps and slants scatter.
    pub imperfection: Imperfection,
    /// The imperfect rows that are solved if they scatter at all.
    pub samples: Samples,
}

/// Which imperfect rows are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    /// How many.
    pub count: usize,
    /// Seed of their random numbers.
    pub seed: usize,
}

impl Default for Case {
    /// The first design of the paper sweep.
    fn default() -> Self {
        Self {
            design: Design { gap: 0.1, length: 0.025, slant_deg: 0.0, base: Base::L, width: 1.0 },
            common: Common::default(),
            puncture: puncture::Parameters::default(),
            flexure: flexure::Parameters::default(),
            coupling: Coupling::Nearest,
            imperfection: Imperfection::default(),
            samples: Samples { count: 100, seed: 1 },
        }
    }
}
