//! Equilibria at chosen values of a quantity, solved for between the points of a path.

use solver::{Path, Point, State, System};

/// A quantity counts as at its value where it is off by less than this, relative to one plus its size.
const CLOSE: f64 = 1e-12;

/// Evaluations after which the bracket of a crossing is as narrow as an `f64` allows.
const EVALUATIONS: usize = 100;

/// A place of a path: where a quantity first takes a value.
pub(crate) struct Crossing<Q> {
    /// The quantity, a function of system and state.
    pub(crate) quantity: Q,
    /// The value that the quantity takes there.
    pub(crate) value: f64,
}

/// Follows `path` until every crossing is found or the path ends, and returns the equilibrium of each.
pub(crate) fn follow<S, Q>(
    path: &mut Path<S>,
    crossings: &[Crossing<Q>],
) -> Vec<Option<State<S::Mode>>>
where
    S: System,
    Q: Fn(&S, &State<S::Mode>) -> f64,
{
    let start = &path.point().state;
    let at_start =
        |crossing: &Crossing<Q>| crossing.is_at(path.system(), start).then(|| start.clone());
    let mut found: Vec<_> = crossings.iter().map(at_start).collect();
    while found.contains(&None) {
        let from = path.point().clone();
        let Some(to) = path.next() else { break };
        for (crossing, found) in crossings.iter().zip(&mut found).filter(|(_, f)| f.is_none()) {
            *found = crossing.between(path, &from, &to);
        }
    }
    found
}

impl<Q> Crossing<Q> {
    fn off<S: System>(&self, system: &S, state: &State<S::Mode>) -> f64
    where
        Q: Fn(&S, &State<S::Mode>) -> f64,
    {
        (self.quantity)(system, state) - self.value
    }

    fn is_at<S: System>(&self, system: &S, state: &State<S::Mode>) -> bool
    where
        Q: Fn(&S, &State<S::Mode>) -> f64,
    {
        self.off(system, state).abs() <= CLOSE * (1.0 + self.value.abs())
    }

    /// The equilibrium between two neighbouring points at which the quantity has its value: by
    /// the secant through the ends of a bracket, with the Illinois rule.
    pub(crate) fn between<S: System>(
        &self,
        path: &mut Path<S>,
        from: &Point<S::Mode>,
        to: &Point<S::Mode>,
    ) -> Option<State<S::Mode>>
    where
        Q: Fn(&S, &State<S::Mode>) -> f64,
    {
        let mut low = (0.0, self.off(path.system(), &from.state));
        let mut high = (1.0, self.off(path.system(), &to.state));
        if self.is_at(path.system(), &to.state) {
            return Some(to.state.clone());
        }
        if low.1.signum() == high.1.signum() {
            return None;
        }
        for _ in 0..EVALUATIONS {
            let fraction = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let state = path.between(from, to, fraction)?.state;
            let off = self.off(path.system(), &state);
            if self.is_at(path.system(), &state) || (high.0 - low.0).abs() < f64::EPSILON {
                return Some(state);
            }
            if off.signum() == high.1.signum() {
                high = (fraction, off);
                low.1 *= 0.5;
            } else {
                low = (fraction, off);
                high.1 *= 0.5;
            }
        }
        None
    }
}
