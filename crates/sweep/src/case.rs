//! The case of one design: everything that it is solved with.

use geometry::OutOfRange;
use skin::flexure;
use skin::puncture;
use skin::{Base, Common, Design, Imperfection};
use substrate::{Coupling, Footprint};

use crate::material::Material;
use crate::parameter::Scalar;

/// One design with everything that it is solved with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The geometry.
    pub design: Design,
    /// The contact law and the solver's settings, of puncture and bending.
    pub common: Common,
    /// The other parameters of the puncture.
    pub puncture: puncture::PunctureParameters,
    /// The critical tilts that are given, unless the friction of a free needle says them.
    pub critical_tilt: Scalar,
    /// The friction between needle and scale: of a free needle the critical tilts follow from it.
    pub needle_friction: Option<Scalar>,
    /// The other parameters of bending.
    pub flexure: flexure::FlexureParameters,
    /// The neighbours of a scale that the substrate couples it with.
    pub coupling: Coupling,
    /// The scatter of gaps and slants.
    pub imperfection: Imperfection,
    /// The imperfect rows that are solved if they scatter at all.
    pub samples: Samples,
    /// The material of the skin, in physical units, as far as that is given.
    pub material: Material,
}

/// The imperfect rows that are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    /// The number of rows.
    pub count: usize,
    /// Seed of their random numbers.
    pub seed: usize,
}

impl Case {
    /// The ratios and Poisson's ratio that the springs of the substrate depend on.
    ///
    /// # Errors
    /// If the lengths of the design are too far apart for their ratios to be an `f64`.
    pub fn footprint(&self) -> Result<Footprint, OutOfRange> {
        self.design.footprint(self.puncture.poisson_ratio)
    }
}

impl Default for Case {
    /// The first design of the paper sweep.
    fn default() -> Self {
        Self {
            design: Design { gap: 0.1, length: 0.025, slant_deg: 0.0, base: Base::L, width: 1.0 },
            common: Common::default(),
            puncture: puncture::PunctureParameters::default(),
            critical_tilt: Scalar::Number(
                puncture::PunctureParameters::default().critical_tilt_deg,
            ),
            needle_friction: None,
            flexure: flexure::FlexureParameters::default(),
            coupling: Coupling::Nearest,
            imperfection: Imperfection::default(),
            samples: Samples { count: 100, seed: 1 },
            material: Material::default(),
        }
    }
}
