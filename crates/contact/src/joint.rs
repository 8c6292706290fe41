//! The upper and the lower contact of a pair of neighbours, from open to edge to corner and on.

#[cfg(test)]
mod tests;

use std::f64::consts::FRAC_PI_2;

use geometry::{Corner, Vec2};

use crate::gap::{Gap, Kind, Pair, Pose, quarter};
use crate::law::{Approach, ContactLaw};

/// Where the contacts of a pair are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Between the tops.
    Upper,
    /// Between the bases.
    Lower,
}

impl Level {
    /// The kind in which the sharp corner of this level, the tip, rests on the neighbour's top or base.
    fn tip_on_end(self) -> Kind {
        match self {
            Self::Upper => Kind::TopRightOnTop,
            Self::Lower => Kind::BottomLeftOnBase,
        }
    }

    /// The kind in which the tip rests on the neighbour's side.
    fn tip_on_side(self) -> Kind {
        match self {
            Self::Upper => Kind::TopRightOnLeftEdge,
            Self::Lower => Kind::BottomLeftOnRightEdge,
        }
    }

    /// The kind in which the neighbour's corner rests on the side that ends in the tip.
    fn corner_on_side(self) -> Kind {
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

/// Unknowns of a joint: the force of its kind, that of its partner's kind, and that of the contact beside it.
pub const FORCES: usize = 3;

/// Unknowns that a joint couples: `(x, y, φ)` of the left and of the right scale, and the forces.
pub const COUPLED: usize = 6 + FORCES;

/// Gap of a joint where no corner faces an edge: open.
const FAR: f64 = 1.0;

/// Edges at a smaller angle than this (radians) count as parallel. There the force turns from one normal to the
/// other within round-off of a stiff contact, so it is handed over at once: the path skips a part
/// of it as small as this angle.
const FLUSH: f64 = 1e-6;

/// The contact of neighbours at one level, as three complementarity conditions.
///
/// Two corners meet here, `P` of the left and `Q` of the right scale, and each may rest on an
/// edge that ends in the other. With the normals `m_A` (of the right scale's left edge) and `m_B` (inward, of
/// the left scale's right edge), both pointing left, and `D = P − Q`:
///
/// ```text
/// kind A,  P on the left edge:   force  λ m_A on P,  gap D·m_A
/// kind B,  Q on the right edge:  force −λ m_B on Q,  gap D·m_B
/// ```
///
/// One of the two, `P` above and `Q` below, is as sharp as the scales are slanted: the *tip*. Where the side that ends
/// in it leans beyond the level of the neighbour's end, its top or base, the neighbour's corner cannot rest on that
/// side, but the tip can rest on that end, whose normal `m` takes the place of the side's:
///
/// ```text
/// kind C,  P on the top, or Q on the base:   gap D·m
/// ```
///
/// A corner that slides to the end of its edge meets the other corner. The force cannot jump from
/// one normal to the other: it turns between them while the corners stay together. There both
/// forces act, and the law holds along their sum,
///
/// ```text
/// v ≡ D + δ(|f|) f/|f| = 0,    f = λ m + λ' m'                                     (C5)
/// ```
///
/// With the kind's own force `λ`, normal `m` and edge direction `s`, `λ'` and `m'` those of its partner, and `σ = ±1` for
/// the end of the edge at which the partner waits, this is
///
/// ```text
/// 0 ≤ λ   ⟂   v·m ≥ 0         (closed or open)
/// 0 ≤ λ'  ⟂  −σ v·s ≥ 0       (at the end of the edge or short of it)              (C6)
/// ```
///
/// and `v·m = g + δ(λ)` while `λ' = 0`. When `λ` vanishes before `λ'`, the partner's kind takes over.
///
/// While the side is level with the neighbour's end they lie flush: the corner rests on the side and, *beside* it, the
/// tip on the end. Both contacts act while the force moves from one to the other, and the law holds for their
/// sum. With the angle `β ≥ 0` by which the side is short of level, or beyond it where the tip alone rests,
///
/// ```text
/// 0 ≤ λ    ⟂  g + δ(λ + λ'') ≥ 0
/// 0 ≤ λ''  ⟂  β ≥ 0                                                                (C7)
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

    /// Which corner meets which edge; `None` before the joint has
    /// closed; an open joint keeps the kind that it had.
    pub fn kind(&self) -> Option<Kind> {
        self.kind
    }

    /// The kind of the contact beside it where side and end lie flush; `None` for a tip on a side.
    pub fn beside(&self) -> Option<Kind> {
        let [side, tip] = [self.level.corner_on_side(), self.level.tip_on_end()];
        match self.kind {
            Some(kind) if kind == side => Some(tip),
            Some(kind) if kind == tip => Some(side),
            _ => None,
        }
    }

    /// The joint with the kind that the poses of an open joint give it.
    #[must_use]
    pub fn facing(self, pair: &Pair, poses: [&Pose; 2]) -> Self {
        Self { kind: self.nearest(pair, poses).map(|(kind, _)| kind), ..self }
    }

    /// The kind that the poses of an open joint give it, and its gap: of those whose corner has its foot within the
    /// edge, the one with the corner of the left scale before the other.
    fn nearest(self, pair: &Pair, poses: [&Pose; 2]) -> Option<(Kind, f64)> {
        let (leaning, on_side) = (self.leaning(pair, poses), self.level.tip_on_side());
        let kinds = match self.level {
            Level::Upper => [on_side, leaning],
            Level::Lower => [leaning, on_side],
        };
        pair.facing(kinds, poses)
    }

    /// Angle (radians) by which the side that ends in the tip leans beyond the level of the neighbour's end.
    fn beyond_level(self, pair: &Pair, [left, right]: [&Pose; 2]) -> f64 {
        let [of_left, of_right] = pair.scales();
        let turned = left.rotation - right.rotation;
        let from_the_vertical = match self.level {
            Level::Upper => of_left.slant() - turned,
            Level::Lower => of_right.slant() + turned,
        };
        from_the_vertical - FRAC_PI_2
    }

    /// `β` of (C7) for a contact `beside`, and its derivative with respect to the rotation of the left scale; with
    /// respect to that of the right one it is the opposite.
    fn angle(self, beside: Kind, pair: &Pair, poses: [&Pose; 2]) -> [f64; 2] {
        let toward = if beside == self.level.tip_on_end() { -1.0 } else { 1.0 };
        let turning = if self.level == Level::Upper { -1.0 } else { 1.0 };
        [toward * self.beyond_level(pair, poses), toward * turning]
    }

    /// Where the tip does not rest on a side: which of corner on side and tip on end is possible.
    fn leaning(self, pair: &Pair, poses: [&Pose; 2]) -> Kind {
        if self.beyond_level(pair, poses) > 0.0 {
            self.level.tip_on_end()
        } else {
            self.level.corner_on_side()
        }
    }

    /// The same two corners where they are together: what is on its side stays, the other one is as it leans.
    fn at_corner(self, kind: Kind, pair: &Pair, poses: [&Pose; 2]) -> [Kind; 2] {
        let (leaning, on_side) = (self.leaning(pair, poses), self.level.tip_on_side());
        if kind == on_side { [on_side, leaning] } else { [leaning, on_side] }
    }

    /// Passes the contact on to the partner's kind.
    pub fn hand_over(&mut self, pair: &Pair, poses: [&Pose; 2]) {
        self.kind = self.kind.map(|kind| self.at_corner(kind, pair, poses)[1]);
    }

    /// Leaves the corner with the kind that came, or with what has become of it there.
    pub fn leave_corner(&mut self, pair: &Pair, poses: [&Pose; 2]) {
        self.kind = self.kind.map(|kind| self.at_corner(kind, pair, poses)[0]);
    }

    /// Passes the contact on to the one beside it.
    pub fn pass_beside(&mut self) {
        self.kind = self.beside();
    }

    /// The conditions (C6) and (C7) of a joint of which no force acts.
    pub fn open(&self, pair: &Pair, poses: [&Pose; 2]) -> [f64; FORCES] {
        [self.nearest(pair, poses).map_or(FAR, |(_, gap)| gap), FAR, FAR]
    }

    /// Forces on the left scale, of the two corners on each other's edge and of the contact beside; the right scale
    /// takes their opposites.
    pub fn forces(&self, pair: &Pair, poses: [&Pose; 2], forces: [f64; FORCES]) -> [Vec2; 2] {
        let corners = self
            .kind
            .map(|kind| Corners::new(*self, kind, pair, poses, forces[1] != 0.0).force(forces));
        let beside = self.beside().map(|kind| forces[2] * kind.normal(pair, poses).0);
        [corners, beside].map(Option::unwrap_or_default)
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
        let Some(kind) = self.kind.filter(|_| active[0]) else {
            return JointResponse::open(self.open(pair, poses)[0]);
        };
        let corners = Corners::new(*self, kind, pair, poses, active[1]);
        if active[1] {
            return corners.corner(law, forces);
        }
        let approach = law.approach(forces[0] + forces[2]);
        let mut response = corners.edge(&pair.gap(kind, poses[0], poses[1]), approach, forces[0]);
        if let Some(beside) = self.beside() {
            let gap = pair.gap(beside, poses[0], poses[1]);
            if active[2] {
                response.add_force(2, &gap, forces[2]);
                response.tangent[6][8] = approach.slope;
            }
            if active[2] || self.within_far_end(beside, &gap) {
                let [angle, slope] = self.angle(beside, pair, poses);
                response.residual[8] = angle;
                (response.tangent[8][2], response.tangent[8][5]) = (slope, -slope);
            }
        }
        response
    }

    /// Whether a corner has not passed the end of its edge that is far from where the corners meet.
    fn within_far_end(self, kind: Kind, gap: &Gap) -> bool {
        match (self.level, kind == self.level.tip_on_end()) {
            (Level::Upper, true) | (Level::Lower, false) => gap.foot <= 1.0,
            (Level::Upper, false) | (Level::Lower, true) => gap.foot >= 0.0,
        }
    }
}

impl JointResponse {
    /// Nothing acts, and only the gap between the corners and the edges is at hand.
    fn open(gap: f64) -> Self {
        let mut residual = [0.0; COUPLED];
        residual[6..].copy_from_slice(&[gap, FAR, FAR]);
        Self { residual, tangent: [[0.0; COUPLED]; COUPLED] }
    }

    /// Adds what one of the forces, which acts along a gap, does to the balance.
    fn add_force(&mut self, number: usize, gap: &Gap, force: f64) {
        let column = 6 + number;
        for i in 0..6 {
            self.residual[i] -= force * gap.gradient[i];
            self.tangent[i][column] = -gap.gradient[i];
            for j in 0..6 {
                self.tangent[i][j] -= force * gap.hessian[i][j];
            }
        }
    }
}

impl Kind {
    /// The direction of its force on the left scale, and the column of the rotation with which that turns.
    fn normal(self, pair: &Pair, [left, right]: [&Pose; 2]) -> (Vec2, usize) {
        let [of_left, of_right] = pair.normals();
        match self {
            Self::TopRightOnLeftEdge | Self::BottomRightOnLeftEdge => (right.turn(of_right), 5),
            Self::TopLeftOnRightEdge | Self::BottomLeftOnRightEdge => (left.turn(of_left), 2),
            Self::TopRightOnTop => (right.turn(Vec2::y()), 5),
            Self::BottomLeftOnBase => (left.turn(Vec2::y()), 2),
        }
    }
}

/// The two corners of a joint and the directions at them.
struct Corners {
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

impl Corners {
    fn new(joint: Joint, kind: Kind, pair: &Pair, poses: [&Pose; 2], together: bool) -> Self {
        let [left, right] = poses;
        let [p, q] = joint.level.corners();
        let [of_left, of_right] = pair.scales();
        let arms = [left.turn(of_left.corner(p)), right.turn(of_right.corner(q))];
        let apart = (left.displacement - right.displacement) + (arms[0] - arms[1])
            - Vec2::new(pair.pitch(), 0.0);
        let [own, partner] = joint.at_corner(kind, pair, poses);
        let own = if together { own } else { kind };
        let [(own, own_turns), (partner, partner_turns)] =
            [own, partner].map(|kind| kind.normal(pair, poses));
        // A normal that points left, turned clockwise, points up its edge. The tip leaves the neighbour's side, and the
        // neighbour's corner the side of the tip, towards its end.
        let beyond = if kind == joint.level.tip_on_side() { -quarter(own) } else { quarter(own) };
        Self { apart, arms, normals: [own, partner], turns: [own_turns, partner_turns], beyond }
    }

    fn force(&self, forces: [f64; FORCES]) -> Vec2 {
        forces[0] * self.normals[0] + forces[1] * self.normals[1]
    }

    /// How far a vector reaches beyond the end of the edge.
    fn overrun(&self, v: Vec2) -> f64 {
        v.dot(&self.beyond)
    }

    /// The corner on the edge: the first force alone acts, where the corner is.
    fn edge(&self, gap: &Gap, approach: Approach, force: f64) -> JointResponse {
        let mut response = JointResponse::open(gap.value + approach.value);
        response.add_force(0, gap, force);
        response.tangent[6][6] = approach.slope;
        for i in 0..6 {
            response.tangent[6][i] = gap.gradient[i];
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
