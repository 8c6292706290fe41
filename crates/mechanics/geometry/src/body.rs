//! Cylindrical body on which a row of scales lies.

use crate::{Parallelogram, Vec2, polygon_distance};

/// Largest angle (radians) between the normals of the punctured scale and of any other scale.
///
/// Scales farther around a body face away from the load.
const FARTHEST_ANGLE: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// A body of constant curvature; the default is flat.
///
/// Nodes lie on a circle of radius `R` at equal arc lengths, and scales stand along its normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// `t/R`: positive for a convex body, negative for a concave one, 0 for a flat one.
    pub curvature: f64,
}

impl Body {
    /// Returns true if the body is flat.
    pub fn is_flat(&self) -> bool {
        self.curvature == 0.0
    }

    /// Returns the tangent frame at the arc length `arc` (over `t`, to the right).
    ///
    /// Its position and angle are relative to the frame at `arc = 0`.
    pub fn frame(&self, arc: f64) -> Frame {
        let angle = arc * self.curvature;
        let (sin, cos) = angle.sin_cos();
        // `R sin θ` and `R (cos θ − 1)`, without division by the curvature.
        let half = 0.5 * angle;
        let origin = Vec2::new(arc * sinc(angle), -arc * sinc(half) * half.sin());
        Frame { origin, angle, cos, sin }
    }

    /// Returns the height of the surface at a distance `x` along the tangent at 0.
    ///
    /// Beyond the sides of a convex body it is the height of its centre.
    pub fn height(&self, x: f64) -> f64 {
        let squared = (self.curvature * x).powi(2);
        if squared < 1.0 {
            -self.curvature * x * x / (1.0 + (1.0 - squared).sqrt())
        } else {
            -self.curvature.recip()
        }
    }

    /// Returns the distance between the faces of two neighbours with nodes a pitch apart, over `t`.
    ///
    /// It has no meaning if they overlap.
    pub fn distance(&self, left: &Parallelogram, right: &Parallelogram, pitch: f64) -> f64 {
        let frame = self.frame(pitch);
        let neighbour = right.corners().map(|corner| frame.origin + frame.outward(corner));
        polygon_distance(&left.corners(), &neighbour)
    }

    /// Counts the scales on each side of the punctured one that face the load.
    ///
    /// Their normals are within 80° of its normal. `None` for a flat body, which sets no limit.
    pub fn scales_beside(&self, pitch: f64) -> Option<usize> {
        let step = pitch * self.curvature.abs();
        // A body of vanishing curvature has more scales than an integer can count; the conversion
        // saturates.
        (step > 0.0).then(|| ((FARTHEST_ANGLE / step).ceil() as usize).saturating_sub(1))
    }
}

/// `sin x / x`.
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

/// Tangent frame of a body at the node of a scale, relative to another tangent frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Position of the node in the other frame, over `t`.
    pub origin: Vec2,
    /// Angle `θ` by which the frame is rotated, clockwise, radians.
    pub angle: f64,
    cos: f64,
    sin: f64,
}

impl Frame {
    /// Rotates a vector of this frame to the other frame.
    pub fn outward(&self, v: Vec2) -> Vec2 {
        Vec2::new(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x)
    }

    /// Rotates a vector of the other frame to this frame.
    pub fn inward(&self, v: Vec2) -> Vec2 {
        Vec2::new(self.cos * v.x - self.sin * v.y, self.cos * v.y + self.sin * v.x)
    }
}

#[cfg(test)]
mod tests {
    use super::Body;
    use crate::{Parallelogram, Row, Vec2};
    use approx::assert_relative_eq;

    #[test]
    fn frames_lie_on_a_circle_and_compose() {
        let body = Body { curvature: 0.25 };
        let [first, second, both] = [0.7, 1.2, 1.9].map(|arc| body.frame(arc));
        let centre = Vec2::new(0.0, -4.0);
        assert_relative_eq!((both.origin - centre).norm(), 4.0, epsilon = 1e-14);
        let origin = first.origin + first.outward(second.origin);
        assert_relative_eq!(origin, both.origin, epsilon = 1e-14);
        assert_relative_eq!(first.inward(first.outward(origin)), origin, epsilon = 1e-14);
        // The normal points away from the centre of the circle.
        let normal = both.outward(Vec2::y());
        assert_relative_eq!(normal, (both.origin - centre) / 4.0, epsilon = 1e-14);
    }

    #[test]
    fn a_flat_body_is_the_limit_of_a_vanishing_curvature() {
        let flat = Body::default().frame(1.3);
        assert_eq!((flat.origin, flat.angle), (Vec2::new(1.3, 0.0), 0.0));
        let nearly = Body { curvature: 1e-9 }.frame(1.3);
        assert_relative_eq!(nearly.origin.y, -0.5 * 1e-9 * 1.3 * 1.3, max_relative = 1e-12);
        assert_relative_eq!(nearly.origin.x, 1.3, epsilon = 1e-15);
    }

    #[test]
    fn coverage_on_a_nearly_flat_body_is_the_flat_coverage() {
        for (slant, gap) in [(60.0, 0.3), (45.0, 0.1), (75.0, 0.2), (20.0, 0.4), (0.0, 0.2)] {
            let row = Row::new(Parallelogram::new(0.35, slant).unwrap(), gap).unwrap();
            let nearly = row.coverage_on(Body { curvature: 1e-9 });
            assert_relative_eq!(nearly, row.coverage(), epsilon = 1e-7);
        }
    }

    #[test]
    fn a_convex_body_opens_the_scales_and_a_concave_one_closes_them() {
        let row = Row::new(Parallelogram::new(0.5, 60.0).unwrap(), 0.3).unwrap();
        let [convex, flat, concave] =
            [0.1, 0.0, -0.05].map(|curvature| row.coverage_on(Body { curvature }));
        assert!(convex < flat && flat < concave, "{convex} {flat} {concave}");
    }

    #[test]
    fn scales_that_face_away_from_the_load_are_not_counted() {
        let body = Body { curvature: -0.25 };
        // Five pitches of 1.1 span 78.8°, six 94.5°.
        assert_eq!(body.scales_beside(1.1), Some(5));
        assert_eq!(Body::default().scales_beside(1.1), None);
    }
}
