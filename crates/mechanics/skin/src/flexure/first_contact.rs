//! Curvature at which the scales of a strip first touch.
//!
//! It is independent of the end of the path.

use std::f64::consts::PI;

use contact::{CornerEdge, Corners, Level, Pair, Pose};
use geometry::{OutOfRange, Parallelogram, Row, UnevenRow, Vec2};
use solver::Neighbours;

use super::{FlexureInput, FlexureParameters};
use crate::{Derivative, Design};

/// Sample rotations used to bracket the rotation at which a gap closes.
const SAMPLES: u32 = 512;

/// Largest rotation of a gap: beyond it the arc of the membrane turns back.
const LARGEST_ROTATION: f64 = PI;

/// Returns the curvature `κ₁*` at which neighbours first touch.
///
/// The scales are on the inside of the bend. `None` if the gap does not close before its membrane
/// has turned by half a circle.
///
/// Before contact no force acts in the membrane, so it is an arc of length `d` whatever its
/// stiffness. With the depth `z₀` of the axis below the bases and the rotation `θ`, the node of the
/// right scale in the frame of the left one is at
///
/// ```text
/// (a, −z₀) + d/θ (sin θ, 1 − cos θ) + R(θ) (a, z₀),   κ₁* = θ₁/p                           (F5)
/// ```
///
/// `θ₁` is the first rotation at which a corner of one scale meets an edge of the other. For
/// upright scales the tops meet at `θ₁ = d/(1 + z₀)`.
///
/// # Errors
/// If a length is not positive or the slant is outside `[0°, 90°)`.
pub fn contact_curvature(
    design: &Design,
    parameters: &FlexureParameters,
) -> Result<Option<f64>, OutOfRange> {
    Ok(contact_curvature_of_row(&design.row()?, parameters))
}

/// Returns the curvature `κ₁*` at which neighbours in this row first touch.
pub(super) fn contact_curvature_of_row(row: &Row, parameters: &FlexureParameters) -> Option<f64> {
    let gap = BareGap::from_row(row, parameters);
    gap.closing_rotation(LARGEST_ROTATION).map(|rotation| rotation / gap.pair.offset().x)
}

/// Returns the curvature at which the first gap of an imperfect strip closes.
///
/// All gaps carry the same moment, so before contact they are arcs of one curvature `θ/d`, and the
/// strip as a whole turns by that curvature times `Σd`:
///
/// ```text
/// κ₁* = minᵢ(θ₁ᵢ/dᵢ) Σd/Σp                                                                  (F9)
/// ```
pub(super) fn first_of_gaps(row: &UnevenRow, parameters: &FlexureParameters) -> Option<f64> {
    // Gaps that would close later, or only after half a circle, do not matter.
    let arc = (0..row.gaps().len()).fold(f64::INFINITY, |first, i| {
        let scales = [row.scales()[i], row.scales()[i + 1]];
        let gap = BareGap::new(scales, [row.pitch(i), row.gaps()[i]], parameters);
        let closing = gap.closing_rotation(LARGEST_ROTATION.min(first * gap.width));
        closing.map_or(first, |rotation| first.min(rotation / gap.width))
    });
    arc.is_finite().then(|| arc * row.gaps().iter().sum::<f64>() / row.length())
}

/// Returns the derivatives of [`contact_curvature`] from the gap `g(θ, q)` that vanishes there:
///
/// ```text
/// dκ₁/dq = d(θ₁/p)/dq,   dθ₁/dq = −(∂g/∂q)/(∂g/∂θ)                                          (F6)
/// ```
///
/// If several corners compete, the derivative on each side of the parameter belongs to the corner
/// nearest to its edge there.
pub(super) fn curvature_derivatives(
    input: &FlexureInput,
    variations: &[Neighbours<FlexureInput>],
) -> Result<Vec<Derivative>, OutOfRange> {
    let gap = BareGap::from_input(input)?;
    let Some(rotation) = gap.closing_rotation(LARGEST_ROTATION) else { return Ok(Vec::new()) };
    variations
        .iter()
        .enumerate()
        .map(|(parameter, variation)| {
            let Neighbours { below, above, step } = variation;
            let neighbours = [BareGap::from_input(below)?, BareGap::from_input(above)?];
            // For upright scales corners meet corners, and neither may face an edge.
            let own = gap.meeting(rotation).unwrap_or(CornerEdge::TopRightOnLeftEdge);
            let meetings = neighbours.each_ref().map(|side| side.meeting(rotation).unwrap_or(own));
            let (measure, value) = ("contact_curvature", rotation / gap.pair.offset().x);
            Ok(Derivative::sided(
                (measure, parameter),
                meetings
                    .map(|meeting| Some(gap.closing_rate(meeting, rotation, &neighbours, *step))),
                value,
                *step,
                || "another corner meets an edge".to_owned(),
            ))
        })
        .collect()
}

/// Distance within which a corner is about to meet its edge.
const CLOSE: f64 = 1e-3;

/// Step of the difference in rotation, relative to the rotation.
const STEP: f64 = 1e-6;

/// A gap with a force-free membrane.
struct BareGap {
    pair: Pair,
    width: f64,
    /// Depth of the membrane axis below the bases.
    offset: f64,
}

impl BareGap {
    fn new(
        scales: [Parallelogram; 2],
        [pitch, width]: [f64; 2],
        parameters: &FlexureParameters,
    ) -> Self {
        let offset = parameters.membrane_axis_offset;
        Self { pair: Pair::between(scales, Vec2::new(pitch, 0.0)), width, offset }
    }

    fn from_row(row: &Row, parameters: &FlexureParameters) -> Self {
        Self::new([*row.scale(); 2], [row.pitch(), row.gap()], parameters)
    }

    fn from_input(input: &FlexureInput) -> Result<Self, OutOfRange> {
        Ok(Self::from_row(&input.design.leaning_row()?, &input.parameters))
    }

    /// Computes the derivative of the curvature at which a corner meets its edge.
    ///
    /// The `neighbours` differ by `2 step` in a parameter.
    fn closing_rate(
        &self,
        meeting: CornerEdge,
        rotation: f64,
        neighbours: &[Self; 2],
        step: f64,
    ) -> f64 {
        let turn = STEP * rotation;
        let by_rotation = (self.opening(meeting, rotation + turn)
            - self.opening(meeting, rotation - turn))
            / (2.0 * turn);
        let [below, above] = neighbours.each_ref().map(|gap| gap.opening(meeting, rotation));
        let turned = -(above - below) / (2.0 * step) / by_rotation;
        let [below, above] = neighbours.each_ref().map(|gap| gap.pair.offset().x);
        // `κ₁* = θ₁/p`, and the pitch depends on the parameter, too.
        let pitch = self.pair.offset().x;
        (turned - rotation / pitch * (above - below) / (2.0 * step)) / pitch
    }

    /// Computes the distance of a corner from its edge.
    fn opening(&self, corner_edge: CornerEdge, rotation: f64) -> f64 {
        self.pair.distance(corner_edge, &Pose::new(0.0, 0.0, 0.0), &self.right(rotation))
    }

    /// Returns the corner that is about to meet the edge it faces.
    fn meeting(&self, rotation: f64) -> Option<CornerEdge> {
        let close = self.facing(rotation).filter(|(_, gap)| gap.abs() < CLOSE);
        close.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(meeting, _)| meeting)
    }

    /// Returns the first rotation up to `farthest` at which the neighbours touch.
    fn closing_rotation(&self, farthest: f64) -> Option<f64> {
        // Upright scales meet corner on corner, where no foot is within an edge, so a search for a
        // corner that faces an edge would miss the contact.
        let upright = self.width / (1.0 + self.offset);
        let stands = self.pair.scales().iter().all(|scale| scale.slant() == 0.0);
        if stands && self.offset > -1.0 && upright <= LARGEST_ROTATION {
            return (upright <= farthest).then_some(upright);
        }
        // Start above zero, because the radius of the arc is infinite at zero.
        let samples =
            (1..=SAMPLES).map(|sample| LARGEST_ROTATION * f64::from(sample) / f64::from(SAMPLES));
        let mut open = 0.0;
        for rotation in samples.take_while(|sample| *sample < farthest).chain([farthest]) {
            if self.touches(rotation) {
                return Some(self.narrowed(open, rotation));
            }
            open = rotation;
        }
        None
    }

    /// Bisects for the rotation of first contact between `open` and `closed`.
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

    /// Returns true if a corner of one scale has reached an edge of the other.
    fn touches(&self, rotation: f64) -> bool {
        self.facing(rotation).any(|(_, gap)| gap <= 0.0)
    }

    /// Iterates over the corners that face an edge, with their gaps.
    fn facing(&self, rotation: f64) -> impl Iterator<Item = (CornerEdge, f64)> {
        let (left, right) = (Pose::new(0.0, 0.0, 0.0), self.right(rotation));
        [Level::Upper, Level::Lower]
            .into_iter()
            .filter_map(move |level| Corners::new(level, &self.pair, [&left, &right]).facing())
    }

    /// Computes the pose of the right scale (F5).
    fn right(&self, rotation: f64) -> Pose {
        let (sin, cos) = rotation.sin_cos();
        // Scales of a sample differ in slant, not in base.
        let (a, z0) = (self.pair.scales()[0].half_base(), self.offset);
        // 1 − cos θ without cancellation.
        let versine = 2.0 * (0.5 * rotation).sin().powi(2);
        let chord = self.width / rotation;
        let x = a + chord * sin + cos * a - sin * z0;
        let y = -z0 + chord * versine + sin * a + cos * z0;
        Pose::new(x - self.pair.offset().x, y, rotation)
    }
}
