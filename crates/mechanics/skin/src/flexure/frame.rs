//! Poses of the whole strip from relative poses of neighbours.

use contact::Pose;
use geometry::Vec2;

use crate::arrangement::Arrangement;

/// Displacement and rotation of a scale relative to its left neighbour.
pub(crate) type Step = [f64; 3];

/// Computes the frames of all scales of a strip of `gaps` gaps.
///
/// The gaps repeat the `steps`. The first scale is at rest. A frame holds the node position
/// relative to the node of the first scale, and the rotation.
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

/// Converts frames to displacements from rest and rotations.
pub(crate) fn displacements(frames: &[Pose], row: &Arrangement) -> Vec<Step> {
    frames
        .iter()
        .enumerate()
        .map(|(i, frame)| {
            let node = frame.displacement;
            [node.x - row.position(i), node.y, frame.rotation]
        })
        .collect()
}

/// Maps a point from a frame to the frame of the strip.
pub(crate) fn place(frame: &Pose, point: Vec2) -> Vec2 {
    frame.displacement + frame.turn(point)
}
