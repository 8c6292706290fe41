//! Derivatives of an equilibrium with respect to a parameter of the system.

mod anchor;
mod differences;
mod stationary;

use crate::event::Change;
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure, guard};
use crate::settings::Settings;
use crate::system::{Residual, State, System};
use differences::{difference, moved, rates, turning};

pub use anchor::{AnchoredPoint, PathAnchor};
pub(crate) use stationary::slope_along;

/// A system for two values of a parameter that differ by `2 step`, on both sides of the value that it has.
#[derive(Clone, Debug)]
pub struct Neighbours<S> {
    /// The system for the smaller value.
    pub below: S,
    /// The system for the larger value.
    pub above: S,
    /// Half the difference of the two values.
    pub step: f64,
}

impl<S> Neighbours<S> {
    /// What a function makes of both.
    ///
    /// # Errors
    /// Those of the function.
    pub fn map<T, E>(&self, f: impl Fn(&S) -> Result<T, E>) -> Result<Neighbours<T>, E> {
        Ok(Neighbours { below: f(&self.below)?, above: f(&self.above)?, step: self.step })
    }

    /// What a function makes of both, of several.
    ///
    /// # Errors
    /// Those of the function.
    pub fn map_all<T, E>(
        several: &[Self],
        f: impl Fn(&S) -> Result<T, E>,
    ) -> Result<Vec<Neighbours<T>>, E> {
        several.iter().map(|neighbours| neighbours.map(&f)).collect()
    }
}

/// A place for a neighbouring value of a parameter, to first order.
#[derive(Clone, Debug, PartialEq)]
pub struct MovedPoint<M> {
    /// The equilibrium.
    pub state: State<M>,
    /// The direction of the path there.
    pub direction: Vec<f64>,
}

/// A place with the factors of its tangent, which serve any number of parameters.
///
/// With the unknowns `z`, the equations `r(z, q) = 0`, the active set held, and the tangent `J` with the row of a
/// fixed section of the path in the place of the missing one,
///
/// ```text
/// dz/dq = −J⁻¹ ∂r/∂q + s v,     J v = e,                                                (D2)
/// dv/dq = −J⁻¹ d(J v)/dq at fixed v                                                     (D3)
/// ```
///
/// where `v` is the direction of the path and `s` the number with which the anchor holds: that of a place where the rate
/// `f(z, v)` of a quantity vanishes is
///
/// ```text
/// s = −(df/dq in the section)/(df/ds along the path)                                    (D5)
/// ```
///
/// with `v` that turns by (D3), on the way as in the section. `∂r/∂q` and `d(J v)/dq` are central
/// differences of explicit functions. No solution is ever differenced.
#[derive(Clone, Debug)]
pub struct Linearisation<M> {
    place: AnchoredPoint<M>,
    newton: Newton,
    /// The section of the path that the place stays in.
    section: Vec<(usize, f64)>,
    /// The inactive constraints that a small motion may violate.
    near: Vec<usize>,
}

impl<M: Clone> Linearisation<M> {
    /// Factorises the tangent at a place.
    ///
    /// # Errors
    /// If the tangent is singular there.
    pub fn new<S: System<Mode = M>>(
        system: &S,
        place: AnchoredPoint<M>,
    ) -> Result<Self, NewtonFailure> {
        let section = section(system, &place.direction);
        let condition = Condition::new(section.clone(), 0.0);
        let mut newton = Newton::new(system);
        let direction = newton.tangent(system, &place.state, &condition)?;
        let near = near(system, &place);
        Ok(Self { place: AnchoredPoint { direction, ..place }, newton, section, near })
    }

    /// The place.
    pub fn place(&self) -> &AnchoredPoint<M> {
        &self.place
    }

    /// The place for the neighbouring values of a parameter, to first order: below and above. The directions of the path turn
    /// with it only if they `turn`. The numbers are not finite where the path has a fold at the anchor.
    pub fn moved<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
        turns: bool,
    ) -> [MovedPoint<M>; 2] {
        // First in the section, where the place is held along the path, then along it to where its anchor is met again.
        let mut unknowns = self.unknowns_in_section(system, neighbours);
        let along = self.distance(system, neighbours, &unknowns);
        for (unknown, direction) in unknowns.iter_mut().zip(&self.place.direction) {
            *unknown += along * direction;
        }
        let Neighbours { below, above, step } = neighbours;
        self.turned([below, above], *step, &unknowns, turns)
    }

    /// The place with unknowns that change at these rates.
    fn turned<S: System<Mode = M>>(
        &mut self,
        sides: [&S; 2],
        step: f64,
        unknowns: &[f64],
        turns: bool,
    ) -> [MovedPoint<M>; 2] {
        // Both sides are first-order predictions from one factorisation; nothing is solved for again.
        let states = [-step, step].map(|step| self.place.state.moved(step, unknowns));
        let direction = &self.place.direction;
        let turning = turns.then(|| turning(&mut self.newton, sides, &states, direction, step));
        let direction = |step: f64| match &turning {
            Some(turning) => moved(&self.place.direction, step, turning),
            None => self.place.direction.clone(),
        };
        let [below, above] = states;
        [
            MovedPoint { state: below, direction: direction(-step) },
            MovedPoint { state: above, direction: direction(step) },
        ]
    }

    /// `−J⁻¹ ∂r/∂q`.
    fn unknowns_in_section<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
    ) -> Vec<f64> {
        let state = &self.place.state;
        let values = |system: &S| {
            let mut residual = Residual::new(system.size());
            system.residual(state, &mut residual);
            residual.value
        };
        let [below, above] = [&neighbours.below, &neighbours.above].map(values);
        let change = difference(below, above, neighbours.step);
        rates(&mut self.newton, system, state, change)
    }

    /// `s`: how far the place moves along the path besides.
    fn distance<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
        unknowns: &[f64],
    ) -> f64 {
        if let PathAnchor::Stationary(number) = self.place.anchor {
            return self.distance_to_extremum(system, neighbours, unknowns, number);
        }
        let AnchoredPoint { state, direction, anchor } = &self.place;
        let off = |system: &S, step: f64| anchor.off(system, &state.moved(step, unknowns));
        let step = neighbours.step;
        match *anchor {
            PathAnchor::Still => 0.0,
            // The guard of an active constraint is its unknown, of which no difference is needed.
            PathAnchor::Guard(constraint) if state.active[constraint] => {
                let index = system.constraints()[constraint];
                -unknowns[index] / direction[index]
            }
            _ => {
                let change = off(&neighbours.above, step) - off(&neighbours.below, -step);
                -change / (2.0 * step * anchor.slope(system, state, direction))
            }
        }
    }

    /// `s` of a place at which a rate vanishes (D5).
    fn distance_to_extremum<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
        unknowns: &[f64],
        number: usize,
    ) -> f64 {
        let Neighbours { below, above, step } = neighbours;
        let [lower, upper] = self.turned([below, above], *step, unknowns, true);
        let rate = |system: &S, at: &MovedPoint<M>| system.rate(&at.state, &at.direction, number);
        let change = (rate(above, &upper) - rate(below, &lower)) / (2.0 * step);
        let AnchoredPoint { state, direction, .. } = &self.place;
        let rate = |system: &S, state: &State<M>, v: &[f64]| system.rate(state, v, number);
        -change / slope_along(system, &mut self.newton, state, direction, &rate)
    }

    /// The change of sides that the motion of the place calls for on one side of the parameter: that of the constraint whose
    /// sign is violated most in the state that has `moved` there. `None` if the active set holds.
    pub fn violated<S: System<Mode = M>>(
        &self,
        system: &S,
        moved: &MovedPoint<M>,
    ) -> Option<Change> {
        let active = &self.place.state.active;
        // The guard that anchors the place is zero there by definition, and would be violated by round-off.
        let held = |constraint: usize| self.place.anchor == PathAnchor::Guard(constraint);
        // How far something has slid since an event is counted from a place of the path, not of the parameter.
        let loaded = (0..active.len()).filter(|c| active[*c] && !system.monotone().contains(c));
        let candidates = loaded.chain(self.near.iter().copied()).filter(|&c| !held(c));
        let guards = candidates.map(|c| (c, guard(system, &moved.state, c)));
        let violated = guards.filter(|(_, guard)| *guard < -FLOOR);
        let (constraint, _) = violated.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Change { constraint, activated: !self.place.state.active[constraint] })
    }

    /// The place with a constraint on the other side, solved for again. `None` if there is no such equilibrium.
    pub fn beyond<S: System<Mode = M>>(
        &self,
        system: &S,
        change: Change,
        settings: &Settings,
    ) -> Option<Self> {
        // A contact that is about to open or close at the place does so on one side of the parameter alone: there the
        // measure has another derivative.
        let mut state = self.place.state.clone();
        state.active[change.constraint] = change.activated;
        state.z[system.constraints()[change.constraint]] = 0.0;
        system.transition(&mut state, change)?;
        let condition = Condition::through(self.section.clone(), &self.place.state.z);
        let direction = Newton::new(system).solve(system, &mut state, &condition, settings).ok()?;
        Self::new(system, AnchoredPoint { state, direction, anchor: self.place.anchor }).ok()
    }
}

/// An inactive constraint whose guard is larger is not violated within the step of a difference, some millionths of a parameter.
const NEAR: f64 = 1e-3;

/// The inactive constraints that a small motion from a place may violate.
fn near<S: System>(system: &S, place: &AnchoredPoint<S::Mode>) -> Vec<usize> {
    let guards = Newton::guards(system, &place.state).into_iter().enumerate();
    let inactive = guards.filter(|&(c, guard)| !place.state.active[c] && guard <= NEAR);
    inactive.map(|(constraint, _)| constraint).collect()
}

/// The condition of the arc length in the controls.
fn section<S: System>(system: &S, direction: &[f64]) -> Vec<(usize, f64)> {
    let controls = system.controls().iter();
    let square: f64 = controls.clone().map(|c| (direction[c.index] / c.scale).powi(2)).sum();
    let length = square.sqrt();
    controls.map(|c| (c.index, direction[c.index] / (c.scale.powi(2) * length))).collect()
}
