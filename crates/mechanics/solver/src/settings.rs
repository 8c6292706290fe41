//! Step sizes, tolerances and limits of a path.

/// Step sizes of a path, tolerance of its equilibria, and limits.
///
/// Steps are in units of [`Control::scale`](crate::Control::scale). With the default
/// [`System::target`](crate::System::target) of 1 they are fractions of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// First step.
    pub first_step: f64,
    /// Largest step.
    pub max_step: f64,
    /// Smallest step; the path stops if a shorter step would be needed.
    pub min_step: f64,
    /// Largest ratio of residual to size of an equation (N2) at a converged equilibrium.
    pub tolerance: f64,
    /// Largest number of Newton iterations per equilibrium.
    ///
    /// If the iteration has not converged, the step is divided by three.
    pub max_iterations: usize,
    /// Largest number of equilibria of a path.
    pub max_points: usize,
    /// Largest work of a path: the unknowns of all its tangents, weighted by the bandwidth.
    ///
    /// The path also stops after half of this work without progress. A path with few tangents may
    /// exceed the limit; otherwise the limit would stop every path of a very large system. If
    /// `max_step` is below its default, the limit is larger in proportion to the number of steps.
    pub max_work: u64,
}

impl Settings {
    /// Returns the ratio of the default `max_step` to `max_step`, rounded down but at least 1.
    pub(crate) fn refinement(&self) -> u64 {
        // The conversion saturates for extremely small steps.
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
            // This work takes less than five seconds. Paths that reach their target need less than
            // half of it.
            max_work: 24_000_000,
        }
    }
}
