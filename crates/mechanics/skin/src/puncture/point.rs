//! Values recorded at the equilibria of a row.

use super::needle::GuidedNeedle;
use super::surface_fold::GapStretch;
use super::system::Chain;
use crate::contacts::{Contacts, Dissipation, SkinPoint, SkinState};
use crate::record::Skin;

/// Values recorded at one equilibrium of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PuncturePoint {
    /// Displacement `u*` of the loaded point, positive downward.
    pub displacement: f64,
    /// Load `F*`.
    pub force: f64,
    /// Force of a guided needle along the row; 0 for a free needle.
    ///
    /// It is in units of `F*` and positive to the right.
    pub lateral_force: f64,
    /// Tilt of the punctured scale, positive clockwise, degrees.
    pub tilt_deg: f64,
    /// Number of closed contacts.
    pub contacts: usize,
    /// Elastic energy of the substrate, in `E* t³`; NaN unless the whole path is recorded.
    pub substrate_energy: f64,
    /// Elastic energy of the contacts and of the bending of elastic scales, in `E* t³`.
    ///
    /// Without friction, the sum of substrate and contact energy is the work `∫ F du` of the load.
    /// NaN unless the whole path is recorded.
    pub contact_energy: f64,
    /// Frictional dissipation between scales since the state of rest, in `E* t³`.
    ///
    /// `None` without friction.
    pub friction_work: Option<f64>,
    /// Stretch of the tightest and of the widest gap.
    ///
    /// `None` for a single scale, and unless the whole path is recorded.
    pub gap_stretch: Option<GapStretch>,
}

/// State of one scale of a row in equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleState {
    /// Number of the scale: 0 is the punctured one, positive to the right.
    pub scale: i64,
    /// Displacement of the node along the body and normal to it, in units of `t`.
    pub displacement: [f64; 2],
    /// Rotation from rest, positive counter-clockwise, degrees.
    pub rotation_deg: f64,
    /// Vertical reaction of the substrate on the scale, positive upward, in `E* t²`.
    pub reaction: f64,
}

impl Skin for Chain {
    type PathPoint = PuncturePoint;

    fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    fn path_point(&self, point: &SkinPoint) -> PuncturePoint {
        let (state, is_whole) = (&point.state, self.is_recorded_whole());
        PuncturePoint {
            displacement: self.depth(&state.z),
            force: self.force(state),
            lateral_force: self.lateral_force(state) / self.length,
            tilt_deg: self.angle_deg(state),
            contacts: Contacts::closed(state),
            substrate_energy: if is_whole { self.substrate_energy(state) } else { f64::NAN },
            contact_energy: if is_whole { self.energy_of_scales(state) } else { f64::NAN },
            friction_work: None,
            gap_stretch: is_whole.then(|| self.gap_stretches(state)).flatten(),
        }
    }

    fn has_friction(&self) -> bool {
        self.contacts.has_friction() || self.needle.as_ref().is_some_and(GuidedNeedle::has_friction)
    }

    fn tip_work(&self, from: &SkinPoint, to: &SkinPoint, spans: [f64; 2]) -> Dissipation {
        self.tip_dissipation(from, to, spans)
    }

    fn stored(&self, state: &SkinState) -> f64 {
        self.substrate_energy(state) + self.energy_of_scales(state)
    }

    fn note_friction(&self, point: &mut PuncturePoint, work: f64) {
        point.friction_work = Some(work);
    }

    fn angle_deg(&self, state: &SkinState) -> f64 {
        let rotation = self.layout.scale(self.layout.left) + 2;
        let tilt = self.bending_unknowns().map_or(rotation, |[_, tilt]| tilt);
        -state.z[tilt].to_degrees()
    }

    /// Computes the tangent stiffness `dF/du` of the loaded point, in `E* t`.
    fn stiffness(&self, state: &SkinState, direction: &[f64]) -> f64 {
        direction[self.layout.load()] / self.depth_slope(&state.z, direction)
    }

    fn number(&self, scale: usize) -> Option<i64> {
        Some(self.layout.number(scale))
    }

    fn interpenetrates(&self, state: &SkinState) -> bool {
        if self.is_elastic {
            // The audit intersects rigid scales, which overlap at contacts of bent scales. Permit
            // this overlap.
            let openings = self.openings(state);
            let overlapping =
                self.contacts.overlapping(state, |pair| Contacts::pair_slack(&openings, pair));
            return !overlapping.is_empty();
        }
        !self.contacts.overlapping(state, |_| 0.0).is_empty()
    }

    fn passes_an_end(&self, at: &SkinPoint) -> bool {
        let contacts = &self.contacts;
        contacts.off_edge(&at.state)
            || contacts.passes_an_end(at)
            || self.is_met_from_the_side(&at.state)
    }
}

impl Chain {
    /// Computes the elastic energy of contacts and bent scales, in `E* t³`.
    fn energy_of_scales(&self, state: &SkinState) -> f64 {
        self.contacts.energy(state) + self.bending_energy(state)
    }
}

/// Lists the states of all scales of a row, from the left.
///
/// Scales of a finite row beyond its solved part are included; they follow in closed form.
pub(super) fn scales(chain: &Chain, state: &SkinState) -> Vec<ScaleState> {
    let solved_for = 0..chain.layout.scales().cast_signed();
    let [left, right] = chain.exterior.scales_to_ends().map(usize::cast_signed);
    (-left..solved_for.end + right)
        .map(|i| {
            let [x, y, rotation] = chain.displacement_anywhere(&state.z, i);
            // No contact acts on a scale beyond the solved part, so its reaction is zero.
            let is_free = !solved_for.contains(&i);
            ScaleState {
                scale: i as i64 + chain.layout.number(0),
                displacement: [x, y],
                rotation_deg: rotation.to_degrees(),
                reaction: if is_free { 0.0 } else { chain.reaction(&state.z, i)[1] },
            }
        })
        .collect()
}
