//! The contacts of a state, for those who look at them.

use contact::{FORCES, Kind};
use geometry::Vec2;
use solver::State;

use super::{JOINTS, Joints};

/// A closed contact between neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The left scale of the pair, from 0 at the left end of the row.
    pub left: usize,
    /// Which corner meets which edge.
    pub kind: Kind,
    /// The corner that touches, deformed, from the node of the first scale at rest; over `t`.
    pub point: [f64; 2],
    /// Force on the left scale; the right one takes its opposite.
    pub force: [f64; 2],
    /// Approach `δ` of the scales, over `t`.
    pub approach: f64,
}

impl Joints {
    /// Every closed contact, from the left; where poses are relative, as the left scale of its pair
    /// sees it.
    pub(crate) fn contacts(&self, state: &State) -> Vec<Contact> {
        let joints = 0..state.active.len() / FORCES;
        joints.flat_map(|joint| self.of_joint(state, joint)).flatten().collect()
    }

    /// The contacts of a joint: of its corners with each other's edge, and the one beside.
    fn of_joint(&self, state: &State, joint: usize) -> [Option<Contact>; 2] {
        let [corners, _, beside] = [0, 1, 2].map(|k| FORCES * joint + k);
        let [on_corners, on_beside] = self.forces_on_left(&state.z, joint);
        let approach = self.law.approach(self.force(&state.z, joint)).value;
        [(corners, on_corners), (beside, on_beside)].map(|(constraint, force)| {
            let kind = self.kind(constraint).filter(|_| state.active[constraint])?;
            let point = self.corner(&state.z, joint, kind);
            let left = joint / JOINTS;
            Some(Contact { left, kind, point: point.into(), force: force.into(), approach })
        })
    }

    fn corner(&self, z: &[f64], joint: usize, kind: Kind) -> Vec2 {
        let of_right = usize::from(!kind.corner_is_left());
        let pose = self.pair_poses(z, joint)[of_right];
        let left = joint / JOINTS;
        let pair = self.pair(left);
        let arm = pose.turn(pair.scales()[of_right].corner(kind.corner()));
        let place = if self.relative {
            of_right as f64 * pair.pitch()
        } else {
            self.arrangement.place(left + of_right)
        };
        Vec2::new(place, 0.0) + pose.displacement + arm
    }
}
