//! Cylindrical body on which a row of scales lies.

use crate::{Parallelogram, Vec2, polygon_distance};

/// Largest angle between the normal of a scale and the normal of the punctured scale, radians.
///
/// Scales at larger angles face away from the load and do not belong to the row.
const FARTHEST_ANGLE: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// Cylindrical body of constant curvature under a row of scales; the default is flat.
///
/// The nodes of the scales lie at equal arc lengths on a circle of radius `R`. The `y` axis of each
/// scale is the outward normal of the circle at its node.
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

    /// Returns the tangent frame at the arc length `arc`.
    ///
    /// The arc length is in units of `t` and positive to the right. Position and angle of the
    /// returned frame are relative to the frame at `arc = 0`.
    pub fn frame(&self, arc: f64) -> Frame {
        let angle = arc * self.curvature;
        let (sin, cos) = angle.sin_cos();
        // The origin is `(R sin θ, R (cos θ − 1))`. This form does not divide by the curvature,
        // which is zero for a flat body.
        let half = 0.5 * angle;
        let origin = Vec2::new(arc * sinc(angle), -arc * sinc(half) * half.sin());
        Frame { origin, angle, cos, sin }
    }

    /// Returns the height of the surface above the tangent at the arc length 0.
    ///
    /// `x` is the distance along this tangent. For `|x| ≥ R`, beside the circle, returns the height
    /// of its centre. Lengths are in units of `t`.
    pub fn height(&self, x: f64) -> f64 {
        let squared = (self.curvature * x).powi(2);
        if squared < 1.0 {
            -self.curvature * x * x / (1.0 + (1.0 - squared).sqrt())
        } else {
            -self.curvature.recip()
        }
    }

    /// Returns the shortest distance between two neighbouring scales, in units of `t`.
    ///
    /// The arc length between the two nodes is `pitch`. The result is meaningless if the scales
    /// overlap.
    pub fn distance(&self, left: &Parallelogram, right: &Parallelogram, pitch: f64) -> f64 {
        let frame = self.frame(pitch);
        let neighbour = right.corners().map(|corner| frame.origin + frame.outward(corner));
        polygon_distance(&left.corners(), &neighbour)
    }

    /// Returns the number of scales that face the load on each side of the punctured scale.
    ///
    /// A scale faces the load if the angle between its normal and the normal of the punctured scale
    /// is below 80°. `None` for a flat body, on which every scale faces the load.
    pub fn scales_beside(&self, pitch: f64) -> Option<usize> {
        let step = pitch * self.curvature.abs();
        // The number exceeds `usize` for a tiny curvature; the conversion then saturates.
        (step > 0.0).then(|| ((FARTHEST_ANGLE / step).ceil() as usize).saturating_sub(1))
    }
}

/// Returns `sin x / x`, and 1 for `x = 0`.
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

/// Tangent frame of a body at the node of a scale.
///
/// Its position and angle are given relative to a reference frame, the tangent frame at another
/// point of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Position of the node in the reference frame, in units of `t`.
    pub origin: Vec2,
    /// Clockwise rotation `θ` of this frame relative to the reference frame, radians.
    pub angle: f64,
    cos: f64,
    sin: f64,
}

impl Frame {
    /// Converts the components of a vector from this frame to the reference frame.
    pub fn outward(&self, v: Vec2) -> Vec2 {
        Vec2::new(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x)
    }

    /// Converts the components of a vector from the reference frame to this frame.
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
    fn frames_lie_on_a_circle_and_can_be_chained() {
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
    fn coverage_is_smaller_on_a_convex_body_and_larger_on_a_concave_body() {
        let row = Row::new(Parallelogram::new(0.5, 60.0).unwrap(), 0.3).unwrap();
        let [convex, flat, concave] =
            [0.1, 0.0, -0.05].map(|curvature| row.coverage_on(Body { curvature }));
        assert!(convex < flat && flat < concave, "{convex} {flat} {concave}");
    }

    #[test]
    fn scales_that_face_away_from_the_load_are_not_counted() {
        let body = Body { curvature: -0.25 };
        // On a radius of 4, five pitches of 1.1 span 78.8° and six pitches span 94.5°.
        assert_eq!(body.scales_beside(1.1), Some(5));
        assert_eq!(Body::default().scales_beside(1.1), None);
    }
}
