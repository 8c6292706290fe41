//! Scales as polygons.

use contact::{Pose, overlap_polygon};
use geometry::{Row, Vec2};

/// Returns the corners of scale `i` of a row, counter-clockwise from the bottom left.
///
/// The origin is the node of scale 0 at rest.
pub(super) fn corners(row: &Row, i: f64, pose: &Pose) -> [[f64; 2]; 4] {
    let node = Vec2::new(i * row.pitch(), 0.0) + pose.displacement;
    row.scale().corners().map(|corner| (node + pose.turn(corner)).into())
}

/// Returns the polygons in which neighbours overlap, each with the index of its left scale.
///
/// The origin is the node of the first scale at rest.
pub fn overlaps(row: &Row, poses: &[Pose]) -> Vec<(usize, Vec<[f64; 2]>)> {
    let pair = |(left, pair): (usize, &[Pose])| {
        let polygon = overlap_polygon(row.scale(), row.pitch(), &pair[0], &pair[1]);
        let along = left as f64 * row.pitch();
        let points: Vec<_> = polygon.iter().map(|point| [point.x + along, point.y]).collect();
        (left, points)
    };
    poses.windows(2).enumerate().map(pair).filter(|(_, points)| points.len() > 2).collect()
}
