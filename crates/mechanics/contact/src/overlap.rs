//! Overlap of deformed scales, for the interpenetration audit and for drawings.
//!
//! This module uses collision queries of a geometry library instead of gaps. The queries accept
//! scales in any relative position, but lose precision for parallel edges, so they are not used for
//! computing equilibria.

use geometry::{Parallelogram, Vec2};
use parry2d_f64::math::{Pose as Placement, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::ConvexPolygon;
use parry2d_f64::transformation::convex_polygons_intersection_points;

use crate::gap::Pose;

/// Two scales that overlap, and the depth of their overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// Index of the left scale in the row.
    pub left: usize,
    /// Index of the right scale in the row.
    pub right: usize,
    /// Length of the smallest translation that separates the two scales, in units of `t`.
    pub depth: f64,
}

/// Returns all pairs of scales of a row that overlap, also pairs that are not neighbours.
///
/// `at_rest(i)` returns the shape of scale `i` and the position of its node at rest. `poses[i]`
/// contains the displacement from this position.
pub fn overlaps(at_rest: impl Fn(usize) -> (Parallelogram, Vec2), poses: &[Pose]) -> Vec<Overlap> {
    let extents: Vec<Extents> = poses
        .iter()
        .enumerate()
        .map(|(i, pose)| {
            let (scale, node) = at_rest(i);
            Extents::new(&scale, pose, node)
        })
        .collect();
    // `begins[k]` is the left end of the extents of scale `k` and all scales with larger indices.
    let mut begins: Vec<f64> = extents.iter().map(|extents| extents.horizontal.0).collect();
    for k in (1..begins.len()).rev() {
        begins[k - 1] = begins[k - 1].min(begins[k]);
    }
    let mut overlaps = Vec::new();
    for left in 0..poses.len() {
        let reach = extents[left].horizontal.1;
        let candidates = (left + 1..poses.len()).take_while(|&right| begins[right] <= reach);
        for right in candidates {
            if extents[left].are_apart(&extents[right]) {
                continue;
            }
            let ((first, from), (second, to)) = (at_rest(left), at_rest(right));
            let poses = [&poses[left], &poses[right]];
            if let Some(depth) = depth([&first, &second], to - from, poses) {
                overlaps.push(Overlap { left, right, depth });
            }
        }
    }
    overlaps
}

/// Extents of a deformed scale in two fixed directions, for fast rejection of distant scales.
struct Extents {
    /// Smallest and largest horizontal coordinate of the corners.
    horizontal: (f64, f64),
    /// Smallest and largest coordinate normal to the sides of the scale at rest.
    across: (f64, f64),
    /// Slant of the scale in radians, which defines the direction of `across`.
    slant: f64,
}

impl Extents {
    fn new(scale: &Parallelogram, pose: &Pose, node: Vec2) -> Self {
        let slant = scale.slant();
        let corners = corners(scale, pose, node);
        let across = extent(&corners, Vec2::new(slant.cos(), -slant.sin()));
        Self { horizontal: extent(&corners, Vec2::x()), across, slant }
    }

    /// Returns true if the extents in one of the two directions do not overlap.
    fn are_apart(&self, other: &Self) -> bool {
        // The extents `across` have the same direction only for equal slants.
        let alike = self.slant == other.slant;
        apart(self.horizontal, other.horizontal) || (alike && apart(self.across, other.across))
    }
}

/// Returns the corners of the polygon in which two equal scales overlap, or an empty vector.
///
/// `offset` is the horizontal distance between the nodes of both scales at rest.
pub fn overlap_polygon(scale: &Parallelogram, offset: f64, left: &Pose, right: &Pose) -> Vec<Vec2> {
    let [first, second] = [(left, Vec2::zeros()), (right, Vec2::new(offset, 0.0))]
        .map(|(pose, at)| corners(scale, pose, at).map(|v| Vector::new(v.x, v.y)));
    let mut polygon = Vec::new();
    // The library function is unreliable if edges lie on each other, so use it only for drawings.
    convex_polygons_intersection_points(&first, &second, &mut polygon);
    polygon.iter().map(|v| Vec2::new(v.x, v.y)).collect()
}

/// Returns the depth of the overlap of two scales, or `None` if they do not overlap.
///
/// `offset` is the vector from the first to the second node at rest.
fn depth(scales: [&Parallelogram; 2], offset: Vec2, poses: [&Pose; 2]) -> Option<f64> {
    let [first, second] = [(0, Vec2::zeros()), (1, offset)].map(|(i, at)| {
        let points = corners(scales[i], poses[i], at).map(|v| Vector::new(v.x, v.y));
        ConvexPolygon::from_convex_polyline_unmodified(points.to_vec())
    });
    // The corners are already in their deformed positions.
    let placement = Placement::IDENTITY;
    let contact = query::contact(&placement, &first?, &placement, &second?, 0.0).ok()??;
    (contact.dist < 0.0).then_some(-contact.dist)
}

/// Returns the deformed positions of the corners of a scale with its node at `at` at rest.
fn corners(scale: &Parallelogram, pose: &Pose, at: Vec2) -> [Vec2; 4] {
    scale.corners().map(|corner| at + pose.displacement + pose.turn(corner))
}

/// Returns the smallest and largest coordinate of `points` along a direction.
fn extent(points: &[Vec2], direction: Vec2) -> (f64, f64) {
    points
        .iter()
        .map(|p| p.dot(&direction))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// Returns true if two intervals do not overlap.
fn apart(a: (f64, f64), b: (f64, f64)) -> bool {
    a.1 < b.0 || b.1 < a.0
}

#[cfg(test)]
mod tests {
    use super::{corners, extent, overlap_polygon, overlaps};
    use crate::gap::{Pose, quarter};
    use approx::assert_relative_eq;
    use geometry::{Parallelogram, Vec2};
    use proptest::prelude::*;

    #[test]
    fn a_scale_displaced_by_more_than_the_gap_overlaps_by_the_difference() {
        let scale = Parallelogram::new(0.5, 0.0).unwrap();
        let poses =
            [Pose::new(0.0, 0.0, 0.0), Pose::new(-0.25, 0.02, 0.0), Pose::new(0.0, 0.0, 0.0)];
        let found = overlaps(|i| (scale, Vec2::new(1.1 * i as f64, 0.0)), &poses);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].left, found[0].right), (0, 1));
        assert_relative_eq!(found[0].depth, 0.15, epsilon = 1e-9);
    }

    #[test]
    fn a_scale_that_has_passed_its_neighbour_overlaps_with_the_next_scale() {
        let scale = Parallelogram::new(0.1, 45.0).unwrap();
        let rest = Pose::new(0.0, 0.0, 0.0);
        let poses = [Pose::new(0.55, 0.0, 0.0), rest, rest];
        let found = overlaps(|i| (scale, Vec2::new(0.3 * i as f64, 0.0)), &poses);
        assert_eq!(found.iter().map(|o| (o.left, o.right)).collect::<Vec<_>>(), [(0, 2)]);
    }

    #[test]
    fn an_overlap_of_scales_that_are_not_neighbours_is_found() {
        let scale = Parallelogram::new(0.1, 0.0).unwrap();
        // The two scales between the first and the last are displaced far to the right.
        let poses = [0.0, 0.9, 0.9, -0.85].map(|x| Pose::new(x, 0.0, 0.0));
        let found = overlaps(|i| (scale, Vec2::new(0.3 * i as f64, 0.0)), &poses);
        assert_eq!(found.iter().map(|o| (o.left, o.right)).collect::<Vec<_>>(), [(0, 3)]);
        assert_relative_eq!(found[0].depth, 0.15, epsilon = 1e-9);
    }

    /// Computes the depth of the overlap of two convex polygons by the separating-axis theorem.
    ///
    /// Negative if the polygons do not overlap.
    fn overlap(first: &[Vec2; 4], second: &[Vec2; 4]) -> f64 {
        let edges = [first, second].into_iter().flat_map(|corners| {
            (0..4).map(|i| quarter((corners[(i + 1) % 4] - corners[i]).normalize()))
        });
        let depth = edges.map(|normal| {
            let ((a, b), (c, d)) = (extent(first, normal), extent(second, normal));
            (b - c).min(d - a)
        });
        depth.fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #[test]
        fn unequal_scales_overlap_unless_an_edge_separates_them(
            slants in prop::array::uniform3(-80.0_f64..80.0), half_bases in prop::array::uniform3(0.1_f64..1.0),
            q in prop::array::uniform9(-0.8_f64..0.8),
        ) {
            let scales: [_; 3] =
                std::array::from_fn(|i| Parallelogram::leaning(half_bases[i], slants[i]).unwrap());
            let poses: [_; 3] =
                std::array::from_fn(|i| Pose::new(q[3 * i], q[3 * i + 1], q[3 * i + 2]));
            let found = overlaps(|i| (scales[i], Vec2::new(1.5 * i as f64, 0.0)), &poses);
            let placed: [_; 3] =
                std::array::from_fn(|i| corners(&scales[i], &poses[i], Vec2::new(1.5 * i as f64, 0.0)));
            for (left, right) in [(0, 1), (0, 2), (1, 2)] {
                let depth = overlap(&placed[left], &placed[right]);
                let ours = found.iter().find(|o| (o.left, o.right) == (left, right));
                match ours {
                    Some(ours) => assert_relative_eq!(ours.depth, depth, epsilon = 1e-6),
                    None => prop_assert!(depth < 1e-6, "{left} and {right} by {depth}"),
                }
            }
        }
    }

    #[test]
    fn the_overlap_of_a_tilted_and_an_upright_block_is_a_triangle_of_known_area() {
        let scale = Parallelogram::new(0.5, 0.0).unwrap();
        // The top right corner of the tilted left block has passed the left side of its neighbour.
        let phi = 0.2_f64;
        let left = Pose::new(0.0, -0.2, -phi);
        let polygon = overlap_polygon(&scale, 1.1, &left, &Pose::new(0.0, 0.0, 0.0));
        assert_eq!(polygon.len(), 3);
        let area = 0.5 * (0..3).map(|i| polygon[i].perp(&polygon[(i + 1) % 3])).sum::<f64>().abs();
        let depth = phi.sin() + 0.5 * phi.cos() - 0.6;
        assert_relative_eq!(
            area,
            0.5 * depth * depth * (phi.tan() + phi.tan().recip()),
            max_relative = 1e-9
        );
    }
}
