//! The two corners that may meet at one level of a pair.

use std::f64::consts::FRAC_PI_2;

use geometry::{Corner, Vec2};

use crate::gap::{CornerEdge, Gap, Meeting, Pair, Pose};

/// Angle (radians) below which two edges count as parallel.
///
/// Between such edges, the force of two corners in contact would turn within the round-off of a
/// stiff contact. It is transferred at once, which skips a part of the path as small as this angle.
const PARALLEL: f64 = 1e-6;

/// Level of a pair at which two corners may meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Tops: top right corner of the left scale, top left corner of the right one.
    Upper,
    /// Bases: bottom right corner of the left scale, bottom left of the right one.
    Lower,
}

impl Level {
    /// Returns the corners that meet, of the left and the right scale.
    pub(crate) fn corners(self) -> [Corner; 2] {
        match self {
            Self::Upper => [Corner::TopRight, Corner::TopLeft],
            Self::Lower => [Corner::BottomRight, Corner::BottomLeft],
        }
    }

    /// Returns the contact of the tip with the neighbour's end.
    ///
    /// The tip is the sharp corner of this level.
    fn tip_on_end(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopRightOnTop,
            Self::Lower => CornerEdge::BottomLeftOnBase,
        }
    }

    /// Returns the contact of the tip with the neighbour's side.
    pub(crate) fn tip_on_side(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopRightOnLeftEdge,
            Self::Lower => CornerEdge::BottomLeftOnRightEdge,
        }
    }

    /// Returns the contact of the neighbour's corner with the side ending in the tip.
    fn corner_on_side(self) -> CornerEdge {
        match self {
            Self::Upper => CornerEdge::TopLeftOnRightEdge,
            Self::Lower => CornerEdge::BottomRightOnLeftEdge,
        }
    }
}

/// Two corners that may meet at one level of a pair, in given poses.
///
/// ```text
/// upper level:   P = TR of the left scale,   Q = TL of the right scale
/// lower level:   P = BR of the left scale,   Q = BL of the right scale
/// ```
///
/// One of the two corners, `P` above and `Q` below, has the acute angle of the slanted scale: the
/// *tip*. It may rest on the neighbour's side or on the neighbour's *end*, its top or base. The
/// neighbour's corner may rest on the side that ends in the tip. The inclination of that side
/// relative to the neighbour's end decides between tip on end and corner on side.
#[derive(Clone, Copy, Debug)]
pub struct Corners<'a> {
    pub(crate) level: Level,
    pub(crate) pair: &'a Pair,
    pub(crate) poses: [&'a Pose; 2],
}

/// Angle with its derivative with respect to the rotation of the left scale.
///
/// The derivative with respect to the rotation of the right scale is the opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angle {
    pub(crate) value: f64,
    pub(crate) slope: f64,
}

impl<'a> Corners<'a> {
    /// Selects the corners at a level of `pair`.
    ///
    /// `poses` holds the poses of the left and the right scale.
    pub fn new(level: Level, pair: &'a Pair, poses: [&'a Pose; 2]) -> Self {
        Self { level, pair, poses }
    }

    /// Returns the corner that faces an edge while the contact is open, with its gap.
    ///
    /// The gap is over `t`. If both corners have their foot within an edge, the corner of the left
    /// scale counts. `None` if neither has.
    pub fn facing(&self) -> Option<(CornerEdge, f64)> {
        self.meeting().map(|(edge, meeting)| (edge, meeting.gap))
    }

    /// Returns the corner of [`Self::facing`] with its relation to the edge.
    pub(crate) fn meeting(&self) -> Option<(CornerEdge, Meeting)> {
        let (leaning, on_side) = (self.leaning(), self.level.tip_on_side());
        // The corner of the left scale comes first; at the upper level it is the tip.
        let edges = match self.level {
            Level::Upper => [on_side, leaning],
            Level::Lower => [leaning, on_side],
        };
        self.pair.facing(edges, self.poses)
    }

    /// Computes the gap between a corner and an edge of this level.
    pub fn gap(&self, edge: CornerEdge) -> Gap {
        let [left, right] = self.poses;
        self.pair.gap(edge, left, right)
    }

    /// Returns the normal of an edge of this level, in the poses.
    pub(crate) fn normal(&self, edge: CornerEdge) -> Vec2 {
        edge.normal(self.pair, self.poses).0
    }

    /// Computes the tangential displacement between a corner and an edge of this level.
    pub(crate) fn slide(&self, edge: CornerEdge) -> Gap {
        let [left, right] = self.poses;
        self.pair.slide(edge, left, right)
    }

    /// Returns the two contacts that meet in the state corner on corner.
    ///
    /// The first is the contact `edge` that reached the corner, in the form that it would have on
    /// leaving it; the second is its partner.
    pub fn together(&self, edge: CornerEdge) -> [CornerEdge; 2] {
        let (leaning, on_side) = (self.leaning(), self.level.tip_on_side());
        if edge == on_side { [on_side, leaning] } else { [leaning, on_side] }
    }

    /// Returns true if the facing sides are parallel up to a negligible angle.
    ///
    /// The force then need not turn from the normal of one to the normal of the other.
    pub fn are_sides_parallel(&self) -> bool {
        // A slant turns an edge clockwise.
        let [of_left, of_right] = self.pair.scales();
        let at_rest = of_left.slant() - of_right.slant();
        // Rotations accumulate over full turns, so compare their sine.
        (self.turned() - at_rest).sin().abs() < PARALLEL
    }

    /// Computes the rotation of the left scale relative to the right one, radians.
    fn turned(&self) -> f64 {
        self.poses[0].rotation - self.poses[1].rotation
    }

    /// Returns corner on side or tip on end, by the inclination of the side.
    fn leaning(&self) -> CornerEdge {
        if self.beyond_level() > 0.0 {
            self.level.tip_on_end()
        } else {
            self.level.corner_on_side()
        }
    }

    /// Computes the angle (radians) of the side of the tip beyond the neighbour's end.
    ///
    /// At zero the side is level with that end.
    fn beyond_level(&self) -> f64 {
        let [of_left, of_right] = self.pair.scales();
        let from_the_vertical = match self.level {
            Level::Upper => of_left.slant() - self.turned(),
            Level::Lower => of_right.slant() + self.turned(),
        };
        from_the_vertical - FRAC_PI_2
    }

    /// Computes `β` of (C7), the angle to the flush state.
    ///
    /// If the corner rests on the side (`flush` is then the tip on the end), `β` is the angle by
    /// which the side is short of level. If the tip rests on the end, `β` is the angle beyond
    /// level.
    pub(crate) fn angle_to_flush(&self, flush: CornerEdge) -> Angle {
        let toward = if flush == self.level.tip_on_end() { -1.0 } else { 1.0 };
        let turning = if self.level == Level::Upper { -1.0 } else { 1.0 };
        Angle { value: toward * self.beyond_level(), slope: toward * turning }
    }

    /// Returns true if a flush corner has not passed the far end of its edge.
    ///
    /// The far end is the one away from the meeting corners.
    pub(crate) fn is_within_far_end(&self, flush: CornerEdge) -> bool {
        let foot = self.pair.foot(flush, self.poses);
        match (self.level, flush == self.level.tip_on_end()) {
            (Level::Upper, true) | (Level::Lower, false) => foot <= 1.0,
            (Level::Upper, false) | (Level::Lower, true) => foot >= 0.0,
        }
    }
}
