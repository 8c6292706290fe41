//! End of a path, as a start for the ends of neighbouring paths, which are then not followed.

use crate::continuation::{Continuation, Equilibrium};
use crate::event::Change;
use crate::newton::{Condition, FLOOR, Newton};
use crate::settings::Settings;
use crate::system::{State, System};
use crate::termination::Termination;

/// Largest number of Newton iterations from the end of one path to the end of another.
///
/// Close ends need three to five iterations.
const MOST_ITERATIONS: usize = 8;

/// Largest number of constraints that may differ between the ends of two paths.
const MOST_CHANGES: usize = 6;

/// Equilibrium at the target of a path.
///
/// From this point Newton's method finds the end of the path of a similar design. The path between
/// rest and the end is then not followed, so the caller must decide whether events on the path
/// matter.
#[derive(Clone, Debug)]
pub struct TargetPoint<M> {
    /// State at the target.
    state: State<M>,
    /// Orientation ([`Newton::is_positive`]) of the path, which neighbouring paths must share.
    is_positive: bool,
}

impl<M: Clone> TargetPoint<M> {
    /// Returns the end of a path that has reached its target.
    ///
    /// `None` if the path has not reached its target, or if the tangent at the end is singular.
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

    /// Returns the target point with another state on the same branch.
    #[must_use]
    pub fn moved_to(&self, state: State<M>) -> Self {
        Self { state, ..self.clone() }
    }

    /// Finds the equilibrium of a neighbouring system at the target.
    ///
    /// The neighbouring system must have the same unknowns. Violated constraints are changed one
    /// after the other, the most violated constraint first. `None` if Newton's method fails, if too
    /// many constraints change, or if the equilibrium lies on a branch with the other orientation
    /// (N7).
    pub fn of_neighbour<S: System<Mode = M>>(
        &self,
        system: &S,
        settings: &Settings,
    ) -> Option<Equilibrium<M>> {
        self.before_target(system, &self.state, 1.0, settings)
    }

    /// Finds the equilibrium of a neighbouring system at a fraction of the target.
    ///
    /// Works like [`TargetPoint::of_neighbour`], but starts from `near`, an equilibrium of this or
    /// a similar system. The directions of the result are derivatives with respect to the control
    /// parameter divided by its scale.
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
        for remaining in (0..=MOST_CHANGES).rev() {
            let direction = newton.solve(system, &mut state, &condition, &settings).ok()?;
            let violated = violated(&Newton::guards(system, &state));
            let Some(&(constraint, _)) = violated.first() else {
                let is_same_branch = newton.is_positive(&condition, &direction) == self.is_positive;
                let (arriving, leaving) = (direction.clone(), direction);
                let point = Equilibrium { state, arriving, leaving, event: None };
                return is_same_branch.then_some(point);
            };
            if violated.len() > remaining {
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

/// Returns the condition that the control parameter is at a fraction of its target.
///
/// The control parameter has the same sign as in `state`.
fn at_fraction<S: System>(system: &S, state: &State<S::Mode>, fraction: f64) -> Condition {
    let control = system.controls()[0];
    let side = (state.z[control.index] / control.scale).signum();
    Condition::new(vec![(control.index, side / control.scale)], fraction * system.target())
}

/// Returns number and guard of each violated constraint, the most negative guard first.
fn violated(guards: &[f64]) -> Vec<(usize, f64)> {
    let guards = guards.iter().copied().enumerate();
    let mut violated: Vec<_> =
        guards.filter(|(_, guard)| *guard < -FLOOR || guard.is_nan()).collect();
    violated.sort_by(|a, b| a.1.total_cmp(&b.1));
    violated
}
