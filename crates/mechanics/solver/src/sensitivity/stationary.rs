//! Places of a path at which a function is stationary.

use super::anchor::{AnchoredPoint, PathAnchor};
use super::differences::{ALONG, moved, turning};
use super::section;
use crate::newton::{Condition, Newton};
use crate::settings::Settings;
use crate::system::{State, System};

/// First step of the search for a stationary place, and that at which the search ends, as parts of the way over which the state
/// changes; the largest step, as a part of the path.
const SECANT: f64 = 1e-3;
const SETTLED: f64 = 1e-8;
const FARTHEST: f64 = 0.1;

/// The shortest way over which the state is taken to change, as a part of the path.
const SHORTEST: f64 = 1e-6;

/// A function whose slope over the path is this part of its value is constant.
const FLAT: f64 = 1e-9;

/// Steps after which the search for a stationary place has failed.
const MOST_SECANTS: usize = 20;

impl<M: Clone> AnchoredPoint<M> {
    /// The place near this one at which a function of system, state and direction is stationary along the path, by the
    /// secant method. The function must have an extremum there. `None` where the iteration does not settle.
    pub fn stationary<S: System<Mode = M>>(
        &self,
        system: &S,
        f: &impl Fn(&S, &State<M>, &[f64]) -> f64,
        settings: &Settings,
    ) -> Option<Self> {
        let section = section(system, &self.direction);
        let origin = Condition::through(section, &self.state.z);
        let reach = reach(system, &self.state, &self.direction);
        let at = |distance: f64| {
            let mut state = self.state.moved(distance, &self.direction);
            let condition = Condition { value: origin.value + distance, ..origin.clone() };
            let mut newton = Newton::new(system);
            let direction = newton.solve(system, &mut state, &condition, settings).ok()?;
            let slope = slope_along(system, &mut newton, &state, &direction, f);
            Some((distance, slope, Self { state, direction, anchor: PathAnchor::Still }))
        };
        let (mut last, mut here) = (at(0.0)?, at(SECANT * reach)?);
        let value = f(system, &self.state, &self.direction);
        if last.1.abs().max(here.1.abs()) <= FLAT * value.abs() {
            // The function does not change along the path, or hardly.
            return Some(last.2.anchored(system));
        }
        for _ in 0..MOST_SECANTS {
            let step = -here.1 * (here.0 - last.0) / (here.1 - last.1);
            // So far away it would be another extremum than the one that was asked for.
            if !step.is_finite() || step.abs() > FARTHEST {
                return None;
            }
            let next = at(here.0 + step)?;
            last = std::mem::replace(&mut here, next);
            if step.abs() <= SETTLED * reach {
                return Some(here.2.anchored(system));
            }
        }
        None
    }

    /// The place held where the unknown of the fastest constraint keeps its value. Where a function is stationary along the path
    /// any section serves; in this one the layers stay at rest that a force makes which has just begun to act.
    fn anchored<S: System<Mode = M>>(self, system: &S) -> Self {
        let fast = fastest(system, &self.state, &self.direction).filter(|(_, way)| *way < 1.0);
        let anchor =
            fast.map_or(PathAnchor::Still, |(constraint, _)| PathAnchor::Guard(constraint));
        Self { anchor, ..self }
    }
}

/// The derivative of a function of system, state and direction along the path, at a state at which the tangent was factorised last.
/// The length of the direction makes no difference to the function.
pub(crate) fn slope_along<S: System>(
    system: &S,
    newton: &mut Newton,
    state: &State<S::Mode>,
    direction: &[f64],
    f: &impl Fn(&S, &State<S::Mode>, &[f64]) -> f64,
) -> f64 {
    let step = ALONG * reach(system, state, direction);
    let states = [-step, step].map(|step| state.moved(step, direction));
    let turning = turning(newton, [system; 2], &states, direction, step);
    let value =
        |side: usize, step: f64| f(system, &states[side], &moved(direction, step, &turning));
    (value(1, step) - value(0, -step)) / (2.0 * step)
}

/// The active constraint whose unknown changes fastest along the path, as a part of itself, and the way over which it changes by as
/// much as it is.
fn fastest<S: System>(
    system: &S,
    state: &State<S::Mode>,
    direction: &[f64],
) -> Option<(usize, f64)> {
    let constraints = system.constraints().iter().zip(&state.active).enumerate();
    // How far something has slid is counted from a place of this path, which another design has elsewhere.
    let counts = |number: usize| !system.monotone().contains(&number);
    let active = constraints.filter(|(number, (_, active))| **active && counts(*number));
    let ways = active
        .map(|(constraint, (&index, _))| (constraint, (state.z[index] / direction[index]).abs()));
    ways.filter(|(_, way)| way.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The way over which nothing changes by more than itself, at most the whole path.
fn reach<S: System>(system: &S, state: &State<S::Mode>, direction: &[f64]) -> f64 {
    fastest(system, state, direction).map_or(1.0, |(_, way)| way.clamp(SHORTEST, 1.0))
}
