//! The two corners that may meet at one level of a pair.

use std::f64::consts::FRAC_PI_2;

use geometry::Corner;

use crate::gap::{CornerEdge, Gap, Meeting, Pair, Pose};

/// Edges at a smaller angle than this (radians) count as parallel. Between them the force of corners that are
/// together turns within round-off of a stiff contact, so it is handed over at once: the path skips a part of
/// it as small as this angle.
const PARALLEL: f64 = 1e-6;

/// Level of a pair at which two corners may meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// At the tops: the top right corner of the left scale and the top left corner of the right one.
    Upper,
    /// At the bases: the bottom right corner of the left scale and the bottom left corner of the right one.
    Lower,
}

impl Level {
    /// The corners that meet: of the left and of the right scale.
    pub(crate) fn corners(self) -> [Corner; 2] {
        match self {
            Self::Upper => [Corner::TopRight, Corner::TopLeft],
            Self::Lower => [Corner::BottomRight, Corner::BottomLeft],
        }
    }

    /// The contact of the tip, the sharp corner of this level, with the neighbour's top or base.
    fn tip_on_end(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopRightOnTop,
            Self::Lower => CornerEdge::BottomLeftOnBase,
        }
    }

    /// The contact of the tip with the neighbour's side.
    pub(crate) fn tip_on_side(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopRightOnLeftEdge,
            Self::Lower => CornerEdge::BottomLeftOnRightEdge,
        }
    }

    /// The contact of the neighbour's corner with the side that ends in the tip.
    fn corner_on_side(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopLeftOnRightEdge,
            Self::Lower => CornerEdge::BottomRightOnLeftEdge,
        }
    }
}

/// The two corners that may meet at one level of a pair, the scales in given poses.
///
/// ```text
/// upper level:   P = TR of the left scale,   Q = TL of the right scale
/// lower level:   P = BR of the left scale,   Q = BL of the right scale
/// ```
///
/// One of the two, `P` above and `Q` below, is as sharp as the scales are slanted: the *tip*. It may rest on the
/// neighbour's side or on the neighbour's *end*, its top or base. The neighbour's corner may rest on the side that
/// ends in the tip. Which of tip on end and corner on side is possible depends on whether that side leans beyond the
/// level of the neighbour's end.
#[derive(Clone, Copy, Debug)]
pub struct Corners<'a> {
    pub(crate) level: Level,
    pub(crate) pair: &'a Pair,
    pub(crate) poses: [&'a Pose; 2],
}

/// An angle and its derivative with respect to the rotation of the left scale. The derivative with respect to the
/// rotation of the right scale is the opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angle {
    pub(crate) value: f64,
    pub(crate) slope: f64,
}

impl<'a> Corners<'a> {
    /// The corners at a level of `pair`, the left and the right scale in `poses`.
    pub fn new(level: Level, pair: &'a Pair, poses: [&'a Pose; 2]) -> Self {
        Self { level, pair, poses }
    }

    /// The corner that faces an edge of the neighbour while the contact is open, and its gap over `t`. Of two corners
    /// that both have their foot within an edge, that of the left scale counts. `None` if neither has.
    pub fn facing(&self) -> Option<(CornerEdge, f64)> {
        self.meeting().map(|(edge, meeting)| (edge, meeting.gap))
    }

    /// The corner of [`Self::facing`] and the edge that it faces.
    pub(crate) fn meeting(&self) -> Option<(CornerEdge, Meeting)> {
        let (leaning, on_side) = (self.leaning(), self.level.tip_on_side());
        // The corner of the left scale comes first: that of the upper level is the tip.
        let edges = match self.level {
            Level::Upper => [on_side, leaning],
            Level::Lower => [leaning, on_side],
        };
        self.pair.facing(edges, self.poses)
    }

    /// The gap between a corner and an edge of this level.
    pub(crate) fn gap(&self, edge: CornerEdge) -> Gap {
        let [left, right] = self.poses;
        self.pair.gap(edge, left, right)
    }

    /// The contacts on both sides of the place where the two corners are together: the one that arrives there as
    /// `edge`, in the form in which it would leave again, and its partner.
    pub fn together(&self, edge: CornerEdge) -> [CornerEdge; 2] {
        let (leaning, on_side) = (self.leaning(), self.level.tip_on_side());
        if edge == on_side { [on_side, leaning] } else { [leaning, on_side] }
    }

    /// Whether the sides that face each other are so nearly parallel that a force need not turn from the normal of one
    /// to that of the other.
    pub fn are_sides_parallel(&self) -> bool {
        // A slant turns an edge clockwise.
        let [of_left, of_right] = self.pair.scales();
        let at_rest = of_left.slant() - of_right.slant();
        // The sine knows no turns: rotations are counted beyond a full one.
        (self.turned() - at_rest).sin().abs() < PARALLEL
    }

    /// Rotation of the left scale against the right one, radians.
    fn turned(&self) -> f64 {
        self.poses[0].rotation - self.poses[1].rotation
    }

    /// Which of corner on side and tip on end is possible.
    fn leaning(&self) -> CornerEdge {
        if self.beyond_level() > 0.0 {
            self.level.tip_on_end()
        } else {
            self.level.corner_on_side()
        }
    }

    /// Angle (radians) by which the side that ends in the tip leans beyond the level of the neighbour's end.
    fn beyond_level(&self) -> f64 {
        let [of_left, of_right] = self.pair.scales();
        let from_the_vertical = match self.level {
            Level::Upper => of_left.slant() - self.turned(),
            Level::Lower => of_right.slant() + self.turned(),
        };
        from_the_vertical - FRAC_PI_2
    }

    /// `β` of (C7): the angle by which the side is short of level while the corner rests on it (`flush` is then the tip
    /// on the end), or beyond level while the tip rests on the end.
    pub(crate) fn angle_to_flush(&self, flush: CornerEdge) -> Angle {
        let toward = if flush == self.level.tip_on_end() { -1.0 } else { 1.0 };
        let turning = if self.level == Level::Upper { -1.0 } else { 1.0 };
        Angle { value: toward * self.beyond_level(), slope: toward * turning }
    }

    /// Whether the corner of a flush contact has not passed the end of its edge that is far from where the corners meet.
    pub(crate) fn is_within_far_end(&self, flush: CornerEdge) -> bool {
        let foot = self.pair.foot(flush, self.poses);
        match (self.level, flush == self.level.tip_on_end()) {
            (Level::Upper, true) | (Level::Lower, false) => foot <= 1.0,
            (Level::Upper, false) | (Level::Lower, true) => foot >= 0.0,
        }
    }
}
