//! Discrete state of a guided needle: its contacts with scales and their friction states.

/// Part of the outline of a scale: a face or a corner.
///
/// Parts are ordered from the left foot over the top to the right foot.
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
        let here = Self::ALL.iter().position(|part| *part == self)?;
        let next = if forward { here + 1 } else { here.checked_sub(1)? };
        Self::ALL.get(next).copied()
    }
}

/// Friction state of the needle tip in contact with a scale.
///
/// It determines the tangential force `T`. `N` is the normal force and `ξ` the coordinate of the
/// tip along the outline of the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TipState {
    /// The tip slides, and `T = sign μ_n N`.
    ///
    /// `sign` is the sign of `ξ̇`, or 0 without friction; sliding began at `ξ = start`.
    Slip { sign: f64, start: f64 },
    /// The tip sticks at `ξ = anchor`, and `T` is unknown.
    Stick { anchor: f64 },
    /// The tip stays at a corner while the force turns, and `T` is unknown.
    ///
    /// `forward` is true if the tip moves forward along the outline. `ξ` is 0 at the corner.
    Passing { forward: bool },
    /// The tip is held in a notch between two scales.
    ///
    /// It does not slide, and the tangential force is `T = ratio N`.
    Locked { ratio: f64 },
}

/// Contact of the needle with a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TipContact {
    /// Number of the scale: 0 for the punctured scale, increasing to the right.
    pub(crate) scale: i64,
    pub(crate) part: OutlinePart,
    pub(crate) tip_state: TipState,
}

impl TipContact {
    pub(crate) fn is_locked(&self) -> bool {
        matches!(self.tip_state, TipState::Locked { .. })
    }

    /// Returns the tip contact with its outline part replaced by [`OutlinePart::Top`].
    ///
    /// Used to compare contacts of a round tip regardless of their outline part, because `ξ` and
    /// `T` of a round tip are continuous between parts.
    pub(crate) fn without_part(&self) -> Self {
        Self { part: OutlinePart::Top, ..*self }
    }

    /// Returns true if the position `ξ` of the tip is fixed and the tangential force is unknown.
    pub(crate) fn has_fixed_position(&self) -> bool {
        matches!(self.tip_state, TipState::Stick { .. } | TipState::Passing { .. })
    }

    /// Returns true if the equations depend on an anchor or a locked ratio.
    pub(crate) fn has_history(&self) -> bool {
        matches!(self.tip_state, TipState::Stick { .. } | TipState::Locked { .. })
    }
}

/// Number of slots for contacts of a sharp tip, which touches at most two neighbouring scales.
pub(crate) const SHARP_SLOTS: usize = 2;

/// Discrete state of a guided needle, including its history; empty for a free needle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct NeedleMode {
    /// One entry for each slot, which holds at most one tip contact.
    ///
    /// A sharp tip has two slots, a round tip one slot for each scale in reach.
    pub(crate) tip_contacts: Vec<Option<TipContact>>,
}

impl NeedleMode {
    /// Returns true for a round tip, which always has more than two slots.
    pub(crate) fn is_round(&self) -> bool {
        self.tip_contacts.len() > SHARP_SLOTS
    }

    /// Returns the part of a scale that the tip touches; `None` if the tip does not touch it.
    ///
    /// Scales are numbered as in [`TipContact::scale`].
    pub(crate) fn part(&self, scale: i64) -> Option<OutlinePart> {
        self.all().find(|(_, touch)| touch.scale == scale).map(|(_, touch)| touch.part)
    }

    /// Iterates over all tip contacts, each with the number of its slot.
    pub(crate) fn all(&self) -> impl Iterator<Item = (usize, &TipContact)> {
        let slots = self.tip_contacts.iter().enumerate();
        slots.filter_map(|(slot, touch)| Some((slot, touch.as_ref()?)))
    }
}
