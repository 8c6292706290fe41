//! The gap between a corner of one scale and an edge of its neighbour.

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
    /// The pose with displacements `x`, `y` of the node and rotation `rotation`.
    pub fn new(x: f64, y: f64, rotation: f64) -> Self {
        let (sin, cos) = rotation.sin_cos();
        Self { displacement: Vec2::new(x, y), rotation, cos, sin }
    }

    /// A vector that turns with the scale.
    pub fn turn(&self, v: Vec2) -> Vec2 {
        Vec2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }
}

/// Which corner of a pair of neighbours meets which edge of the other.
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
    /// The six possible meetings, the tips on a top or a base last.
    pub const ALL: [Self; 6] = [
        Self::TopRightOnLeftEdge,
        Self::TopLeftOnRightEdge,
        Self::BottomRightOnLeftEdge,
        Self::BottomLeftOnRightEdge,
        Self::TopRightOnTop,
        Self::BottomLeftOnBase,
    ];

    /// Short name, as in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::TopRightOnLeftEdge => "TR on left edge",
            Self::TopLeftOnRightEdge => "TL on right edge",
            Self::BottomRightOnLeftEdge => "BR on left edge",
            Self::BottomLeftOnRightEdge => "BL on right edge",
            Self::TopRightOnTop => "TR on top",
            Self::BottomLeftOnBase => "BL on base",
        }
    }

    /// The corner that touches.
    pub fn corner(self) -> Corner {
        match self {
            Self::TopRightOnLeftEdge | Self::TopRightOnTop => Corner::TopRight,
            Self::TopLeftOnRightEdge => Corner::TopLeft,
            Self::BottomRightOnLeftEdge => Corner::BottomRight,
            Self::BottomLeftOnRightEdge | Self::BottomLeftOnBase => Corner::BottomLeft,
        }
    }

    /// Whether the corner belongs to the left scale of the pair.
    pub fn corner_is_left(self) -> bool {
        matches!(self, Self::TopRightOnLeftEdge | Self::BottomRightOnLeftEdge | Self::TopRightOnTop)
    }

    /// The contact at the other end of the two edges when they lie flush: the tip on the neighbour's end for the
    /// neighbour's corner on the side of the tip, and the other way round. `None` for a tip on a side.
    pub fn flush(self) -> Option<Self> {
        match self {
            Self::TopLeftOnRightEdge => Some(Self::TopRightOnTop),
            Self::TopRightOnTop => Some(Self::TopLeftOnRightEdge),
            Self::BottomRightOnLeftEdge => Some(Self::BottomLeftOnBase),
            Self::BottomLeftOnBase => Some(Self::BottomRightOnLeftEdge),
            Self::TopRightOnLeftEdge | Self::BottomLeftOnRightEdge => None,
        }
    }

    /// The edge that the corner meets.
    fn edge(self, scale: &Parallelogram) -> Edge {
        match self {
            Self::TopRightOnLeftEdge | Self::BottomRightOnLeftEdge => Edge::left(scale),
            Self::TopLeftOnRightEdge | Self::BottomLeftOnRightEdge => Edge::right(scale),
            Self::TopRightOnTop => Edge::top(scale),
            Self::BottomLeftOnBase => Edge::base(scale),
        }
    }
}

/// A gap and its derivatives with respect to the six coordinates
/// `(x, y, φ)` of the left and `(x, y, φ)` of the right scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// `g`, over `t`; negative where the corner has passed the edge.
    pub value: f64,
    /// `∇g`.
    pub gradient: [f64; 6],
    /// `∇²g`, symmetric.
    pub hessian: [[f64; 6]; 6],
    /// Where the corner's foot lies on the edge: from 0 at the base (the left end of a base or a top) to 1.
    pub foot: f64,
    /// Outward normal of the edge: the direction of the force on the corner.
    pub normal: Vec2,
}

/// Neighbouring scales at a pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The left scale and the right one.
    scales: [Parallelogram; 2],
    pitch: f64,
    /// The corner and the edge of each contact, undeformed, in the order of [`CornerEdge`].
    meetings: [(Vec2, Edge); 6],
}

/// An edge of a scale, undeformed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    /// Outward.
    normal: Vec2,
    /// Distance from the node.
    distance: f64,
    /// Where the edge begins: at the base, or at the left end of a base or a top.
    start: Vec2,
    /// From where it begins to where it ends, over the square of its length.
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

/// A quarter turn counter-clockwise.
pub(crate) fn quarter(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

impl Pair {
    /// Neighbours of the shape `scale`, their nodes `pitch` apart (over `t`).
    pub fn new(scale: Parallelogram, pitch: f64) -> Self {
        Self::of([scale; 2], pitch)
    }

    /// Neighbours of any two shapes, the left and the right one, their nodes `pitch` apart (over `t`).
    pub fn of(scales: [Parallelogram; 2], pitch: f64) -> Self {
        let meeting = |corner_edge: CornerEdge| {
            let [left, right] = &scales;
            let (a, b) = if corner_edge.corner_is_left() { (left, right) } else { (right, left) };
            (a.corner(corner_edge.corner()), corner_edge.edge(b))
        };
        Self { scales, pitch, meetings: CornerEdge::ALL.map(meeting) }
    }

    /// The shapes of the left and of the right scale.
    pub fn scales(&self) -> [Parallelogram; 2] {
        self.scales
    }

    /// Distance of the nodes at rest, over `t`.
    pub fn pitch(&self) -> f64 {
        self.pitch
    }

    /// Normals, at rest, of the right edge of the left scale (inward) and of the left edge of the right
    /// one (outward): both point left.
    pub(crate) fn normals(&self) -> [Vec2; 2] {
        let normal = |corner_edge: CornerEdge| self.meetings[corner_edge as usize].1.normal;
        [-normal(CornerEdge::TopLeftOnRightEdge), normal(CornerEdge::TopRightOnLeftEdge)]
    }

    /// The gap between a corner and an edge, with all its derivatives.
    ///
    /// With the corner `ρ` from the node of its scale `A`, turned by `φ_A`; the edge's outward normal `n`
    /// and quarter turn `n'`, turned by `φ_B`; the edge's distance `e` from the node of `B`; and the vector `D` from the
    /// node of `B` to the corner (a prime is a quarter turn counter-clockwise):
    ///
    /// ```text
    /// g = D·n − e                                                                  (C1)
    /// ∂g/∂u_A = n      ∂g/∂φ_A = ρ'·n      ∂g/∂u_B = −n      ∂g/∂φ_B = D·n'        (C2)
    /// ∂²g/∂u_A∂φ_B = n'      ∂²g/∂u_B∂φ_B = −n'
    /// ∂²g/∂φ_A² = −ρ·n       ∂²g/∂φ_A∂φ_B = ρ·n        ∂²g/∂φ_B² = −D·n            (C3)
    /// ```
    pub fn gap(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> Gap {
        let meeting = self.meeting(corner_edge, left, right);
        let Meeting { arm, normal, to_corner, .. } = meeting;
        let normal_turned = quarter(normal);
        // Coordinates of the corner's scale (A) and of the edge's scale (B) among the six.
        let (a, b) = if corner_edge.corner_is_left() { (0, 3) } else { (3, 0) };
        let mut gradient = [0.0; 6];
        let mut hessian = [[0.0; 6]; 6];
        for axis in 0..2 {
            gradient[a + axis] = normal[axis];
            gradient[b + axis] = -normal[axis];
            set(&mut hessian, a + axis, b + 2, normal_turned[axis]);
            set(&mut hessian, b + axis, b + 2, -normal_turned[axis]);
        }
        gradient[a + 2] = quarter(arm).dot(&normal);
        gradient[b + 2] = to_corner.dot(&normal_turned);
        set(&mut hessian, a + 2, a + 2, -arm.dot(&normal));
        set(&mut hessian, a + 2, b + 2, arm.dot(&normal));
        set(&mut hessian, b + 2, b + 2, -to_corner.dot(&normal));
        Gap { value: meeting.gap, gradient, hessian, foot: meeting.foot, normal }
    }

    /// The gap between a corner and an edge alone.
    pub fn distance(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> f64 {
        self.meeting(corner_edge, left, right).gap
    }

    /// Where the foot of a corner lies on an edge, as [`Gap::foot`].
    pub(crate) fn foot(&self, corner_edge: CornerEdge, [left, right]: [&Pose; 2]) -> f64 {
        self.meeting(corner_edge, left, right).foot
    }

    /// The first of `corner_edges` whose corner has its foot within the edge, and its gap.
    pub(crate) fn facing(
        &self,
        corner_edges: [CornerEdge; 2],
        [left, right]: [&Pose; 2],
    ) -> Option<(CornerEdge, f64)> {
        corner_edges.into_iter().find_map(|corner_edge| {
            let meeting = self.meeting(corner_edge, left, right);
            (0.0..=1.0).contains(&meeting.foot).then_some((corner_edge, meeting.gap))
        })
    }

    fn meeting(&self, corner_edge: CornerEdge, left: &Pose, right: &Pose) -> Meeting {
        let (corner_pose, edge_pose, offset) = if corner_edge.corner_is_left() {
            (left, right, -self.pitch)
        } else {
            (right, left, self.pitch)
        };
        let (corner, edge) = &self.meetings[corner_edge as usize];
        let arm = corner_pose.turn(*corner);
        // Relative positions, so that the place of the pair in a long row costs no digits.
        let to_corner =
            Vec2::new(offset, 0.0) + (corner_pose.displacement - edge_pose.displacement) + arm;
        let normal = edge_pose.turn(edge.normal);
        let gap = to_corner.dot(&normal) - edge.distance;
        let foot = (to_corner - edge_pose.turn(edge.start)).dot(&edge_pose.turn(edge.along));
        Meeting { arm, normal, to_corner, gap, foot }
    }
}

/// A corner at an edge of the neighbour, deformed.
struct Meeting {
    arm: Vec2,
    normal: Vec2,
    to_corner: Vec2,
    gap: f64,
    foot: f64,
}

fn set(hessian: &mut [[f64; 6]; 6], row: usize, column: usize, value: f64) {
    hessian[row][column] = value;
    hessian[column][row] = value;
}

#[cfg(test)]
mod tests {
    use super::{CornerEdge, Pair, Pose, quarter};
    use approx::assert_relative_eq;
    use geometry::{Corner, Parallelogram, Vec2};
    use proptest::prelude::*;

    fn poses(q: &[f64; 6]) -> (Pose, Pose) {
        (Pose::new(q[0], q[1], q[2]), Pose::new(q[3], q[4], q[5]))
    }

    fn moved(q: &[f64; 6], i: usize, h: f64) -> (Pose, Pose) {
        let mut q = *q;
        q[i] += h;
        poses(&q)
    }

    proptest! {
        #[test]
        fn derivatives_agree_with_finite_differences(
            slant in 0.0_f64..80.0, half_base in 0.02_f64..3.0, gap in 0.05_f64..2.0,
            q in prop::array::uniform6(-1.5_f64..1.5), corner_edge in 0_usize..6,
        ) {
            let corner_edge = CornerEdge::ALL[corner_edge];
            let scale = Parallelogram::new(half_base, slant).unwrap();
            let pair = Pair::new(scale, 2.0 * half_base + gap);
            let (left, right) = poses(&q);
            let ours = pair.gap(corner_edge, &left, &right);
            let h = 1e-6;
            for i in 0..6 {
                let (l, r) = moved(&q, i, h);
                let high = pair.gap(corner_edge, &l, &r);
                let (l, r) = moved(&q, i, -h);
                let low = pair.gap(corner_edge, &l, &r);
                assert_relative_eq!(
                    ours.gradient[i], (high.value - low.value) / (2.0 * h), epsilon = 1e-7, max_relative = 1e-7
                );
                for j in 0..6 {
                    assert_relative_eq!(
                        ours.hessian[i][j], (high.gradient[j] - low.gradient[j]) / (2.0 * h),
                        epsilon = 1e-7, max_relative = 1e-7
                    );
                }
            }
        }
    }

    proptest! {
        /// A corner that is laid on its edge, some way along it.
        #[test]
        fn the_foot_is_where_the_corner_stands_on_the_edge(
            slants in prop::array::uniform2(0.0_f64..80.0), half_bases in prop::array::uniform2(0.02_f64..3.0),
            rotations in prop::array::uniform2(-0.5_f64..0.5), place in -0.5_f64..1.5, off in -0.2_f64..0.2,
            corner_edge in 0_usize..6,
        ) {
            let corner_edge = CornerEdge::ALL[corner_edge];
            let scales: [_; 2] =
                std::array::from_fn(|i| Parallelogram::new(half_bases[i], slants[i]).unwrap());
            let pair = Pair::of(scales, 7.0);
            prop_assert_eq!(pair.pitch(), 7.0);
            let (a, b) = if corner_edge.corner_is_left() { (0, 1) } else { (1, 0) };
            // From the base up, or from the left to the right.
            let (start, end, outward) = match corner_edge {
                CornerEdge::TopRightOnLeftEdge | CornerEdge::BottomRightOnLeftEdge => {
                    (Corner::BottomLeft, Corner::TopLeft, 1.0)
                }
                CornerEdge::TopLeftOnRightEdge | CornerEdge::BottomLeftOnRightEdge => {
                    (Corner::BottomRight, Corner::TopRight, -1.0)
                }
                CornerEdge::TopRightOnTop => (Corner::TopLeft, Corner::TopRight, 1.0),
                CornerEdge::BottomLeftOnBase => (Corner::BottomLeft, Corner::BottomRight, -1.0),
            };
            let (start, end) = (scales[b].corner(start), scales[b].corner(end));
            let along = end - start;
            let target = start + place * along + outward * off * quarter(along.normalize());
            let turned = |i: usize| Pose::new(0.0, 0.0, rotations[i]);
            let at = [0.0, 7.0];
            let corner = turned(a).turn(scales[a].corner(corner_edge.corner()));
            let shift = turned(b).turn(target) - corner + Vec2::new(at[b] - at[a], 0.0);
            let mut poses = [turned(0), turned(1)];
            poses[a] = Pose::new(shift.x, shift.y, rotations[a]);
            let gap = pair.gap(corner_edge, &poses[0], &poses[1]);
            assert_relative_eq!(gap.foot, place, epsilon = 1e-11);
            assert_relative_eq!(gap.value, off, epsilon = 1e-12);
        }
    }

    #[test]
    fn kinds_have_names_that_say_what_meets_what() {
        assert_eq!(
            CornerEdge::ALL.map(CornerEdge::name),
            [
                "TR on left edge",
                "TL on right edge",
                "BR on left edge",
                "BL on right edge",
                "TR on top",
                "BL on base",
            ]
        );
    }

    #[test]
    fn at_rest_the_gap_is_the_distance_of_the_edges() {
        let scale = Parallelogram::new(0.5, 60.0).unwrap();
        let pair = Pair::new(scale, 1.2);
        let rest = Pose::new(0.0, 0.0, 0.0);
        for corner_edge in [CornerEdge::TopRightOnLeftEdge, CornerEdge::BottomLeftOnRightEdge] {
            assert_relative_eq!(
                pair.distance(corner_edge, &rest, &rest),
                0.1,
                max_relative = 1e-14
            );
        }
    }

    #[test]
    fn a_rotated_neighbour_is_met_where_trigonometry_says() {
        // Upright blocks; the left one turns clockwise by φ about its node: its top right corner
        // moves right by (sin φ + a (cos φ − 1)).
        let (a, gap, phi) = (0.5, 0.3, 0.2_f64);
        let pair = Pair::new(Parallelogram::new(a, 0.0).unwrap(), 2.0 * a + gap);
        let left = Pose::new(0.0, 0.0, -phi);
        let rest = Pose::new(0.0, 0.0, 0.0);
        let expected = gap - (phi.sin() + a * (phi.cos() - 1.0));
        let ours = pair.distance(CornerEdge::TopRightOnLeftEdge, &left, &rest);
        assert_relative_eq!(ours, expected, max_relative = 1e-14);
    }
}
