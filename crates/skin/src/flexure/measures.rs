//! The numbers that bending comes down to.

use serde::{Deserialize, Serialize};

/// The measures of bending; `None` where the value does not exist.
///
/// The moment is `M* = M t/(E_m I_m)`, the curvature `κ* = κ t` with `κ` the rotation of one end
/// against the other over the length `n p` of the strip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// Flexural compliance `C_f* = 1/max(dM*/dκ*)`.
    pub compliance: Option<f64>,
    /// `1/(dM*/dκ*)` at rest.
    pub initial_compliance: Option<f64>,
    /// Whether scales touched.
    pub contact: Option<bool>,
    /// `κ*` at the first contact.
    pub first_contact_curvature: Option<f64>,
    /// Largest `M*`.
    pub max_moment: Option<f64>,
    /// Part of the axial energy in the elastic energy at the end of the path.
    pub axial_energy_share: Option<f64>,
    /// Gaps of the strip.
    pub gaps: usize,
}

impl Measures {
    /// What remains true of a path that did not end as it should: how it began.
    pub(crate) fn without_final_values(self) -> Self {
        Self {
            initial_compliance: self.initial_compliance,
            first_contact_curvature: self.first_contact_curvature,
            contact: self.first_contact_curvature.map(|_| true),
            gaps: self.gaps,
            ..Self::default()
        }
    }
}
