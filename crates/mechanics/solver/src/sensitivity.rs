//! Derivatives of a point of a path with respect to a parameter of the system.

mod anchor;
mod differences;
mod stationary;

use crate::event::Change;
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure, guard, guard_slope};
use crate::settings::Settings;
use crate::system::{Residual, State, System};
use differences::{difference, moved, rates, turning};

pub use anchor::{AnchoredPoint, PathAnchor};
pub(crate) use stationary::slope_along;

/// Two systems for the difference quotient by a parameter, at a smaller and a larger value.
///
/// Both values differ by `step` from the current value of the parameter.
#[derive(Clone, Debug)]
pub struct Neighbours<S> {
    /// System at the smaller value of the parameter.
    pub below: S,
    /// System at the larger value of the parameter.
    pub above: S,
    /// Half of the difference between the two values.
    pub step: f64,
}

impl<S> Neighbours<S> {
    /// Applies `f` to both systems.
    ///
    /// # Errors
    /// Returns the error of `f`.
    pub fn map<T, E>(&self, f: impl Fn(&S) -> Result<T, E>) -> Result<Neighbours<T>, E> {
        Ok(Neighbours { below: f(&self.below)?, above: f(&self.above)?, step: self.step })
    }

    /// Applies `f` to both systems of each entry of `several`.
    ///
    /// # Errors
    /// Returns the error of `f`.
    pub fn map_all<T, E>(
        several: &[Self],
        f: impl Fn(&S) -> Result<T, E>,
    ) -> Result<Vec<Neighbours<T>>, E> {
        several.iter().map(|neighbours| neighbours.map(&f)).collect()
    }
}

/// First-order prediction of a point of the path for a perturbed parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct MovedPoint<M> {
    /// Predicted state.
    pub state: State<M>,
    /// Predicted direction of the path at this state.
    pub direction: Vec<f64>,
}

/// Point of a path with the factors of its tangent, for derivatives by any number of parameters.
///
/// The unknowns `z` satisfy the equations `r(z, q) = 0` with a fixed active set; `q` is a parameter
/// and `v` the direction of the path. In the tangent `J`, the row of a section across the path
/// replaces the missing row, and `e` is the unit vector of this row:
///
/// ```text
/// dz/dq = −J⁻¹ ∂r/∂q + s v,     J v = e                                                 (D2)
/// dv/dq = −J⁻¹ d(J v)/dq at fixed v                                                     (D3)
/// ```
///
/// The first term of (D2) keeps the point in the section. The distance `s` along the path is such
/// that the condition of the anchor remains satisfied. If the anchor is the point at which the rate
/// `f(z, v)` of a quantity is zero,
///
/// ```text
/// s = −(df/dq in the section)/(df/ds along the path)                                    (D5)
/// ```
///
/// Both derivatives of `f` include the change of `v` by (D3). `∂r/∂q` and `d(J v)/dq` are central
/// differences of explicit functions; differences of solutions are not used.
#[derive(Clone, Debug)]
pub struct Linearisation<M> {
    /// Point with its anchor.
    point: AnchoredPoint<M>,
    /// Factors of the tangent `J` at the point.
    newton: Newton,
    /// Index and coefficient of each unknown in the row of the section.
    section: Vec<(usize, f64)>,
    /// Inactive constraints that a small change of the state may violate.
    near: Vec<usize>,
}

impl<M: Clone> Linearisation<M> {
    /// Factorises the tangent at a point of the path.
    ///
    /// # Errors
    /// If the tangent is singular.
    pub fn new<S: System<Mode = M>>(
        system: &S,
        point: AnchoredPoint<M>,
    ) -> Result<Self, NewtonFailure> {
        let section = section(system, &point.direction);
        let condition = Condition::new(section.clone(), 0.0);
        let mut newton = Newton::new(system);
        let direction = newton.tangent(system, &point.state, &condition)?;
        let near = near(system, &point);
        Ok(Self { point: AnchoredPoint { direction, ..point }, newton, section, near })
    }

    /// Returns the point with its anchor.
    pub fn point(&self) -> &AnchoredPoint<M> {
        &self.point
    }

    /// Predicts the points for the smaller and the larger value of a parameter, to first order.
    ///
    /// The directions of the path are predicted only if `predict_direction` is true, otherwise they
    /// are the current direction. Results are not finite if the slope of the anchor along the path
    /// is zero.
    pub fn moved<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
        predict_direction: bool,
    ) -> [MovedPoint<M>; 2] {
        // Rates of the unknowns: first in the section, then along the path so that the condition of
        // the anchor remains satisfied.
        let mut unknowns = self.unknowns_in_section(system, neighbours);
        let along = self.distance(system, neighbours, &unknowns);
        for (unknown, direction) in unknowns.iter_mut().zip(&self.point.direction) {
            *unknown += along * direction;
        }
        let Neighbours { below, above, step } = neighbours;
        self.turned([below, above], *step, &unknowns, predict_direction)
    }

    /// Predicts the points for both systems `sides` from the rates `unknowns` of the unknowns.
    ///
    /// The directions of the path are predicted only if `predict_direction` is true.
    fn turned<S: System<Mode = M>>(
        &mut self,
        sides: [&S; 2],
        step: f64,
        unknowns: &[f64],
        predict_direction: bool,
    ) -> [MovedPoint<M>; 2] {
        // Both predictions use the same rates and factors.
        let states = [-step, step].map(|step| self.point.state.moved(step, unknowns));
        let direction = &self.point.direction;
        let turning =
            predict_direction.then(|| turning(&mut self.newton, sides, &states, direction, step));
        let [below, above] = [-step, step].map(|step| match &turning {
            Some(turning) => moved(direction, step, turning),
            None => direction.clone(),
        });
        let [lower, upper] = states;
        [
            MovedPoint { state: lower, direction: below },
            MovedPoint { state: upper, direction: above },
        ]
    }

    /// Computes `−J⁻¹ ∂r/∂q`, the rates of the unknowns in the section.
    fn unknowns_in_section<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
    ) -> Vec<f64> {
        let state = &self.point.state;
        let [below, above] = [&neighbours.below, &neighbours.above].map(|system| {
            let mut residual = Residual::new(system.size());
            system.residual(state, &mut residual);
            residual.value
        });
        let change = difference(below, above, neighbours.step);
        rates(&mut self.newton, system, state, change)
    }

    /// Computes `s` of (D2), the motion of the point along the path.
    fn distance<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
        unknowns: &[f64],
    ) -> f64 {
        if let PathAnchor::Stationary(number) = self.point.anchor {
            return self.distance_to_extremum(system, neighbours, unknowns, number);
        }
        let AnchoredPoint { state, direction, anchor } = &self.point;
        let step = neighbours.step;
        match *anchor {
            PathAnchor::Still => 0.0,
            // The guard of an active constraint is its unknown, with a known rate.
            PathAnchor::Guard(constraint) if state.active[constraint] => {
                let index = system.constraints()[constraint];
                -unknowns[index] / direction[index]
            }
            _ => {
                let above = anchor.value(&neighbours.above, &state.moved(step, unknowns));
                let below = anchor.value(&neighbours.below, &state.moved(-step, unknowns));
                -(above - below) / (2.0 * step * anchor.slope(system, state, direction))
            }
        }
    }

    /// Computes `s` by (D5) for a point at which the rate `number` is zero.
    fn distance_to_extremum<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
        unknowns: &[f64],
        number: usize,
    ) -> f64 {
        let Neighbours { below, above, step } = neighbours;
        let [lower, upper] = self.turned([below, above], *step, unknowns, true);
        let rates = [
            below.rate(&lower.state, &lower.direction, number),
            above.rate(&upper.state, &upper.direction, number),
        ];
        let change = (rates[1] - rates[0]) / (2.0 * step);
        let AnchoredPoint { state, direction, .. } = &self.point;
        let slope = slope_along(system, &mut self.newton, state, direction, &|system, state, v| {
            system.rate(state, v, number)
        });
        -change / slope
    }

    /// Returns the change of the constraint that the state `moved` violates most.
    ///
    /// `None` if the state violates no constraint, so that the active set remains valid.
    pub fn violated<S: System<Mode = M>>(
        &self,
        system: &S,
        moved: &MovedPoint<M>,
    ) -> Option<Change> {
        let active = &self.point.state.active;
        // The unknown of a monotone constraint, a slip distance, is measured from a point of the
        // path that itself depends on the parameter, so its derivative is not meaningful.
        let loaded = (0..active.len()).filter(|c| active[*c] && !system.monotone().contains(c));
        // The guard of the anchor is zero by definition, and must not be violated by round-off.
        let candidates = loaded
            .chain(self.near.iter().copied())
            .filter(|&c| self.point.anchor != PathAnchor::Guard(c));
        let guards = candidates.map(|c| (c, guard(system, &moved.state, c)));
        let violated = guards.filter(|(_, guard)| *guard < -FLOOR);
        let (constraint, _) = violated.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Change { constraint, activated: !self.point.state.active[constraint] })
    }

    /// Solves for the point after `change`, for the derivative on the other side of a kink.
    ///
    /// `None` if there is no such equilibrium.
    pub fn beyond<S: System<Mode = M>>(
        &self,
        system: &S,
        change: Change,
        settings: &Settings,
    ) -> Option<Self> {
        // If a contact is about to open or close, it does so only for a larger or only for a
        // smaller parameter. The derivative on this side belongs to the changed active set.
        let mut state = self.point.state.clone();
        state.active[change.constraint] = change.activated;
        state.z[system.constraints()[change.constraint]] = 0.0;
        system.transition(&mut state, change)?;
        let condition = Condition::through(self.section.clone(), &self.point.state.z);
        let mut newton = Newton::new(system);
        let mut direction = newton.solve(system, &mut state, &condition, settings).ok()?;
        let closes = change.activated && !system.monotone().contains(&change.constraint);
        let coupled = system.coupled(change.constraint);
        if !closes || coupled.len() == 1 {
            return Self::new(
                system,
                AnchoredPoint { state, direction, anchor: self.point.anchor },
            )
            .ok();
        }
        // With friction, a contact that has just closed sticks or slips in one of two directions,
        // and other contacts may stop slipping. The direction of the path decides this, not the
        // parameter, which only shifts the point at which the contact closes.
        for _ in 0..MOST_CHANGES {
            let limits = coupled
                .clone()
                .filter(|&c| c != change.constraint && guard(system, &state, c).abs() <= FLOOR)
                .map(|c| (c, guard_slope(system, &state, c, &direction)));
            let slips = system.monotone().iter().copied().filter(|&c| state.active[c]);
            let slips = slips.map(|c| (c, guard_slope(system, &state, c, &direction)));
            let violated = limits.chain(slips).filter(|(_, slope)| *slope < -FLOOR);
            let Some((constraint, _)) = violated.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            let next = Change { constraint, activated: !state.active[constraint] };
            state.active[constraint] = next.activated;
            state.z[system.constraints()[constraint]] = 0.0;
            system.transition(&mut state, next)?;
            direction = newton.solve(system, &mut state, &condition, settings).ok()?;
        }
        // The position at which a contact begins to stick depends on the parameter, but it is
        // stored in the mode, which is fixed here. The derivative would therefore be wrong.
        let sticks = (0..state.active.len()).any(|c| {
            state.active[c]
                && !self.point.state.active[c]
                && c != change.constraint
                && !system.monotone().contains(&c)
        });
        if sticks {
            return None;
        }
        Self::new(system, AnchoredPoint { state, direction, anchor: self.point.anchor }).ok()
    }
}

/// Maximum number of changes of friction constraints after the closing of a contact.
const MOST_CHANGES: usize = 8;

/// Largest guard of an inactive constraint that a small change of a parameter may violate.
///
/// Parameters are changed by some millionths of their values.
const NEAR: f64 = 1e-3;

/// Returns the inactive constraints that a small change of the state may violate.
fn near<S: System>(system: &S, point: &AnchoredPoint<S::Mode>) -> Vec<usize> {
    let guards = Newton::guards(system, &point.state).into_iter().enumerate();
    let inactive = guards.filter(|&(c, guard)| !point.state.active[c] && guard <= NEAR);
    inactive.map(|(constraint, _)| constraint).collect()
}

/// Returns the row of the section: the coefficients of the arc length in the controls.
fn section<S: System>(system: &S, direction: &[f64]) -> Vec<(usize, f64)> {
    let controls = system.controls().iter();
    let square: f64 = controls.clone().map(|c| (direction[c.index] / c.scale).powi(2)).sum();
    let length = square.sqrt();
    controls.map(|c| (c.index, direction[c.index] / (c.scale.powi(2) * length))).collect()
}
