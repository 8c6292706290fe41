//! Kinematics of the needle tip relative to a scale.

use contact::Pose;
use geometry::{Corner, Parallelogram, Vec2};

use crate::contacts::OutlinePart;

/// Face of a scale, in the frame of the scale.
///
/// A corner is a face of zero length with the mean direction of both adjacent faces.
pub(super) struct Face {
    /// First point of the face along the outline from the left foot to the right foot.
    pub(super) origin: Vec2,
    /// Unit vector from the first to the last point.
    pub(super) along: Vec2,
    pub(super) length: f64,
}

impl Face {
    pub(super) fn new(scale: &Parallelogram, part: OutlinePart) -> Self {
        let between = |from: Corner, to: Corner| {
            let (origin, end) = (scale.corner(from), scale.corner(to));
            let length = (end - origin).norm();
            Self { origin, along: (end - origin) / length, length }
        };
        let left = || between(Corner::BottomLeft, Corner::TopLeft);
        let top = || between(Corner::TopLeft, Corner::TopRight);
        let right = || between(Corner::TopRight, Corner::BottomRight);
        let corner = |one: Self, other: Self| Self {
            origin: other.origin,
            along: (one.along + other.along).normalize(),
            length: 0.0,
        };
        match part {
            OutlinePart::Left => left(),
            OutlinePart::TopLeft => corner(left(), top()),
            OutlinePart::Top => top(),
            OutlinePart::TopRight => corner(top(), right()),
            OutlinePart::Right => right(),
        }
    }
}

/// The needle tip relative to a face of a scale.
///
/// With the tip at `P`, the node of the scale at `O`, the origin of the face at `E`, its direction
/// `t` and its outward normal `n`, all deformed, and `r = P − O`,
///
/// ```text
/// g = (P − E)·n        ξ = (P − E)·t                                                   (L3)
/// ∂g = −n, −r·t, −n·v        ∂ξ = −t, r·n, −t·v          for O, φ and the depth D      (L4)
/// ```
///
/// All vectors are in the tangent frame of the scale. `v` is the upward direction of the needle.
pub(super) struct Tip {
    /// Vector `r` from the node of the scale to the tip.
    arm: Vec2,
    normal: Vec2,
    along: Vec2,
    upward: Vec2,
    /// Distance `g` of the tip from the face, positive outside the scale.
    pub(super) gap: f64,
    /// Coordinate `ξ` of the tip along the face.
    pub(super) xi: f64,
    /// Length of the face.
    pub(super) length: f64,
}

/// Number of coordinates of a tip contact: `x, y, φ` of the scale, and the depth.
pub(super) const COORDINATES: usize = 4;

/// Index of the rotation among the coordinates of a tip contact.
pub(super) const TURN: usize = 2;

/// Index of the depth among the coordinates of a tip contact.
const DEPTH: usize = 3;

impl Tip {
    /// Computes the position of the tip relative to a face.
    ///
    /// `away` leads from the node of the scale at rest to the tip. `upward` is opposite to the
    /// motion of the needle.
    pub(super) fn new(face: &Face, pose: &Pose, away: Vec2, upward: Vec2) -> Self {
        let arm = away - pose.displacement;
        let along = pose.turn(face.along);
        // Faces run from the left foot over the top to the right foot, so the outward normal is
        // `along` turned by 90° counter-clockwise.
        let normal = Vec2::new(-along.y, along.x);
        let from_origin = arm - pose.turn(face.origin);
        let (gap, xi) = (from_origin.dot(&normal), from_origin.dot(&along));
        Self { arm, normal, along, upward, gap, xi, length: face.length }
    }

    /// Rotates normal and tangent so that the normal points from the corner to a round tip.
    pub(super) fn at_corner(self) -> Self {
        let away = self.gap * self.normal + self.xi * self.along;
        let gap = away.norm();
        // Nonzero: in contact, the distance from the corner is close to the radius of the tip.
        let normal = away / gap;
        Self { normal, along: Vec2::new(normal.y, -normal.x), gap, xi: 0.0, ..self }
    }

    /// Returns the outward normal of the face.
    pub(super) fn normal(&self) -> Vec2 {
        self.normal
    }

    /// Returns the vector from the tip to the point `xi` of the face.
    pub(super) fn to_end(&self, xi: f64) -> Vec2 {
        (xi - self.xi) * self.along - self.gap * self.normal
    }

    /// Returns the derivatives `∂g`.
    pub(super) fn gap_slopes(&self) -> [f64; COORDINATES] {
        [-self.normal.x, -self.normal.y, -self.arm.dot(&self.along), -self.normal.dot(&self.upward)]
    }

    /// Returns the derivatives `∂ξ`.
    pub(super) fn xi_slopes(&self) -> [f64; COORDINATES] {
        [-self.along.x, -self.along.y, self.arm.dot(&self.normal), -self.along.dot(&self.upward)]
    }

    /// Computes the second derivatives of `−N g + T ξ`.
    pub(super) fn curvature(
        &self,
        [normal_force, tangential_force]: [f64; 2],
    ) -> [[f64; COORDINATES]; COORDINATES] {
        let mut curvature = [[0.0; COORDINATES]; COORDINATES];
        let turning = -normal_force * self.along - tangential_force * self.normal;
        for (i, value) in [(0, turning.x), (1, turning.y), (DEPTH, turning.dot(&self.upward))] {
            curvature[i][TURN] = value;
            curvature[TURN][i] = value;
        }
        curvature[TURN][TURN] = normal_force * self.arm.dot(&self.normal)
            - tangential_force * self.arm.dot(&self.along);
        curvature
    }

    /// Computes the force on the scale from normal force `N` and tangential force `T`.
    pub(super) fn force(&self, [normal_force, tangential_force]: [f64; 2]) -> Vec2 {
        tangential_force * self.along - normal_force * self.normal
    }

    /// Resolves a force on the scale into normal force `N` and tangential force `T`.
    pub(super) fn parts(&self, force: Vec2) -> [f64; 2] {
        [-force.dot(&self.normal), force.dot(&self.along)]
    }
}

/// Kinematics of a tip in contact with a face or, for a round tip, with a corner of a scale.
///
/// The slip coordinate `ξ` of a round tip with the centre `C` is the distance that the circle has
/// slid along the outline, without rolling. `ψ` is the angle of the normal, clockwise from upward,
/// and `s` the length of the faces before the touched part. `ξ` is continuous from face to corner.
///
/// ```text
/// ξ = s + (C − E)·t + R ψ  on a face,     s + R ψ  on a corner
/// ∂ξ = −t, (P − O)·n, −t_y                                                             (L9)
/// ```
pub(super) struct TipKinematics {
    /// The tip or the centre of a round tip relative to the touched outline part.
    pub(super) tip: Tip,
    /// Radius of the tip; 0 for a sharp tip.
    radius: f64,
    /// True if a round tip is on a corner.
    is_corner: bool,
    /// Length `s` of the faces before the touched part.
    before: f64,
}

impl TipKinematics {
    pub(super) fn new(tip: Tip, radius: f64, before: f64) -> Self {
        let is_corner = radius > 0.0 && tip.length == 0.0;
        Self { tip: if is_corner { tip.at_corner() } else { tip }, radius, is_corner, before }
    }

    /// Returns the vector from the node of the scale to the point of contact.
    pub(super) fn contact_arm(&self) -> Vec2 {
        self.tip.arm - self.tip.gap * self.tip.normal
    }

    /// Returns the gap between tip and scale.
    pub(super) fn gap(&self) -> f64 {
        self.tip.gap - self.radius
    }

    /// Returns the slip coordinate `ξ`.
    pub(super) fn xi(&self) -> f64 {
        if self.radius == 0.0 {
            return self.tip.xi;
        }
        self.before + self.tip.xi + self.radius * self.tip.normal.x.atan2(self.tip.normal.y)
    }

    /// Returns the derivatives `∂ξ`.
    pub(super) fn xi_slopes(&self) -> [f64; COORDINATES] {
        let mut slopes = self.tip.xi_slopes();
        if !self.is_corner {
            // The normal turns with the scale, `∂ψ/∂φ = −1`.
            slopes[TURN] -= self.radius;
            return slopes;
        }
        // On a corner the arm leads from the node to the corner, not to the centre of the tip.
        slopes[TURN] -= self.tip.gap;
        slopes.map(|slope| slope * self.radius / self.tip.gap)
    }

    /// Computes the second derivatives of `−N g + T ξ` (L8).
    pub(super) fn curvature(
        &self,
        [normal_force, tangential_force]: [f64; 2],
    ) -> [[f64; COORDINATES]; COORDINATES] {
        let tip = &self.tip;
        if !self.is_corner {
            return tip.curvature([normal_force, tangential_force]);
        }
        let (off, mut along) = (tip.gap_slopes(), tip.xi_slopes());
        along[TURN] -= tip.gap;
        let rolled = tangential_force * self.radius / tip.gap;
        let entry = |i: usize, j: usize| {
            let turning = off[i] * along[j] + along[i] * off[j];
            -(normal_force * along[i] * along[j] + rolled * turning) / tip.gap
        };
        let mut curvature: [[f64; COORDINATES]; COORDINATES] =
            std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
        curvature[TURN][TURN] += rolled * tip.arm.dot(&tip.along) - normal_force * along[TURN];
        curvature
    }
}
