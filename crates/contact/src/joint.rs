//! The upper and the lower contact of a pair of neighbours, from open to edge to corner and on.

use geometry::{Corner, Vec2};

use crate::gap::{Kind, Pair, Pose, quarter};
use crate::law::ContactLaw;

/// Which of the two contacts of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Between the tops.
    Upper,
    /// Between the bases.
    Lower,
}

impl Level {
    /// The corners that meet: of the left and of the right scale.
    fn corners(self) -> [Corner; 2] {
        match self {
            Self::Upper => [Corner::TopRight, Corner::TopLeft],
            Self::Lower => [Corner::BottomRight, Corner::BottomLeft],
        }
    }
}

/// Unknowns of a joint: the force of its kind and the force of its partner's kind.
pub const FORCES: usize = 2;

/// Unknowns that a joint couples: `(x, y, φ)` of the left and of the right scale, and the forces.
pub const COUPLED: usize = 6 + FORCES;

/// Gap of a joint where no corner faces an edge: open.
const FAR: f64 = 1.0;

/// Edges at a smaller angle than this (radians) count as parallel. There the force turns from one normal to the
/// other within round-off of a stiff contact, so it is handed over at once: the path skips a part
/// of it as small as this angle.
const FLUSH: f64 = 1e-6;

/// The contact of neighbours at one level, as two complementarity conditions.
///
/// Two corners meet here, `P` of the left and `Q` of the right scale, and each may rest on the
/// edge that ends in the other. With the normals `m_A` (of the right scale's left edge) and `m_B` (inward, of
/// the left scale's right edge), both pointing left, and `D = P − Q`:
///
/// ```text
/// kind A,  P on the left edge:   force  λ m_A on P,  gap D·m_A
/// kind B,  Q on the right edge:  force −λ m_B on Q,  gap D·m_B
/// ```
///
/// A corner that slides to the end of its edge meets the other corner. The force cannot jump from
/// one normal to the other: it turns between them while the corners stay together. There both
/// forces act, and the law holds along their sum,
///
/// ```text
/// v ≡ D + δ(|f|) f/|f| = 0,    f = λ_A m_A + λ_B m_B                               (C5)
/// ```
///
/// With the kind's own force `λ`, normal `m` and edge direction `s` (up), `λ'` its partner's force, and `σ = ±1` for the
/// end of the edge at which the partner waits, this is
///
/// ```text
/// 0 ≤ λ   ⟂   v·m ≥ 0         (closed or open)
/// 0 ≤ λ'  ⟂  −σ v·s ≥ 0       (at the end of the edge or short of it)              (C6)
/// ```
///
/// and `v·m = g + δ(λ)` while `λ' = 0`. When `λ` vanishes before `λ'`, the partner's kind takes over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Joint {
    level: Level,
    kind: Option<Kind>,
}

/// Residual and tangent of a joint in the coordinates of the pair and its two forces.
///
/// Rows 0 to 5 are what the contact subtracts from the balance of the two scales, rows 6 and 7 the
/// conditions of the two forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointResponse {
    /// Values of the rows.
    pub residual: [f64; COUPLED],
    /// Derivatives of the rows, by column.
    pub tangent: [[f64; COUPLED]; COUPLED],
}

impl Joint {
    /// An open joint: its kind depends on the poses until it closes.
    pub fn new(level: Level) -> Self {
        Self { level, kind: None }
    }

    /// Which contact of the pair.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Which corner meets which edge; `None` before the joint has
    /// closed; an open joint keeps the kind that it had.
    pub fn kind(&self) -> Option<Kind> {
        self.kind
    }

    /// The joint with the kind that the poses of an open joint give it.
    #[must_use]
    pub fn facing(self, pair: &Pair, poses: [&Pose; 2]) -> Self {
        Self { kind: self.nearest(pair, poses).map(|(kind, _)| kind), ..self }
    }

    /// The kind that the poses of an open joint give it, and its gap.
    fn nearest(self, pair: &Pair, [left, right]: [&Pose; 2]) -> Option<(Kind, f64)> {
        match self.level {
            Level::Upper => pair.upper(left, right),
            Level::Lower => pair.lower(left, right),
        }
    }

    /// Passes the contact on to the partner's kind.
    pub fn hand_over(&mut self) {
        self.kind = self.kind.map(Kind::partner);
    }

    /// The two conditions (C6) of an open joint.
    pub fn open(&self, pair: &Pair, poses: [&Pose; 2]) -> [f64; FORCES] {
        [self.nearest(pair, poses).map_or(FAR, |(_, gap)| gap), FAR]
    }

    /// Force on the left scale; the right one takes its opposite.
    pub fn force(&self, pair: &Pair, [left, right]: [&Pose; 2], forces: [f64; FORCES]) -> Vec2 {
        self.kind.map_or_else(Vec2::zeros, |kind| {
            Corners::new(pair, kind, self.level, left, right).force(forces)
        })
    }

    /// Whether the edges are so nearly parallel that the force need not turn at a corner.
    pub fn is_flush(pair: &Pair, [left, right]: [&Pose; 2]) -> bool {
        // A slant turns an edge clockwise.
        (left.rotation - right.rotation - pair.convergence()).sin().abs() < FLUSH
    }

    /// Residual and tangent of a joint of which the first force acts, and the second if `at_corner`.
    pub fn response(
        &self,
        pair: &Pair,
        law: &ContactLaw,
        [left, right]: [&Pose; 2],
        forces: [f64; FORCES],
        at_corner: bool,
    ) -> JointResponse {
        let Some(kind) = self.kind else { return JointResponse::zero() };
        let corners = Corners::new(pair, kind, self.level, left, right);
        if at_corner { corners.corner(law, forces) } else { corners.edge(pair, law, forces[0]) }
    }
}

impl JointResponse {
    fn zero() -> Self {
        Self { residual: [0.0; COUPLED], tangent: [[0.0; COUPLED]; COUPLED] }
    }
}

/// The two corners of a joint and the directions at them.
struct Corners<'a> {
    kind: Kind,
    left: &'a Pose,
    right: &'a Pose,
    /// `D = P − Q`.
    apart: Vec2,
    /// From the node of its scale to each corner, turned.
    arms: [Vec2; 2],
    /// `m` of the kind and of its partner.
    normals: [Vec2; 2],
    /// Column of the rotation with which each normal turns.
    turns: [usize; 2],
    /// `s` of the kind, times `σ`.
    beyond: Vec2,
}

impl<'a> Corners<'a> {
    fn new(pair: &Pair, kind: Kind, level: Level, left: &'a Pose, right: &'a Pose) -> Self {
        let [p, q] = level.corners();
        let [of_left, of_right] = pair.scales();
        let arms = [left.turn(of_left.corner(p)), right.turn(of_right.corner(q))];
        let apart = (left.displacement - right.displacement) + (arms[0] - arms[1])
            - Vec2::new(pair.pitch(), 0.0);
        let [of_left, of_right] = pair.right_normals();
        let (from_right, from_left) = (right.turn(-of_right), left.turn(-of_left));
        // P slides off its edge beyond Q, Q beyond P; upward at the upper, downward at the lower level.
        let outward = if level == Level::Upper { 1.0 } else { -1.0 };
        let (normals, turns, sign) = if kind.corner_is_left() {
            ([from_right, from_left], [5, 2], outward)
        } else {
            ([from_left, from_right], [2, 5], -outward)
        };
        // A normal that points left, turned clockwise, points up its edge.
        let beyond = -sign * quarter(normals[0]);
        Self { kind, left, right, apart, arms, normals, turns, beyond }
    }

    fn force(&self, forces: [f64; FORCES]) -> Vec2 {
        forces[0] * self.normals[0] + forces[1] * self.normals[1]
    }

    /// How far a vector reaches beyond the end of the edge.
    fn overrun(&self, v: Vec2) -> f64 {
        v.dot(&self.beyond)
    }

    /// The corner on the edge: the first force alone acts, where the corner is.
    fn edge(&self, pair: &Pair, law: &ContactLaw, force: f64) -> JointResponse {
        let gap = pair.gap(self.kind, self.left, self.right);
        let approach = law.approach(force);
        let mut response = JointResponse::zero();
        for i in 0..6 {
            response.residual[i] = -force * gap.gradient[i];
            response.tangent[i][6] = -gap.gradient[i];
            response.tangent[6][i] = gap.gradient[i];
            for j in 0..6 {
                response.tangent[i][j] = -force * gap.hessian[i][j];
            }
            response.tangent[7][i] = -self.overrun(self.apart_slope(i));
        }
        response.tangent[7][self.turns[0]] -= self.apart.dot(&quarter(self.beyond));
        response.residual[6] = gap.value + approach.value;
        response.residual[7] = -self.overrun(self.apart);
        response.tangent[6][6] = approach.slope;
        response
    }

    /// Corner on corner: both forces act, Eq. (C5).
    fn corner(&self, law: &ContactLaw, forces: [f64; FORCES]) -> JointResponse {
        let f = self.force(forces);
        let (compliance, growth) = secant(law, f);
        let v = self.apart + compliance * f;
        let mut response = JointResponse::zero();
        response.residual[6] = v.dot(&self.normals[0]);
        response.residual[7] = -self.overrun(v);
        for column in 0..COUPLED {
            let df = self.force_slope(forces, column);
            let mut dv = compliance * df + growth * f.dot(&df) * f;
            if column < 6 {
                dv += self.apart_slope(column);
            }
            response.tangent[6][column] = dv.dot(&self.normals[0]);
            response.tangent[7][column] = -self.overrun(dv);
            for row in 0..6 {
                response.tangent[row][column] = -df.dot(&self.apart_slope(row));
            }
        }
        response.tangent[6][self.turns[0]] += v.dot(&quarter(self.normals[0]));
        response.tangent[7][self.turns[0]] -= v.dot(&quarter(self.beyond));
        for row in 0..6 {
            response.residual[row] = -f.dot(&self.apart_slope(row));
        }
        // Turning an arm turns the direction in which its corner moves.
        response.tangent[2][2] += f.dot(&self.arms[0]);
        response.tangent[5][5] -= f.dot(&self.arms[1]);
        response
    }

    /// `∂D/∂q` for a coordinate of the pair.
    fn apart_slope(&self, coordinate: usize) -> Vec2 {
        match coordinate {
            0 => Vec2::x(),
            1 => Vec2::y(),
            2 => quarter(self.arms[0]),
            3 => -Vec2::x(),
            4 => -Vec2::y(),
            _ => -quarter(self.arms[1]),
        }
    }

    /// `∂f` for any of the coupled unknowns.
    fn force_slope(&self, forces: [f64; FORCES], column: usize) -> Vec2 {
        let mut slope = Vec2::zeros();
        for (k, force) in forces.into_iter().enumerate() {
            if column == 6 + k {
                slope += self.normals[k];
            } else if column == self.turns[k] {
                slope += force * quarter(self.normals[k]);
            }
        }
        slope
    }
}

/// `h = δ/|f|` and `h'/|f|`, such that `d(h f) = h df + (h'/|f|) (f·df) f`.
fn secant(law: &ContactLaw, f: Vec2) -> (f64, f64) {
    let force = f.norm();
    if force == 0.0 {
        return (law.approach(0.0).slope, 0.0);
    }
    let approach = law.approach(force);
    let secant = approach.value / force;
    (secant, (approach.slope - secant) / (force * force))
}

#[cfg(test)]
mod tests {
    use super::{COUPLED, Joint, JointResponse, Level};
    use crate::gap::{Kind, Pair, Pose};
    use crate::law::{ContactLaw, Law};
    use approx::assert_relative_eq;
    use geometry::Parallelogram;
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
        at_corner: bool,
    }

    impl Case {
        fn at(&self, z: &[f64; COUPLED]) -> JointResponse {
            let (left, right) = (Pose::new(z[0], z[1], z[2]), Pose::new(z[3], z[4], z[5]));
            let forces = if self.at_corner { [z[6], z[7]] } else { [z[6], 0.0] };
            self.joint.response(&self.pair, &self.law, [&left, &right], forces, self.at_corner)
        }
    }

    fn case(kind: usize, slant: f64, law: Law, at_corner: bool) -> Case {
        let (level, kind) = KINDS[kind];
        let pair = Pair::new(Parallelogram::new(0.4, slant).unwrap(), 1.0);
        // A soft law, so that its part of the tangent is seen.
        let law = ContactLaw::new(law, 0.8, 1.0, 3.0).unwrap();
        Case { joint: Joint { level, kind: Some(kind) }, pair, law, at_corner }
    }

    proptest! {
        #[test]
        fn tangents_agree_with_finite_differences(
            kind in 0_usize..4, slant in 0.0_f64..80.0, printed: bool, at_corner: bool,
            q in prop::array::uniform6(-0.5_f64..0.5), forces in prop::array::uniform2(0.2_f64..2.0),
        ) {
            let law = if printed { Law::PRINTED } else { Law::EXCHANGED };
            let case = case(kind, slant, law, at_corner);
            let z = [q[0], q[1], q[2], q[3], q[4], q[5], forces[0], forces[1]];
            let ours = case.at(&z).tangent;
            let h = 1e-6;
            for j in 0..if at_corner { COUPLED } else { COUPLED - 1 } {
                let (mut low, mut high) = (z, z);
                low[j] -= h;
                high[j] += h;
                let (low, high) = (case.at(&low).residual, case.at(&high).residual);
                for i in 0..COUPLED {
                    let difference = (high[i] - low[i]) / (2.0 * h);
                    assert_relative_eq!(ours[i][j], difference, epsilon = 1e-6, max_relative = 1e-6);
                }
            }
        }
    }

    /// Two blocks with relative rotation, the corner of the left exactly at the end of the right one's edge.
    #[test]
    fn edge_and_corner_agree_where_one_becomes_the_other() {
        for (k, slant) in [(0, 40.0), (1, 40.0), (2, 20.0), (3, 20.0)] {
            let case = |at_corner| case(k, slant, Law::EXCHANGED, at_corner);
            let (force, phi) = (0.7, [-0.05, 0.03]);
            // Place the left scale so that D = −δ m: then the foot is at the end of the edge.
            let edge = case(false);
            let at = |x: f64, y: f64| [x, y, phi[0], 0.0, 0.0, phi[1], force, 0.0];
            let (mut x, mut y) = (0.0, 0.0);
            for _ in 0..30 {
                let response = edge.at(&at(x, y));
                let [a, b] = [response.residual[6], response.residual[7]];
                let t = response.tangent;
                let determinant = t[6][0] * t[7][1] - t[6][1] * t[7][0];
                x -= (a * t[7][1] - b * t[6][1]) / determinant;
                y -= (b * t[6][0] - a * t[7][0]) / determinant;
            }
            let (edge, corner) = (edge.at(&at(x, y)), case(true).at(&at(x, y)));
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
                joint.response(&pair, &law, [&left, &right], [0.1, 0.0], false).residual[7]
            };
            assert!(short(&joint) > 0.0, "{level:?}");
            joint.hand_over();
            assert!(short(&joint) < 0.0, "{level:?}");
        }
    }
}
