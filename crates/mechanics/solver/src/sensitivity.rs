//! Derivatives of an equilibrium with respect to a parameter of the system.

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

/// System at two values of a parameter, `step` below and above its current one.
#[derive(Clone, Debug)]
pub struct Neighbours<S> {
    /// System at the smaller value.
    pub below: S,
    /// System at the larger value.
    pub above: S,
    /// Half the difference between the values.
    pub step: f64,
}

impl<S> Neighbours<S> {
    /// Applies a function to the systems below and above.
    ///
    /// # Errors
    /// Returns the error of the function.
    pub fn map<T, E>(&self, f: impl Fn(&S) -> Result<T, E>) -> Result<Neighbours<T>, E> {
        Ok(Neighbours { below: f(&self.below)?, above: f(&self.above)?, step: self.step })
    }

    /// Applies a function to each pair of systems.
    ///
    /// # Errors
    /// Returns the error of the function.
    pub fn map_all<T, E>(
        several: &[Self],
        f: impl Fn(&S) -> Result<T, E>,
    ) -> Result<Vec<Neighbours<T>>, E> {
        several.iter().map(|neighbours| neighbours.map(&f)).collect()
    }
}

/// First-order prediction of a point for a neighbouring value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct MovedPoint<M> {
    /// Predicted state.
    pub state: State<M>,
    /// Direction of the path at this point.
    pub direction: Vec<f64>,
}

/// Point with the factors of its tangent, which serve any number of parameters.
///
/// The unknowns `z` satisfy the equations `r(z, q) = 0` with the active set fixed. The tangent `J`
/// contains the row of a fixed section of the path in place of the missing row:
///
/// ```text
/// dz/dq = −J⁻¹ ∂r/∂q + s v,     J v = e,                                                (D2)
/// dv/dq = −J⁻¹ d(J v)/dq at fixed v                                                     (D3)
/// ```
///
/// where `v` is the direction of the path and `s` is chosen so that the anchor still holds. For a
/// point at which the rate `f(z, v)` of a quantity vanishes,
///
/// ```text
/// s = −(df/dq in the section)/(df/ds along the path)                                    (D5)
/// ```
///
/// with `v` turning by (D3), both along the path and in the section. `∂r/∂q` and `d(J v)/dq` are
/// central differences of explicit functions. Solutions are never differenced.
#[derive(Clone, Debug)]
pub struct Linearisation<M> {
    point: AnchoredPoint<M>,
    newton: Newton,
    /// Section of the path in which the point stays.
    section: Vec<(usize, f64)>,
    /// Inactive constraints that a small motion may violate.
    near: Vec<usize>,
}

impl<M: Clone> Linearisation<M> {
    /// Factorises the tangent at a point.
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

    /// Returns the point.
    pub fn point(&self) -> &AnchoredPoint<M> {
        &self.point
    }

    /// Predicts the points for a smaller and a larger parameter, to first order.
    ///
    /// The directions of the path turn only if `turns`. Results are not finite if the path has a
    /// fold at the anchor.
    pub fn moved<S: System<Mode = M>>(
        &mut self,
        system: &S,
        neighbours: &Neighbours<S>,
        turns: bool,
    ) -> [MovedPoint<M>; 2] {
        // First move in the section, then along the path to where the anchor holds again.
        let mut unknowns = self.unknowns_in_section(system, neighbours);
        let along = self.distance(system, neighbours, &unknowns);
        for (unknown, direction) in unknowns.iter_mut().zip(&self.point.direction) {
            *unknown += along * direction;
        }
        let Neighbours { below, above, step } = neighbours;
        self.turned([below, above], *step, &unknowns, turns)
    }

    /// Predicts the point on both sides from the rates of its unknowns.
    fn turned<S: System<Mode = M>>(
        &mut self,
        sides: [&S; 2],
        step: f64,
        unknowns: &[f64],
        turns: bool,
    ) -> [MovedPoint<M>; 2] {
        // Both predictions share one factorisation and need no further solve.
        let states = [-step, step].map(|step| self.point.state.moved(step, unknowns));
        let direction = &self.point.direction;
        let turning = turns.then(|| turning(&mut self.newton, sides, &states, direction, step));
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

    /// Computes the rates of the unknowns in the section, `−J⁻¹ ∂r/∂q`.
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

    /// Computes `s`, the motion of the point along the path.
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
            // The guard of an active constraint is its unknown, so no difference is needed.
            PathAnchor::Guard(constraint) if state.active[constraint] => {
                let index = system.constraints()[constraint];
                -unknowns[index] / direction[index]
            }
            _ => {
                let above = anchor.off(&neighbours.above, &state.moved(step, unknowns));
                let below = anchor.off(&neighbours.below, &state.moved(-step, unknowns));
                -(above - below) / (2.0 * step * anchor.slope(system, state, direction))
            }
        }
    }

    /// Computes `s` for a point at which a rate vanishes (D5).
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

    /// Returns the most violated constraint in the `moved` state, with its change.
    ///
    /// `None` if the active set remains valid on this side of the parameter.
    pub fn violated<S: System<Mode = M>>(
        &self,
        system: &S,
        moved: &MovedPoint<M>,
    ) -> Option<Change> {
        let active = &self.point.state.active;
        // A slip distance is counted from a point of the path and does not respond to the
        // parameter.
        let loaded = (0..active.len()).filter(|c| active[*c] && !system.monotone().contains(c));
        // The anchor's own guard is zero by definition, and round-off would violate it.
        let candidates = loaded
            .chain(self.near.iter().copied())
            .filter(|&c| self.point.anchor != PathAnchor::Guard(c));
        let guards = candidates.map(|c| (c, guard(system, &moved.state, c)));
        let violated = guards.filter(|(_, guard)| *guard < -FLOOR);
        let (constraint, _) = violated.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Change { constraint, activated: !self.point.state.active[constraint] })
    }

    /// Solves again with a constraint on its other side.
    ///
    /// `None` if no such equilibrium exists.
    pub fn beyond<S: System<Mode = M>>(
        &self,
        system: &S,
        change: Change,
        settings: &Settings,
    ) -> Option<Self> {
        // A contact about to open or close does so on one side of the parameter only, where the
        // measure has another derivative.
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
        // The path determines whether a contact that has just closed sticks or slips, and in which
        // direction, and which other contacts stop slipping. The motion with the parameter does
        // not: it shifts the point of closing.
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
        // The position at which a contact begins to stick depends on the parameter, but the mode,
        // which stores it, is held fixed here.
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

/// Maximum number of changes of friction at the closing of a contact.
const MOST_CHANGES: usize = 8;

/// Largest guard of an inactive constraint that a difference may violate.
///
/// The steps of a difference are some millionths of a parameter.
const NEAR: f64 = 1e-3;

/// Returns the inactive constraints that a small motion from a point may violate.
fn near<S: System>(system: &S, point: &AnchoredPoint<S::Mode>) -> Vec<usize> {
    let guards = Newton::guards(system, &point.state).into_iter().enumerate();
    let inactive = guards.filter(|&(c, guard)| !point.state.active[c] && guard <= NEAR);
    inactive.map(|(constraint, _)| constraint).collect()
}

/// Returns the row of the arc-length condition in the controls.
fn section<S: System>(system: &S, direction: &[f64]) -> Vec<(usize, f64)> {
    let controls = system.controls().iter();
    let square: f64 = controls.clone().map(|c| (direction[c.index] / c.scale).powi(2)).sum();
    let length = square.sqrt();
    controls.map(|c| (c.index, direction[c.index] / (c.scale.powi(2) * length))).collect()
}
