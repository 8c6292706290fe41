//! The two corners that may touch at one level of a pair: gaps, normals and angles.

use std::f64::consts::FRAC_PI_2;

use geometry::{Corner, Vec2};

use crate::gap::{CornerEdge, CornerPosition, Gap, Pair, Pose};

/// Angle (radians) below which two sides count as parallel.
///
/// Between nearly parallel sides, the approach of a stiff contact is too small to resolve the state
/// corner on corner. The contact then switches to the other side at once. The error is of the order
/// of this angle.
const PARALLEL: f64 = 1e-6;

/// Level of a pair at which two corners may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Top right corner of the left scale and top left corner of the right scale.
    Upper,
    /// Bottom right corner of the left scale and bottom left corner of the right scale.
    Lower,
}

impl Level {
    /// Returns the corner of the left scale and the corner of the right scale at this level.
    pub(crate) fn corners(self) -> [Corner; 2] {
        match self {
            Self::Upper => [Corner::TopRight, Corner::TopLeft],
            Self::Lower => [Corner::BottomRight, Corner::BottomLeft],
        }
    }

    /// Returns the contact of the tip, the acute corner, with the neighbour's top or base.
    fn tip_on_end(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopRightOnTop,
            Self::Lower => CornerEdge::BottomLeftOnBase,
        }
    }

    /// Returns the contact of the tip, the acute corner, with the neighbour's side.
    pub(crate) fn tip_on_side(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopRightOnLeftEdge,
            Self::Lower => CornerEdge::BottomLeftOnRightEdge,
        }
    }

    /// Returns the contact of the neighbour's corner with the side that ends in the tip.
    fn corner_on_side(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopLeftOnRightEdge,
            Self::Lower => CornerEdge::BottomRightOnLeftEdge,
        }
    }
}

/// Two corners that may touch at one level of a pair, in given poses.
///
/// ```text
/// upper level:   P = TR of the left scale,   Q = TL of the right scale
/// lower level:   P = BR of the left scale,   Q = BL of the right scale
/// ```
///
/// An acute corner of a slanted scale is a *tip*: `P` at the upper level, `Q` at the lower level.
/// The top and the base are the *end faces* of a scale. Three contacts are possible at a level:
///
/// - tip on side: the tip rests on the neighbour's side;
/// - tip on end: the tip rests on the neighbour's end face;
/// - corner on side: the neighbour's corner rests on the side that ends in the tip.
///
/// The angle between the side that ends in the tip and the neighbour's end face decides between tip
/// on end and corner on side.
#[derive(Clone, Copy, Debug)]
pub struct Corners<'a> {
    pub(crate) level: Level,
    pub(crate) pair: &'a Pair,
    pub(crate) poses: [&'a Pose; 2],
}

/// Angle in radians, with its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angle {
    pub(crate) value: f64,
    /// Derivative with respect to the rotation of the left scale.
    ///
    /// The derivative with respect to the rotation of the right scale is `-slope`.
    pub(crate) slope: f64,
}

impl<'a> Corners<'a> {
    /// Creates the corners at `level` of `pair`, with the poses of the left and the right scale.
    pub fn new(level: Level, pair: &'a Pair, poses: [&'a Pose; 2]) -> Self {
        Self { level, pair, poses }
    }

    /// Returns the corner and edge that face each other in an open contact, with the gap.
    ///
    /// A corner faces an edge if its projection (foot) lies within the edge. If both corners face
    /// an edge, the corner of the left scale is returned; `None` if no corner faces an edge. The
    /// gap is in units of `t`.
    pub fn facing(&self) -> Option<(CornerEdge, f64)> {
        self.facing_position().map(|(edge, position)| (edge, position.gap))
    }

    /// Returns the corner and edge of [`Self::facing`], with their relative position.
    pub(crate) fn facing_position(&self) -> Option<(CornerEdge, CornerPosition)> {
        let (leaning, on_side) = (self.leaning(), self.level.tip_on_side());
        // The corner of the left scale is first in the list; at the upper level it is the tip.
        let edges = match self.level {
            Level::Upper => [on_side, leaning],
            Level::Lower => [leaning, on_side],
        };
        self.pair.facing(edges, self.poses)
    }

    /// Computes the gap between a corner and an edge of this level, with derivatives.
    pub fn gap(&self, edge: CornerEdge) -> Gap {
        let [left, right] = self.poses;
        self.pair.gap(edge, left, right)
    }

    /// Returns the direction of a contact force on the left scale, in the current poses.
    pub(crate) fn normal(&self, edge: CornerEdge) -> Vec2 {
        edge.normal(self.pair, self.poses).0
    }

    /// Computes the tangential coordinate of a corner along an edge, as [`Pair::slide`].
    pub(crate) fn slide(&self, edge: CornerEdge) -> Gap {
        let [left, right] = self.poses;
        self.pair.slide(edge, left, right)
    }

    /// Returns the two contacts that act in the state corner on corner: own and partner.
    ///
    /// `edge` is the own contact at the time when the corners coincided. If `edge` is corner on
    /// side or tip on end, the current angle of the side selects between these two contacts.
    pub fn together(&self, edge: CornerEdge) -> [CornerEdge; 2] {
        let (leaning, on_side) = (self.leaning(), self.level.tip_on_side());
        if edge == on_side { [on_side, leaning] } else { [leaning, on_side] }
    }

    /// Returns true if the two facing sides of the pair are parallel up to a negligible angle.
    ///
    /// A contact that reaches the corner then switches to the other side at once.
    pub fn are_sides_parallel(&self) -> bool {
        // A slant rotates a side clockwise.
        let [of_left, of_right] = self.pair.scales();
        let at_rest = of_left.slant() - of_right.slant();
        // Rotations may contain full turns, so compare the sine of their difference.
        (self.turned() - at_rest).sin().abs() < PARALLEL
    }

    /// Returns the rotation of the left scale relative to the right scale, radians.
    fn turned(&self) -> f64 {
        self.poses[0].rotation - self.poses[1].rotation
    }

    /// Returns the contact corner on side or tip on end, depending on the angle of the side.
    fn leaning(&self) -> CornerEdge {
        if self.beyond_flush() > 0.0 {
            self.level.tip_on_end()
        } else {
            self.level.corner_on_side()
        }
    }

    /// Returns the angle from the neighbour's end face to the side that ends in the tip, radians.
    ///
    /// The angle is zero if side and end face are parallel, and positive if the side has rotated
    /// beyond this position, so that only the tip can rest on the end face.
    fn beyond_flush(&self) -> f64 {
        let [of_left, of_right] = self.pair.scales();
        let from_the_vertical = match self.level {
            Level::Upper => of_left.slant() - self.turned(),
            Level::Lower => of_right.slant() + self.turned(),
        };
        from_the_vertical - FRAC_PI_2
    }

    /// Returns the angle `β` of (C7) between the side that ends in the tip and the end face.
    ///
    /// `flush` is the contact that begins to act at `β = 0`. `β` is positive as long as the other
    /// contact alone can act: before the parallel position if `flush` is tip on end, beyond it if
    /// `flush` is corner on side.
    pub(crate) fn angle_to_flush(&self, flush: CornerEdge) -> Angle {
        let toward = if flush == self.level.tip_on_end() { -1.0 } else { 1.0 };
        let turning = if self.level == Level::Upper { -1.0 } else { 1.0 };
        Angle { value: toward * self.beyond_flush(), slope: toward * turning }
    }

    /// Returns true if the corner of the contact `flush` has not passed the far end of its edge.
    ///
    /// The far end is opposite to the end at which the two corners of this level lie.
    pub(crate) fn is_within_far_end(&self, flush: CornerEdge) -> bool {
        let foot = self.pair.foot(flush, self.poses);
        match (self.level, flush == self.level.tip_on_end()) {
            (Level::Upper, true) | (Level::Lower, false) => foot <= 1.0,
            (Level::Upper, false) | (Level::Lower, true) => foot >= 0.0,
        }
    }
}
