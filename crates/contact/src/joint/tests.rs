use super::{COUPLED, FAR, FORCES, Joint, JointResponse, Level};
use crate::gap::{Kind, Pair, Pose};
use crate::law::{ContactLaw, Law};
use approx::assert_relative_eq;
use geometry::{Parallelogram, Vec2};
use proptest::prelude::*;

/// Half a turn of a pair makes the first of these the last, the second the last but one, and so on.
const KINDS: [(Level, Kind); 6] = [
    (Level::Upper, Kind::TopRightOnLeftEdge),
    (Level::Upper, Kind::TopLeftOnRightEdge),
    (Level::Upper, Kind::TopRightOnTop),
    (Level::Lower, Kind::BottomLeftOnBase),
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

const FLUSH_EDGES: [bool; FORCES] = [true, false, true];

/// Which forces may act: that of one contact, those of two corners that are together, or those of flush edges.
fn states(joint: Joint) -> Vec<[bool; FORCES]> {
    let beside = joint.beside().map(|_| FLUSH_EDGES);
    [ON_EDGE, AT_CORNER].into_iter().chain(beside).collect()
}

proptest! {
    #[test]
    fn tangents_agree_with_finite_differences(
        kind in 0_usize..6, slant in 0.0_f64..80.0, printed: bool, state in 0_usize..3,
        q in prop::array::uniform6(-0.5_f64..0.5), forces in prop::array::uniform3(0.2_f64..2.0),
    ) {
        let law = if printed { Law::PRINTED } else { Law::EXCHANGED };
        let mut case = case(kind, slant, law, ON_EDGE);
        let states = states(case.joint);
        let active = states[state % states.len()];
        case.active = active;
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

    /// The conditions of the end of the edge and of the contact beside are needed before their forces act.
    #[test]
    fn what_stops_a_contact_agrees_with_finite_differences(
        kind in 0_usize..6, slant in 0.0_f64..80.0, q in prop::array::uniform6(-0.5_f64..0.5),
    ) {
        let case = case(kind, slant, Law::PRINTED, ON_EDGE);
        let z = [q[0], q[1], q[2], q[3], q[4], q[5], 0.7, 0.0, 0.0];
        let ours = case.at(&z).tangent;
        for (row, j) in (7..9).flat_map(|row| (0..6).map(move |j| (row, j))) {
            let [low, high] = [-1e-6, 1e-6].map(|h| {
                let mut z = z;
                z[j] += h;
                case.at(&z).residual[row]
            });
            // The contact beside may be out of reach.
            if row == 7 || low != FAR && high != FAR {
                let difference = (high - low) / 2e-6;
                assert_relative_eq!(ours[row][j], difference, epsilon = 1e-6, max_relative = 1e-6);
            }
        }
    }

    /// A pair that is turned by half a turn is a pair again, its left scale the one that was right and its
    /// upper contact the one that was lower.
    #[test]
    fn half_a_turn_exchanges_the_levels(
        kind in 0_usize..6, slant in 0.0_f64..80.0, state in 0_usize..3,
        q in prop::array::uniform6(-0.5_f64..0.5), forces in prop::array::uniform3(0.2_f64..2.0),
    ) {
        let mut ours = case(kind, slant, Law::EXCHANGED, ON_EDGE);
        let states = states(ours.joint);
        ours.active = states[state % states.len()];
        let there = case(5 - kind, slant, Law::EXCHANGED, ours.active);
        let turned = half_turn(slant, &q);
        let with = |q: &[f64; 6]| [q[0], q[1], q[2], q[3], q[4], q[5], forces[0], forces[1], forces[2]];
        let (ours, there) = (ours.at(&with(&q)), there.at(&with(&turned)));
        for row in 6..COUPLED {
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
    let (alike, leaning) = ([-0.05, 0.03], [0.05, -0.03]);
    for (k, slant, phi) in [
        (0, 40.0, alike),
        (1, 40.0, alike),
        (2, 88.0, alike),
        (3, 88.0, leaning),
        (4, 20.0, alike),
        (5, 20.0, alike),
    ] {
        let case = |active| case(k, slant, Law::EXCHANGED, active);
        let force = 0.7;
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
        // The last one is of the contact beside, which corners do not have.
        for i in 0..COUPLED - 1 {
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
        joint.hand_over(&pair, [&left, &right]);
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

const ACROSS: [(Kind, Kind); 3] = [
    (Kind::BottomRightOnLeftEdge, Kind::TopLeftOnRightEdge),
    (Kind::BottomLeftOnRightEdge, Kind::TopRightOnLeftEdge),
    (Kind::BottomLeftOnBase, Kind::TopRightOnTop),
];

/// Something of a lower joint of [`under_the_base`], and of what half a turn makes of it.
fn at_both_levels<T>(
    turned: f64,
    inside: f64,
    below: f64,
    kind: Option<Kind>,
    f: impl Fn(Joint, &Pair, [&Pose; 2]) -> T,
) -> [T; 2] {
    let across = |kind| ACROSS.into_iter().find(|(lower, _)| *lower == kind).unwrap().1;
    let (pair, [left, right]) = under_the_base(turned, inside, below);
    let under = f(Joint { level: Level::Lower, kind }, &pair, [&left, &right]);
    let (pair, [left, right]) = above_the_top(turned, inside, below);
    let upper = Joint { level: Level::Upper, kind: kind.map(across) };
    [under, f(upper, &pair, [&left, &right])]
}

/// The side of the tip leans by 75° at rest.
#[test]
fn what_an_open_joint_faces_depends_on_how_its_side_leans() {
    for (turned, inside, kind) in [
        (14.9, 0.3, Some(Kind::BottomRightOnLeftEdge)),
        (15.1, 0.3, Some(Kind::BottomLeftOnBase)),
        // Beside the base, at either end.
        (16.0, -0.1, Some(Kind::BottomLeftOnRightEdge)),
        (16.0, -0.01, None),
        (16.0, 2.1, None),
    ] {
        let facing = |joint: Joint, pair: &Pair, poses: [&Pose; 2]| {
            let gap = joint.open(pair, poses);
            (joint.facing(pair, poses).kind(), gap)
        };
        let [(lower, at_base), (upper, at_top)] = at_both_levels(turned, inside, 0.1, None, facing);
        assert_eq!(lower, kind);
        assert_eq!(upper, kind.map(|kind| ACROSS.iter().find(|a| a.0 == kind).unwrap().1));
        assert_relative_eq!(at_base[0], at_top[0], epsilon = 1e-12);
        assert_eq!((at_base[1], at_base[2]), (FAR, FAR));
        match kind {
            Some(Kind::BottomLeftOnBase) => assert_relative_eq!(at_base[0], 0.1, epsilon = 1e-12),
            Some(_) => assert!((0.0..0.2).contains(&at_base[0])),
            None => assert_eq!(at_base[0], FAR),
        }
    }
}

/// The angle by which a side is short of level, or beyond it, of a contact that carries.
fn to_level(kind: Kind, active: [bool; FORCES], turned: f64, inside: f64) -> f64 {
    let angle = |joint: Joint, pair: &Pair, poses: [&Pose; 2]| {
        joint.response(pair, &soft(), poses, [0.0; FORCES], active).residual[8]
    };
    let [lower, upper] = at_both_levels(turned, inside, 0.1, Some(kind), angle);
    assert_relative_eq!(lower, upper, epsilon = 1e-12);
    lower
}

#[test]
fn the_contact_beside_waits_until_the_side_is_level() {
    let (on_side, on_end) = (Kind::BottomRightOnLeftEdge, Kind::BottomLeftOnBase);
    for turned in [5.0, 14.0, 17.0] {
        let short = (15.0_f64 - turned).to_radians();
        assert_relative_eq!(to_level(on_side, ON_EDGE, turned, 0.3), short, epsilon = 1e-12);
        assert_relative_eq!(to_level(on_end, ON_EDGE, turned, 0.3), -short, epsilon = 1e-12);
    }
    // Out of reach for corners that are together, and for a tip that rests on the neighbour's side.
    assert_eq!(to_level(on_side, AT_CORNER, 14.0, 0.3), FAR);
    assert_eq!(to_level(on_end, AT_CORNER, 16.0, 0.3), FAR);
    assert_eq!(to_level(Kind::BottomLeftOnRightEdge, ON_EDGE, 14.0, 0.3), FAR);
}

/// The base is 2 long, the side 3.86.
#[test]
fn there_is_no_contact_beside_beyond_the_far_end_of_its_edge() {
    let (on_side, on_end) = (Kind::BottomRightOnLeftEdge, Kind::BottomLeftOnBase);
    for (kind, within, beyond) in [(on_side, 1.99, 2.01), (on_end, 3.8, 3.9)] {
        assert!(to_level(kind, ON_EDGE, 15.0, within).abs() < 1e-12);
        assert_eq!(to_level(kind, ON_EDGE, 15.0, beyond), FAR);
        // The near end is where the corners meet, and another condition's.
        assert!(to_level(kind, ON_EDGE, 15.0, -0.01).abs() < 1e-12);
    }
}

/// Short of level the force turns from the normal of the neighbour's side to that of the tip's side, beyond it only to
/// that of the neighbour's end.
#[test]
fn at_the_corner_the_force_turns_no_further_than_to_the_end() {
    let side = Vec2::new(75.0_f64.to_radians().cos(), -75.0_f64.to_radians().sin());
    for (turned, expected) in
        [(10.0_f64, 5.0_f64), (14.0, 1.0), (15.0, 0.0), (16.0, 0.0), (40.0, 0.0)]
    {
        let of_tip = expected.to_radians();
        let normal = Vec2::new(-of_tip.sin(), of_tip.cos());
        for kind in ACROSS.map(|(kind, _)| kind) {
            let force = |joint: Joint, pair: &Pair, poses: [&Pose; 2]| {
                joint.forces(pair, poses, [0.3, 0.2, 0.0])
            };
            let ours = at_both_levels(turned, 0.0, 0.0, Some(kind), force);
            let expected = match kind {
                Kind::BottomLeftOnRightEdge => 0.2 * normal - 0.3 * side,
                _ => 0.3 * normal - 0.2 * side,
            };
            for [corners, beside] in ours {
                assert_relative_eq!(corners, expected, epsilon = 1e-12);
                assert_eq!(beside, Vec2::zeros());
            }
        }
    }
}

#[test]
fn a_corner_is_left_as_the_side_leans() {
    let (on_side, on_end, tip_on_side) =
        (Kind::BottomRightOnLeftEdge, Kind::BottomLeftOnBase, Kind::BottomLeftOnRightEdge);
    for (turned, leaning) in [(14.0, on_side), (16.0, on_end)] {
        let (pair, [left, right]) = under_the_base(turned, 0.0, 0.0);
        let poses = [&left, &right];
        let after = |kind, change: fn(&mut Joint, &Pair, [&Pose; 2])| {
            let mut joint = lower(Some(kind));
            change(&mut joint, &pair, poses);
            joint.kind().unwrap()
        };
        for kind in [on_side, on_end] {
            assert_eq!(after(kind, Joint::leave_corner), leaning);
            assert_eq!(after(kind, Joint::hand_over), tip_on_side);
        }
        assert_eq!(after(tip_on_side, Joint::leave_corner), tip_on_side);
        assert_eq!(after(tip_on_side, Joint::hand_over), leaning);
    }
}

#[test]
fn contacts_of_flush_edges_are_beside_each_other() {
    for (level, kind) in KINDS {
        let mut joint = Joint { level, kind: Some(kind) };
        let beside = joint.beside();
        joint.pass_beside();
        assert_eq!(joint.kind(), beside);
        assert_eq!(joint.beside(), beside.map(|_| kind));
    }
    assert_eq!(lower(Some(Kind::BottomLeftOnBase)).beside(), Some(Kind::BottomRightOnLeftEdge));
    assert_eq!(lower(Some(Kind::BottomLeftOnRightEdge)).beside(), None);
    assert_eq!(lower(None).beside(), None);
}

/// Where side and base lie flush, it does not matter to the approach of the two scales which of the two
/// contacts carries how much.
#[test]
fn flush_contacts_share_one_approach() {
    let law = soft();
    let below = -law.approach(0.5).value;
    let (pair, [left, right]) = under_the_base(15.0, 0.3, below);
    for kind in [Kind::BottomRightOnLeftEdge, Kind::BottomLeftOnBase].map(Some) {
        for share in [0.0, 0.2, 1.0] {
            let forces = [0.5 * share, 0.0, 0.5 * (1.0 - share)];
            let response = lower(kind).response(&pair, &law, [&left, &right], forces, FLUSH_EDGES);
            assert_relative_eq!(response.residual[6], 0.0, epsilon = 1e-12);
            assert_relative_eq!(response.residual[8], 0.0, epsilon = 1e-12);
            let [on_corner, beside] = lower(kind).forces(&pair, [&left, &right], forces);
            assert_relative_eq!(on_corner + beside, Vec2::new(0.0, 0.5), epsilon = 1e-12);
            assert_relative_eq!(beside.y, forces[2], epsilon = 1e-12);
            assert_relative_eq!(response.residual[1], -0.5, epsilon = 1e-12);
        }
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
            let facing = joint.facing(&pair, poses).kind();
            let distance = facing.map_or(FAR, |kind| pair.distance(kind, &left, &right));
            assert_eq!(joint.open(&pair, poses), [distance, FAR, FAR]);
            let response = joint.response(&pair, &law, poses, [0.0; FORCES], [false; FORCES]);
            assert_eq!(response.residual[6..], [distance, FAR, FAR]);
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

/// What the joints of two levels face where the scales stand in these places.
fn faced(slant: f64, pitch: f64, left: [f64; 2], right: [f64; 2]) -> [Option<Kind>; 2] {
    let pair = Pair::new(Parallelogram::new(0.5, slant).unwrap(), pitch);
    let poses = [left, right].map(|[x, y]| Pose::new(x, y, 0.0));
    [Level::Upper, Level::Lower]
        .map(|level| Joint::new(level).facing(&pair, poses.each_ref()).kind())
}

#[test]
fn corners_face_the_sides_of_their_neighbours() {
    let rest = [0.0, 0.0];
    let left_corner = [Kind::TopRightOnLeftEdge, Kind::BottomRightOnLeftEdge].map(Some);
    let right_corner = [Kind::TopLeftOnRightEdge, Kind::BottomLeftOnRightEdge].map(Some);
    assert_eq!(faced(60.0, 1.2, rest, rest), [left_corner[0], right_corner[1]]);
    // Where a corner has left the edge, its neighbour's faces this scale's.
    assert_eq!(faced(0.0, 1.2, [0.0, 0.1], rest), [right_corner[0], left_corner[1]]);
    assert_eq!(faced(0.0, 1.2, rest, [0.0, 0.1]), [left_corner[0], right_corner[1]]);
    // Upright blocks at one height: both, and the left one's comes first.
    assert_eq!(faced(0.0, 1.2, rest, rest), left_corner);
    // Far below its neighbour, a corner faces no edge.
    assert_eq!(faced(60.0, 3.0, [0.0, -0.6], rest)[0], None);
}
