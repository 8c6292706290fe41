use super::{COUPLED, FAR, FORCES, Joint, JointResponse, Level};
use crate::gap::{Kind, Pair, Pose};
use crate::law::{ContactLaw, Law};
use approx::assert_relative_eq;
use geometry::{Parallelogram, Vec2};
use proptest::prelude::*;

const KINDS: [(Level, Kind); 4] = [
    (Level::Upper, Kind::TopRightOnLeftEdge),
    (Level::Upper, Kind::TopLeftOnRightEdge),
    (Level::Lower, Kind::BottomRightOnLeftEdge),
    (Level::Lower, Kind::BottomLeftOnRightEdge),
];

struct Case {
    joint: Joint,
    pair: Pair,
    law: ContactLaw,
    active: [bool; FORCES],
}

impl Case {
    fn at(&self, z: &[f64; COUPLED]) -> JointResponse {
        let (left, right) = (Pose::new(z[0], z[1], z[2]), Pose::new(z[3], z[4], z[5]));
        let forces = std::array::from_fn(|k| if self.active[k] { z[6 + k] } else { 0.0 });
        self.joint.response(&self.pair, &self.law, [&left, &right], forces, self.active)
    }
}

fn case(kind: usize, slant: f64, law: Law, active: [bool; FORCES]) -> Case {
    let (level, kind) = KINDS[kind];
    let pair = Pair::new(Parallelogram::new(0.4, slant).unwrap(), 1.0);
    // A soft law, so that its part of the tangent is seen.
    let law = ContactLaw::new(law, 0.8, 1.0, 3.0).unwrap();
    Case { joint: Joint { level, kind: Some(kind) }, pair, law, active }
}

const ON_EDGE: [bool; FORCES] = [true, false, false];
const AT_CORNER: [bool; FORCES] = [true, true, false];

/// What of a joint may act: one corner, two that are together, either with the tip, or the tip alone.
const STATES: [[bool; FORCES]; 5] =
    [ON_EDGE, AT_CORNER, [true, false, true], [true, true, true], [false, false, true]];

proptest! {
    #[test]
    fn tangents_agree_with_finite_differences(
        kind in 0_usize..4, slant in 0.0_f64..80.0, printed: bool, state in 0..STATES.len(),
        q in prop::array::uniform6(-0.5_f64..0.5), forces in prop::array::uniform3(0.2_f64..2.0),
    ) {
        let law = if printed { Law::PRINTED } else { Law::EXCHANGED };
        let active = STATES[state];
        let case = case(kind, slant, law, active);
        let z = [q[0], q[1], q[2], q[3], q[4], q[5], forces[0], forces[1], forces[2]];
        let ours = case.at(&z).tangent;
        let h = 1e-6;
        for j in acting(active) {
            let (mut low, mut high) = (z, z);
            low[j] -= h;
            high[j] += h;
            let (low, high) = (case.at(&low).residual, case.at(&high).residual);
            for i in acting(active) {
                let difference = (high[i] - low[i]) / (2.0 * h);
                assert_relative_eq!(ours[i][j], difference, epsilon = 1e-6, max_relative = 1e-6);
            }
        }
    }

    /// The condition of the end of the edge is needed before its force acts.
    #[test]
    fn the_distance_to_the_end_of_the_edge_agrees_with_finite_differences(
        kind in 0_usize..4, slant in 0.0_f64..80.0, q in prop::array::uniform6(-0.5_f64..0.5),
    ) {
        let case = case(kind, slant, Law::PRINTED, ON_EDGE);
        let z = [q[0], q[1], q[2], q[3], q[4], q[5], 0.7, 0.0, 0.0];
        let ours = case.at(&z).tangent[7];
        for j in 0..6 {
            let at = |h: f64| {
                let mut z = z;
                z[j] += h;
                case.at(&z).residual[7]
            };
            let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert_relative_eq!(ours[j], difference, epsilon = 1e-6, max_relative = 1e-6);
        }
    }

    /// A pair that is turned by half a turn is a pair again, its left scale the one that was right and its
    /// upper contact the one that was lower.
    #[test]
    fn half_a_turn_exchanges_the_levels(
        kind in 0_usize..4, slant in 0.0_f64..80.0, state in 0..STATES.len(),
        q in prop::array::uniform6(-0.5_f64..0.5), forces in prop::array::uniform3(0.2_f64..2.0),
    ) {
        let ours = case(kind, slant, Law::EXCHANGED, STATES[state]);
        let there = case(3 - kind, slant, Law::EXCHANGED, STATES[state]);
        let turned = half_turn(slant, &q);
        let with = |q: &[f64; 6]| [q[0], q[1], q[2], q[3], q[4], q[5], forces[0], forces[1], forces[2]];
        let (ours, there) = (ours.at(&with(&q)), there.at(&with(&turned)));
        for row in acting(STATES[state]).filter(|&row| row >= 6) {
            assert_relative_eq!(ours.residual[row], there.residual[row], epsilon = 1e-12);
        }
        // Forces point the other way, the scales have changed places.
        for (k, row) in [3, 4, 0, 1].into_iter().enumerate() {
            let column = [0, 1, 3, 4][k];
            assert_relative_eq!(ours.residual[column], -there.residual[row], epsilon = 1e-12);
        }
    }
}

/// Displacements of a pair that is turned by half a turn. Tops become bases, so that the nodes are
/// the midpoints of what were tops.
fn half_turn(slant: f64, q: &[f64; 6]) -> [f64; 6] {
    let top = Vec2::new(slant.to_radians().tan(), 1.0);
    let node = |scale: usize| {
        let q = &q[3 * scale..];
        let moved = Vec2::new(q[0], q[1]) + Pose::new(0.0, 0.0, q[2]).turn(top) - top;
        [-moved.x, -moved.y, q[2]]
    };
    let ([a, b, c], [d, e, f]) = (node(1), node(0));
    [a, b, c, d, e, f]
}

/// The unknowns of a joint some of whose forces act.
fn acting(active: [bool; FORCES]) -> impl Iterator<Item = usize> {
    (0..COUPLED).filter(move |&i| i < 6 || active[i - 6])
}

/// Two blocks with relative rotation, the corner of the left exactly at the end of the right one's edge.
#[test]
fn edge_and_corner_agree_where_one_becomes_the_other() {
    for (k, slant) in [(0, 40.0), (1, 40.0), (2, 20.0), (3, 20.0)] {
        let case = |active| case(k, slant, Law::EXCHANGED, active);
        let (force, phi) = (0.7, [-0.05, 0.03]);
        // Place the left scale so that D = −δ m: then the foot is at the end of the edge.
        let edge = case(ON_EDGE);
        let at = |x: f64, y: f64| [x, y, phi[0], 0.0, 0.0, phi[1], force, 0.0, 0.0];
        let (mut x, mut y) = (0.0, 0.0);
        for _ in 0..30 {
            let response = edge.at(&at(x, y));
            let [a, b] = [response.residual[6], response.residual[7]];
            let t = response.tangent;
            let determinant = t[6][0] * t[7][1] - t[6][1] * t[7][0];
            x -= (a * t[7][1] - b * t[6][1]) / determinant;
            y -= (b * t[6][0] - a * t[7][0]) / determinant;
        }
        let (edge, corner) = (edge.at(&at(x, y)), case(AT_CORNER).at(&at(x, y)));
        for i in 0..COUPLED {
            assert_relative_eq!(edge.residual[i], corner.residual[i], epsilon = 1e-12);
        }
    }
}

#[test]
fn a_corner_short_of_the_end_of_its_edge_keeps_its_partner_at_rest() {
    let pair = Pair::new(Parallelogram::new(0.4, 30.0).unwrap(), 1.0);
    let law = ContactLaw::new(Law::PRINTED, 0.8, 1.0, 3.0).unwrap();
    let (left, right) = (Pose::new(0.2, -0.1, 0.0), Pose::new(0.0, 0.0, 0.0));
    for level in [Level::Upper, Level::Lower] {
        let mut joint = Joint::new(level);
        joint = joint.facing(&pair, [&left, &right]);
        let short = |joint: &Joint| {
            joint.response(&pair, &law, [&left, &right], [0.1, 0.0, 0.0], ON_EDGE).residual[7]
        };
        assert!(short(&joint) > 0.0, "{level:?}");
        joint.hand_over();
        assert!(short(&joint) < 0.0, "{level:?}");
    }
}

/// The lower joint of two steep scales, the right one leaning over by `turned` degrees, its bottom left corner
/// under the base of the left one: `inside` its right end and `below`.
fn under_the_base(turned: f64, inside: f64, below: f64) -> (Pair, [Pose; 2]) {
    let pair = Pair::new(Parallelogram::new(1.0, 75.0).unwrap(), 2.2);
    // The corner is at −1 from the node of its scale, and the base of the other ends at +1.
    let arm = Pose::new(0.0, 0.0, -turned.to_radians()).turn(Vec2::new(-1.0, 0.0));
    let corner = Vec2::new(1.0 - inside, -below);
    let place = corner - arm - Vec2::new(2.2, 0.0);
    (pair, [Pose::new(0.0, 0.0, 0.0), Pose::new(place.x, place.y, -turned.to_radians())])
}

/// The same for the top: half a turn of the pair.
fn above_the_top(turned: f64, inside: f64, above: f64) -> (Pair, [Pose; 2]) {
    let (pair, [left, right]) = under_the_base(turned, inside, above);
    let coordinates = |pose: &Pose| [pose.displacement.x, pose.displacement.y, pose.rotation];
    let ([a, b, c], [d, e, f]) = (coordinates(&left), coordinates(&right));
    let [a, b, c, d, e, f] = half_turn(75.0, &[a, b, c, d, e, f]);
    (pair, [Pose::new(a, b, c), Pose::new(d, e, f)])
}

fn soft() -> ContactLaw {
    ContactLaw::new(Law::EXCHANGED, 2.0, 1.0, 3.0).unwrap()
}

fn lower(kind: Option<Kind>) -> Joint {
    Joint { level: Level::Lower, kind }
}

/// The gap of the tip, the same at both levels.
fn tip_gap(kind: Option<Kind>, active: [bool; FORCES], turned: f64, inside: f64) -> f64 {
    let gap = |level, kind, (pair, [left, right]): (Pair, [Pose; 2])| {
        let joint = Joint { level, kind };
        joint.response(&pair, &soft(), [&left, &right], [0.0; FORCES], active).residual[8]
    };
    let below = gap(Level::Lower, kind, under_the_base(turned, inside, 0.1));
    let across = |kind| match kind {
        Kind::BottomRightOnLeftEdge => Kind::TopLeftOnRightEdge,
        _ => Kind::TopRightOnLeftEdge,
    };
    let above = gap(Level::Upper, kind.map(across), above_the_top(turned, inside, 0.1));
    assert_relative_eq!(below, above, epsilon = 1e-12);
    below
}

#[test]
fn a_tip_faces_the_base_that_it_lies_under() {
    const OPEN: [bool; FORCES] = [false; FORCES];
    assert_relative_eq!(tip_gap(None, OPEN, 16.0, 0.3), 0.1, epsilon = 1e-12);
    // Nearly level, and not nearly so.
    assert_relative_eq!(tip_gap(None, OPEN, 10.0, 0.3), 0.1, epsilon = 1e-12);
    assert_eq!(tip_gap(None, OPEN, 9.0, 0.3), FAR);
    // Beside the base, at either end.
    assert_eq!(tip_gap(None, OPEN, 16.0, -0.1), FAR);
    assert_eq!(tip_gap(None, OPEN, 16.0, 2.1), FAR);
}

#[test]
fn a_tip_is_out_of_reach_unless_the_other_corner_rests_on_its_side() {
    let on_its_side = Some(Kind::BottomRightOnLeftEdge);
    assert_relative_eq!(tip_gap(on_its_side, ON_EDGE, 16.0, 0.3), 0.1, epsilon = 1e-12);
    assert_eq!(tip_gap(on_its_side, AT_CORNER, 16.0, 0.3), FAR);
    assert_eq!(tip_gap(Some(Kind::BottomLeftOnRightEdge), ON_EDGE, 16.0, 0.3), FAR);
}

/// The near end is where the other corner is.
#[test]
fn a_tip_that_comes_from_the_corner_is_within_reach() {
    let on_its_side = Some(Kind::BottomRightOnLeftEdge);
    assert_relative_eq!(tip_gap(on_its_side, ON_EDGE, 16.0, -0.01), 0.1, epsilon = 1e-12);
    assert_eq!(tip_gap(on_its_side, ON_EDGE, 16.0, 2.01), FAR);
}

/// Where side and base lie flush, it does not matter to the approach of the two scales which of the two
/// contacts carries how much.
#[test]
fn flush_contacts_share_one_approach() {
    let (kind, law) = (Some(Kind::BottomRightOnLeftEdge), soft());
    let below = -law.approach(0.5).value;
    let (pair, [left, right]) = under_the_base(15.0, 0.3, below);
    for share in [0.0, 0.2, 1.0] {
        let forces = [0.5 * share, 0.0, 0.5 * (1.0 - share)];
        let response =
            lower(kind).response(&pair, &law, [&left, &right], forces, [true, false, true]);
        assert_relative_eq!(response.residual[6], 0.0, epsilon = 1e-12);
        assert_relative_eq!(response.residual[8], 0.0, epsilon = 1e-12);
        let [on_corner, on_tip] = lower(kind).forces(&pair, [&left, &right], forces);
        assert_relative_eq!(on_corner + on_tip, Vec2::new(0.0, 0.5), epsilon = 1e-12);
        assert_relative_eq!(on_tip.y, forces[2], epsilon = 1e-12);
        assert_relative_eq!(response.residual[1], -0.5, epsilon = 1e-12);
    }
}

#[test]
fn the_forces_on_a_top_are_those_on_a_base_turned_round() {
    let forces = [0.3, 0.0, 0.2];
    let (pair, [left, right]) = under_the_base(15.0, 0.3, 0.0);
    let below = lower(Some(Kind::BottomRightOnLeftEdge));
    let [corner, tip] = below.forces(&pair, [&left, &right], forces);
    let (pair, [left, right]) = above_the_top(15.0, 0.3, 0.0);
    let above = Joint { level: Level::Upper, kind: Some(Kind::TopLeftOnRightEdge) };
    let turned = above.forces(&pair, [&left, &right], forces);
    // The force on the left scale is now minus that on what was the right one, turned round.
    assert_relative_eq!(turned[0], corner, epsilon = 1e-12);
    assert_relative_eq!(turned[1], tip, epsilon = 1e-12);
    let [none, _] = Joint::new(Level::Upper).forces(&pair, [&left, &right], forces);
    assert_eq!(none, Vec2::zeros());
}

/// What an open joint is about to do depends on the poses, and not on what it did before.
#[test]
fn a_joint_without_forces_is_open() {
    let (pair, [left, right]) = under_the_base(12.0, 0.3, 0.1);
    let (law, poses) = (soft(), [&left, &right]);
    for level in [Level::Upper, Level::Lower] {
        for kind in [None, Some(Kind::BottomRightOnLeftEdge), Some(Kind::BottomLeftOnRightEdge)] {
            let joint = Joint { level, kind };
            let [gap, short, tip] = joint.open(&pair, poses);
            let facing = joint.facing(&pair, poses).kind();
            let distance = facing.map_or(FAR, |kind| pair.distance(kind, &left, &right));
            assert_eq!((gap, short), (distance, FAR));
            let response = joint.response(&pair, &law, poses, [0.0; FORCES], [false; FORCES]);
            assert_eq!(response.residual[6..], [gap, short, tip]);
            // Under the force of the tip the scales approach, and the corner with them.
            let tip_alone = [false, false, true];
            let response = joint.response(&pair, &law, poses, [0.0, 0.0, 0.4], tip_alone);
            let expected = gap + law.approach(0.4).value;
            assert_relative_eq!(response.residual[6], expected, epsilon = 1e-14);
        }
    }
    let kind = Joint::new(Level::Lower).facing(&pair, poses).kind();
    assert_eq!(kind, Some(Kind::BottomRightOnLeftEdge));
}

#[test]
fn sides_are_flush_where_their_directions_agree() {
    let scales = [50.0, 30.0].map(|slant| Parallelogram::new(0.4, slant).unwrap());
    let pair = Pair::of(scales, 1.0);
    // The left one leans by 20° more, and turns back by as much.
    let flush = |left: f64, right: f64| {
        let poses = [left, right].map(|degrees| Pose::new(0.3, 0.1, degrees.to_radians()));
        Joint::is_flush(&pair, [&poses[0], &poses[1]])
    };
    assert!(flush(20.0, 0.0) && flush(25.0, 5.0) && flush(0.0, -20.0));
    assert!(flush(20.0 + 4e-5, 0.0) && flush(20.0 - 4e-5, 0.0));
    assert!(!flush(20.0 + 8e-5, 0.0) && !flush(20.0 - 8e-5, 0.0));
    assert!(!flush(0.0, 0.0) && !flush(-20.0, 0.0) && !flush(0.0, 20.0));
}
