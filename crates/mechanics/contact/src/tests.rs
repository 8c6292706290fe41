//! Tests of forces, conditions and transitions of the contact states of two corners.

mod tips;
mod transitions;

use approx::assert_relative_eq;
use geometry::{Parallelogram, Vec2};
use proptest::prelude::*;

use crate::corner_contact::{CornerContact, FORCES, Force};
use crate::corners::{Corners, Level};
use crate::gap::{CornerEdge, Pair, Pose};
use crate::law::{ContactLaw, Law};
use crate::response::{COORDINATES, CornerResponse, Equation};

/// Corner-edge combinations with their levels.
///
/// A rotation of the pair by 180° exchanges the first entry with the last, and so on.
const EDGES: [(Level, CornerEdge); 6] = [
    (Level::Upper, CornerEdge::TopRightOnLeftEdge),
    (Level::Upper, CornerEdge::TopLeftOnRightEdge),
    (Level::Upper, CornerEdge::TopRightOnTop),
    (Level::Lower, CornerEdge::BottomLeftOnBase),
    (Level::Lower, CornerEdge::BottomRightOnLeftEdge),
    (Level::Lower, CornerEdge::BottomLeftOnRightEdge),
];

/// Number of coordinates of a pair plus its three forces.
const COUPLED: usize = COORDINATES + FORCES;

/// Contact state at one level of a pair, with its law.
///
/// The argument `z` of its methods contains the coordinates of the pair and the three forces.
struct Case {
    level: Level,
    contact: CornerContact,
    pair: Pair,
    law: ContactLaw,
}

impl Case {
    /// Evaluates the response without friction.
    fn at(&self, z: &[f64; COUPLED]) -> CornerResponse {
        self.with_friction(z, 0.0)
    }

    /// Returns the corner and edge that face each other.
    fn facing(&self, z: &[f64; COUPLED]) -> Option<CornerEdge> {
        let (left, right) = (Pose::new(z[0], z[1], z[2]), Pose::new(z[3], z[4], z[5]));
        Corners::new(self.level, &self.pair, [&left, &right]).facing().map(|(edge, _)| edge)
    }

    /// Evaluates the response with a ratio of friction to normal force at corners.
    fn with_friction(&self, z: &[f64; COUPLED], ratio: f64) -> CornerResponse {
        let (left, right) = (Pose::new(z[0], z[1], z[2]), Pose::new(z[3], z[4], z[5]));
        let acting = self.contact.acting();
        let forces = std::array::from_fn(|k| if acting[k] { z[COORDINATES + k] } else { 0.0 });
        let corners = Corners::new(self.level, &self.pair, [&left, &right]);
        if ratio == 0.0 {
            return self.contact.response(&corners, &self.law, forces);
        }
        self.contact.acting_response(&corners, &self.law, forces, ratio)
    }

    /// Adds to `balance` the friction of a corner that slides on an edge.
    fn add_sliding(&self, balance: &mut [f64; COORDINATES], z: &[f64; COUPLED], friction: f64) {
        let (left, right) = (Pose::new(z[0], z[1], z[2]), Pose::new(z[3], z[4], z[5]));
        let slide = self.pair.slide(self.contact.edge().unwrap(), &left, &right);
        for (value, slope) in balance.iter_mut().zip(slide.gradient) {
            *value -= friction * z[COORDINATES] * slope;
        }
    }
}

/// Constructor of a closed contact state from its corner and edge.
type Closed = fn(CornerEdge) -> CornerContact;

/// Creates a pair of equal scales with a closed contact at entry `edge` of [`EDGES`].
fn case(edge: usize, slant: f64, law: Law, closed: Closed) -> Case {
    let (level, edge) = EDGES[edge];
    let pair = Pair::new(Parallelogram::new(0.4, slant).unwrap(), 1.0);
    // With a soft law the compliance contributes visibly to the tangent.
    let law = ContactLaw::new(law, 0.8, 1.0, 3.0).unwrap();
    Case { level, contact: closed(edge), pair, law }
}

/// Returns one of the closed states that are possible at entry `edge` of [`EDGES`].
fn closed(edge: usize, state: usize) -> Closed {
    let states: [Closed; 3] = [CornerContact::Edge, CornerContact::Corner, CornerContact::Flush];
    states[state % if EDGES[edge].1.flush().is_some() { 3 } else { 2 }]
}

/// Returns the derivatives of an equation with respect to all entries of `z`.
fn derivatives(equation: &Equation) -> [f64; COUPLED] {
    std::array::from_fn(|i| match i {
        0..COORDINATES => equation.by_coordinate[i],
        _ => equation.by_force[i - COORDINATES],
    })
}

/// Returns the equations of a state: the balance and the conditions of the acting forces.
fn equations(response: &CornerResponse, acting: [bool; FORCES]) -> Vec<Equation> {
    let conditions = response.conditions.iter().zip(acting).filter(|(_, acts)| *acts);
    let conditions = conditions.map(|(condition, _)| condition.unwrap());
    response.balance.iter().copied().chain(conditions).collect()
}

proptest! {
    #[test]
    fn tangents_agree_with_finite_differences(
        edge in 0_usize..6, slant in 0.0_f64..80.0, printed: bool, state in 0_usize..3,
        q in prop::array::uniform6(-0.5_f64..0.5), forces in prop::array::uniform3(0.2_f64..2.0),
    ) {
        let law = if printed { Law::PRINTED } else { Law::EXCHANGED };
        let case = case(edge, slant, law, closed(edge, state));
        let acting = case.contact.acting();
        let z = with(q, forces);
        let ours = equations(&case.at(&z), acting);
        let h = 1e-6;
        for j in (0..COUPLED).filter(|&j| j < COORDINATES || acting[j - COORDINATES]) {
            let (mut low, mut high) = (z, z);
            low[j] -= h;
            high[j] += h;
            let [low, high] = [low, high].map(|z| equations(&case.at(&z), acting));
            for (ours, (low, high)) in ours.iter().zip(low.iter().zip(&high)) {
                let difference = (high.value - low.value) / (2.0 * h);
                assert_relative_eq!(derivatives(ours)[j], difference, epsilon = 1e-6, max_relative = 1e-6);
            }
        }
    }

    #[test]
    fn tangents_of_corners_with_friction_agree_with_finite_differences(
        edge in 0_usize..6, slant in 0.0_f64..80.0, q in prop::array::uniform6(-0.5_f64..0.5),
        forces in prop::array::uniform3(0.2_f64..2.0), ratio in -0.6_f64..0.6,
    ) {
        let case = case(edge, slant, Law::PRINTED, CornerContact::Corner);
        let z = with(q, forces);
        let ours = case.with_friction(&z, ratio).balance;
        for j in 0..COORDINATES + 2 {
            let [low, high] = [-1e-6, 1e-6].map(|h| {
                let mut z = z;
                z[j] += h;
                case.with_friction(&z, ratio).balance.map(|equation| equation.value)
            });
            for (ours, (low, high)) in ours.iter().zip(low.iter().zip(&high)) {
                let difference = (high - low) / 2e-6;
                assert_relative_eq!(derivatives(ours)[j], difference, epsilon = 1e-6, max_relative = 1e-6);
            }
        }
    }

    /// Compares the friction in the states edge and corner on corner at the same `z`.
    #[test]
    fn friction_is_continuous_where_a_corner_reaches_the_end_of_its_edge(
        edge in 0_usize..6, slant in 0.0_f64..80.0, q in prop::array::uniform6(-0.5_f64..0.5),
        force in 0.2_f64..2.0, friction in -0.6_f64..0.6,
    ) {
        prop_assume!(friction != 0.0);
        let z = with(q, [force, 0.0, 0.0]);
        let at_end = case(edge, slant, Law::PRINTED, CornerContact::Corner);
        // The frictionless balance is continuous only in equilibrium, so the comparison is limited
        // to friction.
        let without = at_end.at(&z).balance.map(|equation| equation.value);
        let mut expected = without;
        // Depending on the rotation of the scales, the contact of the tip with a top or base
        // replaces the contact of a corner with a side, or vice versa.
        let (left, right) = (Pose::new(q[0], q[1], q[2]), Pose::new(q[3], q[4], q[5]));
        let [own, _] = Corners::new(at_end.level, &at_end.pair, [&left, &right]).together(EDGES[edge].1);
        let on_edge = Case { contact: CornerContact::Edge(own), ..case(edge, slant, Law::PRINTED, CornerContact::Edge) };
        on_edge.add_sliding(&mut expected, &z, friction);
        let balance = at_end.with_friction(&z, friction).balance;
        for (ours, expected) in balance.iter().zip(expected) {
            assert_relative_eq!(ours.value, expected, epsilon = 1e-12, max_relative = 1e-12);
        }
    }

    /// Checks the conditions of the partner and the flush contact while their forces do not act.
    #[test]
    fn resting_conditions_agree_with_finite_differences(
        edge in 0_usize..6, slant in 0.0_f64..80.0, q in prop::array::uniform6(-0.5_f64..0.5),
    ) {
        let case = case(edge, slant, Law::PRINTED, CornerContact::Edge);
        let z = with(q, [0.7, 0.0, 0.0]);
        let ours = case.at(&z);
        prop_assert!(ours.conditions[Force::Partner as usize].is_some());
        for (force, j) in [Force::Partner, Force::Flush].into_iter().flat_map(|f| (0..COORDINATES).map(move |j| (f, j))) {
            let [low, high] = [-1e-6, 1e-6].map(|h| {
                let mut z = z;
                z[j] += h;
                case.at(&z).conditions[force as usize]
            });
            // The condition of the flush contact is `None` beyond the far end of its edge.
            if let (Some(low), Some(high)) = (low, high) {
                let difference = (high.value - low.value) / 2e-6;
                let ours = ours.conditions[force as usize].unwrap().by_coordinate[j];
                assert_relative_eq!(ours, difference, epsilon = 1e-6, max_relative = 1e-6);
            }
        }
    }

    #[test]
    fn the_gradient_of_an_open_contact_agrees_with_finite_differences(
        edge in 0_usize..6, slant in 0.0_f64..80.0, q in prop::array::uniform6(-0.2_f64..0.2),
    ) {
        let case = case(edge, slant, Law::PRINTED, |_| CornerContact::Open);
        let z = with(q, [0.0; FORCES]);
        let facing = case.facing(&z);
        for j in 0..COORDINATES {
            let moved = [-1e-6, 1e-6].map(|h| {
                let mut z = z;
                z[j] += h;
                z
            });
            prop_assume!(moved.iter().all(|moved| case.facing(moved) == facing));
            let [low, high] = moved.map(|z| case.at(&z).conditions);
            let ours = case.at(&z).conditions;
            prop_assert_eq!([ours[1], ours[2]], [None; 2]);
            prop_assert_eq!(ours[0].is_some(), facing.is_some());
            if let (Some(ours), Some(low), Some(high)) = (ours[0], low[0], high[0]) {
                let difference = (high.value - low.value) / 2e-6;
                assert_relative_eq!(ours.by_coordinate[j], difference, epsilon = 1e-6, max_relative = 1e-6);
            }
        }
    }

    /// Rotates a pair by 180°, which exchanges left and right scale and upper and lower level.
    #[test]
    fn rotation_by_180_degrees_exchanges_the_levels(
        edge in 0_usize..6, slant in 0.0_f64..80.0, state in 0_usize..3,
        q in prop::array::uniform6(-0.5_f64..0.5), forces in prop::array::uniform3(0.2_f64..2.0),
    ) {
        let closed = closed(edge, state);
        let ours = case(edge, slant, Law::EXCHANGED, closed);
        let rotated = case(5 - edge, slant, Law::EXCHANGED, closed);
        let turned = half_turn(slant, &q);
        let (ours, rotated) = (ours.at(&with(q, forces)), rotated.at(&with(turned, forces)));
        for (ours, rotated) in ours.conditions.iter().zip(&rotated.conditions) {
            prop_assert_eq!(ours.is_some(), rotated.is_some());
            if let (Some(ours), Some(rotated)) = (ours, rotated) {
                assert_relative_eq!(ours.value, rotated.value, epsilon = 1e-12);
            }
        }
        // The rotation reverses forces and exchanges the left and the right scale.
        for (k, row) in [3, 4, 0, 1].into_iter().enumerate() {
            let column = [0, 1, 3, 4][k];
            assert_relative_eq!(ours.balance[column].value, -rotated.balance[row].value, epsilon = 1e-12);
        }
    }
}

/// Joins coordinates and forces to an argument `z` of [`Case`].
fn with(q: [f64; COORDINATES], forces: [f64; FORCES]) -> [f64; COUPLED] {
    std::array::from_fn(|i| if i < COORDINATES { q[i] } else { forces[i - COORDINATES] })
}

/// Returns the coordinates of the pair with coordinates `q` after a rotation by 180°.
///
/// Tops become bases, so the nodes of the rotated pair are the midpoints of the former tops.
fn half_turn(slant: f64, q: &[f64; 6]) -> [f64; 6] {
    let top = Vec2::new(slant.to_radians().tan(), 1.0);
    let [[a, b, c], [d, e, f]] = [3, 0].map(|first| {
        let [x, y, rotation] = [0, 1, 2].map(|k| q[first + k]);
        let moved = Vec2::new(x, y) + Pose::new(0.0, 0.0, rotation).turn(top) - top;
        [-moved.x, -moved.y, rotation]
    });
    [a, b, c, d, e, f]
}

/// Places a corner exactly at the end of an edge of the other scale.
///
/// At this point balance and conditions must be equal in the states edge and corner on corner.
#[test]
fn edge_and_corner_states_agree_at_their_transition() {
    let (alike, leaning) = ([-0.05, 0.03], [0.05, -0.03]);
    for (k, slant, phi) in [
        (0, 40.0, alike),
        (1, 40.0, alike),
        (2, 88.0, alike),
        (3, 88.0, leaning),
        (4, 20.0, alike),
        (5, 20.0, alike),
    ] {
        let [edge, corner] = [CornerContact::Edge as Closed, CornerContact::Corner]
            .map(|closed| case(k, slant, Law::EXCHANGED, closed));
        // Newton's method for the position of the left scale: both conditions (C6) are zero, so
        // D = −δ m and the corner is at the end of the edge.
        let mut z = [0.0, 0.0, phi[0], 0.0, 0.0, phi[1], 0.7, 0.0, 0.0];
        for _ in 0..30 {
            let [a, b] = [0, 1].map(|k| edge.at(&z).conditions[k].unwrap());
            let (s, t) = (a.by_coordinate, b.by_coordinate);
            let determinant = s[0] * t[1] - s[1] * t[0];
            z[0] -= (a.value * t[1] - b.value * s[1]) / determinant;
            z[1] -= (b.value * s[0] - a.value * t[0]) / determinant;
        }
        let (edge, corner) = (edge.at(&z), corner.at(&z));
        for (edge, corner) in edge.balance.iter().zip(&corner.balance) {
            assert_relative_eq!(edge.value, corner.value, epsilon = 1e-12);
        }
        // Corner on corner has no condition of a flush contact.
        for k in 0..2 {
            let [edge, corner] = [edge, corner].map(|response| response.conditions[k].unwrap());
            assert_relative_eq!(edge.value, corner.value, epsilon = 1e-12);
        }
        assert_eq!(corner.conditions[2], None);
    }
}

#[test]
fn the_partner_force_does_not_act_while_a_corner_is_short_of_the_end_of_its_edge() {
    let pair = Pair::new(Parallelogram::new(0.4, 30.0).unwrap(), 1.0);
    let law = ContactLaw::new(Law::PRINTED, 0.8, 1.0, 3.0).unwrap();
    let (left, right) = (Pose::new(0.2, -0.1, 0.0), Pose::new(0.0, 0.0, 0.0));
    for level in [Level::Upper, Level::Lower] {
        let corners = Corners::new(level, &pair, [&left, &right]);
        let (edge, _) = corners.facing().unwrap();
        let [own, partner] = [edge, corners.together(edge)[1]].map(|edge| {
            let response = CornerContact::Edge(edge).response(&corners, &law, [0.1, 0.0, 0.0]);
            response.conditions[Force::Partner as usize].unwrap().value
        });
        assert!(own > 0.0 && partner < 0.0, "{level:?} {own} {partner}");
    }
}

#[test]
fn sides_are_parallel_where_their_directions_agree() {
    let scales = [50.0, 30.0].map(|slant| Parallelogram::new(0.4, slant).unwrap());
    let pair = Pair::between(scales, Vec2::new(1.0, 0.0));
    // The slant of the left scale is 20° larger, so a relative rotation by 20° makes the sides
    // parallel.
    for (left, right, expected) in [
        (20.0, 0.0, true),
        (25.0, 5.0, true),
        (0.0, -20.0, true),
        (20.0 + 4e-5, 0.0, true),
        (20.0 - 4e-5, 0.0, true),
        (20.0 + 8e-5, 0.0, false),
        (20.0 - 8e-5, 0.0, false),
        (0.0, 0.0, false),
        (-20.0, 0.0, false),
        (0.0, 20.0, false),
    ] {
        let poses = [left, right].map(|degrees: f64| Pose::new(0.3, 0.1, degrees.to_radians()));
        let corners = Corners::new(Level::Upper, &pair, poses.each_ref());
        assert_eq!(corners.are_sides_parallel(), expected, "{left} {right}");
    }
}

/// Returns the corner and edge that face each other at the upper and at the lower level.
///
/// `left` and `right` are the displacements of the scales.
fn faced(slant: f64, pitch: f64, left: [f64; 2], right: [f64; 2]) -> [Option<CornerEdge>; 2] {
    let pair = Pair::new(Parallelogram::new(0.5, slant).unwrap(), pitch);
    let poses = [left, right].map(|[x, y]| Pose::new(x, y, 0.0));
    [Level::Upper, Level::Lower]
        .map(|level| Corners::new(level, &pair, poses.each_ref()).facing().map(|(edge, _)| edge))
}

#[test]
fn corners_face_the_sides_of_their_neighbours() {
    let rest = [0.0, 0.0];
    let left_corner = [CornerEdge::TopRightOnLeftEdge, CornerEdge::BottomRightOnLeftEdge].map(Some);
    let right_corner =
        [CornerEdge::TopLeftOnRightEdge, CornerEdge::BottomLeftOnRightEdge].map(Some);
    assert_eq!(faced(60.0, 1.2, rest, rest), [left_corner[0], right_corner[1]]);
    // If the corner of one scale faces no edge, the corner of the other scale does.
    assert_eq!(faced(0.0, 1.2, [0.0, 0.1], rest), [right_corner[0], left_corner[1]]);
    assert_eq!(faced(0.0, 1.2, rest, [0.0, 0.1]), [left_corner[0], right_corner[1]]);
    // Both corners of upright blocks at equal height face an edge; the corner of the left scale
    // has priority.
    assert_eq!(faced(0.0, 1.2, rest, rest), left_corner);
    // No corner faces an edge if the left scale lies far below its neighbour.
    assert_eq!(faced(60.0, 3.0, [0.0, -0.6], rest)[0], None);
}
