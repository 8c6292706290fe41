//! Tests of tips, the acute corners that may rest on the neighbour's top or base.

use approx::assert_relative_eq;
use geometry::{Parallelogram, Vec2};

use super::{Closed, EDGES, half_turn};
use crate::corner_contact::{CornerContact, FORCES, Force};
use crate::corners::{Corners, Level};
use crate::gap::{CornerEdge, Pair, Pose};
use crate::law::{ContactLaw, Law};
use crate::response::{COORDINATES, Equation};

/// Creates two steep scales with the tip of the right scale under the base of the left scale.
///
/// The right scale is rotated clockwise by `turned` degrees. Its bottom left corner, the tip, lies
/// `inside` to the left of the right end of the base, and `below` the base.
pub(super) fn under_the_base(turned: f64, inside: f64, below: f64) -> (Pair, [Pose; 2]) {
    let pair = Pair::new(Parallelogram::new(1.0, 75.0).unwrap(), 2.2);
    // The tip lies 1 to the left of its node, and the base of the neighbour ends 1 to the right of
    // the neighbour's node.
    let arm = Pose::new(0.0, 0.0, -turned.to_radians()).turn(Vec2::new(-1.0, 0.0));
    let corner = Vec2::new(1.0 - inside, -below);
    let node = corner - arm - Vec2::new(2.2, 0.0);
    (pair, [Pose::new(0.0, 0.0, 0.0), Pose::new(node.x, node.y, -turned.to_radians())])
}

/// Creates the pair of [`under_the_base`] rotated by 180°, with the tip above a top.
fn above_the_top(turned: f64, inside: f64, above: f64) -> (Pair, [Pose; 2]) {
    let (pair, poses) = under_the_base(turned, inside, above);
    let [[a, b, c], [d, e, f]] =
        poses.map(|pose| [pose.displacement.x, pose.displacement.y, pose.rotation]);
    let [a, b, c, d, e, f] = half_turn(75.0, &[a, b, c, d, e, f]);
    (pair, [Pose::new(a, b, c), Pose::new(d, e, f)])
}

/// Creates a law with a large compliance.
fn soft() -> ContactLaw {
    ContactLaw::new(Law::EXCHANGED, 2.0, 1.0, 3.0).unwrap()
}

/// Corner and edge at the lower level, and the corner and edge after a rotation by 180°.
const ROTATED: [(CornerEdge, CornerEdge); 3] = [
    (CornerEdge::BottomRightOnLeftEdge, CornerEdge::TopLeftOnRightEdge),
    (CornerEdge::BottomLeftOnRightEdge, CornerEdge::TopRightOnLeftEdge),
    (CornerEdge::BottomLeftOnBase, CornerEdge::TopRightOnTop),
];

/// Returns the corner and edge at the upper level that correspond to `lower`, as in [`ROTATED`].
fn rotated(lower: CornerEdge) -> CornerEdge {
    ROTATED.into_iter().find(|(edge, _)| *edge == lower).unwrap().1
}

/// Returns the values of `f` at the lower level of a pair and at the upper level after rotation.
///
/// [`under_the_base`] creates the pair, [`above_the_top`] the pair rotated by 180°.
fn at_both_levels<T>(
    turned: f64,
    inside: f64,
    below: f64,
    edge: CornerEdge,
    f: impl Fn(&Corners, CornerEdge) -> T,
) -> [T; 2] {
    let (pair, [left, right]) = under_the_base(turned, inside, below);
    let under = f(&Corners::new(Level::Lower, &pair, [&left, &right]), edge);
    let (pair, [left, right]) = above_the_top(turned, inside, below);
    [under, f(&Corners::new(Level::Upper, &pair, [&left, &right]), rotated(edge))]
}

/// The slant is 75°, so the side is parallel to the base after a rotation by 15°.
#[test]
fn the_inclination_of_the_side_selects_the_edge_that_a_corner_faces() {
    for (turned, inside, expected) in [
        (14.9, 0.3, Some(CornerEdge::BottomRightOnLeftEdge)),
        (15.1, 0.3, Some(CornerEdge::BottomLeftOnBase)),
        // The tip lies beyond the right or the left end of the base.
        (16.0, -0.1, Some(CornerEdge::BottomLeftOnRightEdge)),
        (16.0, -0.01, None),
        (16.0, 2.1, None),
    ] {
        let any = CornerEdge::BottomLeftOnBase;
        let [lower, upper] =
            at_both_levels(turned, inside, 0.1, any, |corners, _| corners.facing());
        assert_eq!(lower.map(|(edge, _)| edge), expected);
        assert_eq!(upper.map(|(edge, _)| edge), expected.map(rotated));
        if let (Some((edge, at_base)), Some((_, at_top))) = (lower, upper) {
            assert_relative_eq!(at_base, at_top, epsilon = 1e-12);
            match edge {
                CornerEdge::BottomLeftOnBase => assert_relative_eq!(at_base, 0.1, epsilon = 1e-12),
                _ => assert!((0.0..0.2).contains(&at_base)),
            }
        }
    }
}

/// Returns the angle `β` between side and base of a closed contact, or `None` if it has none.
fn flush_angle(edge: CornerEdge, closed: Closed, turned: f64, inside: f64) -> Option<f64> {
    let [lower, upper] = at_both_levels(turned, inside, 0.1, edge, |corners, edge| {
        let response = closed(edge).response(corners, &soft(), [0.0; FORCES]);
        response.conditions[Force::Flush as usize].map(|condition| condition.value)
    });
    assert_eq!(lower.is_some(), upper.is_some());
    assert_relative_eq!(lower.unwrap_or(0.0), upper.unwrap_or(0.0), epsilon = 1e-12);
    lower
}

#[test]
fn the_flush_condition_is_the_angle_between_side_and_base() {
    let (on_side, on_end) = (CornerEdge::BottomRightOnLeftEdge, CornerEdge::BottomLeftOnBase);
    for turned in [5.0, 14.0, 17.0] {
        let short = (15.0_f64 - turned).to_radians();
        for (edge, expected) in [(on_side, short), (on_end, -short)] {
            let angle = flush_angle(edge, CornerContact::Edge, turned, 0.3).unwrap();
            assert_relative_eq!(angle, expected, epsilon = 1e-12);
        }
    }
    // Corner on corner and a tip on the neighbour's side have no flush condition.
    assert_eq!(flush_angle(on_side, CornerContact::Corner, 14.0, 0.3), None);
    assert_eq!(flush_angle(on_end, CornerContact::Corner, 16.0, 0.3), None);
    assert_eq!(
        flush_angle(CornerEdge::BottomLeftOnRightEdge, CornerContact::Edge, 14.0, 0.3),
        None
    );
}

/// The length of the base is 2, the length of the side 3.86.
#[test]
fn there_is_no_flush_contact_beyond_the_far_end_of_its_edge() {
    let (on_side, on_end) = (CornerEdge::BottomRightOnLeftEdge, CornerEdge::BottomLeftOnBase);
    for (edge, within, beyond) in [(on_side, 1.99, 2.01), (on_end, 3.8, 3.9)] {
        // Beyond the near end, at which both corners lie, the flush condition still exists.
        let [near, within, beyond_end] = [-0.01, within, beyond]
            .map(|inside| flush_angle(edge, CornerContact::Edge, 15.0, inside));
        assert!(near.unwrap().abs() < 1e-12 && within.unwrap().abs() < 1e-12);
        assert_eq!(beyond_end, None);
        // While the flush force acts, its condition exists everywhere.
        assert!(flush_angle(edge, CornerContact::Flush, 15.0, beyond).unwrap().abs() < 1e-12);
    }
}

/// Checks the directions of both forces in the state corner on corner.
///
/// One force is normal to the neighbour's side. The other force is normal to the side that ends in
/// the tip, or normal to the base once this side has rotated beyond parallel to the base.
#[test]
fn the_corner_force_rotates_at_most_to_the_normal_of_the_base() {
    let side = Vec2::new(75.0_f64.to_radians().cos(), -75.0_f64.to_radians().sin());
    for (turned, expected) in
        [(10.0_f64, 5.0_f64), (14.0, 1.0), (15.0, 0.0), (16.0, 0.0), (40.0, 0.0)]
    {
        let of_tip = expected.to_radians();
        let normal = Vec2::new(-of_tip.sin(), of_tip.cos());
        for edge in ROTATED.map(|(edge, _)| edge) {
            let ours = at_both_levels(turned, 0.0, 0.0, edge, |corners, edge| {
                CornerContact::Corner(edge).forces_on_left(corners, [0.3, 0.2, 0.0])
            });
            let expected = match edge {
                CornerEdge::BottomLeftOnRightEdge => 0.2 * normal - 0.3 * side,
                _ => 0.3 * normal - 0.2 * side,
            };
            for [corners, flush] in ours {
                assert_relative_eq!(corners, expected, epsilon = 1e-12);
                assert_eq!(flush, Vec2::zeros());
            }
        }
    }
}

#[test]
fn the_inclination_of_the_side_selects_the_edge_along_which_a_corner_leaves() {
    let (on_side, on_end, tip_on_side) = (
        CornerEdge::BottomRightOnLeftEdge,
        CornerEdge::BottomLeftOnBase,
        CornerEdge::BottomLeftOnRightEdge,
    );
    for (turned, leaning) in [(14.0, on_side), (16.0, on_end)] {
        let (pair, [left, right]) = under_the_base(turned, 0.0, 0.0);
        let corners = Corners::new(Level::Lower, &pair, [&left, &right]);
        for (edge, force, after) in [
            (on_side, Force::Partner, leaning),
            (on_side, Force::Own, tip_on_side),
            (on_end, Force::Partner, leaning),
            (on_end, Force::Own, tip_on_side),
            (tip_on_side, Force::Partner, tip_on_side),
            (tip_on_side, Force::Own, leaning),
        ] {
            let corner = CornerContact::Corner(edge);
            let transition = corner.transition(force, false, &corners, [0.0; FORCES]).unwrap();
            assert_eq!(transition.contact, CornerContact::Edge(after));
        }
    }
}

#[test]
fn flush_contacts_of_two_edges_refer_to_each_other() {
    for (level, edge) in EDGES {
        let flush = edge.flush();
        assert_eq!(flush.and_then(CornerEdge::flush), flush.map(|_| edge));
        assert!(flush.is_none_or(|flush| EDGES.contains(&(level, flush))));
    }
    let on_base = CornerEdge::BottomLeftOnBase;
    assert_eq!(on_base.flush(), Some(CornerEdge::BottomRightOnLeftEdge));
    assert_eq!(CornerEdge::BottomLeftOnRightEdge.flush(), None);
    assert_eq!(CornerEdge::TopRightOnLeftEdge.flush(), None);
}

/// The approach of flush edges depends on the sum of both forces, not on their distribution.
#[test]
fn flush_contacts_share_one_approach() {
    let law = soft();
    let below = -law.approach(0.5).value;
    let (pair, [left, right]) = under_the_base(15.0, 0.3, below);
    let corners = Corners::new(Level::Lower, &pair, [&left, &right]);
    for edge in [CornerEdge::BottomRightOnLeftEdge, CornerEdge::BottomLeftOnBase] {
        for fraction in [0.0, 0.2, 1.0] {
            let forces = [0.5 * fraction, 0.0, 0.5 * (1.0 - fraction)];
            let contact = CornerContact::Flush(edge);
            let response = contact.response(&corners, &law, forces);
            let [own, _, flush] = response.conditions.map(Option::unwrap);
            assert_relative_eq!(own.value, 0.0, epsilon = 1e-12);
            assert_relative_eq!(flush.value, 0.0, epsilon = 1e-12);
            let [on_corner, on_flush] = contact.forces_on_left(&corners, forces);
            assert_relative_eq!(on_corner + on_flush, Vec2::new(0.0, 0.5), epsilon = 1e-12);
            assert_relative_eq!(on_flush.y, forces[2], epsilon = 1e-12);
            assert_relative_eq!(response.balance[1].value, -0.5, epsilon = 1e-12);
        }
    }
}

#[test]
fn forces_on_a_top_equal_rotated_forces_on_a_base() {
    let forces = [0.3, 0.0, 0.2];
    let (pair, [left, right]) = under_the_base(15.0, 0.3, 0.0);
    let corners = Corners::new(Level::Lower, &pair, [&left, &right]);
    let below = CornerContact::Flush(CornerEdge::BottomRightOnLeftEdge);
    let [corner, tip] = below.forces_on_left(&corners, forces);
    let (pair, [left, right]) = above_the_top(15.0, 0.3, 0.0);
    let corners = Corners::new(Level::Upper, &pair, [&left, &right]);
    let above = CornerContact::Flush(CornerEdge::TopLeftOnRightEdge);
    let turned = above.forces_on_left(&corners, forces);
    // The rotation reverses the forces and exchanges the scales, so the forces on the left scale
    // are unchanged.
    assert_relative_eq!(turned[0], corner, epsilon = 1e-12);
    assert_relative_eq!(turned[1], tip, epsilon = 1e-12);
    assert_eq!(CornerContact::Open.forces_on_left(&corners, forces), [Vec2::zeros(); 2]);
}

/// An open contact has no force, and one condition: the gap of the corner that faces an edge.
#[test]
fn an_open_contact_has_only_the_condition_of_its_gap() {
    let (pair, [left, right]) = under_the_base(12.0, 0.3, 0.1);
    for level in [Level::Upper, Level::Lower] {
        let corners = Corners::new(level, &pair, [&left, &right]);
        let distance = corners.facing().map(|(edge, _)| pair.distance(edge, &left, &right));
        let response = CornerContact::Open.response(&corners, &soft(), [0.0; FORCES]);
        let values = response.conditions.map(|condition| condition.map(|c| c.value));
        assert_eq!(values, [distance, None, None]);
        assert_eq!(response.balance, [Equation::default(); COORDINATES]);
    }
    let corners = Corners::new(Level::Lower, &pair, [&left, &right]);
    assert_eq!(corners.facing().unwrap().0, CornerEdge::BottomRightOnLeftEdge);
}
