//! Outcome of a path and its audit.

use solver::{Continuation, Termination};

use crate::contacts::SkinState;
use crate::record::Skin;

/// Outcome of a puncture or of bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The path reached its end (in a puncture on a row of sufficient length) and passed the audit.
    Complete,
    /// The path stopped before its end.
    Stopped(Termination),
    /// Load, depth and tilt have all turned back, and the path stopped before any of them recovered
    /// its maximum.
    LimitPoint,
    /// [`RowLength::Auto`](crate::puncture::RowLength::Auto) would need a longer row than allowed.
    RowLimit,
    /// A guided needle pushed a scale straight down, to a bifurcation or to twice the thickness,
    /// without a critical tilt.
    Untilted,
    /// Two scales overlap by more than their contact law allows.
    Interpenetration,
    /// The scales of a strip lock: the moment grows while the rotation hardly changes.
    Locked,
    /// A contact slid off the end of its edge, a corner passed that end, or a corner met a guided
    /// needle from the side.
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
