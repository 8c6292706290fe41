//! Equilibria at chosen values of a quantity, solved for between the points of a path.

use solver::{Bracket, Path, Point, State, System};

/// A quantity counts as at its value where it is off by less than this, relative to one plus its size.
const CLOSE: f64 = 1e-12;

/// Evaluations after which the bracket of a crossing is as narrow as an `f64` allows.
const EVALUATIONS: usize = 100;

/// A place of a path: where a quantity first takes a value.
pub(crate) struct PathLocation<S: System> {
    /// The quantity, a function of system and state.
    pub(crate) quantity: fn(&S, &State<S::Mode>) -> f64,
    /// The value that the quantity takes there.
    pub(crate) value: f64,
}

impl<S: System> PathLocation<S> {
    fn off(&self, system: &S, state: &State<S::Mode>) -> f64 {
        (self.quantity)(system, state) - self.value
    }

    fn is_at(&self, system: &S, state: &State<S::Mode>) -> bool {
        self.off(system, state).abs() <= CLOSE * (1.0 + self.value.abs())
    }

    /// The equilibrium between two neighbouring points at which the quantity has its value.
    pub(crate) fn between(
        &self,
        path: &mut Path<S>,
        from: &Point<S::Mode>,
        to: &Point<S::Mode>,
    ) -> Option<Point<S::Mode>> {
        let low = (0.0, self.off(path.system(), &from.state));
        let high = (1.0, self.off(path.system(), &to.state));
        // This comes before the signs: at the end the difference may have either sign by round-off.
        if self.is_at(path.system(), &to.state) {
            return Some(to.clone());
        }
        // A value that is only passed and left again within a segment is not looked for.
        if low.1.signum() == high.1.signum() {
            return None;
        }
        let mut bracket = Bracket::new(low, high);
        for _ in 0..EVALUATIONS {
            let fraction = bracket.secant();
            let point = path.between(from, to, fraction)?;
            // A bracket that cannot be narrowed has the value to within its round-off.
            if self.is_at(path.system(), &point.state) || bracket.width() < f64::EPSILON {
                return Some(point);
            }
            bracket.narrow(fraction, self.off(path.system(), &point.state));
        }
        None
    }
}

/// Looks along a path for the equilibria at which it first comes to some places.
pub(crate) struct PointLocator<S: System> {
    locations: Vec<PathLocation<S>>,
    /// `None` where the path has not got there.
    pub(crate) points: Vec<Option<Point<S::Mode>>>,
}

impl<S: System> PointLocator<S> {
    /// Begins at the start of a path.
    pub(crate) fn new(
        path: &Path<S>,
        locations: impl IntoIterator<Item = PathLocation<S>>,
    ) -> Self {
        let locations: Vec<_> = locations.into_iter().collect();
        let start = path.point();
        // A place at the very beginning, such as a load of zero, has no segment before it.
        let is_start = |location: &PathLocation<S>| location.is_at(path.system(), &start.state);
        let points =
            locations.iter().map(|location| is_start(location).then(|| start.clone())).collect();
        Self { locations, points }
    }

    /// Looks between two points of the path.
    pub(crate) fn follow(
        &mut self,
        path: &mut Path<S>,
        from: &Point<S::Mode>,
        to: &Point<S::Mode>,
    ) {
        for (location, found) in self.locations.iter().zip(&mut self.points) {
            // A path that turns back passes a value again: the first time counts.
            if found.is_none() {
                *found = location.between(path, from, to);
            }
        }
    }
}
