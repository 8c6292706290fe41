//! Derivatives of an equilibrium with respect to a parameter of the system.

use crate::event::Change;
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure, guard, guard_slope};
use crate::step::Settings;
use crate::system::{Residual, State, System, inactive};
use crate::tangent::Tangent;

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

/// A place for a neighbouring value of a parameter, to first order.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved<M> {
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
/// where `v` is the direction of the path and `s` the number with which the anchor holds. `∂r/∂q` and `d(J v)/dq` are central
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
        let condition = Condition { row: section.clone(), value: 0.0 };
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
    ) -> [Moved<M>; 2] {
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
    ) -> [Moved<M>; 2] {
        let states = [-step, step].map(|step| self.place.state.moved(step, unknowns));
        let direction = &self.place.direction;
        let turning = turns.then(|| turning(&mut self.newton, sides, &states, direction, step));
        let direction = |step: f64| match &turning {
            Some(turning) => moved(&self.place.direction, step, turning),
            None => self.place.direction.clone(),
        };
        let [below, above] = states;
        [
            Moved { state: below, direction: direction(-step) },
            Moved { state: above, direction: direction(step) },
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
        &self,
        system: &S,
        neighbours: &Neighbours<S>,
        unknowns: &[f64],
    ) -> f64 {
        let AnchoredPoint { state, direction, anchor } = &self.place;
        let off = |system: &S, step: f64| anchor.off(system, &state.moved(step, unknowns));
        let step = neighbours.step;
        match *anchor {
            PathAnchor::Still => 0.0,
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

    /// The change of sides that the motion of the place calls for on one side of the parameter: that of the constraint whose
    /// sign is violated most in the state that has `moved` there. `None` if the active set holds.
    pub fn violated<S: System<Mode = M>>(&self, system: &S, moved: &Moved<M>) -> Option<Change> {
        let active = &self.place.state.active;
        let held = |constraint: usize| self.place.anchor == PathAnchor::Guard(constraint);
        let loaded = (0..active.len()).filter(|&c| active[c]);
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
        let mut state = self.place.state.clone();
        state.active[change.constraint] = change.activated;
        state.z[system.constraints()[change.constraint]] = 0.0;
        system.transition(&mut state, change)?;
        let condition = Condition::through(self.section.clone(), &self.place.state.z);
        let direction = Newton::new(system).solve(system, &mut state, &condition, settings).ok()?;
        Self::new(system, AnchoredPoint { state, direction, anchor: self.place.anchor }).ok()
    }

    /// This place held by the guard of another constraint.
    #[must_use]
    pub fn held_by(self, constraint: usize) -> Self {
        Self {
            place: AnchoredPoint { anchor: PathAnchor::Guard(constraint), ..self.place },
            ..self
        }
    }
}

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

/// An inactive constraint whose guard is larger is not violated within the step of a difference, some millionths of a parameter.
const NEAR: f64 = 1e-3;

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

/// Part of the way over which the state changes, for derivatives along the path by differences.
const ALONG: f64 = 1e-5;

impl PathAnchor {
    /// The number that vanishes where the anchor holds.
    fn off<S: System>(self, system: &S, state: &State<S::Mode>) -> f64 {
        let control = system.controls()[0];
        match self {
            Self::Still => 0.0,
            Self::Target => state.z[control.index] / control.scale - 1.0,
            Self::Guard(constraint) => guard(system, state, constraint),
            Self::Marker(number) => system.marker(state, number),
        }
    }

    /// The derivative of that number along a direction.
    fn slope<S: System>(self, system: &S, state: &State<S::Mode>, direction: &[f64]) -> f64 {
        let control = system.controls()[0];
        match self {
            Self::Still => 0.0,
            Self::Target => direction[control.index] / control.scale,
            Self::Guard(constraint) => guard_slope(system, state, constraint, direction),
            Self::Marker(number) => {
                let at = |step: f64| system.marker(&state.moved(step, direction), number);
                (at(ALONG) - at(-ALONG)) / (2.0 * ALONG)
            }
        }
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
    let active = constraints.filter(|(_, (_, active))| **active);
    let ways = active
        .map(|(constraint, (&index, _))| (constraint, (state.z[index] / direction[index]).abs()));
    ways.filter(|(_, way)| way.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The way over which nothing changes by more than itself, at most the whole path.
fn reach<S: System>(system: &S, state: &State<S::Mode>, direction: &[f64]) -> f64 {
    fastest(system, state, direction).map_or(1.0, |(_, way)| way.clamp(SHORTEST, 1.0))
}

/// `−J⁻¹ d(J v)/dq` between two states of neighbouring systems.
fn turning<S: System>(
    newton: &mut Newton,
    sides: [&S; 2],
    states: &[State<S::Mode>; 2],
    direction: &[f64],
    step: f64,
) -> Vec<f64> {
    let product = |side: usize| {
        let mut product = Product { by: direction, rows: vec![0.0; direction.len()] };
        sides[side].tangent(&states[side], &mut product);
        product.rows
    };
    let change = difference(product(0), product(1), step);
    rates(newton, sides[0], &states[0], change)
}

/// The inactive constraints that a small motion from a place may violate.
fn near<S: System>(system: &S, place: &AnchoredPoint<S::Mode>) -> Vec<usize> {
    let guards = Newton::guards(system, &place.state).into_iter().enumerate();
    let inactive = guards.filter(|&(c, guard)| !place.state.active[c] && guard <= NEAR);
    inactive.map(|(constraint, _)| constraint).collect()
}

/// Solves for minus a change of the equations, which the section and the constraints at rest do not take part in.
fn rates<S: System>(
    newton: &mut Newton,
    system: &S,
    state: &State<S::Mode>,
    change: Vec<f64>,
) -> Vec<f64> {
    let mut x: Vec<f64> = change.into_iter().map(|change| -change).collect();
    x[system.load()] = 0.0;
    for index in inactive(system, state) {
        x[index] = 0.0;
    }
    newton.solve_again(&mut x);
    x
}

/// The derivative of what has these values below and above.
fn difference(below: Vec<f64>, mut above: Vec<f64>, step: f64) -> Vec<f64> {
    for (above, below) in above.iter_mut().zip(below) {
        *above = (*above - below) / (2.0 * step);
    }
    above
}

fn moved(from: &[f64], step: f64, rates: &[f64]) -> Vec<f64> {
    from.iter().zip(rates).map(|(from, rate)| from + step * rate).collect()
}

/// The condition of the arc length in the controls.
fn section<S: System>(system: &S, direction: &[f64]) -> Vec<(usize, f64)> {
    let controls = system.controls().iter();
    let square: f64 = controls.clone().map(|c| (direction[c.index] / c.scale).powi(2)).sum();
    let length = square.sqrt();
    controls.map(|c| (c.index, direction[c.index] / (c.scale.powi(2) * length))).collect()
}

/// A tangent that is multiplied by a vector as it is evaluated.
struct Product<'a> {
    by: &'a [f64],
    rows: Vec<f64>,
}

impl Tangent for Product<'_> {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row] += value * self.by[column];
    }

    fn clear_row(&mut self, row: usize) {
        self.rows[row] = 0.0;
    }
}
