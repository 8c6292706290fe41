//! Outcome of a puncture or bending path, including the audit of its end state.

use solver::{Continuation, Termination};

use crate::contacts::SkinState;
use crate::record::Skin;

/// Outcome of the path of a puncture or of bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The path reached its target, and its end state passed the audit.
    ///
    /// In a puncture the row was also long enough for the spread of contact.
    Complete,
    /// The path stopped before its target, for the given reason.
    Stopped(Termination),
    /// The solver stopped while load, depth and tilt were all below their maxima.
    ///
    /// In bending of several equal gaps: the path reached the largest moment.
    LimitPoint,
    /// A row of automatic length would need more scales than allowed.
    ///
    /// See [`RowLength::Auto`](crate::puncture::RowLength::Auto).
    RowLimit,
    /// A guided needle pushed a scale down without reaching the critical tilt.
    ///
    /// The path ended at a bifurcation or at a depth of twice the thickness.
    Untilted,
    /// The tip of an elastic scale turned by 5° relative to its base.
    ///
    /// Linear bending is not valid beyond this rotation.
    Bent,
    /// Two scales overlap by more than their contact law allows.
    Interpenetration,
    /// The scales of a strip lock: the moment grows while the rotation hardly changes.
    Locked,
    /// A contact lies beyond an end of its edge, which the contact model does not cover.
    ///
    /// This status is also used if a corner of a scale reached a guided needle from the side.
    OffEdge,
}

impl Status {
    /// Determines the status of a path from the reason why the solver stopped, and from its end.
    pub(crate) fn of<S: Skin>(path: &Continuation<S>, stop: Termination) -> Self {
        let (skin, end) = (path.system(), &path.point().state);
        match stop {
            Termination::Reached => Self::audited(skin, end),
            // Newton's method also fails where the contact model ceases to be valid. Report the
            // mechanical reason if the last state shows one.
            stop if stop.is_numerical() && skin.interpenetrates(end) => Self::Interpenetration,
            stop if stop.is_numerical() && skin.passes_an_end(path.point()) => Self::OffEdge,
            stop => Self::Stopped(stop),
        }
    }

    /// Checks an end state for overlapping scales and for contacts beyond the end of their edge.
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
