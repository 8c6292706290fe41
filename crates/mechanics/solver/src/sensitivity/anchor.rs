//! Anchors: conditions that select a point of a path while a parameter changes the path.

use super::differences::ALONG;
use crate::continuation::Equilibrium;
use crate::newton::{guard, guard_slope};
use crate::system::{State, System};

/// Condition that selects a point of a path while a parameter changes the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathAnchor {
    /// The arc length in the controls is constant, so the point does not move along the path.
    ///
    /// Used for the state of rest, and for a smooth maximum, where a motion along the path has no
    /// first-order effect.
    Still,
    /// The control parameter has the magnitude of its scale, the default [`System::target`].
    Target,
    /// The guard (N5) of the constraint with this number is constant; at an event it is zero.
    Guard(usize),
    /// The marker with this number ([`System::marker`]) is constant.
    Marker(usize),
    /// The rate with this number ([`System::rate`]) is zero.
    Stationary(usize),
}

/// Point of a path with the condition that selects it.
#[derive(Clone, Debug, PartialEq)]
pub struct AnchoredPoint<M> {
    /// Equilibrium, with the active set and mode for the derivatives.
    pub state: State<M>,
    /// Direction of the path at the point.
    pub direction: Vec<f64>,
    /// Condition that selects the point.
    pub anchor: PathAnchor,
}

impl<M: Clone> AnchoredPoint<M> {
    /// Creates an anchored point from a point of a path and its incoming direction.
    pub fn arriving(point: &Equilibrium<M>, anchor: PathAnchor) -> Self {
        Self { state: point.state.clone(), direction: point.arriving.clone(), anchor }
    }
}

impl PathAnchor {
    /// Evaluates the function of the state that the anchor keeps constant.
    pub(super) fn value<S: System>(self, system: &S, state: &State<S::Mode>) -> f64 {
        let control = system.controls()[0];
        match self {
            Self::Still | Self::Stationary(_) => 0.0,
            Self::Target => (state.z[control.index] / control.scale).abs() - 1.0,
            Self::Guard(constraint) => guard(system, state, constraint),
            Self::Marker(number) => system.marker(state, number),
        }
    }

    /// Evaluates the derivative of the function of the anchor along a direction.
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
