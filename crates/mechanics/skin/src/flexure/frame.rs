//! From scales seen by their neighbours to the whole strip.

use contact::Pose;
use geometry::Vec2;

use crate::arrangement::Arrangement;

/// Displacement and rotation of a scale, seen from its left neighbour.
pub(crate) type Step = [f64; 3];

/// The frames of the scales of a strip of `gaps` gaps that repeat the `steps`, the first scale at rest: where the node of each stands, from that
/// of the first scale, and how far it has turned.
pub(crate) fn frames(steps: &[Step], gaps: usize, row: &Arrangement) -> Vec<Pose> {
    let first = Pose::new(0.0, 0.0, 0.0);
    let steps = steps.iter().cycle().take(gaps).enumerate();
    let others = steps.scan(first, |frame, (gap, &[x, y, rotation])| {
        let node = place(frame, Vec2::new(row.pitch(gap) + x, y));
        *frame = Pose::new(node.x, node.y, frame.rotation + rotation);
        Some(*frame)
    });
    std::iter::once(first).chain(others).collect()
}

/// Displacements from rest, and rotations, of scales that stand in these frames.
pub(crate) fn displacements(frames: &[Pose], row: &Arrangement) -> Vec<Step> {
    let displacement = |(i, frame): (usize, &Pose)| {
        let node = frame.displacement;
        [node.x - row.place(i), node.y, frame.rotation]
    };
    frames.iter().enumerate().map(displacement).collect()
}

/// A point that is known in a frame.
pub(crate) fn place(frame: &Pose, point: Vec2) -> Vec2 {
    frame.displacement + frame.turn(point)
}
