//! From scales seen by their neighbours to the whole strip.

use geometry::Vec2;

use crate::arrangement::Arrangement;

/// Displacement and rotation of a scale, seen from its left neighbour.
pub(crate) type Step = [f64; 3];

/// The frame of a scale: where its node stands and how far it has turned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) origin: Vec2,
    pub(crate) rotation: f64,
}

impl Frame {
    /// The frames of a strip of `gaps` gaps that repeat the `steps`, the first scale at rest.
    pub(crate) fn strip(steps: &[Step], gaps: usize, row: &Arrangement) -> Vec<Self> {
        let first = Self { origin: Vec2::zeros(), rotation: 0.0 };
        let steps = steps.iter().cycle().take(gaps).enumerate();
        let others = steps.scan(first, |frame, (gap, &[x, y, rotation])| {
            let origin = frame.place(Vec2::new(row.pitch(gap) + x, y));
            *frame = Self { origin, rotation: frame.rotation + rotation };
            Some(*frame)
        });
        std::iter::once(first).chain(others).collect()
    }

    /// Displacement from rest, and rotation, of the scale with the number `i`.
    pub(crate) fn displacement(&self, i: usize, row: &Arrangement) -> Step {
        [self.origin.x - row.place(i), self.origin.y, self.rotation]
    }

    /// A vector of the frame.
    pub(crate) fn turn(&self, v: Vec2) -> Vec2 {
        let (sin, cos) = self.rotation.sin_cos();
        Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    }

    /// A point of the frame.
    pub(crate) fn place(&self, point: Vec2) -> Vec2 {
        self.origin + self.turn(point)
    }
}
