//! Outcome of a path and its audit.

use solver::{Continuation, Termination};

use crate::contacts::SkinState;
use crate::record::Skin;

/// Outcome of a puncture or of bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The path reached its end and passed the audit.
    ///
    /// In a puncture the row was long enough.
    Complete,
    /// The path stopped before its end.
    Stopped(Termination),
    /// Load, depth and tilt have all turned back, and none recovered its maximum.
    ///
    /// In bending: the moment of several gaps in series has reached its maximum.
    LimitPoint,
    /// A row of automatic length would need more scales than allowed.
    ///
    /// See [`RowLength::Auto`](crate::puncture::RowLength::Auto).
    RowLimit,
    /// A guided needle pushed a scale straight down without a critical tilt.
    ///
    /// The path ended at a bifurcation or at twice the thickness.
    Untilted,
    /// The tip of an elastic scale turned so far that linear bending ends.
    Bent,
    /// Two scales overlap by more than their contact law allows.
    Interpenetration,
    /// The scales of a strip lock: the moment grows while the rotation hardly changes.
    Locked,
    /// A contact slid off the end of its edge.
    ///
    /// Or a corner passed that end, or a corner met a guided needle from the side.
    OffEdge,
}

impl Status {
    /// Determines the status of a path from its stop reason.
    pub(crate) fn of<S: Skin>(path: &Continuation<S>, stop: Termination) -> Self {
        let (skin, end) = (path.system(), &path.point().state);
        match stop {
            Termination::Reached => Self::audited(skin, end),
            // Newton's method also fails where the model itself ends: prefer a mechanical reason
            // visible in the state.
            stop if stop.is_numerical() && skin.interpenetrates(end) => Self::Interpenetration,
            stop if stop.is_numerical() && skin.passes_an_end(path.point()) => Self::OffEdge,
            stop => Self::Stopped(stop),
        }
    }

    /// Audits an equilibrium at which a path may end.
    pub(crate) fn audited<S: Skin>(skin: &S, end: &SkinState) -> Self {
        if skin.interpenetrates(end) {
            Self::Interpenetration
        } else if skin.contacts().off_edge(end) {
            Self::OffEdge
        } else {
            Self::Complete
        }
    }
}
