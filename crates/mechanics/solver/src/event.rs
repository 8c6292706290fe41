//! Events of a path, and the constraints that become active or inactive at an event.

/// Event at a point of the path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Constraints become active or inactive, several of them if their events coincide.
    Changed(Vec<Change>),
    /// The load has a maximum or a minimum.
    LoadExtremum,
    /// A load that can only push has returned to zero.
    Unloaded,
    /// The control parameter has reached its target, or a constraint ends the path.
    Target,
}

/// Change of a constraint between active and inactive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// Number of the constraint.
    pub constraint: usize,
    /// True if the constraint becomes active, false if it becomes inactive.
    pub activated: bool,
}
