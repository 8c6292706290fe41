//! Equilibria of a strip as they are recorded.

use super::strip::Strip;
use crate::contacts::{Contacts, Point, State};
use crate::record::Skin;

/// One equilibrium of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// `κ*`.
    pub curvature: f64,
    /// `M*`.
    pub moment: f64,
    /// `dM*/dκ*` of the path that goes on from here.
    pub stiffness: f64,
    /// Rotation of each end, degrees.
    pub end_rotation_deg: f64,
    /// Bending energy of the membrane of the whole strip, over `E_m t³`.
    pub bending_energy: f64,
    /// Axial energy of the membrane, over `E_m t³`.
    pub axial_energy: f64,
    /// Energy of the contacts, over `E_m t³`.
    pub contact_energy: f64,
    /// Closed contacts of the whole strip.
    pub contacts: usize,
}

impl Skin for Strip {
    type PathPoint = PathPoint;

    fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    fn path_point(&self, point: &Point) -> PathPoint {
        let state = &point.state;
        let repeats = self.repeats() as f64;
        let membrane = self.membrane_energy(state);
        PathPoint {
            curvature: self.curvature(&state.z),
            moment: self.normalised_moment(&state.z),
            stiffness: self.normalised_stiffness(self.stiffness(state, &point.leaving)),
            end_rotation_deg: self.angle_deg(state),
            bending_energy: membrane.bending * repeats,
            axial_energy: membrane.axial * repeats,
            contact_energy: self.contacts.energy(state) * repeats,
            contacts: self.repeats() * Contacts::closed(state),
        }
    }

    fn angle_deg(&self, state: &State) -> f64 {
        0.5 * (self.rotation(&state.z) * self.repeats() as f64).to_degrees()
    }

    /// `dM/dΦ` of the gaps that are solved for.
    fn stiffness(&self, _state: &State, direction: &[f64]) -> f64 {
        self.moment(direction) / self.rotation(direction)
    }

    fn number(&self, scale: usize) -> Option<i64> {
        (self.repeats() == 1).then_some(scale as i64)
    }

    /// A strip that is bent to a ring may meet its own other end: neighbours count alone.
    fn interpenetrates(&self, state: &State) -> bool {
        self.contacts.neighbours_interpenetrate(state)
    }
}
