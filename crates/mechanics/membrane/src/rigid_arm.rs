//! Points that are rigidly attached to a body, and beam elements between two such points.

use geometry::Vec2;
use nalgebra::Matrix3;

use crate::corotational_beam::{CorotationalBeam, Ends, Response, Stiffness};
use crate::{Local, NodePose};

/// Point rigidly attached to a body.
///
/// ```text
///      ┌─────────┐
///      │    φ    │          body with its node ○ at x, rotated by φ
///      └────○────┘
///            ╲ Rp
///             ● x_P         the attached point; its direction rotates with the body
/// ```
///
/// With the arm `p` in the frame of the body and the rotation matrix `R` for the angle `φ`,
///
/// ```text
/// x_P = x + R p,   φ_P = φ                                                      (M10)
/// ∂x_P/∂x = 1,   ∂x_P/∂φ = R p turned by +90°,   ∂²x_P/∂φ² = −R p               (M11)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidArm(Vec2);

impl RigidArm {
    /// Arm of length zero: the attached point is the node of the body.
    pub const NONE: Self = Self(Vec2::new(0.0, 0.0));

    /// Creates an arm from the vector `p` in the frame of the body.
    pub const fn new(arm: Vec2) -> Self {
        Self(arm)
    }

    /// Returns the arm `R p` in fixed axes, for a body rotated by `phi`.
    pub fn lever(&self, phi: f64) -> Vec2 {
        let (sin, cos) = phi.sin_cos();
        Vec2::new(cos * self.0.x - sin * self.0.y, sin * self.0.x + cos * self.0.y)
    }

    /// Returns the pose of the attached point (M10).
    pub fn attached(&self, body: &NodePose) -> NodePose {
        let lever = self.lever(body[2]);
        NodePose::new(body[0] + lever.x, body[1] + lever.y, body[2])
    }

    /// Returns the derivatives of the attached pose with respect to the pose of the body (M11).
    ///
    /// Rows are components of the attached pose, columns are components of the pose of the body.
    pub fn gradient(&self, phi: f64) -> Matrix3<f64> {
        let lever = self.lever(phi);
        Matrix3::new(1.0, 0.0, -lever.y, 0.0, 1.0, lever.x, 0.0, 0.0, 1.0)
    }

    /// Returns `−R p`, the second derivative of the attached position with respect to `φ` (M11).
    pub fn second_derivative(&self, phi: f64) -> Vec2 {
        -self.lever(phi)
    }
}

/// Beam element between two points, each rigidly attached to a body.
///
/// The ends of the element have the attached poses `Q(q)`, where `q` are the poses of the bodies.
/// With the force `F` and the tangent `K` of the element at `Q`, and with `T = ∂Q/∂q`, force and
/// tangent as functions of `q` are
///
/// ```text
/// f = Tᵀ F,   k = Tᵀ K T + Σᵢ Fᵢ·(−R pᵢ) iᵩᵢ iᵩᵢᵀ                               (M12)
/// ```
///
/// `Fᵢ` is the force on end `i` without the moment, and `iᵩᵢ` the unit vector of the rotation of
/// body `i`. The sum is a geometric stiffness: the ends move on circles when the bodies rotate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetBeam {
    /// Beam element between the attached points.
    pub beam: CorotationalBeam,
    /// Arms from the nodes of the two bodies to ends 1 and 2 of the element.
    pub arms: [RigidArm; 2],
}

impl OffsetBeam {
    /// Returns the poses of the ends of the element for given poses of the bodies.
    pub fn ends(&self, bodies: &Ends) -> Ends {
        let first = self.arms[0].attached(&bodies.fixed_rows::<3>(0).into());
        let second = self.arms[1].attached(&bodies.fixed_rows::<3>(3).into());
        Ends::new(first[0], first[1], first[2], second[0], second[1], second[2])
    }

    /// Returns the deformations and forces of the element in the frame of its chord.
    pub fn local(&self, bodies: &Ends) -> Local {
        self.beam.local(&self.ends(bodies))
    }

    /// Returns the point of the deformed axis at `ξ`, from 0 at end 1 to 1 at end 2.
    pub fn axis_point(&self, bodies: &Ends, xi: f64) -> Vec2 {
        self.beam.axis_point(&self.ends(bodies), xi)
    }

    /// Returns the energies, and force and tangent with respect to the poses of the bodies (M12).
    pub fn response(&self, bodies: &Ends) -> Response {
        let at_ends = self.beam.response(&self.ends(bodies));
        let transform = self.transform(bodies);
        let mut tangent = transform.transpose() * at_ends.tangent * transform;
        for (arm, phi) in self.arms.iter().zip([2, 5]) {
            let force = Vec2::new(at_ends.force[phi - 2], at_ends.force[phi - 1]);
            tangent[(phi, phi)] += force.dot(&arm.second_derivative(bodies[phi]));
        }
        Response { force: transform.transpose() * at_ends.force, tangent, ..at_ends }
    }

    /// Returns `T = ∂Q/∂q`, the derivatives of the poses of the ends by the poses of the bodies.
    fn transform(&self, bodies: &Ends) -> Stiffness {
        let mut transform = Stiffness::zeros();
        for (arm, start) in self.arms.iter().zip([0, 3]) {
            let gradient = arm.gradient(bodies[start + 2]);
            transform.fixed_view_mut::<3, 3>(start, start).copy_from(&gradient);
        }
        transform
    }
}
