//! Comparison of gaps with trigonometry, and of their derivatives with finite differences.

use super::{CornerEdge, Pair, Pose, quarter};
use approx::assert_relative_eq;
use geometry::{Corner, Parallelogram, Vec2};
use proptest::prelude::*;

fn poses(q: &[f64; 6]) -> (Pose, Pose) {
    (Pose::new(q[0], q[1], q[2]), Pose::new(q[3], q[4], q[5]))
}

fn moved(q: &[f64; 6], i: usize, h: f64) -> (Pose, Pose) {
    let mut q = *q;
    q[i] += h;
    poses(&q)
}

proptest! {
    #[test]
    fn derivatives_agree_with_finite_differences(
        slant in 0.0_f64..80.0, half_base in 0.02_f64..3.0, gap in 0.05_f64..2.0,
        q in prop::array::uniform6(-1.5_f64..1.5), corner_edge in 0_usize..6, slides: bool,
    ) {
        let corner_edge = CornerEdge::ALL[corner_edge];
        let scale = Parallelogram::new(half_base, slant).unwrap();
        let pair = Pair::new(scale, 2.0 * half_base + gap);
        let coordinate = if slides { Pair::slide } else { Pair::gap };
        let (left, right) = poses(&q);
        let ours = coordinate(&pair, corner_edge, &left, &right);
        let h = 1e-6;
        for i in 0..6 {
            let (l, r) = moved(&q, i, h);
            let high = coordinate(&pair, corner_edge, &l, &r);
            let (l, r) = moved(&q, i, -h);
            let low = coordinate(&pair, corner_edge, &l, &r);
            assert_relative_eq!(
                ours.gradient[i], (high.value - low.value) / (2.0 * h), epsilon = 1e-7, max_relative = 1e-7
            );
            for j in 0..6 {
                assert_relative_eq!(
                    ours.curvature.hessian()[i][j],
                    (high.gradient[j] - low.gradient[j]) / (2.0 * h),
                    epsilon = 1e-7, max_relative = 1e-7
                );
            }
        }
    }
}

proptest! {
    /// Places a corner at a given fraction of the edge, at a given distance from it.
    #[test]
    fn gap_and_foot_are_the_coordinates_of_the_corner_at_the_edge(
        slants in prop::array::uniform2(0.0_f64..80.0), half_bases in prop::array::uniform2(0.02_f64..3.0),
        rotations in prop::array::uniform2(-0.5_f64..0.5), fraction in -0.5_f64..1.5, off in -0.2_f64..0.2,
        corner_edge in 0_usize..6,
    ) {
        let corner_edge = CornerEdge::ALL[corner_edge];
        let scales: [_; 2] =
            std::array::from_fn(|i| Parallelogram::new(half_bases[i], slants[i]).unwrap());
        let pair = Pair::between(scales, Vec2::new(7.0, 0.0));
        prop_assert_eq!(pair.offset().x, 7.0);
        let (a, b) = if corner_edge.corner_is_left() { (0, 1) } else { (1, 0) };
        // Start and end of the edge. The foot is measured from the base up, or from left to right.
        let (start, end, outward) = match corner_edge {
            CornerEdge::TopRightOnLeftEdge | CornerEdge::BottomRightOnLeftEdge => {
                (Corner::BottomLeft, Corner::TopLeft, 1.0)
            }
            CornerEdge::TopLeftOnRightEdge | CornerEdge::BottomLeftOnRightEdge => {
                (Corner::BottomRight, Corner::TopRight, -1.0)
            }
            CornerEdge::TopRightOnTop => (Corner::TopLeft, Corner::TopRight, 1.0),
            CornerEdge::BottomLeftOnBase => (Corner::BottomLeft, Corner::BottomRight, -1.0),
        };
        let (start, end) = (scales[b].corner(start), scales[b].corner(end));
        let along = end - start;
        let target = start + fraction * along + outward * off * quarter(along.normalize());
        let mut poses = rotations.map(|rotation| Pose::new(0.0, 0.0, rotation));
        let at = [0.0, 7.0];
        let corner = poses[a].turn(scales[a].corner(corner_edge.corner()));
        let shift = poses[b].turn(target) - corner + Vec2::new(at[b] - at[a], 0.0);
        poses[a] = Pose::new(shift.x, shift.y, rotations[a]);
        let gap = pair.gap(corner_edge, &poses[0], &poses[1]);
        assert_relative_eq!(gap.foot, fraction, epsilon = 1e-11);
        assert_relative_eq!(gap.value, off, epsilon = 1e-12);
    }
}

#[test]
fn names_contain_the_corner_and_the_edge() {
    assert_eq!(
        CornerEdge::ALL.map(CornerEdge::name),
        [
            "TR on left edge",
            "TL on right edge",
            "BR on left edge",
            "BL on right edge",
            "TR on top",
            "BL on base",
        ]
    );
}

#[test]
fn at_rest_the_gap_is_the_distance_between_the_parallel_sides() {
    let scale = Parallelogram::new(0.5, 60.0).unwrap();
    let pair = Pair::new(scale, 1.2);
    let rest = Pose::new(0.0, 0.0, 0.0);
    for corner_edge in [CornerEdge::TopRightOnLeftEdge, CornerEdge::BottomLeftOnRightEdge] {
        assert_relative_eq!(pair.distance(corner_edge, &rest, &rest), 0.1, max_relative = 1e-14);
    }
}

#[test]
fn the_gap_to_a_rotated_neighbour_agrees_with_trigonometry() {
    // Of two upright blocks, the left block rotates clockwise by φ about its node. Its top right
    // corner moves to the right by sin φ + a (cos φ − 1).
    let (a, gap, phi) = (0.5, 0.3, 0.2_f64);
    let pair = Pair::new(Parallelogram::new(a, 0.0).unwrap(), 2.0 * a + gap);
    let left = Pose::new(0.0, 0.0, -phi);
    let rest = Pose::new(0.0, 0.0, 0.0);
    let expected = gap - (phi.sin() + a * (phi.cos() - 1.0));
    let ours = pair.distance(CornerEdge::TopRightOnLeftEdge, &left, &rest);
    assert_relative_eq!(ours, expected, max_relative = 1e-14);
}
