//! Discrete state of a guided needle: its touches and their friction states.

/// Part of the outline of a scale.
///
/// The order is from the left foot over the top to the right foot.
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

    /// Returns the next part along the outline, forward or backward; `None` at a foot.
    pub(crate) fn next(self, forward: bool) -> Option<Self> {
        let here = Self::ALL.iter().position(|place| *place == self)?;
        let next = if forward { here + 1 } else { here.checked_sub(1)? };
        Self::ALL.get(next).copied()
    }
}

/// Friction state of the needle tip at a touch.
///
/// It determines the law of the tangential force `T`, with normal force `N` and coordinate `ξ`
/// along the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TipState {
    /// Slides since `ξ` was `start`: `T = sign μ N` with the sign of `ξ̇`.
    ///
    /// 0 without friction.
    Slip { sign: f64, start: f64 },
    /// Sticks: `ξ = anchor`, and `T` is unknown.
    Stick { anchor: f64 },
    /// Passes over a corner, forward or backward along the outline.
    ///
    /// `ξ = 0` in the frame of the corner, and `T` is unknown.
    Passing { forward: bool },
    /// Locked in a notch by the neighbouring face.
    ///
    /// Nothing moves, and `T = ratio N` keeps its ratio.
    Locked { ratio: f64 },
}

/// Contact of the needle with a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Number of the scale, counted from the punctured one to the right.
    pub(crate) scale: i64,
    pub(crate) place: OutlinePart,
    pub(crate) tip_state: TipState,
}

impl Touch {
    pub(crate) fn is_locked(&self) -> bool {
        matches!(self.tip_state, TipState::Locked { .. })
    }

    /// Replaces the outline part, for comparison.
    ///
    /// A round tip rolls between parts without sliding.
    pub(crate) fn anywhere(&self) -> Self {
        Self { place: OutlinePart::Top, ..*self }
    }

    /// Returns true if the tangential force is unknown because the position is fixed.
    pub(crate) fn has_fixed_position(&self) -> bool {
        matches!(self.tip_state, TipState::Stick { .. } | TipState::Passing { .. })
    }

    /// Returns true if the equations depend on an anchor or a locked ratio.
    pub(crate) fn has_history(&self) -> bool {
        matches!(self.tip_state, TipState::Stick { .. } | TipState::Locked { .. })
    }
}

/// Slots of a sharp tip: it touches at most two neighbouring scales.
pub(crate) const SHARP_SLOTS: usize = 2;

/// Discrete state of a guided needle, history included; empty under a free needle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct NeedleMode {
    /// One entry per slot: two for a sharp tip, one per scale in reach for a round tip.
    pub(crate) touches: Vec<Option<Touch>>,
}

impl NeedleMode {
    /// Returns true for a round tip, which always has more slots.
    pub(crate) fn is_round(&self) -> bool {
        self.touches.len() > SHARP_SLOTS
    }

    /// Returns the part of a scale that the tip touches.
    ///
    /// Scales are counted from the punctured one.
    pub(crate) fn place(&self, scale: i64) -> Option<OutlinePart> {
        self.all().find(|(_, touch)| touch.scale == scale).map(|(_, touch)| touch.place)
    }

    /// Iterates over all touches with their slots.
    pub(crate) fn all(&self) -> impl Iterator<Item = (usize, &Touch)> {
        let slots = self.touches.iter().enumerate();
        slots.filter_map(|(slot, touch)| Some((slot, touch.as_ref()?)))
    }
}
