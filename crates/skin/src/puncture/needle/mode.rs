//! What a guided needle touches, and how it rubs there.

use super::round::FARTHEST_TOUCH;

/// A place on the outline of a scale, in the order in which one goes along it, from the left foot over the top to the right foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The left face.
    Left,
    /// The corner between the left face and the top.
    TopLeft,
    /// The top.
    Top,
    /// The corner between the top and the right face.
    TopRight,
    /// The right face.
    Right,
}

impl Place {
    const ALL: [Self; 5] = [Self::Left, Self::TopLeft, Self::Top, Self::TopRight, Self::Right];

    /// The next place along the outline, forward or backward; `None` at a foot.
    pub(crate) fn next(self, forward: bool) -> Option<Self> {
        let here = Self::ALL.iter().position(|place| *place == self)?;
        let next = if forward { here + 1 } else { here.checked_sub(1)? };
        Self::ALL.get(next).copied()
    }
}

/// How the tip of a needle moves at the place that it touches: the law of its tangential force `T`, with its normal force `N` and its
/// coordinate `ξ` along the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rub {
    /// It slides: `T = sign μ N` with the sign of `ξ̇`, 0 without friction. It has done so since `ξ` was `from`.
    Slip { sign: f64, from: f64 },
    /// It sticks: `ξ = at`, its anchor, and `T` is unknown.
    Stick { at: f64 },
    /// It passes over a corner, forward or backward along the outline: `ξ = 0` in the frame of the corner, and `T` is unknown.
    Passing { forward: bool },
    /// It is held in a notch by the neighbour's face: nothing moves, and `T = ratio N` stays what it was.
    Held { ratio: f64 },
}

/// A scale that the needle touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Number of the scale, from the punctured one to the right.
    pub(crate) scale: i64,
    pub(crate) place: Place,
    pub(crate) rub: Rub,
}

impl Touch {
    pub(crate) fn is_held(&self) -> bool {
        matches!(self.rub, Rub::Held { .. })
    }

    /// Whether the equations keep something of the way to the state: where the tip sticks, or with what force it is held.
    pub(crate) fn has_history(&self) -> bool {
        matches!(self.rub, Rub::Stick { .. } | Rub::Held { .. })
    }
}

/// The state of a guided needle, history included: the scales that it touches, which are neighbours if they are two. Nothing in a row
/// under a free needle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NeedleMode {
    pub(crate) touches: [Option<Touch>; 2],
    /// Where a round tip touches each scale, from the left.
    places: [Option<Place>; SLOTS],
}

/// Scales that a round tip may come to.
const SLOTS: usize = 2 * FARTHEST_TOUCH + 1;

impl Default for NeedleMode {
    fn default() -> Self {
        Self { touches: [None; 2], places: [None; SLOTS] }
    }
}

impl NeedleMode {
    /// Where a round tip touches a scale, counted from the punctured one.
    pub(crate) fn place(&self, scale: i64) -> Option<Place> {
        self.places.get((scale + FARTHEST_TOUCH as i64) as usize).copied().flatten()
    }

    /// Lets a round tip touch a scale at a place.
    pub(crate) fn set_place(&mut self, scale: i64, place: Option<Place>) {
        self.places[(scale + FARTHEST_TOUCH as i64) as usize] = place;
    }

    /// The scales that are touched, counted from the punctured one.
    pub(crate) fn touched(&self) -> impl Iterator<Item = i64> {
        let sharp = self.touches.iter().flatten().map(|touch| touch.scale);
        let first = -(FARTHEST_TOUCH as i64);
        let round = (first..).zip(&self.places).filter(|(_, place)| place.is_some());
        sharp.chain(round.map(|(scale, _)| scale))
    }
}
