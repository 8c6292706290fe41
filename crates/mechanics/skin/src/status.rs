//! The end of a path, and whether it can be trusted.

use solver::{Path, Stop};

use crate::contacts::SkinState;
use crate::record::Skin;

/// The end of a puncture or a bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The path reached its end, in a puncture on a row that is long enough, and the audit has no objection.
    Complete,
    /// The path stopped before its end.
    Stopped(Stop),
    /// Load, depth and tilt have turned back together, and the path stopped before any of them came to its largest value again.
    LimitPoint,
    /// [`RowLength::Auto`](crate::puncture::RowLength::Auto) needs a longer row than it may take.
    RowLimit,
    /// A guided needle pushes a scale straight down, up to where it may go either way or to two thicknesses, and tilts none critically.
    Untilted,
    /// Two scales overlap by more than their contact law allows.
    Interpenetration,
    /// The scales of a strip lock: the moment grows, and next to nothing turns.
    Locked,
    /// A contact carries beyond the end of its edge, a corner passes round that end, or one comes at a guided needle from the side.
    OffEdge,
}

impl Status {
    /// The status of a path that came to its end, or stopped for a reason.
    pub(crate) fn of<S: Skin>(path: &Path<S>, stop: Stop) -> Self {
        let (skin, end) = (path.system(), &path.point().state);
        match stop {
            Stop::Reached => Self::audited(skin, end),
            // Newton's method fails where the model itself ends, too: a mechanical reason that the
            // state shows says more than the numeric one.
            stop if stop.is_numerical() && skin.interpenetrates(end) => Self::Interpenetration,
            stop if stop.is_numerical() && skin.passes_an_end(path.point()) => Self::OffEdge,
            stop => Self::Stopped(stop),
        }
    }

    /// The status of an equilibrium at which a path may end.
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
