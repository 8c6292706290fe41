//! Lists the closed contacts of a state and their forces.

use contact::{CornerContact, CornerEdge};
use geometry::Vec2;

use super::{Contacts, SkinState};

/// A closed contact between two scales.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the left scale of the pair, from 0 at the left end of the row.
    pub left: usize,
    /// Index of the right scale of the pair, nearly always the neighbour of the left scale.
    pub right: usize,
    /// Corner and edge that touch.
    pub corner_edge: CornerEdge,
    /// Position `x`, `y` of the touching corner in the deformed state, in units of `t`.
    ///
    /// It is relative to the node of the first scale at rest. On a curved body its components are
    /// in the tangent frame of the first scale.
    pub point: [f64; 2],
    /// Components `x`, `y` of the force on the left scale; the opposite force acts on the right
    /// scale.
    pub force: [f64; 2],
    /// Approach `δ` of the two scales, in units of `t`.
    pub approach: f64,
    /// True if the contact slips; `None` without friction.
    pub slips: Option<bool>,
}

impl Contacts {
    /// Lists the closed contacts from left to right.
    ///
    /// With relative poses, point and force of a contact are in the frame of its left scale.
    pub(crate) fn closed_contacts(&self, state: &SkinState) -> Vec<Contact> {
        let contacts = (0..state.mode.contacts.len())
            .filter(|&contact| state.mode.contacts[contact] != CornerContact::Open);
        contacts.flat_map(|contact| self.closed_at(state, contact)).flatten().collect()
    }

    /// Returns the contact at the corner and the flush contact at one level of a pair.
    ///
    /// `None` if the respective contact is open.
    fn closed_at(&self, state: &SkinState, contact: usize) -> [Option<Contact>; 2] {
        let [own, flush] = state.mode.contacts[contact].carrying();
        let [on_corners, on_flush] = self.forces_on_left(state, contact);
        let approach = self.approach(state, contact);
        let slips = self.has_friction().then(|| Self::is_slipping(&state.mode, contact));
        [(own, on_corners), (flush, on_flush)].map(|(corner_edge, force)| {
            let corner_edge = corner_edge?;
            let point = self.corner(&state.z, contact, corner_edge).into();
            let [left, right] = self.ends(Self::pair_of(contact));
            let force =
                if self.body.is_flat() { force } else { self.frame_at(left).outward(force) };
            Some(Contact { left, right, corner_edge, point, force: force.into(), approach, slips })
        })
    }

    /// Lists the contact forces on the scales of a row, in the order of the contacts.
    ///
    /// Each entry holds the index of the scale, the vector from its node to the contact in the
    /// deformed state, and the force. Both vectors are in the tangent frame of the scale.
    pub(crate) fn forces_on_scales(&self, state: &SkinState) -> Vec<(usize, [Vec2; 2])> {
        let mut forces = Vec::new();
        for (contact, mode) in state.mode.contacts.iter().enumerate() {
            let carrying = mode.carrying();
            if carrying == [None, None] {
                continue;
            }
            let pair = Self::pair_of(contact);
            let [left, right] = self.ends(pair);
            let on_left = self.forces_on_left(state, contact);
            for (corner_edge, force) in carrying.into_iter().zip(on_left) {
                let Some(corner_edge) = corner_edge else { continue };
                let corner = self.corner(&state.z, contact, corner_edge);
                // Contact forces are in the frame of the left scale of the pair.
                let on_right = if self.body.is_flat() {
                    force
                } else {
                    self.pair_and_frame(pair).1.inward(force)
                };
                for (scale, force) in [(left, force), (right, -1.0 * on_right)] {
                    let frame = self.frame_at(scale);
                    let node =
                        frame.origin + frame.outward(self.pose(&state.z, scale).displacement);
                    forces.push((scale, [frame.inward(corner - node), force]));
                }
            }
        }
        forces
    }

    /// Returns the position of the corner of a contact in the deformed state.
    ///
    /// It is relative to the node of the first scale at rest, or to the node of the left scale of
    /// the pair if poses are relative.
    fn corner(&self, z: &[f64], contact: usize, corner_edge: CornerEdge) -> Vec2 {
        let of_right = usize::from(!corner_edge.corner_is_left());
        let pose = self.pair_poses(z, contact)[of_right];
        let pair = Self::pair_of(contact);
        let (ends, pair) = (self.ends(pair), self.pair(pair));
        let arm = pose.turn(pair.scales()[of_right].corner(corner_edge.corner()));
        let moved = pose.displacement + arm;
        // With relative poses or on a curved body, `moved` is in the frame of the left scale of the
        // pair.
        if self.relative || !self.body.is_flat() {
            let corner = of_right as f64 * pair.offset() + moved;
            if self.relative {
                return corner;
            }
            let frame = self.frame_at(ends[0]);
            return frame.origin + frame.outward(corner);
        }
        Vec2::new(self.arrangement.position(ends[of_right]), 0.0) + moved
    }
}
