//! Gap between a corner of one scale and an edge of its neighbour.

#[cfg(test)]
mod tests;

use geometry::{Corner, Parallelogram, Vec2};

/// Displacement and rotation of a scale from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Displacement of the node, in units of `t`.
    pub displacement: Vec2,
    /// Counter-clockwise rotation `φ`, radians.
    pub rotation: f64,
    cos: f64,
    sin: f64,
}

impl Pose {
    /// Creates a pose from the displacement `(x, y)` of the node and the rotation in radians.
    pub fn new(x: f64, y: f64, rotation: f64) -> Self {
        // Sine and cosine are stored, because many vectors are rotated with each pose.
        let (sin, cos) = rotation.sin_cos();
        Self { displacement: Vec2::new(x, y), rotation, cos, sin }
    }

    /// Returns the vector `v`, which is fixed to the scale, after the rotation of the scale.
    pub fn turn(&self, v: Vec2) -> Vec2 {
        Vec2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }
}

/// Combination of a corner of one scale and an edge of its neighbour that may touch.
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
    /// All six combinations, in the order of the variants.
    // The order must not change: `Pair` stores an array that is indexed by variant.
    pub const ALL: [Self; 6] = [
        Self::TopRightOnLeftEdge,
        Self::TopLeftOnRightEdge,
        Self::BottomRightOnLeftEdge,
        Self::BottomLeftOnRightEdge,
        Self::TopRightOnTop,
        Self::BottomLeftOnBase,
    ];

    /// Returns the name, the corner, and the function that constructs the edge of a scale.
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

    /// Returns the short name for result tables.
    pub fn name(self) -> &'static str {
        self.parts().0
    }

    /// Returns the corner that touches the edge.
    pub fn corner(self) -> Corner {
        self.parts().1
    }

    /// Returns true if the corner belongs to the left scale of the pair.
    pub fn corner_is_left(self) -> bool {
        matches!(self, Self::TopRightOnLeftEdge | Self::BottomRightOnLeftEdge | Self::TopRightOnTop)
    }

    /// Returns the second contact of two edges that lie flush, at their other end.
    ///
    /// For a tip (acute corner) on the neighbour's top or base this is the neighbour's corner on
    /// the side that ends in the tip, and vice versa. `None` for a tip on the neighbour's side.
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

/// Gap between a corner and an edge, with derivatives with respect to the coordinates of a pair.
///
/// The coordinates are `(x, y, φ)` of the left scale and `(x, y, φ)` of the right scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Gap `g` in units of `t`; negative if the corner has passed the edge.
    pub value: f64,
    /// Gradient `∇g`.
    pub gradient: [f64; 6],
    /// Nonzero entries of the Hessian `∇²g`.
    pub curvature: Curvature,
    /// Position of the foot, the projection of the corner onto the edge, as a fraction of the edge.
    ///
    /// A side runs from 0 at the base to 1 at the top; a base or a top from 0 at the left to 1 at
    /// the right end. Values outside this range lie beyond an end of the edge.
    pub foot: f64,
    /// Outward normal of the edge: the direction of the force on the corner.
    pub normal: Vec2,
}

/// Nonzero second derivatives (C3) of a gap.
///
/// `A` is the scale with the corner, `B` the scale with the edge; `u` and `φ` are displacement and
/// rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// True if the corner belongs to the left scale.
    pub corner_is_left: bool,
    /// Normal of the edge rotated by 90°: `n' = ∂²g/∂u_A∂φ_B = −∂²g/∂u_B∂φ_B`.
    pub normal_turned: Vec2,
    /// Arm of the corner along the normal: `ρ·n = ∂²g/∂φ_A∂φ_B = −∂²g/∂φ_A²`.
    pub arm: f64,
    /// Negative distance of the corner from the node of `B`, along the normal: `−D·n = ∂²g/∂φ_B²`.
    pub distance: f64,
}

impl Curvature {
    /// Returns the symmetric Hessian `∇²g` in the coordinates of the pair.
    pub fn hessian(&self) -> [[f64; 6]; 6] {
        // Index of the first coordinate of the scale with the corner (A) and with the edge (B).
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

/// Shapes and relative position of two neighbouring scales at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Shapes of the left and the right scale.
    scales: [Parallelogram; 2],
    /// Vector from the node of the left scale to the node of the right scale at rest.
    offset: Vec2,
    /// Corner and edge of each contact in the scales at rest, in the order of [`CornerEdge`].
    undeformed: [(Vec2, Edge); 6],
}

/// Undeformed edge of a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    /// Outward unit normal.
    normal: Vec2,
    /// Distance of the edge from the node of the scale, along the normal.
    distance: f64,
    /// Start: the lower end of a side, or the left end of a base or a top.
    start: Vec2,
    /// Vector from the start to the end of the edge, divided by its squared length.
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

/// Returns the vector `v` rotated by 90° counter-clockwise.
pub fn quarter(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

impl Pair {
    /// Creates a pair of equal scales on a flat row.
    ///
    /// `pitch` is the distance between the nodes in units of `t`.
    pub fn new(scale: Parallelogram, pitch: f64) -> Self {
        Self::between([scale; 2], Vec2::new(pitch, 0.0))
    }

    /// Creates a pair from the left and the right scale.
    ///
    /// `offset` is the vector from the left to the right node at rest, in units of `t`.
    pub fn between(scales: [Parallelogram; 2], offset: Vec2) -> Self {
        let undeformed = CornerEdge::ALL.map(|corner_edge| {
            let [left, right] = &scales;
            let (a, b) = if corner_edge.corner_is_left() { (left, right) } else { (right, left) };
            let (_, corner, edge) = corner_edge.parts();
            (a.corner(corner), edge(b))
        });
        Self { scales, offset, undeformed }
    }

    /// Returns the shapes of the left and the right scale.
    pub fn scales(&self) -> [Parallelogram; 2] {
        self.scales
    }

    /// Returns the vector from the left to the right node at rest, in units of `t`.
    pub fn offset(&self) -> Vec2 {
        self.offset
    }

    /// Returns the outward normal of the edge of `corner_edge` in the scale at rest.
    pub fn normal(&self, corner_edge: CornerEdge) -> Vec2 {
        self.undeformed[corner_edge as usize].1.normal
    }

    /// Computes the gap between a corner and an edge, with first and second derivatives.
    ///
    /// Scale `A` has the corner, scale `B` the edge. In the deformed configuration `ρ` is the
    /// vector from the node of `A` to the corner, `D` the vector from the node of `B` to the
    /// corner, and `n` the outward normal of the edge. `e` is the distance of the edge from the
    /// node of `B`. A prime denotes a rotation by 90° counter-clockwise:
    ///
    /// ```text
    /// g = D·n − e                                                                  (C1)
    /// ∂g/∂u_A = n      ∂g/∂φ_A = ρ'·n      ∂g/∂u_B = −n      ∂g/∂φ_B = D·n'        (C2)
    /// ∂²g/∂u_A∂φ_B = n'      ∂²g/∂u_B∂φ_B = −n'
    /// ∂²g/∂φ_A² = −ρ·n       ∂²g/∂φ_A∂φ_B = ρ·n        ∂²g/∂φ_B² = −D·n            (C3)
    /// ```
    #[inline]
    pub fn gap(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> Gap {
        let position = self.position(corner_edge, left, right);
        position.along(corner_edge, position.normal, position.gap)
    }

    /// Computes the tangential coordinate of a corner along an edge, with derivatives.
    ///
    /// The coordinate is zero at the node of the scale with the edge. It increases if the left
    /// scale moves in the direction of the contact force on the left scale, rotated by 90°
    /// counter-clockwise. Value and derivatives follow from (C1) to (C3) of [`Pair::gap`] with `n'`
    /// for `n` and `e = 0`. The field `normal` of the result is `n'`.
    pub fn slide(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> Gap {
        let position = self.position(corner_edge, left, right);
        let along = quarter(position.normal);
        position.along(corner_edge, along, position.to_corner.dot(&along))
    }

    /// Computes the gap between a corner and an edge without derivatives.
    pub fn distance(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> f64 {
        self.position(corner_edge, left, right).gap
    }

    /// Computes the position of the foot of a corner on an edge, defined as in [`Gap::foot`].
    pub(crate) fn foot(&self, corner_edge: CornerEdge, [left, right]: [&Pose; 2]) -> f64 {
        self.position(corner_edge, left, right).foot
    }

    /// Returns the first of `corner_edges` for which the foot of the corner lies within the edge.
    pub(crate) fn facing(
        &self,
        corner_edges: [CornerEdge; 2],
        [left, right]: [&Pose; 2],
    ) -> Option<(CornerEdge, CornerPosition)> {
        corner_edges.into_iter().find_map(|corner_edge| {
            let position = self.position(corner_edge, left, right);
            (0.0..=1.0).contains(&position.foot).then_some((corner_edge, position))
        })
    }

    /// Computes the position of a corner relative to an edge in the given poses.
    #[inline]
    fn position(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> CornerPosition {
        let (corner_pose, edge_pose, offset) = if corner_edge.corner_is_left() {
            (left, right, -self.offset)
        } else {
            (right, left, self.offset)
        };
        let (corner, edge) = &self.undeformed[corner_edge as usize];
        let arm = corner_pose.turn(*corner);
        // Only relative positions are used, so the precision does not depend on the position of the
        // pair in a long row.
        let to_corner = offset + (corner_pose.displacement - edge_pose.displacement) + arm;
        let normal = edge_pose.turn(edge.normal);
        let gap = to_corner.dot(&normal) - edge.distance;
        let foot = (to_corner - edge_pose.turn(edge.start)).dot(&edge_pose.turn(edge.along));
        CornerPosition { arm, normal, to_corner, gap, foot }
    }
}

/// Position of a corner relative to an edge of the neighbour, in deformed poses.
pub(crate) struct CornerPosition {
    /// Vector `ρ` from the node of the scale with the corner to the corner.
    arm: Vec2,
    /// Outward normal `n` of the edge.
    normal: Vec2,
    /// Vector `D` from the node of the scale with the edge to the corner.
    to_corner: Vec2,
    /// Gap `g`, in units of `t`.
    pub(crate) gap: f64,
    /// Position of the foot, as [`Gap::foot`].
    foot: f64,
}

impl CornerPosition {
    /// Returns the gradient of the gap.
    pub(crate) fn gradient(&self, corner_edge: CornerEdge) -> [f64; 6] {
        self.gradient_along(corner_edge, self.normal)
    }

    /// Returns the gradient of the coordinate of the corner along a direction fixed to the edge.
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

    /// Returns the coordinate `value` of the corner along `direction` with its derivatives.
    ///
    /// `direction` is fixed to the edge: its normal, or the normal rotated by 90°.
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

/// Sets the entries `(row, column)` and `(column, row)` of a symmetric matrix.
fn set(hessian: &mut [[f64; 6]; 6], row: usize, column: usize, value: f64) {
    hessian[row][column] = value;
    hessian[column][row] = value;
}
