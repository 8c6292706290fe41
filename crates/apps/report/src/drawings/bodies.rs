//! Scales as polygons.

use contact::{Pose, overlap_polygon};
use geometry::{Row, Vec2};

/// Returns the corners of scale `i` of a row in a pose, counter-clockwise from the bottom left, from the node
/// of the scale 0 at rest.
pub(super) fn corners(row: &Row, i: f64, pose: &Pose) -> [[f64; 2]; 4] {
    let node = Vec2::new(i * row.pitch(), 0.0) + pose.displacement;
    row.scale().corners().map(|corner| (node + pose.turn(corner)).into())
}

/// Returns the polygon in which each pair of neighbours overlaps, with its left scale, from 0; in the plane of
/// the row whose first node at rest is the origin.
pub fn overlaps(row: &Row, poses: &[Pose]) -> Vec<(usize, Vec<[f64; 2]>)> {
    let pair = |(left, pair): (usize, &[Pose])| {
        let polygon = overlap_polygon(row.scale(), row.pitch(), &pair[0], &pair[1]);
        let along = left as f64 * row.pitch();
        let points: Vec<_> = polygon.iter().map(|point| [point.x + along, point.y]).collect();
        (left, points)
    };
    poses.windows(2).enumerate().map(pair).filter(|(_, points)| points.len() > 2).collect()
}
