//! Locates the equilibria of a path at which a quantity has a given value.

use solver::{Bracket, Continuation, Equilibrium, State, System};

/// Largest accepted difference between a quantity and its required value.
///
/// The difference is divided by one plus the magnitude of the required value.
const CLOSE: f64 = 1e-12;

/// Maximum number of evaluations of the root search; a bracket then has the resolution of `f64`.
const EVALUATIONS: usize = 100;

/// Location on a path: the point at which a quantity first has a given value.
pub(crate) struct PathLocation<S: System> {
    /// The quantity as a function of system and state.
    pub(crate) quantity: fn(&S, &State<S::Mode>) -> f64,
    /// Value to reach.
    pub(crate) value: f64,
}

impl<S: System> PathLocation<S> {
    fn off(&self, system: &S, state: &State<S::Mode>) -> f64 {
        (self.quantity)(system, state) - self.value
    }

    fn is_at(&self, system: &S, state: &State<S::Mode>) -> bool {
        self.off(system, state).abs() <= CLOSE * (1.0 + self.value.abs())
    }

    /// Solves for the equilibrium between two neighbouring points where the quantity is `value`.
    ///
    /// Returns `None` if the quantity does not pass the value between both points, or if the solver
    /// fails.
    pub(crate) fn between(
        &self,
        path: &mut Continuation<S>,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
    ) -> Option<Equilibrium<S::Mode>> {
        let low = (0.0, self.off(path.system(), &from.state));
        let high = (1.0, self.off(path.system(), &to.state));
        // Check `to` before comparing signs: if the quantity has the required value at this point,
        // round-off may give the difference either sign.
        if self.is_at(path.system(), &to.state) {
            return Some(to.clone());
        }
        // A value that is passed twice between the two points is not detected.
        if low.1.signum() == high.1.signum() {
            return None;
        }
        let mut bracket = Bracket::new(low, high);
        for _ in 0..EVALUATIONS {
            let fraction = bracket.secant();
            let point = path.between(from, to, fraction)?;
            // A bracket that cannot shrink further has located the point up to round-off.
            if self.is_at(path.system(), &point.state) || bracket.width() < f64::EPSILON {
                return Some(point);
            }
            bracket.narrow(fraction, self.off(path.system(), &point.state));
        }
        None
    }
}

/// Finds the first point of a path at each of several locations while the path is followed.
pub(crate) struct PointLocator<S: System> {
    locations: Vec<PathLocation<S>>,
    /// One point for each location; `None` while the path has not reached the location.
    pub(crate) points: Vec<Option<Equilibrium<S::Mode>>>,
}

impl<S: System> PointLocator<S> {
    /// Creates a locator at the current point of a path.
    pub(crate) fn new(
        path: &Continuation<S>,
        locations: impl IntoIterator<Item = PathLocation<S>>,
    ) -> Self {
        let locations: Vec<_> = locations.into_iter().collect();
        let start = path.point();
        // No segment precedes a location at the start of the path, such as zero load, so check the
        // start here.
        let points = locations
            .iter()
            .map(|location| location.is_at(path.system(), &start.state).then(|| start.clone()))
            .collect();
        Self { locations, points }
    }

    /// Searches the segment between two points of the path for the locations not yet found.
    pub(crate) fn follow(
        &mut self,
        path: &mut Continuation<S>,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
    ) {
        for (location, point) in self.locations.iter().zip(&mut self.points) {
            // A path that reverses passes a value again: keep the first point.
            if point.is_none() {
                *point = location.between(path, from, to);
            }
        }
    }
}
