//! From scales seen by their neighbours to the whole strip.

use contact::Pose;
use geometry::Vec2;

use crate::arrangement::Arrangement;

/// Displacement and rotation of a scale, seen from its left neighbour.
pub(crate) type Step = [f64; 3];

/// The frame of a scale: where its node stands, from that of the first scale, and how far it has turned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame(Pose);

impl Frame {
    /// The frames of a strip of `gaps` gaps that repeat the `steps`, the first scale at rest.
    pub(crate) fn strip(steps: &[Step], gaps: usize, row: &Arrangement) -> Vec<Self> {
        let first = Self(Pose::new(0.0, 0.0, 0.0));
        let steps = steps.iter().cycle().take(gaps).enumerate();
        let others = steps.scan(first, |frame, (gap, &[x, y, rotation])| {
            let node = frame.place(Vec2::new(row.pitch(gap) + x, y));
            *frame = Self(Pose::new(node.x, node.y, frame.0.rotation + rotation));
            Some(*frame)
        });
        std::iter::once(first).chain(others).collect()
    }

    /// Displacement from rest, and rotation, of the scale with the number `i`.
    pub(crate) fn displacement(&self, i: usize, row: &Arrangement) -> Step {
        let node = self.0.displacement;
        [node.x - row.place(i), node.y, self.0.rotation]
    }

    /// A vector of the frame.
    pub(crate) fn turn(&self, v: Vec2) -> Vec2 {
        self.0.turn(v)
    }

    /// A point of the frame.
    pub(crate) fn place(&self, point: Vec2) -> Vec2 {
        self.0.displacement + self.turn(point)
    }
}
