//! Locates equilibria at given values of a quantity, between the points of a path.

use solver::{Bracket, Continuation, Equilibrium, State, System};

/// Tolerance within which a quantity has reached its value.
///
/// It is relative to one plus the magnitude.
const CLOSE: f64 = 1e-12;

/// Evaluations after which a bracket is as narrow as an `f64` allows.
const EVALUATIONS: usize = 100;

/// Point of a path at which a quantity first takes a value.
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

    /// Solves for the equilibrium at which a quantity has its value.
    ///
    /// It lies between two neighbouring points.
    pub(crate) fn between(
        &self,
        path: &mut Continuation<S>,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
    ) -> Option<Equilibrium<S::Mode>> {
        let low = (0.0, self.off(path.system(), &from.state));
        let high = (1.0, self.off(path.system(), &to.state));
        // Check the end before the signs, because at the end round-off may give the difference
        // either sign.
        if self.is_at(path.system(), &to.state) {
            return Some(to.clone());
        }
        // A value passed twice within one segment is not detected.
        if low.1.signum() == high.1.signum() {
            return None;
        }
        let mut bracket = Bracket::new(low, high);
        for _ in 0..EVALUATIONS {
            let fraction = bracket.secant();
            let point = path.between(from, to, fraction)?;
            // A bracket that cannot shrink further locates the value to within round-off.
            if self.is_at(path.system(), &point.state) || bracket.width() < f64::EPSILON {
                return Some(point);
            }
            bracket.narrow(fraction, self.off(path.system(), &point.state));
        }
        None
    }
}

/// Locates the first equilibria at several locations while a path is followed.
pub(crate) struct PointLocator<S: System> {
    locations: Vec<PathLocation<S>>,
    /// One point per location; `None` while the path has not reached it.
    pub(crate) points: Vec<Option<Equilibrium<S::Mode>>>,
}

impl<S: System> PointLocator<S> {
    /// Starts at the first point of a path.
    pub(crate) fn new(
        path: &Continuation<S>,
        locations: impl IntoIterator<Item = PathLocation<S>>,
    ) -> Self {
        let locations: Vec<_> = locations.into_iter().collect();
        let start = path.point();
        // A location at the very start, such as zero load, has no segment before it.
        let points = locations
            .iter()
            .map(|location| location.is_at(path.system(), &start.state).then(|| start.clone()))
            .collect();
        Self { locations, points }
    }

    /// Searches for the remaining locations between two points of the path.
    pub(crate) fn follow(
        &mut self,
        path: &mut Continuation<S>,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
    ) {
        for (location, found) in self.locations.iter().zip(&mut self.points) {
            // A reversing path passes a value again: keep the first point.
            if found.is_none() {
                *found = location.between(path, from, to);
            }
        }
    }
}
