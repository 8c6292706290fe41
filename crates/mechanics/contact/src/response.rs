//! Forces and complementarity conditions of a contact of two corners, with derivatives.

use geometry::Vec2;

use crate::corner_contact::{CornerContact, FORCES, Force};
use crate::corners::Corners;
use crate::gap::{CornerEdge, Gap, Pair, Pose, quarter};
use crate::law::ContactLaw;

/// Number of coordinates of a pair: `(x, y, φ)` of the left and of the right scale.
pub const COORDINATES: usize = 6;

/// Indices of the rotations of the two scales among the coordinates.
pub(crate) const ROTATIONS: [usize; 2] = [2, 5];

/// Value of an equation of the system, with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Equation {
    /// Value: the residual of a balance, or the left-hand side of a condition `… ≥ 0`.
    pub value: f64,
    /// Derivatives with respect to the coordinates of the pair.
    pub by_coordinate: [f64; COORDINATES],
    /// Derivatives with respect to the three contact forces, in the order of [`Force::ALL`].
    pub by_force: [f64; FORCES],
}

/// Contribution of a contact of two corners to the equations of a system.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CornerResponse {
    /// Negative generalised force of the contact on each coordinate of the pair.
    pub balance: [Equation; COORDINATES],
    /// Condition (C6) or (C7) of each force; it is satisfied if its value is not negative.
    ///
    /// `None` for a force that cannot begin to act in this state.
    pub conditions: [Option<Equation>; FORCES],
}

impl CornerContact {
    /// Evaluates balance and conditions, with derivatives, at the given `forces`.
    pub fn response(
        self,
        corners: &Corners,
        law: &ContactLaw,
        forces: [f64; FORCES],
    ) -> CornerResponse {
        let mut response = self.acting_response(corners, law, forces, 0.0);
        let resting = self.resting_conditions(corners);
        for (condition, resting) in response.conditions.iter_mut().zip(resting) {
            *condition = condition.or(resting);
        }
        response
    }

    /// Evaluates the condition under which each force that does not act begins to act.
    ///
    /// `None` for a force that acts, or that cannot begin to act.
    pub fn resting_conditions(self, corners: &Corners) -> [Option<Equation>; FORCES] {
        match self {
            Self::Open => [open_condition(corners), None, None],
            Self::Edge(edge) => {
                let flush = edge.flush().filter(|&flush| corners.is_within_far_end(flush));
                let flush = flush.map(|flush| flush_condition(corners, flush));
                [None, Some(partner_condition(edge, corners)), flush]
            }
            Self::Corner(_) => [None; FORCES],
            Self::Flush(edge) => [None, Some(partner_condition(edge, corners)), None],
        }
    }

    /// Evaluates the balance, and the conditions of the forces that act.
    ///
    /// `friction_ratio` is used only for corner on corner. It is the ratio of friction to normal
    /// force at the time when the corners coincided. For each normal force on the left scale, the
    /// balance contains a friction force: the normal force times `friction_ratio`, rotated by 90°
    /// counter-clockwise, at the corner of this normal force. Friction does not enter the contact
    /// law.
    pub fn acting_response(
        self,
        corners: &Corners,
        law: &ContactLaw,
        forces: [f64; FORCES],
        friction_ratio: f64,
    ) -> CornerResponse {
        match self {
            Self::Open => CornerResponse::default(),
            Self::Edge(edge) => CornerResponse::edge(edge, corners, law, forces),
            Self::Corner(edge) => {
                let edges = corners.together(edge);
                let mut response = Together::new(corners, edges).response(law, forces);
                // Each friction force acts at the corner that rests on its edge. The corners are
                // the approach `δ` apart, so with one common point of action the moments would
                // jump when a corner reaches or leaves the end of its edge.
                if friction_ratio != 0.0 {
                    for (which, edge) in [Force::Own, Force::Partner].into_iter().zip(edges) {
                        response.add_force(which, &corners.slide(edge), forces, friction_ratio);
                    }
                }
                response
            }
            Self::Flush(edge) => {
                let mut response = CornerResponse::edge(edge, corners, law, forces);
                // `flush()` is always `Some`, because a tip on a side never becomes flush.
                if let Some(flush) = edge.flush() {
                    response.add_force(Force::Flush, &corners.gap(flush), forces, 1.0);
                    response.conditions[Force::Flush as usize] =
                        Some(flush_condition(corners, flush));
                }
                response
            }
        }
    }

    /// Returns the contact forces on the left scale, as two vectors.
    ///
    /// The first vector is the sum of the forces `λ` and `λ'`, the second vector is the force `λ''`
    /// of the flush contact. The forces on the right scale are opposite.
    pub fn forces_on_left(self, corners: &Corners, forces: [f64; FORCES]) -> [Vec2; 2] {
        let [own, partner, flush] = forces;
        match self {
            Self::Open => [Vec2::zeros(); 2],
            Self::Edge(edge) => [own * corners.normal(edge), Vec2::zeros()],
            Self::Corner(edge) => {
                let [first, second] = corners.together(edge).map(|edge| corners.normal(edge));
                [own * first + partner * second, Vec2::zeros()]
            }
            Self::Flush(edge) => {
                let beside = edge.flush().map_or(Vec2::zeros(), |edge| corners.normal(edge));
                [own * corners.normal(edge), flush * beside]
            }
        }
    }
}

impl CornerResponse {
    /// Evaluates a corner on an edge: balance, and the first condition of (C6) or (C7).
    fn edge(edge: CornerEdge, corners: &Corners, law: &ContactLaw, forces: [f64; FORCES]) -> Self {
        let gap = corners.gap(edge);
        let approach = law.approach(forces[Force::Own as usize] + forces[Force::Flush as usize]);
        let condition = Equation {
            value: gap.value + approach.value,
            by_coordinate: gap.gradient,
            by_force: [approach.slope, 0.0, approach.slope],
        };
        let (force, hessian) = (forces[Force::Own as usize], gap.curvature.hessian());
        let balance = std::array::from_fn(|i| Equation {
            value: -force * gap.gradient[i],
            by_coordinate: hessian[i].map(|hessian| -force * hessian),
            by_force: [-gap.gradient[i], 0.0, 0.0],
        });
        Self { balance, conditions: [Some(condition), None, None] }
    }

    /// Adds to the balance the force `which`, multiplied by `ratio`.
    ///
    /// `gap` is the coordinate in the direction of the force: a gap, or a slide for friction.
    fn add_force(&mut self, which: Force, gap: &Gap, forces: [f64; FORCES], ratio: f64) {
        let (force, hessian) = (ratio * forces[which as usize], gap.curvature.hessian());
        for (i, row) in self.balance.iter_mut().enumerate() {
            row.value -= force * gap.gradient[i];
            row.by_force[which as usize] -= ratio * gap.gradient[i];
            for (slope, hessian) in row.by_coordinate.iter_mut().zip(hessian[i]) {
                *slope -= force * hessian;
            }
        }
    }
}

/// Evaluates the condition of an open contact, its gap; `None` if no corner faces an edge.
fn open_condition(corners: &Corners) -> Option<Equation> {
    let (edge, position) = corners.facing_position()?;
    let (value, by_coordinate) = (position.gap, position.gradient(edge));
    Some(Equation { value, by_coordinate, ..Equation::default() })
}

/// Evaluates the second condition of (C6) for a corner on an edge while `λ' = 0`.
fn partner_condition(edge: CornerEdge, corners: &Corners) -> Equation {
    let [_, partner] = corners.together(edge);
    Together::new(corners, [edge, partner]).short_of_the_end()
}

/// Evaluates the condition `β ≥ 0` of (C7).
fn flush_condition(corners: &Corners, flush: CornerEdge) -> Equation {
    let angle = corners.angle_to_flush(flush);
    let mut condition = Equation { value: angle.value, ..Equation::default() };
    let [left, right] = ROTATIONS;
    condition.by_coordinate[left] = angle.slope;
    condition.by_coordinate[right] = -angle.slope;
    condition
}

impl CornerEdge {
    /// Returns the direction of the contact force on the left scale.
    ///
    /// The second value is the index of the coordinate, the rotation of the scale with the edge,
    /// with which the direction rotates.
    pub(crate) fn normal(self, pair: &Pair, [left, right]: [&Pose; 2]) -> (Vec2, usize) {
        let (normal, [with_left, with_right]) = (pair.normal(self), ROTATIONS);
        // The force on the scale with the corner acts along the outward normal of the edge, the
        // force on the scale with the edge in the opposite direction.
        if self.corner_is_left() {
            (right.turn(normal), with_right)
        } else {
            (left.turn(-normal), with_left)
        }
    }
}

/// Relative position of the two corners `P` and `Q` of a level, and the directions of their forces.
pub(crate) struct Together {
    /// Vector `D = P − Q`.
    apart: Vec2,
    /// Vectors from the node of the left scale to `P` and from the node of the right scale to `Q`.
    pub(crate) arms: [Vec2; 2],
    /// Normal `m` of the own contact and normal `m'` of its partner.
    pub(crate) normals: [Vec2; 2],
    /// Index of the coordinate, a rotation, with which each of the two normals rotates.
    turns: [usize; 2],
    /// Direction `σ s` along the edge of the own contact.
    ///
    /// `D·σs` is positive if the corner of the own contact has passed the end of its edge.
    beyond: Vec2,
}

impl Together {
    /// Computes the relative position for the own contact `own` and its partner.
    pub(crate) fn new(corners: &Corners, [own, partner]: [CornerEdge; 2]) -> Self {
        let Corners { level, pair, poses } = *corners;
        let [left, right] = poses;
        let [p, q] = level.corners();
        let [of_left, of_right] = pair.scales();
        let arms = [left.turn(of_left.corner(p)), right.turn(of_right.corner(q))];
        let apart = (left.displacement - right.displacement) + (arms[0] - arms[1]) - pair.offset();
        let [(normal, turn), (other_normal, other_turn)] =
            [own, partner].map(|edge| edge.normal(pair, poses));
        // If the tip passes the end of the neighbour's side, `D` points up along this side: along
        // the normal, which points to the left, rotated clockwise. In the other two contacts `D`
        // points along the normal rotated counter-clockwise.
        let beyond = if own == level.tip_on_side() { -quarter(normal) } else { quarter(normal) };
        Self { apart, arms, normals: [normal, other_normal], turns: [turn, other_turn], beyond }
    }

    /// Returns the component `v·σs` of a vector along the edge of the own contact.
    pub(crate) fn overrun(&self, v: Vec2) -> f64 {
        v.dot(&self.beyond)
    }

    /// Returns the components `v·m` and `−v·σs` of (C6).
    fn distances(&self, v: Vec2) -> [f64; 2] {
        [v.dot(&self.normals[0]), -self.overrun(v)]
    }

    /// Evaluates the second condition of (C6) with `v = D`, while the partner's force is 0.
    fn short_of_the_end(&self) -> Equation {
        let mut condition = Equation { value: -self.overrun(self.apart), ..Equation::default() };
        for (i, slope) in condition.by_coordinate.iter_mut().enumerate() {
            *slope = -self.overrun(self.apart_slope(i));
        }
        // The direction `σs` rotates with the scale of the edge.
        condition.by_coordinate[self.turns[0]] -= self.apart.dot(&quarter(self.beyond));
        condition
    }

    /// Evaluates the state corner on corner, in which both forces act, by (C5) and (C6).
    fn response(&self, law: &ContactLaw, [own, partner, _]: [f64; FORCES]) -> CornerResponse {
        let force = own * self.normals[0] + partner * self.normals[1];
        let turning = std::array::from_fn(|i| self.force_slope([own, partner], i));
        let [closed, at_end] = self.conditions(law, force, &turning);
        let balance = self.balance(force, &turning, self.normals);
        CornerResponse { balance, conditions: [Some(closed), Some(at_end), None] }
    }

    /// Evaluates both conditions (C6) under a force `f`.
    ///
    /// `turning` contains the derivative of `f` with respect to each coordinate of the pair.
    fn conditions(
        &self,
        law: &ContactLaw,
        f: Vec2,
        turning: &[Vec2; COORDINATES],
    ) -> [Equation; 2] {
        let secant = Secant::new(law, f);
        let v = self.apart + secant.compliance * f;
        let [mut closed, mut at_end] =
            self.distances(v).map(|value| Equation { value, ..Equation::default() });
        for (i, &df) in turning.iter().enumerate() {
            let dv = secant.slope(f, df) + self.apart_slope(i);
            [closed.by_coordinate[i], at_end.by_coordinate[i]] = self.distances(dv);
        }
        for (k, &normal) in self.normals.iter().enumerate() {
            [closed.by_force[k], at_end.by_force[k]] = self.distances(secant.slope(f, normal));
        }
        closed.by_coordinate[self.turns[0]] += v.dot(&quarter(self.normals[0]));
        at_end.by_coordinate[self.turns[0]] -= v.dot(&quarter(self.beyond));
        [closed, at_end]
    }

    /// Evaluates the balance of both scales under a force `f`.
    ///
    /// `turning` contains the derivative of `f` with respect to each coordinate, `parts` the
    /// derivatives of `f` with respect to `λ` and `λ'`.
    fn balance(
        &self,
        f: Vec2,
        turning: &[Vec2; COORDINATES],
        parts: [Vec2; 2],
    ) -> [Equation; COORDINATES] {
        let mut balance = std::array::from_fn(|row| {
            let moved = self.apart_slope(row);
            let [own, partner] = parts.map(|part| -part.dot(&moved));
            Equation {
                value: -f.dot(&moved),
                by_coordinate: turning.map(|df| -df.dot(&moved)),
                by_force: [own, partner, 0.0],
            }
        });
        // A rotation of a scale also rotates the direction in which a further rotation moves its
        // corner.
        let [left, right] = ROTATIONS;
        balance[left].by_coordinate[left] += f.dot(&self.arms[0]);
        balance[right].by_coordinate[right] -= f.dot(&self.arms[1]);
        balance
    }

    /// Returns the derivative of `D` with respect to a coordinate of the pair.
    pub(crate) fn apart_slope(&self, coordinate: usize) -> Vec2 {
        match coordinate {
            0 => Vec2::x(),
            1 => Vec2::y(),
            2 => quarter(self.arms[0]),
            3 => -Vec2::x(),
            4 => -Vec2::y(),
            _ => -quarter(self.arms[1]),
        }
    }

    /// Returns the derivative of the force `f` with respect to a coordinate of the pair.
    ///
    /// The derivative is zero for displacements. A normal rotates with the scale of its edge.
    fn force_slope(&self, forces: [f64; 2], coordinate: usize) -> Vec2 {
        let mut slope = Vec2::zeros();
        for ((&normal, &turn), force) in self.normals.iter().zip(&self.turns).zip(forces) {
            if coordinate == turn {
                slope += force * quarter(normal);
            }
        }
        slope
    }
}

/// Secant compliance `h = δ/|f|` of the contact law under a force `f`, with its derivative.
///
/// With a prime for the derivative by `|f|`, `δ f/|f| = h f` and
/// `d(h f) = h df + (h'/|f|) (f·df) f`.
pub(crate) struct Secant {
    /// Secant compliance `h`.
    pub(crate) compliance: f64,
    /// Coefficient `h'/|f|`.
    pub(crate) growth: f64,
}

impl Secant {
    /// Evaluates the contact law under the force `f`.
    pub(crate) fn new(law: &ContactLaw, f: Vec2) -> Self {
        let force = f.norm();
        if force == 0.0 {
            // In the limit of zero force the secant compliance is the slope of the law.
            return Self { compliance: law.approach(0.0).slope, growth: 0.0 };
        }
        let approach = law.approach(force);
        let compliance = approach.value / force;
        Self { compliance, growth: (approach.slope - compliance) / (force * force) }
    }

    /// Returns the change `d(h f)` for a change `df` of the force.
    fn slope(&self, f: Vec2, df: Vec2) -> Vec2 {
        self.compliance * df + self.growth * f.dot(&df) * f
    }
}
