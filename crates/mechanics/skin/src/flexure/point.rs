//! Recorded equilibria of a strip.

use super::strip::Strip;
use crate::contacts::{Contacts, SkinPoint, SkinState};
use crate::record::Skin;

/// Recorded values of one equilibrium of the path.
///
/// Energies, dissipation and contacts refer to the whole strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexurePoint {
    /// Curvature `κ*`.
    pub curvature: f64,
    /// Moment `M*`.
    pub moment: f64,
    /// Stiffness `dM*/dκ*` of the outgoing branch.
    pub stiffness: f64,
    /// Rotation of each end, degrees.
    pub end_rotation_deg: f64,
    /// Bending energy of the membrane, in units of `E_m t³`.
    pub bending_energy: f64,
    /// Axial energy of the membrane, in units of `E_m t³`.
    pub axial_energy: f64,
    /// Elastic energy of the contacts, in units of `E_m t³`.
    pub contact_energy: f64,
    /// Frictional dissipation from rest to this point, in units of `E_m t³`.
    ///
    /// `None` without friction.
    pub friction_work: Option<f64>,
    /// Number of closed contacts, for the rounded number of gaps.
    pub contacts: usize,
    /// Largest strain `|ε| + ½ h |κ|` at the surface of the membrane.
    pub membrane_strain: f64,
}

impl Skin for Strip {
    type PathPoint = FlexurePoint;

    fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    fn path_point(&self, point: &SkinPoint) -> FlexurePoint {
        let state = &point.state;
        let repeats = self.repeats;
        let membrane = self.membrane_energy(state);
        FlexurePoint {
            curvature: self.curvature(&state.z),
            moment: self.normalised_moment(&state.z),
            stiffness: self.normalised_stiffness(self.stiffness(state, &point.leaving)),
            end_rotation_deg: self.angle_deg(state),
            bending_energy: membrane.bending * repeats,
            axial_energy: membrane.axial * repeats,
            contact_energy: self.contacts.energy(state) * repeats,
            // Set by `note_friction`, because the dissipation also depends on the previous points.
            friction_work: None,
            contacts: self.whole_gaps() / self.gaps() * Contacts::closed(state),
            membrane_strain: self.largest_strain(state),
        }
    }

    fn stored(&self, state: &SkinState) -> f64 {
        let membrane = self.membrane_energy(state);
        (membrane.bending + membrane.axial + self.contacts.energy(state)) * self.repeats
    }

    fn repeats(&self) -> f64 {
        self.repeats
    }

    fn note_friction(&self, point: &mut FlexurePoint, work: f64) {
        point.friction_work = Some(work);
    }

    fn angle_deg(&self, state: &SkinState) -> f64 {
        // Each end rotates by half of the relative rotation of both ends.
        0.5 * (self.rotation(&state.z) * self.repeats).to_degrees()
    }

    /// Returns `dM/dΦ` of the solved gaps.
    fn stiffness(&self, _state: &SkinState, direction: &[f64]) -> f64 {
        self.moment(direction) / self.rotation(direction)
    }

    fn number(&self, scale: usize) -> Option<i64> {
        (self.whole_gaps() == self.gaps()).then_some(scale as i64)
    }

    /// Checks neighbours only, because a strip bent to a ring may overlap its other end.
    fn interpenetrates(&self, state: &SkinState) -> bool {
        self.contacts.neighbours_interpenetrate(state)
    }
}
