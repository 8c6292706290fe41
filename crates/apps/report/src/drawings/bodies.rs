//! Scales as polygons.

use contact::{Pose, overlap_polygon};
use geometry::{Body, Row, Vec2};

/// Returns the corners of scale `i` of a row, counter-clockwise from the bottom left.
///
/// The origin is the node of scale 0 at rest; poses are in the tangent frames of the body.
pub(super) fn corners(row: &Row, body: Body, i: f64, pose: &Pose) -> [[f64; 2]; 4] {
    let frame = body.frame(i * row.pitch());
    row.scale()
        .corners()
        .map(|corner| (frame.origin + frame.outward(pose.displacement + pose.turn(corner))).into())
}

/// Returns the polygons in which neighbours overlap, each with the index of its left scale.
///
/// The origin is the node of the first scale at rest.
pub fn overlaps(row: &Row, body: Body, poses: &[Pose]) -> Vec<(usize, Vec<[f64; 2]>)> {
    let right = body.frame(row.pitch());
    poses
        .windows(2)
        .enumerate()
        .map(|(left, pair)| {
            // Express the right scale in the tangent frame of the left scale.
            let beside = right.origin - Vec2::new(row.pitch(), 0.0);
            let moved = beside + right.outward(pair[1].displacement);
            let seen = Pose::new(moved.x, moved.y, pair[1].rotation - right.angle);
            let polygon = overlap_polygon(row.scale(), row.pitch(), &pair[0], &seen);
            let frame = body.frame(left as f64 * row.pitch());
            let points: Vec<_> =
                polygon.iter().map(|point| (frame.origin + frame.outward(*point)).into()).collect();
            (left, points)
        })
        .filter(|(_, points)| points.len() > 2)
        .collect()
}
