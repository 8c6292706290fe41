//! The numbers that bending comes down to.

/// The measures of bending; `None` where the value does not exist.
///
/// The moment is `M* = M t/(E_m I_m)`, the curvature `κ* = κ t` with `κ` the rotation of one end
/// against the other over the length `n p` of the strip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
    /// Largest strain `|ε| + ½ h |κ|` at the surface of the membrane, anywhere on the path.
    pub membrane_strain_max: Option<f64>,
    /// Largest relative error of the measures that the discretisation of the membrane makes, estimated; `None` for a given
    /// number of elements.
    pub error: Option<f64>,
    /// Gaps `n` of the strip, a whole number in a chain.
    pub gaps: f64,
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
