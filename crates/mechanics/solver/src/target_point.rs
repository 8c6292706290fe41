//! End of a path, from which ends of neighbouring paths are found without following them.

use crate::continuation::{Continuation, Equilibrium};
use crate::event::Change;
use crate::newton::{Condition, FLOOR, Newton};
use crate::settings::Settings;
use crate::system::{State, System};
use crate::termination::Termination;

/// Largest number of Newton iterations from one end to a neighbouring one.
///
/// Neighbours need three to five. More mean that the ends are not close.
const MOST_ITERATIONS: usize = 8;

/// Largest number of constraints that may change sides between two neighbouring ends.
const MOST_CHANGES: usize = 6;

/// Equilibrium at the target of a path.
///
/// The end of one design is a good start for Newton's method at the end of a similar one. The path
/// between rest and the end is not followed, so the caller must decide whether events along it
/// matter.
#[derive(Clone, Debug)]
pub struct TargetPoint<M> {
    state: State<M>,
    /// Orientation ([`Newton::is_positive`]) of the path, which neighbours share.
    is_positive: bool,
}

impl<M: Clone> TargetPoint<M> {
    /// Returns the end of a path that reached its target.
    ///
    /// `None` for other paths, and if the tangent at the end is singular.
    pub fn of_path<S: System<Mode = M>>(path: &Continuation<S>) -> Option<Self> {
        if path.termination() != Some(Termination::Reached) {
            return None;
        }
        let (system, state) = (path.system(), &path.point().state);
        let (mut newton, condition) = (Newton::new(system), at_fraction(system, state, 1.0));
        let direction = newton.tangent(system, state, &condition).ok()?;
        let is_positive = newton.is_positive(&condition, &direction);
        Some(Self { state: state.clone(), is_positive })
    }

    /// Returns this point with another state on the same branch.
    #[must_use]
    pub fn moved_to(&self, state: State<M>) -> Self {
        Self { state, ..self.clone() }
    }

    /// Finds the target point of a neighbouring system with the same unknowns.
    ///
    /// Constraints that are violated there change sides one after the other, the most violated one
    /// first. `None` if Newton's method fails, if too many constraints change, or if the point lies
    /// on a branch with the other orientation (N7).
    pub fn of_neighbour<S: System<Mode = M>>(
        &self,
        system: &S,
        settings: &Settings,
    ) -> Option<Equilibrium<M>> {
        self.before_target(system, &self.state, 1.0, settings)
    }

    /// Finds the point of a neighbouring system at a fraction of the target.
    ///
    /// Starts from `near`, an equilibrium of that system or of a similar one; otherwise like
    /// [`TargetPoint::of_neighbour`]. Directions are derivatives with respect to the control
    /// parameter over its scale.
    pub fn before_target<S: System<Mode = M>>(
        &self,
        system: &S,
        near: &State<M>,
        fraction: f64,
        settings: &Settings,
    ) -> Option<Equilibrium<M>> {
        let settings = Settings { max_iterations: MOST_ITERATIONS, ..*settings };
        let condition = at_fraction(system, &self.state, fraction);
        let (mut state, mut newton) = (near.clone(), Newton::new(system));
        for left in (0..=MOST_CHANGES).rev() {
            let direction = newton.solve(system, &mut state, &condition, &settings).ok()?;
            let violated = violated(&Newton::guards(system, &state));
            let Some(&(constraint, _)) = violated.first() else {
                let is_same_branch = newton.is_positive(&condition, &direction) == self.is_positive;
                let (arriving, leaving) = (direction.clone(), direction);
                let point = Equilibrium { state, arriving, leaving, event: None };
                return is_same_branch.then_some(point);
            };
            if violated.len() > left {
                return None;
            }
            let change = Change { constraint, activated: !state.active[constraint] };
            state.active[constraint] = change.activated;
            state.z[system.constraints()[constraint]] = 0.0;
            system.transition(&mut state, change)?;
        }
        None
    }
}

/// Returns the condition that the control parameter has a fraction of its target.
///
/// The control parameter has the sign that it has in `state`, and its magnitude measures the path.
fn at_fraction<S: System>(system: &S, state: &State<S::Mode>, fraction: f64) -> Condition {
    let control = system.controls()[0];
    let side = (state.z[control.index] / control.scale).signum();
    Condition::new(vec![(control.index, side / control.scale)], fraction * system.target())
}

/// Returns the violated constraints with their guards, the most negative one first.
fn violated(guards: &[f64]) -> Vec<(usize, f64)> {
    let guards = guards.iter().copied().enumerate();
    let mut violated: Vec<_> =
        guards.filter(|(_, guard)| *guard < -FLOOR || guard.is_nan()).collect();
    violated.sort_by(|a, b| a.1.total_cmp(&b.1));
    violated
}
