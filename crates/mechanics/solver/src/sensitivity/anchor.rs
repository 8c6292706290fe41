//! Conditions that fix a point on a path while a parameter changes the path.

use super::differences::ALONG;
use crate::continuation::Equilibrium;
use crate::newton::{guard, guard_slope};
use crate::system::{State, System};

/// Condition that fixes a point on a path while a parameter changes the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathAnchor {
    /// The point keeps its position along the path.
    ///
    /// At rest, or at a smooth maximum, where motion along the path has no first-order effect.
    Still,
    /// The control parameter is at its target, in either direction.
    Target,
    /// The guard (N5) of this constraint keeps its value: at an event it vanishes.
    Guard(usize),
    /// The marker of this number keeps its value.
    Marker(usize),
    /// The rate of this number vanishes: a quantity is stationary along the path.
    Stationary(usize),
}

/// Point of a path with the condition that fixes it.
#[derive(Clone, Debug, PartialEq)]
pub struct AnchoredPoint<M> {
    /// Equilibrium, with fixed active set and mode.
    pub state: State<M>,
    /// Direction of the path at the point.
    pub direction: Vec<f64>,
    /// Condition that fixes the point on the path.
    pub anchor: PathAnchor,
}

impl<M: Clone> AnchoredPoint<M> {
    /// Anchors a point of a path, with its incoming direction.
    pub fn arriving(point: &Equilibrium<M>, anchor: PathAnchor) -> Self {
        Self { state: point.state.clone(), direction: point.arriving.clone(), anchor }
    }
}

impl PathAnchor {
    /// Evaluates the function of the state that vanishes where the anchor holds.
    pub(super) fn off<S: System>(self, system: &S, state: &State<S::Mode>) -> f64 {
        let control = system.controls()[0];
        match self {
            Self::Still | Self::Stationary(_) => 0.0,
            Self::Target => (state.z[control.index] / control.scale).abs() - 1.0,
            Self::Guard(constraint) => guard(system, state, constraint),
            Self::Marker(number) => system.marker(state, number),
        }
    }

    /// Evaluates the derivative of the anchor function along a direction.
    pub(super) fn slope<S: System>(
        self,
        system: &S,
        state: &State<S::Mode>,
        direction: &[f64],
    ) -> f64 {
        let control = system.controls()[0];
        match self {
            Self::Still | Self::Stationary(_) => 0.0,
            Self::Target => {
                let sign = (state.z[control.index] / control.scale).signum();
                sign * direction[control.index] / control.scale
            }
            Self::Guard(constraint) => guard_slope(system, state, constraint, direction),
            Self::Marker(number) => {
                // A system provides only the value of a marker, so use a difference.
                let [ahead, behind] =
                    [ALONG, -ALONG].map(|s| system.marker(&state.moved(s, direction), number));
                (ahead - behind) / (2.0 * ALONG)
            }
        }
    }
}
