//! Events of a path, and the constraints that change sides at them.

/// Event at a point of the path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Constraints change sides; several if symmetry makes the events coincide.
    Changed(Vec<Change>),
    /// The load has a maximum or a minimum.
    LoadExtremum,
    /// The load of a system that only pushes has returned to zero.
    Unloaded,
    /// The control parameter has reached its target.
    Target,
}

/// Constraint that changes sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// Number of the constraint.
    pub constraint: usize,
    /// True if the constraint becomes active, false if it becomes inactive.
    pub activated: bool,
}
