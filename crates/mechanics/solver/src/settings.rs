//! Step sizes and tolerances.

/// Step sizes of a path and tolerance of its equilibria.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// First step, as a fraction of the whole path.
    ///
    /// The whole path ends at the target of the control parameter.
    pub first_step: f64,
    /// Largest step, as a fraction of the whole path.
    pub max_step: f64,
    /// Smallest step, as a fraction of the whole path; below it the path stops.
    pub min_step: f64,
    /// Largest scaled residual at which Newton's iteration has converged.
    pub tolerance: f64,
    /// Iterations after which a Newton solve fails and the step is divided by three.
    pub max_iterations: usize,
    /// Number of equilibria after which the path stops.
    pub max_points: usize,
    /// Work after which the path stops: the unknowns of all its tangents, weighted by bandwidth.
    ///
    /// Half of it without progress also stops the path. A path with few tangents may exceed it, for
    /// a row of any length. A path with a `max_step` below the default may take more, in proportion
    /// to the number of steps.
    pub max_work: u64,
}

impl Settings {
    /// Returns the number of steps in a step of the default length, at least 1.
    pub(crate) fn refinement(&self) -> u64 {
        // The conversion saturates.
        (Self::default().max_step / self.max_step).max(1.0) as u64
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            first_step: 0.1,
            max_step: 0.2,
            min_step: 1e-9,
            tolerance: 1e-10,
            max_iterations: 12,
            max_points: 100_000,
            // Less than five seconds. Paths that reach their target need less than half of this work.
            max_work: 24_000_000,
        }
    }
}
