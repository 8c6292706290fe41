//! Closed form of the curvature at which the scales of a strip first touch.
//!
//! The curvature exists even if bending stops before contact.

use std::f64::consts::PI;

use contact::{CornerEdge, Corners, Level, Pair, Pose};
use geometry::{OutOfRange, Parallelogram, Row, UnevenRow, Vec2};
use solver::Neighbours;

use super::{FlexureInput, FlexureParameters};
use crate::{Derivative, Design};

/// Number of sample rotations used to bracket the rotation at which a gap closes.
const SAMPLES: u32 = 512;

/// Largest rotation of a gap considered for contact: half a turn, radians.
const LARGEST_ROTATION: f64 = PI;

/// Computes the curvature `κ₁*` at which neighbours first touch.
///
/// The scales are on the inside of the bend. `None` if neighbours do not touch up to a relative
/// rotation of half a turn.
///
/// Before contact no force acts in the membrane, so it is an arc of length `d` for any stiffness.
/// With the depth `z₀` of the axis below the bases and the rotation `θ`, the node of the right
/// scale, seen from the left scale, is at
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

/// Computes the curvature `κ₁*` at which neighbours in an even row first touch.
pub(super) fn contact_curvature_of_row(row: &Row, parameters: &FlexureParameters) -> Option<f64> {
    let gap = BareGap::from_row(row, parameters);
    gap.closing_rotation(LARGEST_ROTATION).map(|rotation| rotation / gap.pair.offset().x)
}

/// Computes the curvature at which the first gap of an imperfect strip closes.
///
/// All gaps carry the same moment, so before contact their membranes are arcs of the same curvature
/// `θ/d`. The whole strip then turns by this curvature times `Σd`, over its length `Σp`:
///
/// ```text
/// κ₁* = minᵢ(θ₁ᵢ/dᵢ) Σd/Σp                                                                  (F9)
/// ```
pub(super) fn first_of_gaps(row: &UnevenRow, parameters: &FlexureParameters) -> Option<f64> {
    // Search each gap only up to the curvature at which an earlier gap closes.
    let arc = (0..row.gaps().len()).fold(f64::INFINITY, |first, i| {
        let scales = [row.scales()[i], row.scales()[i + 1]];
        let gap = BareGap::new(scales, [row.pitch(i), row.gaps()[i]], parameters);
        let closing = gap.closing_rotation(LARGEST_ROTATION.min(first * gap.width));
        closing.map_or(first, |rotation| first.min(rotation / gap.width))
    });
    arc.is_finite().then(|| arc * row.gaps().iter().sum::<f64>() / row.length())
}

/// Computes the derivatives of [`contact_curvature`] with respect to the varied parameters `q`.
///
/// The distance `g(θ, q)` of a corner from the edge that it meets vanishes at first contact, so
///
/// ```text
/// dκ₁/dq = d(θ₁/p)/dq,   dθ₁/dq = −(∂g/∂q)/(∂g/∂θ)                                          (F6)
/// ```
///
/// If two corners reach their edges at almost the same rotation, the derivative on each side of the
/// parameter belongs to the corner nearest to its edge on this side.
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
            // Corners of upright scales meet corners. If none faces an edge, use the upper one.
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

/// Distance in units of `t` within which a corner counts as about to meet its edge.
const CLOSE: f64 = 1e-3;

/// Step of the difference quotient in the rotation, relative to the rotation.
const STEP: f64 = 1e-6;

/// A gap between two scales with a force-free membrane; lengths in units of `t`.
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

    /// Computes the derivative of the curvature at which the corner of `meeting` meets its edge.
    ///
    /// `neighbours` are the gaps for the parameter decreased and increased by `step`.
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
        // Differentiate `κ₁* = θ₁/p`, in which both `θ₁` and `p` depend on the parameter.
        let pitch = self.pair.offset().x;
        (turned - rotation / pitch * (above - below) / (2.0 * step)) / pitch
    }

    /// Computes the distance of a corner from its edge at a rotation of the gap.
    fn opening(&self, corner_edge: CornerEdge, rotation: f64) -> f64 {
        self.pair.distance(corner_edge, &Pose::new(0.0, 0.0, 0.0), &self.right(rotation))
    }

    /// Returns the corner and edge that are about to meet; `None` if no corner is close to an edge.
    fn meeting(&self, rotation: f64) -> Option<CornerEdge> {
        let close = self.facing(rotation).filter(|(_, gap)| gap.abs() < CLOSE);
        close.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(meeting, _)| meeting)
    }

    /// Returns the first rotation up to `farthest` at which the neighbours touch.
    fn closing_rotation(&self, farthest: f64) -> Option<f64> {
        // The tops of upright scales meet corner on corner. No corner then faces an edge, and the
        // search below would miss the contact.
        let upright = self.width / (1.0 + self.offset);
        let stands = self.pair.scales().iter().all(|scale| scale.slant() == 0.0);
        if stands && self.offset > -1.0 && upright <= LARGEST_ROTATION {
            return (upright <= farthest).then_some(upright);
        }
        // Start above zero, because the radius of the arc is infinite at zero rotation.
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

    /// Finds the rotation of first contact between the rotations `open` and `closed` by bisection.
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

    /// Computes the pose of the right scale relative to the left scale (F5).
    fn right(&self, rotation: f64) -> Pose {
        let (sin, cos) = rotation.sin_cos();
        // Both scales have the same base, also in an imperfect strip.
        let (a, z0) = (self.pair.scales()[0].half_base(), self.offset);
        // Compute `1 − cos θ` without cancellation.
        let versine = 2.0 * (0.5 * rotation).sin().powi(2);
        let chord = self.width / rotation;
        let x = a + chord * sin + cos * a - sin * z0;
        let y = -z0 + chord * versine + sin * a + cos * z0;
        Pose::new(x - self.pair.offset().x, y, rotation)
    }
}
