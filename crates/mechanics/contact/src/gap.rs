//! Gap between a corner of one scale and an edge of its neighbour.

#[cfg(test)]
mod tests;

use geometry::{Corner, Parallelogram, Vec2};

/// Displacement and rotation of a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Displacement of the node, over `t`.
    pub displacement: Vec2,
    /// Rotation `φ`, counter-clockwise, radians.
    pub rotation: f64,
    cos: f64,
    sin: f64,
}

impl Pose {
    /// Creates the pose with node displacements `x`, `y` and `rotation`.
    pub fn new(x: f64, y: f64, rotation: f64) -> Self {
        // Computed once for all vectors that turn with the scale.
        let (sin, cos) = rotation.sin_cos();
        Self { displacement: Vec2::new(x, y), rotation, cos, sin }
    }

    /// Rotates a vector with the scale.
    pub fn turn(&self, v: Vec2) -> Vec2 {
        Vec2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }
}

/// Corner of one scale and edge of its neighbour that may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CornerEdge {
    /// Top right corner of the left scale on the left edge of the right scale.
    TopRightOnLeftEdge,
    /// Top left corner of the right scale on the right edge of the left scale.
    TopLeftOnRightEdge,
    /// Bottom right corner of the left scale on the left edge of the right scale.
    BottomRightOnLeftEdge,
    /// Bottom left corner of the right scale on the right edge of the left scale.
    BottomLeftOnRightEdge,
    /// Top right corner of the left scale on the top of the right scale.
    TopRightOnTop,
    /// Bottom left corner of the right scale on the base of the left scale.
    BottomLeftOnBase,
}

impl CornerEdge {
    /// All six combinations, the tips on a top or a base last.
    // In the order of the variants: a pair indexes its corners and edges by variant.
    pub const ALL: [Self; 6] = [
        Self::TopRightOnLeftEdge,
        Self::TopLeftOnRightEdge,
        Self::BottomRightOnLeftEdge,
        Self::BottomLeftOnRightEdge,
        Self::TopRightOnTop,
        Self::BottomLeftOnBase,
    ];

    /// Returns the name, the corner and the edge.
    fn parts(self) -> (&'static str, Corner, fn(&Parallelogram) -> Edge) {
        match self {
            Self::TopRightOnLeftEdge => ("TR on left edge", Corner::TopRight, Edge::left),
            Self::TopLeftOnRightEdge => ("TL on right edge", Corner::TopLeft, Edge::right),
            Self::BottomRightOnLeftEdge => ("BR on left edge", Corner::BottomRight, Edge::left),
            Self::BottomLeftOnRightEdge => ("BL on right edge", Corner::BottomLeft, Edge::right),
            Self::TopRightOnTop => ("TR on top", Corner::TopRight, Edge::top),
            Self::BottomLeftOnBase => ("BL on base", Corner::BottomLeft, Edge::base),
        }
    }

    /// Returns the short name used in tables.
    pub fn name(self) -> &'static str {
        self.parts().0
    }

    /// Returns the corner that touches.
    pub fn corner(self) -> Corner {
        self.parts().1
    }

    /// Returns true if the corner belongs to the left scale of the pair.
    pub fn corner_is_left(self) -> bool {
        matches!(self, Self::TopRightOnLeftEdge | Self::BottomRightOnLeftEdge | Self::TopRightOnTop)
    }

    /// Returns the contact at the other end of two edges that lie flush.
    ///
    /// For the tip on the neighbour's end this is the neighbour's corner on the side of the tip,
    /// and vice versa. `None` for a tip on a side.
    pub fn flush(self) -> Option<Self> {
        match self {
            Self::TopLeftOnRightEdge => Some(Self::TopRightOnTop),
            Self::TopRightOnTop => Some(Self::TopLeftOnRightEdge),
            Self::BottomRightOnLeftEdge => Some(Self::BottomLeftOnBase),
            Self::BottomLeftOnBase => Some(Self::BottomRightOnLeftEdge),
            Self::TopRightOnLeftEdge | Self::BottomLeftOnRightEdge => None,
        }
    }
}

/// Gap with its derivatives with respect to the six coordinates of a pair.
///
/// The coordinates are `(x, y, φ)` of the left and `(x, y, φ)` of the right scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// `g`, over `t`; negative where the corner has passed the edge.
    pub value: f64,
    /// `∇g`.
    pub gradient: [f64; 6],
    /// `∇²g`, by its nonzero entries.
    pub curvature: Curvature,
    /// Position of the foot of the corner on the edge, from 0 to 1.
    ///
    /// It is 0 at the base, or at the left end of a base or a top.
    pub foot: f64,
    /// Outward normal of the edge: the direction of the force on the corner.
    pub normal: Vec2,
}

/// Nonzero second derivatives (C3) of a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// True if the left scale has the corner.
    pub corner_is_left: bool,
    /// `n'`: by the displacement of the corner's scale and the rotation of the edge's scale.
    ///
    /// By the displacement of the edge's scale the derivative is opposite.
    pub normal_turned: Vec2,
    /// `ρ·n`: by both rotations; opposite by the rotation of the corner's scale twice.
    pub arm: f64,
    /// `−D·n`: by the rotation of the edge's scale twice.
    pub distance: f64,
}

impl Curvature {
    /// Returns `∇²g`, a symmetric matrix.
    pub fn hessian(&self) -> [[f64; 6]; 6] {
        // First coordinates of the scale with the corner (A) and of the scale with the edge (B).
        let (a, b) = if self.corner_is_left { (0, 3) } else { (3, 0) };
        let mut hessian = [[0.0; 6]; 6];
        for axis in 0..2 {
            set(&mut hessian, a + axis, b + 2, self.normal_turned[axis]);
            set(&mut hessian, b + axis, b + 2, -self.normal_turned[axis]);
        }
        set(&mut hessian, a + 2, a + 2, -self.arm);
        set(&mut hessian, a + 2, b + 2, self.arm);
        set(&mut hessian, b + 2, b + 2, self.distance);
        hessian
    }
}

/// Two neighbouring scales at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Left and right scale.
    scales: [Parallelogram; 2],
    /// Node of the right scale at rest, relative to the node of the left one.
    offset: Vec2,
    /// Undeformed corner and edge of each contact, in the order of [`CornerEdge`].
    meetings: [(Vec2, Edge); 6],
}

/// Undeformed edge of a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    /// Outward unit normal.
    normal: Vec2,
    /// Distance from the node.
    distance: f64,
    /// Start of the edge: at the base, or at the left end of a base or a top.
    start: Vec2,
    /// Vector from start to end, divided by its squared length.
    along: Vec2,
}

impl Edge {
    fn right(scale: &Parallelogram) -> Self {
        let (sin, cos) = scale.slant().sin_cos();
        let rise = Vec2::new(scale.shift(), 1.0);
        Self {
            normal: Vec2::new(cos, -sin),
            distance: scale.half_base() * cos,
            start: scale.corner(Corner::BottomRight),
            along: rise / rise.norm_squared(),
        }
    }

    fn left(scale: &Parallelogram) -> Self {
        // A parallelogram has point symmetry about its centre.
        let right = Self::right(scale);
        Self { normal: -right.normal, start: scale.corner(Corner::BottomLeft), ..right }
    }

    fn top(scale: &Parallelogram) -> Self {
        Self {
            normal: Vec2::y(),
            distance: 1.0,
            start: scale.corner(Corner::TopLeft),
            along: Vec2::x() / (2.0 * scale.half_base()),
        }
    }

    fn base(scale: &Parallelogram) -> Self {
        let top = Self::top(scale);
        Self { normal: -top.normal, distance: 0.0, start: scale.corner(Corner::BottomLeft), ..top }
    }
}

/// Rotates a vector by 90° counter-clockwise.
pub fn quarter(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

impl Pair {
    /// Creates a pair of equal scales with nodes `pitch` apart (over `t`).
    pub fn new(scale: Parallelogram, pitch: f64) -> Self {
        Self::between([scale; 2], Vec2::new(pitch, 0.0))
    }

    /// Creates a pair of a left and a right scale.
    ///
    /// `offset` leads from the node of the left scale to the node of the right one (over `t`).
    pub fn between(scales: [Parallelogram; 2], offset: Vec2) -> Self {
        let meetings = CornerEdge::ALL.map(|corner_edge| {
            let [left, right] = &scales;
            let (a, b) = if corner_edge.corner_is_left() { (left, right) } else { (right, left) };
            let (_, corner, edge) = corner_edge.parts();
            (a.corner(corner), edge(b))
        });
        Self { scales, offset, meetings }
    }

    /// Returns the shapes of the left and the right scale.
    pub fn scales(&self) -> [Parallelogram; 2] {
        self.scales
    }

    /// Returns the right node relative to the left one, at rest, over `t`.
    pub fn offset(&self) -> Vec2 {
        self.offset
    }

    /// Returns the outward normal, at rest, of the edge that a corner meets.
    pub fn normal(&self, corner_edge: CornerEdge) -> Vec2 {
        self.meetings[corner_edge as usize].1.normal
    }

    /// Computes the gap between a corner and an edge, with all its derivatives.
    ///
    /// `ρ` is the vector from the node of scale `A` to its corner, turned by `φ_A`. `n` is the
    /// outward normal of the edge and `n'` its quarter turn, both turned by `φ_B`. `e` is the
    /// distance of the edge from the node of `B`, and `D` the vector from the node of `B` to the
    /// corner. A prime is a quarter turn counter-clockwise:
    ///
    /// ```text
    /// g = D·n − e                                                                  (C1)
    /// ∂g/∂u_A = n      ∂g/∂φ_A = ρ'·n      ∂g/∂u_B = −n      ∂g/∂φ_B = D·n'        (C2)
    /// ∂²g/∂u_A∂φ_B = n'      ∂²g/∂u_B∂φ_B = −n'
    /// ∂²g/∂φ_A² = −ρ·n       ∂²g/∂φ_A∂φ_B = ρ·n        ∂²g/∂φ_B² = −D·n            (C3)
    /// ```
    #[inline]
    pub fn gap(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> Gap {
        let meeting = self.meeting(corner_edge, left, right);
        meeting.along(corner_edge, meeting.normal, meeting.gap)
    }

    /// Computes the tangential displacement between corner and edge, with derivatives.
    ///
    /// It is positive if the left scale moves in the direction of the contact force on it, turned
    /// by 90° counter-clockwise. It is measured from the node of the scale with the edge. The
    /// derivatives are (C1) to (C3) with the quarter turn of the normal, as in [`Pair::gap`];
    /// `normal` is the sliding direction of the scale with the corner.
    pub fn slide(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> Gap {
        let meeting = self.meeting(corner_edge, left, right);
        let along = quarter(meeting.normal);
        meeting.along(corner_edge, along, meeting.to_corner.dot(&along))
    }

    /// Computes the gap between a corner and an edge without derivatives.
    pub fn distance(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> f64 {
        self.meeting(corner_edge, left, right).gap
    }

    /// Computes the position of the foot of a corner on an edge, as [`Gap::foot`].
    pub(crate) fn foot(&self, corner_edge: CornerEdge, [left, right]: [&Pose; 2]) -> f64 {
        self.meeting(corner_edge, left, right).foot
    }

    /// Returns the first of `corner_edges` with its foot within the edge.
    pub(crate) fn facing(
        &self,
        corner_edges: [CornerEdge; 2],
        [left, right]: [&Pose; 2],
    ) -> Option<(CornerEdge, Meeting)> {
        corner_edges.into_iter().find_map(|corner_edge| {
            let meeting = self.meeting(corner_edge, left, right);
            (0.0..=1.0).contains(&meeting.foot).then_some((corner_edge, meeting))
        })
    }

    #[inline]
    fn meeting(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> Meeting {
        let (corner_pose, edge_pose, offset) = if corner_edge.corner_is_left() {
            (left, right, -self.offset)
        } else {
            (right, left, self.offset)
        };
        let (corner, edge) = &self.meetings[corner_edge as usize];
        let arm = corner_pose.turn(*corner);
        // Relative positions, so that the position of the pair in a long row costs no digits.
        let to_corner = offset + (corner_pose.displacement - edge_pose.displacement) + arm;
        let normal = edge_pose.turn(edge.normal);
        let gap = to_corner.dot(&normal) - edge.distance;
        let foot = (to_corner - edge_pose.turn(edge.start)).dot(&edge_pose.turn(edge.along));
        Meeting { arm, normal, to_corner, gap, foot }
    }
}

/// Corner at an edge of the neighbour, deformed.
pub(crate) struct Meeting {
    arm: Vec2,
    normal: Vec2,
    to_corner: Vec2,
    pub(crate) gap: f64,
    foot: f64,
}

impl Meeting {
    /// Computes the gradient of the gap.
    pub(crate) fn gradient(&self, corner_edge: CornerEdge) -> [f64; 6] {
        self.gradient_along(corner_edge, self.normal)
    }

    /// Differentiates the coordinate of the corner along a direction fixed to the edge.
    #[inline]
    fn gradient_along(&self, corner_edge: CornerEdge, direction: Vec2) -> [f64; 6] {
        let (of_corner, of_edge) =
            (quarter(self.arm).dot(&direction), self.to_corner.dot(&quarter(direction)));
        let (x, y) = (direction.x, direction.y);
        if corner_edge.corner_is_left() {
            [x, y, of_corner, -x, -y, of_edge]
        } else {
            [-x, -y, of_edge, x, y, of_corner]
        }
    }

    /// Evaluates the coordinate of the corner along a direction fixed to the edge.
    #[inline]
    fn along(&self, corner_edge: CornerEdge, direction: Vec2, value: f64) -> Gap {
        let curvature = Curvature {
            corner_is_left: corner_edge.corner_is_left(),
            normal_turned: quarter(direction),
            arm: self.arm.dot(&direction),
            distance: -self.to_corner.dot(&direction),
        };
        let gradient = self.gradient_along(corner_edge, direction);
        Gap { value, gradient, curvature, foot: self.foot, normal: direction }
    }
}

fn set(hessian: &mut [[f64; 6]; 6], row: usize, column: usize, value: f64) {
    hessian[row][column] = value;
    hessian[column][row] = value;
}
