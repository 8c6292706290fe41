//! The numbers that a puncture comes down to.

use serde::{Deserialize, Serialize};

/// The measures of a puncture; `None` where the value does not exist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// `F_c* = F (1−ν²)/(E_s L t)` at the critical tilt.
    pub critical_force: Option<f64>,
    /// Largest `F*` up to the critical tilt.
    pub peak_force: Option<f64>,
    /// `u_c* = u/t` of the punctured point at the critical tilt.
    pub critical_displacement: Option<f64>,
    /// Depth of the deepest base corner of any scale at the critical tilt, over `t`.
    pub penetration: Option<f64>,
    /// Depth of the deepest node at the critical tilt, over `t`.
    pub sink: Option<f64>,
    /// `u*` at the first contact.
    pub first_contact_displacement: Option<f64>,
    /// Contacts at the critical tilt.
    pub contacts: Option<usize>,
    /// Scales that touch a neighbour at the critical tilt.
    pub engaged_scales: Option<usize>,
    /// Scales in the row.
    pub scales: usize,
    /// `K* = K/(E_s t)` at rest.
    pub initial_stiffness: Option<f64>,
    /// Largest `K*` on the path.
    pub max_stiffness: Option<f64>,
    /// Secant `K*` at the critical tilt.
    pub secant_stiffness: Option<f64>,
}

impl Measures {
    /// What remains true of a path that did not end as it should: how it began.
    pub(crate) fn without_final_values(self) -> Self {
        Self {
            first_contact_displacement: self.first_contact_displacement,
            scales: self.scales,
            initial_stiffness: self.initial_stiffness,
            ..Self::default()
        }
    }
}
