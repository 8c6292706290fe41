//! Everything that one design of a sweep is solved with.

use contact::Law;
use skin::flexure::{self, Method};
use skin::puncture::{self, RowLength};
use skin::{Base, Design};
use solver::Settings;

/// One design with everything that it is solved with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The geometry.
    pub design: Design,
    /// What the puncture depends on besides.
    pub puncture: puncture::Parameters,
    /// What bending depends on besides. Its contact law and its steps are those of the puncture.
    pub flexure: flexure::Parameters,
}

impl Case {
    /// Gives bending the contact law and the steps of the puncture.
    pub(crate) fn share(&mut self) {
        self.flexure.law = self.puncture.law;
        self.flexure.solver = self.puncture.solver;
    }
}

impl Default for Case {
    /// The first design of the paper sweep.
    fn default() -> Self {
        Self {
            design: Design { gap: 0.1, length: 0.025, slant_deg: 0.0, base: Base::L, width: 1.0 },
            puncture: puncture::Parameters {
                poisson_ratio: 0.5,
                law: Law::PRINTED,
                contact_modulus_over_substrate: 9677.0,
                scales: RowLength::Auto,
                load_position: 1.0,
                critical_tilt_deg: 10.0,
                solver: Settings::default(),
            },
            flexure: flexure::Parameters {
                law: Law::PRINTED,
                contact_modulus_over_membrane: 667.0,
                method: Method::UnitCell,
                membrane_length: 100.0,
                membrane_thickness: 0.125,
                membrane_axis_offset: 0.0,
                elements_per_gap: 1,
                max_end_rotation_deg: 180.0,
                solver: Settings::default(),
            },
        }
    }
}
