//! The outcome of a measure: complete, or the reason why it has no values.

use std::fmt;

use serde::{Deserialize, Serialize};
use skin::Status;
use solver::Termination;

/// Outcome of a measure of a design: complete, or the reason why it has no values.
///
/// The list is complete and the texts are stable, so that tables can be filtered by these texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// All values of the measure exist.
    Complete,
    /// Newton's method did not converge at the smallest step.
    NoConvergence,
    /// The path has no unique continuation.
    Singular,
    /// The path reached the maximum number of equilibria.
    TooManyPoints,
    /// The path reached the limit of its computational work.
    TooMuchWork,
    /// Contacts open and close at one point without progress along the path.
    Cycling,
    /// A value is not finite.
    NotFinite,
    /// The row needs more scales than its maximum.
    RowLimit,
    /// Two scales overlap by more than the range of the contact law.
    Interpenetration,
    /// A contact slid off a corner.
    OffEdge,
    /// Neighbouring scales overlap at rest on a concave body.
    Overlapping,
    /// The calibration of the substrate springs failed.
    Calibration,
    /// Internal error of the program.
    Internal,
    /// The load reached zero.
    Unloaded,
    /// Load, depth and tilt decreased together and did not recover.
    ///
    /// In bending: the moment of several gaps in series reached its maximum.
    LimitPoint,
    /// The needle pushed a scale straight down, and no scale tilted critically.
    Untilted,
    /// An elastic scale bent by more than 5°, the limit of the linear beam.
    Bent,
    /// The scales of a strip locked: only the membrane still deformed.
    Locked,
    /// The path has no quasi-static continuation.
    ///
    /// Contacts can neither stick nor slip, or the path oscillates without progress.
    Jumps,
}

impl Outcome {
    /// All outcomes.
    pub const ALL: [Self; 19] = [
        Self::Complete,
        Self::NoConvergence,
        Self::Singular,
        Self::TooManyPoints,
        Self::TooMuchWork,
        Self::Cycling,
        Self::NotFinite,
        Self::RowLimit,
        Self::Interpenetration,
        Self::OffEdge,
        Self::Overlapping,
        Self::Calibration,
        Self::Internal,
        Self::Unloaded,
        Self::LimitPoint,
        Self::Untilted,
        Self::Bent,
        Self::Locked,
        Self::Jumps,
    ];

    /// Returns the text of the outcome in the tables.
    pub fn text(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::NoConvergence => "no convergence",
            Self::Singular => "singular tangent",
            Self::TooManyPoints => "too many points",
            Self::TooMuchWork => "too much work",
            Self::Cycling => "cycling contacts",
            Self::NotFinite => "not finite",
            Self::RowLimit => "row limit",
            Self::Interpenetration => "interpenetration",
            Self::Overlapping => "overlap at rest",
            Self::OffEdge => "off the edge",
            Self::Locked => "locked",
            Self::Jumps => "jumps",
            Self::Calibration => "no calibration",
            Self::Internal => "internal error",
            Self::Unloaded => "unloaded",
            Self::LimitPoint => "limit point",
            Self::Untilted => "no critical tilt",
            Self::Bent => "bent",
        }
    }

    /// Returns the meaning of the outcome, as a phrase without a full stop.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Complete => "the path reached its end and every check holds",
            Self::NoConvergence => "Newton's method did not converge at the smallest step",
            Self::Singular => "the tangent is singular: the path has no unique continuation",
            Self::TooManyPoints => "the path reached `solver.max_points` equilibria",
            Self::TooMuchWork => {
                "the path reached the limit of its computational work, which a smaller `solver.max_step` raises"
            }
            Self::Cycling => "contacts open and close at one point without progress along the path",
            Self::NotFinite => "a value is not finite",
            Self::RowLimit => "the row needs more scales than its maximum",
            Self::Interpenetration => {
                "two scales overlap by more than the range of the contact law"
            }
            Self::Overlapping => {
                "neighbouring scales overlap at rest, because the body below them is too concave"
            }
            Self::OffEdge => {
                "a contact slid off a corner, or a corner reaches a guided needle from the side"
            }
            Self::Locked => {
                "the scales of a strip lock: the moment grows, and only the membrane still deforms, beyond the range of its law"
            }
            Self::Jumps => {
                "no quasi-static continuation: contacts can neither stick nor slip, or the path oscillates without progress; the skin jumps"
            }
            Self::Calibration => "the calibration of the substrate springs failed",
            Self::Internal => "an error of the program; please report the design",
            Self::Unloaded => {
                "the load returned to zero: a needle cannot pull, and the scale has lost contact"
            }
            Self::LimitPoint => {
                "load, depth and tilt decreased together, and the path ends before any of them recovers; in bending, the moment reached its maximum, beyond which a single gap bends"
            }
            Self::Untilted => {
                "the needle pushes a scale straight down, and no scale tilts critically"
            }
            Self::Bent => "an elastic scale bends by more than 5°, the limit of the linear beam",
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

impl From<Status> for Outcome {
    fn from(status: Status) -> Self {
        match status {
            Status::Complete => Self::Complete,
            Status::RowLimit => Self::RowLimit,
            Status::Interpenetration => Self::Interpenetration,
            Status::OffEdge => Self::OffEdge,
            Status::Locked => Self::Locked,
            Status::LimitPoint => Self::LimitPoint,
            Status::Untilted => Self::Untilted,
            Status::Bent => Self::Bent,
            Status::Stopped(stop) => stop.into(),
        }
    }
}

impl From<Termination> for Outcome {
    fn from(stop: Termination) -> Self {
        match stop {
            Termination::NoConvergence => Self::NoConvergence,
            Termination::Singular => Self::Singular,
            Termination::TooManyPoints => Self::TooManyPoints,
            Termination::TooMuchWork => Self::TooMuchWork,
            Termination::Cycling => Self::Cycling,
            Termination::Jumps | Termination::NoProgress => Self::Jumps,
            Termination::NotFinite => Self::NotFinite,
            Termination::Unloaded => Self::Unloaded,
            // A path that reached its target has not stopped early, and the result of an
            // interrupted path is discarded, so both are internal errors.
            Termination::Reached | Termination::Interrupted => Self::Internal,
        }
    }
}
