//! Computes the poses of all scales of a strip from the relative poses of neighbours.

use contact::Pose;
use geometry::Vec2;

use crate::arrangement::Arrangement;

/// Displacements `x`, `y` and rotation of a scale relative to its left neighbour.
pub(crate) type Step = [f64; 3];

/// Computes the frames of all scales of a strip with `gaps` gaps.
///
/// `steps` holds the relative poses of the solved gaps; they are repeated to fill the strip. Each
/// frame consists of the position of the node of a scale relative to the node of the first scale,
/// and its rotation. The first scale is fixed.
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

/// Converts frames of scales to their displacements from the undeformed strip, and rotations.
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

/// Transforms a point from the frame of a scale to the frame of the strip.
pub(crate) fn place(frame: &Pose, point: Vec2) -> Vec2 {
    frame.displacement + frame.turn(point)
}
