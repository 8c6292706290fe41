//! The curvature at which the scales of a strip first touch, wherever the bending ends.

use std::f64::consts::PI;

use contact::{Corners, Level, Pair, Pose};
use geometry::{OutOfRange, Row};

use super::FlexureParameters;
use crate::Design;

/// Rotations at which a gap is looked at before the one at which it closes is narrowed down.
const LOOKS: u32 = 512;

/// Largest rotation of a gap: beyond it the arc of the membrane turns back.
const LARGEST: f64 = PI;

/// Returns `κ₁*`, the curvature at which neighbours first touch when the strip bends to the inside, the scales being on the inside.
/// `None` if the gap does not close before its membrane has turned by half a circle.
///
/// Until then no force goes through the membrane and it is an arc of length `d`, whatever its stiffness. Seen from the left
/// scale, with the depth `z₀` of the axis below the bases and the rotation `θ`, the node of the right one stands at
///
/// ```text
/// (a, −z₀) + d/θ (sin θ, 1 − cos θ) + R(θ) (a, z₀),   κ₁* = θ₁/p                           (F5)
/// ```
///
/// and `θ₁` is the first rotation at which a corner of one scale meets an edge of the other. For upright scales their tops
/// meet at `θ₁ = d/(1 + z₀)`.
///
/// # Errors
/// If a length is not positive or the slant is outside `[0°, 90°)`.
pub fn contact_curvature(
    design: &Design,
    parameters: &FlexureParameters,
) -> Result<Option<f64>, OutOfRange> {
    Ok(row_contact_curvature(&design.row()?, parameters))
}

/// As [`contact_curvature`], of a row, whose scales may lean the other way.
pub(super) fn row_contact_curvature(row: &Row, parameters: &FlexureParameters) -> Option<f64> {
    let gap = BareGap {
        row,
        pair: Pair::new(*row.scale(), row.pitch()),
        offset: parameters.membrane_axis_offset,
    };
    gap.closing_rotation().map(|rotation| rotation / row.pitch())
}

/// A gap whose membrane carries no force.
struct BareGap<'a> {
    row: &'a Row,
    pair: Pair,
    /// Depth of the axis of the membrane below the bases.
    offset: f64,
}

impl BareGap<'_> {
    /// The first rotation at which the neighbours touch.
    fn closing_rotation(&self) -> Option<f64> {
        let upright = self.row.gap() / (1.0 + self.offset);
        if self.row.scale().slant() == 0.0 && self.offset > -1.0 && upright <= LARGEST {
            return Some(upright);
        }
        let at = |look: u32| LARGEST * f64::from(look) / f64::from(LOOKS);
        let closed = (1..=LOOKS).find(|&look| self.touches(at(look)))?;
        Some(self.narrowed(at(closed - 1), at(closed)))
    }

    /// The rotation between `open` and `closed` at which the neighbours touch, to the last digit.
    fn narrowed(&self, mut open: f64, mut closed: f64) -> f64 {
        loop {
            let middle = f64::midpoint(open, closed);
            if middle <= open || middle >= closed {
                return closed;
            }
            if self.touches(middle) {
                closed = middle;
            } else {
                open = middle;
            }
        }
    }

    /// Whether a corner of one scale has reached an edge of the other.
    fn touches(&self, rotation: f64) -> bool {
        let (left, right) = (Pose::new(0.0, 0.0, 0.0), self.right(rotation));
        [Level::Upper, Level::Lower].into_iter().any(|level| {
            let facing = Corners::new(level, &self.pair, [&left, &right]).facing();
            facing.is_some_and(|(_, gap)| gap <= 0.0)
        })
    }

    /// The pose of the right scale (F5).
    fn right(&self, rotation: f64) -> Pose {
        let (sin, cos) = rotation.sin_cos();
        let (a, z0) = (self.row.scale().half_base(), self.offset);
        // 1 − cos θ without loss of digits.
        let versine = 2.0 * (0.5 * rotation).sin().powi(2);
        let chord = self.row.gap() / rotation;
        let x = a + chord * sin + cos * a - sin * z0;
        let y = -z0 + chord * versine + sin * a + cos * z0;
        Pose::new(x - self.row.pitch(), y, rotation)
    }
}
