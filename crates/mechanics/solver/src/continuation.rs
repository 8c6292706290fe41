//! Path following: [`Continuation`], an iterator over the equilibria of a path.

mod budget;
mod direction;
mod returns;
mod steps;

use std::sync::Arc;

use self::budget::Budget;
use self::direction::{HIDDEN, SHORT};
use self::returns::Returns;
use crate::event::Event;
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure};
use crate::settings::Settings;
use crate::system::{Control, State, System};
use crate::termination::Termination;

/// Smallest rate of the control parameter for steps that prescribe its increment.
///
/// The rate is per unit of arc length. At a lower rate the control parameter is about to reverse,
/// and steps prescribe the arc length instead: otherwise a step would be more than twenty times as
/// long along the path as in the control parameter.
const DRIVES: f64 = 0.05;

/// Equilibrium of a path, with the incoming and outgoing direction of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium<M = ()> {
    /// State at the equilibrium. At an event it has the outgoing active set and mode.
    pub state: State<M>,
    /// Incoming direction `ż` of the path, with unit length in the controls.
    pub arriving: Vec<f64>,
    /// Outgoing direction `ż` of the path, with unit length in the controls.
    ///
    /// Differs from `arriving` if a constraint becomes active or inactive at this point.
    pub leaving: Vec<f64>,
    /// Event at this point, if any.
    pub event: Option<Event>,
}

/// Path of equilibria of a system.
///
/// The path starts at a given equilibrium. It ends where the magnitude of the control parameter
/// reaches its target, where a constraint ends the path, or where a load that can only push returns
/// to zero.
///
/// Between events the active set is fixed and the equations are smooth. A predictor along the
/// direction `ż₀` of the path is followed by Newton's method for the point at the distance `s`,
///
/// ```text
/// r(z) = 0,    c·(z − z₀) = s,    z ≈ z₀ + s ż₀/(c·ż₀)                                (N4)
/// ```
///
/// The vector `c` measures the control parameter, or the arc length in the controls if the control
/// parameter is about to reverse (Keller 1977; Rheinboldt 1986, isbn 978-0-471-86282-6; Allgower &
/// Georg 2003, doi 10.1137/1.9780898719154). If a constraint becomes active or inactive within the
/// step, the solver locates this event, changes the constraint there, and continues in the
/// direction that satisfies the changed constraint. No step crosses a kink, and the path is
/// followed through reversals of the control parameter and of the load.
///
/// A step must not lead to another branch of equilibria. Along a path, and across events, the
/// determinant
///
/// ```text
/// det [∂r/∂z; c],    equations and unknowns of active constraints,    c·ż > 0         (N7)
/// ```
///
/// keeps its sign, the *orientation* of the path (Allgower & Georg 2003, section 2.1). A step that
/// ends with the other sign has reached another branch, or returns along the incoming path, and is
/// rejected.
///
/// The iterator ends with the path; [`Continuation::termination`] returns the reason.
#[derive(Clone, Debug)]
pub struct Continuation<S: System> {
    pub(crate) system: S,
    pub(crate) settings: Settings,
    pub(crate) newton: Newton,
    /// Current point of the path.
    pub(crate) point: Arc<Equilibrium<S::Mode>>,
    /// Guard (N5) of each constraint at `point`.
    pub(crate) guards: Vec<f64>,
    /// Derivative of each guard along the outgoing direction at `point`.
    pub(crate) slopes: Vec<f64>,
    /// Cached [`System::coordinates`].
    coordinates: Vec<usize>,
    /// Orientation ([`Newton::is_positive`]) of the outgoing path at `point`.
    pub(crate) is_positive: bool,
    /// False if a second outgoing branch was found at any event.
    pub(crate) is_unique: bool,
    /// Number of reversals at friction events since the last maximum of the control parameter.
    pub(crate) reversals: usize,
    /// Number of failed steps from `point` that would undo a change made at zero rate.
    ///
    /// An example is slip that ended when its rate reached zero.
    pub(crate) undone: usize,
    /// Largest magnitude of the control parameter so far.
    ///
    /// After [`Continuation::turn_back`], the smallest magnitude so far with a negative sign.
    farthest: f64,
    /// Events since the control parameter was at `farthest`.
    returns: Returns,
    /// Limit on the work of the path.
    budget: Budget,
    /// Sign of a load that must not reverse, or `None` if the load may have any sign.
    ///
    /// The path ends where such a load returns to zero.
    pub(crate) pushes: Option<f64>,
    /// True after [`Continuation::turn_back`]: the path leads away from its target.
    pub(crate) is_back: bool,
    /// Length of the next step, as a fraction of the path.
    step: f64,
    /// Number of points so far.
    points: usize,
    /// Reason for the end of the path, `None` while it continues.
    pub(crate) termination: Option<Termination>,
}

/// Candidate for the next point of the path.
pub(crate) struct Candidate<M> {
    /// State, with the active set and mode before any event at this point.
    pub(crate) state: State<M>,
    /// Incoming direction of the path.
    pub(crate) direction: Vec<f64>,
    /// Event at this point, if any.
    pub(crate) event: Option<Event>,
    /// Orientation (N7) of the incoming path.
    pub(crate) is_positive: bool,
}

impl<M> From<Candidate<M>> for Equilibrium<M> {
    fn from(Candidate { state, direction, .. }: Candidate<M>) -> Self {
        let (arriving, leaving) = (direction.clone(), direction);
        Self { state, arriving, leaving, event: None }
    }
}

impl<S: System> Continuation<S> {
    /// Creates a path from the equilibrium `start`.
    ///
    /// The path starts in the direction in which the control parameter increases, or in the
    /// opposite direction if a load that can only push would have to pull.
    pub fn new(system: S, start: State<S::Mode>, settings: Settings) -> Self {
        let nowhere = vec![0.0; system.size()];
        let point =
            Equilibrium { state: start, arriving: nowhere.clone(), leaving: nowhere, event: None };
        let mut path = Self {
            newton: Newton::new(&system),
            coordinates: system.coordinates(),
            is_positive: true,
            system,
            settings,
            point: Arc::new(point.clone()),
            guards: Vec::new(),
            slopes: Vec::new(),
            is_unique: true,
            reversals: 0,
            undone: 0,
            farthest: 0.0,
            returns: Returns::default(),
            budget: Budget::default(),
            pushes: None,
            is_back: false,
            step: settings.first_step.min(settings.max_step),
            points: 0,
            termination: None,
        };
        path.pushes = path.system.load_only_pushes().then_some(1.0);
        path.set_start(point);
        if path.ends_at_start() {
            path.termination = Some(Termination::Reached);
        }
        path
    }

    /// Returns the current point of the path.
    pub fn point(&self) -> &Equilibrium<S::Mode> {
        &self.point
    }

    /// Returns the current point of the path as a shared pointer.
    pub fn point_shared(&self) -> Arc<Equilibrium<S::Mode>> {
        Arc::clone(&self.point)
    }

    /// Continues the path from `point` with another system, for example with more unknowns.
    ///
    /// The path keeps the outgoing direction of `point`. It is sufficient if `point` is an
    /// approximate equilibrium of the new system. Returns the previous system.
    pub fn continue_with(&mut self, system: S, mut point: Equilibrium<S::Mode>) -> S {
        // The history covers only the iterations of steps, not the iterations of this transfer.
        let history = std::mem::take(&mut self.newton.history);
        let work = self.newton.work;
        self.newton = Newton::new(&system);
        self.newton.work = work;
        self.coordinates = system.coordinates();
        let previous = std::mem::replace(&mut self.system, system);
        self.termination = None;
        let condition = self.condition(&point);
        match self.newton.solve(&self.system, &mut point.state, &condition, &self.settings) {
            Ok(direction) => {
                self.is_positive = self.newton.is_positive(&condition, &direction);
                point.leaving = self.normalised(direction);
            }
            Err(failure) => self.termination = Some(Termination::from(failure)),
        }
        self.newton.history = history;
        self.set_point(point);
        previous
    }

    /// Returns the work so far, in units of [`Settings::max_work`].
    pub fn work(&self) -> u64 {
        self.newton.work.unknowns / self.settings.refinement()
    }

    /// Returns the reason why the path ended, or `None` while it continues.
    pub fn termination(&self) -> Option<Termination> {
        self.termination
    }

    /// Returns false if a second outgoing branch was found at any event.
    pub fn is_unique(&self) -> bool {
        self.is_unique
    }

    /// Returns the system of equations of the path.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Returns the residual norms of all Newton iterations since the last call, and clears them.
    pub fn take_history(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.newton.history)
    }

    /// Solves for the equilibrium at a fraction of the segment between two successive points.
    ///
    /// The active set and mode are the outgoing ones of `from`. `None` if Newton's method fails.
    pub fn between(
        &mut self,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
        fraction: f64,
    ) -> Option<Equilibrium<S::Mode>> {
        self.between_from(from, to, fraction, from)
    }

    /// Returns the length of a segment in units of the path directions at its two ends.
    ///
    /// The segment lies between two successive points. The first length is in units of the outgoing
    /// direction of `from`, the second in units of the incoming direction of `to`. A direction
    /// times its length is the derivative of the unknowns with respect to `fraction` in
    /// [`Continuation::between`].
    pub fn spans(&self, from: &Equilibrium<S::Mode>, to: &Equilibrium<S::Mode>) -> [f64; 2] {
        [&from.leaving, &to.arriving].map(|direction| self.rate_in(from, to, direction))
    }

    /// Returns the length of a segment in units of `direction`.
    ///
    /// The direction times this length is the derivative of the unknowns with respect to `fraction`
    /// in [`Continuation::between`].
    pub(crate) fn rate_in(
        &self,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
        direction: &[f64],
    ) -> f64 {
        let condition = self.condition(from);
        (condition.measure(&to.state.z) - condition.value) / condition.measure(direction)
    }

    /// Solves for the same equilibrium as [`Continuation::between`], starting from `near`.
    ///
    /// `near` is a point of the segment close to the solution.
    pub fn between_from(
        &mut self,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
        fraction: f64,
        near: &Equilibrium<S::Mode>,
    ) -> Option<Equilibrium<S::Mode>> {
        let mut condition = self.condition(from);
        let distance = fraction * (condition.measure(&to.state.z) - condition.value);
        condition.value += distance;
        self.solved(Self::extrapolate(near, &condition), &condition)
    }

    /// Solves for the equilibrium near `state` that satisfies `condition`.
    ///
    /// The active set and mode of `state` are kept. `None` if Newton's method fails.
    pub fn solved(
        &mut self,
        state: State<S::Mode>,
        condition: &Condition,
    ) -> Option<Equilibrium<S::Mode>> {
        self.corrected(state, condition).map(Equilibrium::from)
    }

    /// Solves for an equilibrium ahead of the current point, and checks it.
    ///
    /// Works like [`Continuation::solved`] with another tolerance. `None` also if the equilibrium
    /// violates a constraint, or if it lies on a branch with another orientation (N7) than the
    /// current point.
    pub fn solved_ahead(
        &mut self,
        state: State<S::Mode>,
        condition: &Condition,
        tolerance: f64,
    ) -> Option<Equilibrium<S::Mode>> {
        let own = std::mem::replace(&mut self.settings.tolerance, tolerance);
        let candidate = self.corrected(state, condition);
        self.settings.tolerance = own;
        let candidate = candidate?;
        let guards = Newton::guards(&self.system, &candidate.state);
        let is_valid = guards.iter().all(|guard| *guard >= -FLOOR);
        let is_same_branch = candidate.is_positive == self.is_positive;
        (is_valid && is_same_branch).then(|| candidate.into())
    }

    /// Steps to the event at which a constraint changes, starting Newton's method from `near`.
    ///
    /// The step may have any length, so the caller must know that no event lies between the current
    /// point and this event. `None` if the event is not found ahead of the current point, or if it
    /// has no outgoing branch; the current point then stays the same.
    pub fn step_to_event(
        &mut self,
        near: State<S::Mode>,
        constraint: usize,
    ) -> Option<Equilibrium<S::Mode>> {
        let candidate = self.known_event(near, constraint)?;
        let point = self.accept(candidate).ok()?;
        self.points += 1;
        self.farthest = self.progress(&point.state.z).abs();
        self.set_point(point.clone());
        Some(point)
    }

    /// Corrects a state that is not a step of the path; `None` if Newton's method fails.
    fn corrected(
        &mut self,
        state: State<S::Mode>,
        condition: &Condition,
    ) -> Option<Candidate<S::Mode>> {
        let iterations = self.newton.history.len();
        let corrected = self.correct(state, condition);
        // The history covers only the iterations of steps, not evaluations between points.
        self.newton.history.truncate(iterations);
        corrected.ok()
    }

    /// Makes `point` the first point and computes the direction of the path there.
    fn set_start(&mut self, mut point: Equilibrium<S::Mode>) {
        let control = self.control_parameter();
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], 0.0);
        match self.newton.tangent(&self.system, &point.state, &condition) {
            Ok(mut direction) => {
                if self.pushes.is_some_and(|sign| sign * direction[self.system.load()] < 0.0) {
                    for rate in &mut direction {
                        *rate = -*rate;
                    }
                }
                self.is_positive = self.newton.is_positive(&condition, &direction);
                point.leaving = self.normalised(direction);
                point.arriving.clone_from(&point.leaving);
            }
            Err(failure) => self.termination = Some(Termination::from(failure)),
        }
        self.set_point(point);
    }

    /// Returns true if the guard of a constraint that ends the path is zero at the start.
    fn ends_at_start(&self) -> bool {
        let guards = self.guards.iter().enumerate();
        let mut vanishing = guards.filter(|(_, guard)| **guard <= FLOOR);
        vanishing.any(|(constraint, _)| self.system.ends(&self.point.state, constraint))
    }

    /// Continues the path at `point` with the initial step size and with all counts at zero.
    pub(crate) fn restart_at(&mut self, point: Equilibrium<S::Mode>) {
        self.step = self.settings.first_step.min(self.settings.max_step);
        self.points = 0;
        self.farthest = f64::NEG_INFINITY;
        self.returns.clear();
        self.budget.restart(self.newton.work);
        self.set_point(point);
    }

    /// Makes `point` the current point, and evaluates the guards and their slopes there.
    fn set_point(&mut self, point: Equilibrium<S::Mode>) {
        let (Self { system, guards, slopes, .. }, Equilibrium { state, leaving, .. }) =
            (&mut *self, &point);
        Newton::guard_slopes(system, state, leaving, guards, slopes);
        self.undone = 0;
        self.point = Arc::new(point);
    }

    /// Returns the first control.
    fn control_parameter(&self) -> Control {
        self.system.controls()[0]
    }

    /// Returns the control parameter divided by its scale.
    ///
    /// With the default [`System::target`] this is 1 at the target.
    pub(crate) fn progress(&self, z: &[f64]) -> f64 {
        z[self.control_parameter().index] / self.control_parameter().scale
    }

    /// Returns the condition that measures the distance from `point` along the path.
    ///
    /// Its left-hand side increases along the path.
    pub(crate) fn condition(&self, point: &Equilibrium<S::Mode>) -> Condition {
        let control = self.control_parameter();
        let drive = self.progress(&point.leaving);
        let is_hidden = self.is_hidden(&point.leaving);
        // Close to the opening of a contact, all controls may reverse at once within the shortest
        // steps, while the path remains straight in all coordinates.
        let is_arc = is_hidden || self.step < SHORT;
        let row = if drive.abs() >= DRIVES && !is_hidden {
            vec![(control.index, drive.signum() / control.scale)]
        } else {
            let controls = self.system.controls();
            controls.iter().map(|c| (c.index, point.leaving[c.index] / c.scale.powi(2))).collect()
        };
        if !is_arc || self.coordinates.is_empty() {
            return Condition::through(row, &point.state.z);
        }
        let all = self.coordinates.iter();
        let length = all.clone().map(|&index| point.leaving[index].powi(2)).sum::<f64>();
        // Hidden directions are normalised to the length `HIDDEN` in all coordinates.
        let unit = if is_hidden { HIDDEN.powi(2) } else { length };
        let arc = all.map(|&index| (index, point.leaving[index] / unit)).collect();
        Condition { stand_in: Some(row), ..Condition::through(arc, &point.state.z) }
    }

    /// Solves for the equilibrium at a distance along the path from the point `from`.
    ///
    /// The active set and mode are the outgoing ones of `from`.
    pub(crate) fn step_to(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let mut condition = self.condition(from);
        condition.value += distance;
        let candidate = self.correct(Self::extrapolate(from, &condition), &condition)?;
        if self.turns_sharply(from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(candidate)
    }

    /// Extrapolates from `near` along its outgoing direction to a state that satisfies `condition`.
    fn extrapolate(near: &Equilibrium<S::Mode>, condition: &Condition) -> State<S::Mode> {
        let distance = condition.value - condition.measure(&near.state.z);
        let factor = distance / condition.measure(&near.leaving);
        near.state.moved(factor, &near.leaving)
    }

    /// Corrects a predicted state to the equilibrium that satisfies `condition`.
    pub(crate) fn correct(
        &mut self,
        mut state: State<S::Mode>,
        condition: &Condition,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let direction = self.newton.solve(&self.system, &mut state, condition, &self.settings)?;
        let is_positive = self.newton.is_positive(condition, &direction);
        Ok(Candidate { state, direction: self.normalised(direction), event: None, is_positive })
    }
}

impl<S: System> Iterator for Continuation<S> {
    type Item = Equilibrium<S::Mode>;

    fn next(&mut self) -> Option<Equilibrium<S::Mode>> {
        if self.termination.is_some() {
            return None;
        }
        if self.points >= self.settings.max_points {
            self.termination = Some(Termination::TooManyPoints);
            return None;
        }
        // Count before the step, so that `max_points` also limits events without progress.
        self.points += 1;
        match self.advance() {
            Ok(point) => {
                let progress = self.progress(&point.state.z).abs();
                let far = if self.is_back { -progress } else { progress };
                if far > self.farthest + FLOOR {
                    (self.farthest, self.reversals) = (far, 0);
                    self.returns.clear();
                }
                self.budget.advance(far, self.newton.work);
                if point.event == Some(Event::Target) || self.reaches_target(&point) {
                    // A path that is turned back and reaches its target again has reversed at an
                    // event instead of unloading.
                    self.termination =
                        Some(if self.is_back { Termination::Jumps } else { Termination::Reached });
                } else if point.event == Some(Event::Unloaded) {
                    // The load is zero near the state of rest after a reversal, so the path has
                    // returned to rest instead of continuing beyond the event.
                    let is_at_rest = progress < 0.01 * self.system.target();
                    let has_turned = self.reversals > 0 && is_at_rest && !self.is_back;
                    self.termination =
                        Some(if has_turned { Termination::Jumps } else { Termination::Unloaded });
                } else if point.event.is_some() {
                    let load = point.state.z[self.system.load()];
                    if self.returns.add([progress, load], self.guards.len()) {
                        self.termination = Some(Termination::NoProgress);
                    }
                }
                self.set_point(point.clone());
                Some(point)
            }
            Err(stop) => {
                self.termination = Some(stop);
                None
            }
        }
    }
}
