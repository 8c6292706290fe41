//! What a guided needle touches, and how it rubs there.

/// A place on the outline of a scale, in the order in which one goes along it, from the left foot over the top to the right foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd)]
pub(crate) enum OutlinePart {
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

impl OutlinePart {
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
pub(crate) enum TipState {
    /// It slides: `T = sign μ N` with the sign of `ξ̇`, 0 without friction. It has done so since `ξ` was `from`.
    Slip { sign: f64, start: f64 },
    /// It sticks: `ξ = at`, its anchor, and `T` is unknown.
    Stick { anchor: f64 },
    /// It passes over a corner, forward or backward along the outline: `ξ = 0` in the frame of the corner, and `T` is unknown.
    Passing { forward: bool },
    /// It is held in a notch by the neighbour's face: nothing moves, and `T = ratio N` stays what it was.
    Locked { ratio: f64 },
}

/// A scale that the needle touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Number of the scale, from the punctured one to the right.
    pub(crate) scale: i64,
    pub(crate) place: OutlinePart,
    pub(crate) tip_state: TipState,
}

impl Touch {
    pub(crate) fn is_locked(&self) -> bool {
        matches!(self.tip_state, TipState::Locked { .. })
    }

    /// The same wherever a round tip touches the scale: it rolls from place to place without sliding.
    pub(crate) fn anywhere(&self) -> Self {
        Self { place: OutlinePart::Top, ..*self }
    }

    /// Whether its tangential force is unknown, since it stays at a place.
    pub(crate) fn is_at_a_place(&self) -> bool {
        matches!(self.tip_state, TipState::Stick { .. } | TipState::Passing { .. })
    }

    /// Whether the equations keep something of the way to the state: where the tip sticks, or with what force it is held.
    pub(crate) fn has_history(&self) -> bool {
        matches!(self.tip_state, TipState::Stick { .. } | TipState::Locked { .. })
    }
}

/// Slots in which a sharp tip may touch: neighbours, if they are two.
pub(super) const SHARP_SLOTS: usize = 2;

/// The state of a guided needle, history included: the scales that it touches. Nothing in a row under a free needle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct NeedleMode {
    /// By slots: those of a sharp tip, or of a round one a slot for each scale in reach.
    pub(crate) touches: Vec<Option<Touch>>,
}

impl NeedleMode {
    /// Whether the tip is round: there are always more slots then.
    pub(super) fn is_round(&self) -> bool {
        self.touches.len() > SHARP_SLOTS
    }

    /// Where the tip touches a scale, counted from the punctured one.
    pub(super) fn place(&self, scale: i64) -> Option<OutlinePart> {
        self.all().find(|(_, touch)| touch.scale == scale).map(|(_, touch)| touch.place)
    }

    /// All touches, each with its slot.
    pub(super) fn all(&self) -> impl Iterator<Item = (usize, &Touch)> {
        let slots = self.touches.iter().enumerate();
        slots.filter_map(|(slot, touch)| Some((slot, touch.as_ref()?)))
    }
}
