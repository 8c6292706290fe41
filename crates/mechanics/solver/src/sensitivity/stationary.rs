//! Points of a path at which a function is stationary.

use super::anchor::{AnchoredPoint, PathAnchor};
use super::differences::{ALONG, moved, turning};
use super::section;
use crate::newton::{Condition, Newton};
use crate::settings::Settings;
use crate::system::{State, System};

/// First step of the secant search, as a fraction of [`reach`].
const SECANT: f64 = 1e-3;

/// Largest last step of a converged secant search, as a fraction of [`reach`].
const SETTLED: f64 = 1e-8;

/// Largest step of the secant search, in units of the arc length in the controls.
const FARTHEST: f64 = 0.1;

/// Lower bound of [`reach`], in units of the arc length in the controls.
const SHORTEST: f64 = 1e-6;

/// Ratio of slope to value of a function up to which the function counts as constant.
const FLAT: f64 = 1e-9;

/// Maximum number of steps of the secant search.
const MOST_SECANTS: usize = 20;

impl<M: Clone> AnchoredPoint<M> {
    /// Finds the nearby point at which the function `f` is stationary along the path.
    ///
    /// `f` is a function of system, state and path direction with an extremum near this point. The
    /// secant method is applied to the slope of `f`. `None` if the iteration does not converge.
    pub fn stationary<S: System<Mode = M>>(
        &self,
        system: &S,
        f: &impl Fn(&S, &State<M>, &[f64]) -> f64,
        settings: &Settings,
    ) -> Option<Self> {
        let section = section(system, &self.direction);
        let origin = Condition::through(section, &self.state.z);
        let reach = reach(system, &self.state, &self.direction);
        let mut last = self.with_slope(system, 0.0, &origin, f, settings)?;
        let mut here = self.with_slope(system, SECANT * reach, &origin, f, settings)?;
        let value = f(system, &self.state, &self.direction);
        if last.1.abs().max(here.1.abs()) <= FLAT * value.abs() {
            // The function is constant along the path, so any point is stationary.
            return Some(last.2.anchored(system));
        }
        for _ in 0..MOST_SECANTS {
            let step = -here.1 * (here.0 - last.0) / (here.1 - last.1);
            // With such a large step the search would find a different extremum.
            if !step.is_finite() || step.abs() > FARTHEST {
                return None;
            }
            let next = self.with_slope(system, here.0 + step, &origin, f, settings)?;
            last = std::mem::replace(&mut here, next);
            if step.abs() <= SETTLED * reach {
                return Some(here.2.anchored(system));
            }
        }
        None
    }

    /// Solves for the point at a distance along the path from this point.
    ///
    /// Returns the distance, the slope of `f` there, and the point. `None` if Newton's method
    /// fails.
    fn with_slope<S: System<Mode = M>>(
        &self,
        system: &S,
        distance: f64,
        origin: &Condition,
        f: &impl Fn(&S, &State<M>, &[f64]) -> f64,
        settings: &Settings,
    ) -> Option<(f64, f64, Self)> {
        let mut state = self.state.moved(distance, &self.direction);
        let condition = Condition { value: origin.value + distance, ..origin.clone() };
        let mut newton = Newton::new(system);
        let direction = newton.solve(system, &mut state, &condition, settings).ok()?;
        let slope = slope_along(system, &mut newton, &state, &direction, f);
        Some((distance, slope, Self { state, direction, anchor: PathAnchor::Still }))
    }

    /// Returns the point, anchored to the unknown with the largest relative rate along the path.
    ///
    /// Any anchor is valid at a stationary point. With this anchor a force that has just begun to
    /// act, and changes by its own value within a short distance, is kept constant. The anchor is
    /// [`PathAnchor::Still`] if no unknown changes by its own value within the distance 1.
    fn anchored<S: System<Mode = M>>(self, system: &S) -> Self {
        let fast =
            fastest(system, &self.state, &self.direction).filter(|(_, distance)| *distance < 1.0);
        let anchor =
            fast.map_or(PathAnchor::Still, |(constraint, _)| PathAnchor::Guard(constraint));
        Self { anchor, ..self }
    }
}

/// Returns the derivative of `f` along the path.
///
/// `f` is a function of system, state and path direction that does not depend on the length of the
/// direction. The last factorised tangent of `newton` must belong to `state`.
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
    let [below, above] = [(0, -step), (1, step)]
        .map(|(side, step)| f(system, &states[side], &moved(direction, step, &turning)));
    (above - below) / (2.0 * step)
}

/// Returns the active constraint with the largest relative rate of its unknown along the path.
///
/// The second value is the distance over which this unknown changes by its own value. `None` if no
/// active constraint changes.
fn fastest<S: System>(
    system: &S,
    state: &State<S::Mode>,
    direction: &[f64],
) -> Option<(usize, f64)> {
    let constraints = system.constraints().iter().zip(&state.active).enumerate();
    // The unknown of a monotone constraint, a slip distance, is measured from a point of the path
    // that depends on the parameter, so leave it out.
    let active =
        constraints.filter(|(number, (_, active))| **active && !system.monotone().contains(number));
    let distances = active
        .map(|(constraint, (&index, _))| (constraint, (state.z[index] / direction[index]).abs()));
    distances.filter(|(_, distance)| distance.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns a distance along the path over which no constraint changes by more than its value.
///
/// Only the unknowns of active constraints count. The distance is limited to [`SHORTEST`] to 1.
fn reach<S: System>(system: &S, state: &State<S::Mode>, direction: &[f64]) -> f64 {
    fastest(system, state, direction).map_or(1.0, |(_, distance)| distance.clamp(SHORTEST, 1.0))
}
