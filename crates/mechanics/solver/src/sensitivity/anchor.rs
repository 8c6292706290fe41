//! Conditions that tell which equilibrium of a path a place is.

use super::differences::ALONG;
use crate::continuation::Equilibrium;
use crate::newton::{guard, guard_slope};
use crate::system::{State, System};

/// The condition that tells which equilibrium of the path a place is, when a parameter changes the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathAnchor {
    /// The place stays where it is along the path: at rest, or at a smooth maximum, where moving along the path changes nothing.
    Still,
    /// The control parameter is at its target.
    Target,
    /// The guard (N5) of this constraint keeps its value: at an event it vanishes.
    Guard(usize),
    /// The marker of this number keeps its value.
    Marker(usize),
    /// The rate of this number vanishes: a quantity is stationary along the path.
    Stationary(usize),
}

/// An equilibrium of a path that a parameter moves.
#[derive(Clone, Debug, PartialEq)]
pub struct AnchoredPoint<M> {
    /// The equilibrium, with the active set and the mode that are held.
    pub state: State<M>,
    /// The direction of the path there.
    pub direction: Vec<f64>,
    /// The condition that holds the place on the path.
    pub anchor: PathAnchor,
}

impl<M: Clone> AnchoredPoint<M> {
    /// A point of a path as the path arrives at it.
    pub fn arriving(point: &Equilibrium<M>, anchor: PathAnchor) -> Self {
        Self { state: point.state.clone(), direction: point.arriving.clone(), anchor }
    }
}

impl PathAnchor {
    /// The number that vanishes where the anchor holds, of one that a state tells.
    pub(super) fn off<S: System>(self, system: &S, state: &State<S::Mode>) -> f64 {
        let control = system.controls()[0];
        match self {
            Self::Still | Self::Stationary(_) => 0.0,
            Self::Target => state.z[control.index] / control.scale - 1.0,
            Self::Guard(constraint) => guard(system, state, constraint),
            Self::Marker(number) => system.marker(state, number),
        }
    }

    /// The derivative of that number along a direction.
    pub(super) fn slope<S: System>(
        self,
        system: &S,
        state: &State<S::Mode>,
        direction: &[f64],
    ) -> f64 {
        let control = system.controls()[0];
        match self {
            Self::Still | Self::Stationary(_) => 0.0,
            Self::Target => direction[control.index] / control.scale,
            Self::Guard(constraint) => guard_slope(system, state, constraint, direction),
            Self::Marker(number) => {
                // Of a marker a system tells the value alone.
                let at = |step: f64| system.marker(&state.moved(step, direction), number);
                (at(ALONG) - at(-ALONG)) / (2.0 * ALONG)
            }
        }
    }
}
