//! Equilibria at chosen values of a quantity, solved for between the points of a path.

use solver::{Path, Point, State, System};

/// A quantity is at its value when it is off by less than this, relative to one plus its size.
const CLOSE: f64 = 1e-12;

/// Evaluations after which the bracket of a crossing is as narrow as an `f64` allows.
const EVALUATIONS: usize = 100;

/// Where a quantity of a state first takes a value along a path.
pub(crate) struct Crossing<Q> {
    /// The quantity.
    pub(crate) quantity: Q,
    /// Its value.
    pub(crate) value: f64,
}

/// Follows `path` and shows `found` the equilibrium of each crossing, with its place in the list and the
/// system as it is there. Ends when all are found, or with the path.
pub(crate) fn follow<S, Q>(
    path: &mut Path<S>,
    crossings: &[Crossing<Q>],
    mut found: impl FnMut(usize, &S, &State),
) where
    S: System + Clone,
    Q: Fn(&S, &State) -> f64,
{
    let mut open: Vec<usize> = (0..crossings.len()).collect();
    let start = path.point().state.clone();
    take(&mut open, |k| {
        let at_rest = crossings[k].is_at(path.system(), &start);
        at_rest.then(|| found(k, path.system(), &start)).is_some()
    });
    while !open.is_empty() {
        // The contacts of a system change at the end of a step: what lies within it is solved for
        // with the system at its beginning.
        let mut before = path.clone();
        let from = before.point().clone();
        let Some(to) = path.next() else { return };
        take(&mut open, |k| match crossings[k].between(&mut before, &from, &to) {
            Some(state) => {
                found(k, before.system(), &state);
                true
            }
            None => false,
        });
    }
}

/// Removes the entries that `is_done`.
fn take(open: &mut Vec<usize>, mut is_done: impl FnMut(usize) -> bool) {
    open.retain(|&k| !is_done(k));
}

impl<Q> Crossing<Q> {
    fn off<S>(&self, system: &S, state: &State) -> f64
    where
        Q: Fn(&S, &State) -> f64,
    {
        (self.quantity)(system, state) - self.value
    }

    fn is_at<S>(&self, system: &S, state: &State) -> bool
    where
        Q: Fn(&S, &State) -> f64,
    {
        self.off(system, state).abs() <= CLOSE * (1.0 + self.value.abs())
    }

    /// The equilibrium between two neighbouring points at which the quantity has its value: by
    /// the secant through the ends of a bracket, with the Illinois rule.
    fn between<S>(&self, path: &mut Path<S>, from: &Point, to: &Point) -> Option<State>
    where
        S: System + Clone,
        Q: Fn(&S, &State) -> f64,
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
