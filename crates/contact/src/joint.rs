//! The upper and the lower contact of a pair of neighbours, from open to edge to corner and on.

#[cfg(test)]
mod tests;

use std::f64::consts::FRAC_PI_2;

use geometry::{Corner, Vec2};

use crate::gap::{Gap, Kind, Pair, Pose, quarter};
use crate::law::{Approach, ContactLaw};

/// Which of the two contacts of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Between the tops.
    Upper,
    /// Between the bases.
    Lower,
}

impl Level {
    /// The kind in which the sharp corner of this level meets the neighbour's top or base.
    pub fn tip(self) -> Kind {
        match self {
            Self::Upper => Kind::TopRightOnTop,
            Self::Lower => Kind::BottomLeftOnBase,
        }
    }

    /// The kind in which a corner rests on the side that ends in the tip.
    fn on_side_of_tip(self) -> Kind {
        match self {
            Self::Upper => Kind::TopLeftOnRightEdge,
            Self::Lower => Kind::BottomRightOnLeftEdge,
        }
    }

    /// The corners that meet: of the left and of the right scale.
    fn corners(self) -> [Corner; 2] {
        match self {
            Self::Upper => [Corner::TopRight, Corner::TopLeft],
            Self::Lower => [Corner::BottomRight, Corner::BottomLeft],
        }
    }
}

/// Unknowns of a joint: the force of its kind, the force of its partner's kind, and that of the tip.
pub const FORCES: usize = 3;

/// Unknowns that a joint couples: `(x, y, φ)` of the left and of the right scale, and the forces.
pub const COUPLED: usize = 6 + FORCES;

/// Gap of a joint where no corner faces an edge: open.
const FAR: f64 = 1.0;

/// Edges at a smaller angle than this (radians) count as parallel. There the force turns from one normal to the
/// other within round-off of a stiff contact, so it is handed over at once: the path skips a part
/// of it as small as this angle.
const FLUSH: f64 = 1e-6;

/// How nearly level a side must be with a top or base (radians) for a tip to meet it. Short of it the
/// corner at the other end of the side is nearer.
const NEARLY_LEVEL: f64 = 0.1;

/// The contact of neighbours at one level, as three complementarity conditions.
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
///
/// The tip, `P` above and `Q` below, is as sharp as the scales are slanted. Where the other corner rests on the side that
/// ends in the tip, and the side turns until it lies flush with the neighbour's top or base, the tip comes to
/// rest on that. Both contacts act while the force moves from one to the other, and the law holds for their sum:
///
/// ```text
/// 0 ≤ λ    ⟂  g  + δ(λ + λ'') ≥ 0
/// 0 ≤ λ''  ⟂  g'' + δ(λ + λ'') ≥ 0                                                 (C7)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Joint {
    level: Level,
    kind: Option<Kind>,
}

/// Residual and tangent of a joint in the coordinates of the pair and its three forces.
///
/// Rows 0 to 5 are what the contact subtracts from the balance of the two scales, rows 6 to 8 the
/// conditions of the three forces.
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

    /// The tip's gap, where it may meet the neighbour's top or base: its side nearly level with that, its foot
    /// within. A closed joint keeps it out of reach while the other corner rests elsewhere than on that side, or
    /// the corners are together.
    fn tip(
        self,
        pair: &Pair,
        [left, right]: [&Pose; 2],
        [own, partner, _]: [bool; FORCES],
    ) -> Option<Gap> {
        if partner || own && self.kind != Some(self.level.on_side_of_tip()) {
            return None;
        }
        let [of_left, of_right] = pair.scales();
        let turned = left.rotation - right.rotation;
        let beyond_level = match self.level {
            Level::Upper => of_left.slant() - turned,
            Level::Lower => of_right.slant() + turned,
        } - FRAC_PI_2;
        if beyond_level < -NEARLY_LEVEL {
            return None;
        }
        let gap = pair.gap(self.level.tip(), left, right);
        let (far_end, near_end) = match self.level {
            Level::Upper => (gap.foot <= 1.0, gap.foot >= 0.0),
            Level::Lower => (gap.foot >= 0.0, gap.foot <= 1.0),
        };
        // The other corner, when it rests on the side, is what keeps the tip from the near end.
        (far_end && (near_end || own)).then_some(gap)
    }

    /// Passes the contact on to the partner's kind.
    pub fn hand_over(&mut self) {
        self.kind = self.kind.and_then(Kind::partner);
    }

    /// The conditions (C6) and (C7) of a joint of which no force acts.
    pub fn open(&self, pair: &Pair, poses: [&Pose; 2]) -> [f64; FORCES] {
        let gap = self.nearest(pair, poses).map_or(FAR, |(_, gap)| gap);
        let tip = self.tip(pair, poses, [false; FORCES]).map_or(FAR, |gap| gap.value);
        [gap, FAR, tip]
    }

    /// Forces on the left scale, of the two corners on each other's edge and of the tip; the right scale takes
    /// their opposites.
    pub fn forces(
        &self,
        pair: &Pair,
        [left, right]: [&Pose; 2],
        forces: [f64; FORCES],
    ) -> [Vec2; 2] {
        let corners = self.kind.map_or_else(Vec2::zeros, |kind| {
            Corners::new(pair, kind, self.level, left, right).force(forces)
        });
        let tip = self.level.tip();
        let tip = match forces[2] {
            0.0 => Vec2::zeros(),
            force if tip.corner_is_left() => force * pair.gap(tip, left, right).normal,
            force => -force * pair.gap(tip, left, right).normal,
        };
        [corners, tip]
    }

    /// Whether the edges are so nearly parallel that the force need not turn at a corner.
    pub fn is_flush(pair: &Pair, [left, right]: [&Pose; 2]) -> bool {
        // A slant turns an edge clockwise.
        let [of_left, of_right] = pair.scales();
        let at_rest = of_left.slant() - of_right.slant();
        (left.rotation - right.rotation - at_rest).sin().abs() < FLUSH
    }

    /// Residual and tangent of a joint of which some forces are `active`.
    pub fn response(
        &self,
        pair: &Pair,
        law: &ContactLaw,
        poses: [&Pose; 2],
        forces: [f64; FORCES],
        active: [bool; FORCES],
    ) -> JointResponse {
        let [left, right] = poses;
        let together = if active[1] { forces[2] } else { forces[0] + forces[2] };
        let mut response = match self.kind {
            Some(kind) if active[0] => {
                let corners = Corners::new(pair, kind, self.level, left, right);
                if active[1] {
                    corners.corner(law, forces)
                } else {
                    corners.edge(pair, law.approach(together), forces[0])
                }
            }
            _ => {
                let gap = self.nearest(pair, poses).map_or(FAR, |(_, gap)| gap);
                JointResponse::open(gap + law.approach(together).value)
            }
        };
        let tip = self.level.tip();
        let reached = || self.tip(pair, poses, active);
        let gap = if active[2] { Some(pair.gap(tip, left, right)) } else { reached() };
        if let Some(gap) = gap {
            let approach = law.approach(together);
            response.add_force(2, &gap, approach, forces[2]);
            if !active[1] {
                response.tangent[6][8] = approach.slope;
                response.tangent[8][6] = approach.slope;
            }
        }
        response
    }
}

impl JointResponse {
    /// Nothing acts, and only the gap between the corners and the edges is at hand.
    fn open(gap: f64) -> Self {
        let mut residual = [0.0; COUPLED];
        residual[6..].copy_from_slice(&[gap, FAR, FAR]);
        Self { residual, tangent: [[0.0; COUPLED]; COUPLED] }
    }

    /// Adds one of the forces, which acts along a gap, and its condition.
    fn add_force(&mut self, number: usize, gap: &Gap, approach: Approach, force: f64) {
        let condition = 6 + number;
        for i in 0..6 {
            self.residual[i] -= force * gap.gradient[i];
            self.tangent[i][condition] = -gap.gradient[i];
            self.tangent[condition][i] = gap.gradient[i];
            for j in 0..6 {
                self.tangent[i][j] -= force * gap.hessian[i][j];
            }
        }
        self.residual[condition] = gap.value + approach.value;
        self.tangent[condition][condition] = approach.slope;
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
        let [of_left, of_right] = pair.normals();
        let (from_right, from_left) = (right.turn(of_right), left.turn(of_left));
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
    fn edge(&self, pair: &Pair, approach: Approach, force: f64) -> JointResponse {
        let gap = pair.gap(self.kind, self.left, self.right);
        let mut response = JointResponse::open(gap.value);
        response.add_force(0, &gap, approach, force);
        for i in 0..6 {
            response.tangent[7][i] = -self.overrun(self.apart_slope(i));
        }
        response.tangent[7][self.turns[0]] -= self.apart.dot(&quarter(self.beyond));
        response.residual[7] = -self.overrun(self.apart);
        response
    }

    /// Corner on corner: both forces act, Eq. (C5).
    fn corner(&self, law: &ContactLaw, forces: [f64; FORCES]) -> JointResponse {
        let f = self.force(forces);
        let (compliance, growth) = secant(law, f);
        let v = self.apart + compliance * f;
        let mut response = JointResponse::open(0.0);
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
        for (k, &force) in forces[..2].iter().enumerate() {
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
