//! Path continuation: an iterator over the equilibria of a path.

mod budget;
mod direction;
mod returns;

use std::sync::Arc;

use self::budget::Budget;
use self::direction::{HIDDEN, SHORT};
use self::returns::Returns;
use crate::event::Event;
use crate::interruption::is_interrupted;
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure};
use crate::progress;
use crate::settings::Settings;
use crate::system::{Control, State, System};
use crate::termination::Termination;

/// Least rate of the control parameter at which it prescribes the step.
///
/// The rate is per unit of arc length. Below this rate the control parameter is about to turn and
/// the arc length prescribes the step: a step of the control parameter would be more than twenty
/// times as long along the path.
const DRIVES: f64 = 0.05;

/// Number of undone steps after which the path jumps.
///
/// Each is a third as long as the last. If the change at the current point is undone at every
/// length, shortening the step does not help. If the step was merely too long, fewer reductions
/// suffice.
const UNDONE: usize = 5;

/// Distances at which the path is resumed beyond a bifurcation point, the preferred one first.
///
/// Closer to the point Newton's method hardly separates the branches.
const BEYOND_BIFURCATION: [f64; 3] = [1e-4, 1e-5, 1e-6];

/// Equilibrium of a path, with its directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium<M = ()> {
    /// State at the equilibrium. At an event it has the outgoing active set and mode.
    pub state: State<M>,
    /// Incoming direction of the path, of unit length in the controls.
    pub arriving: Vec<f64>,
    /// Outgoing direction of the path.
    ///
    /// Differs from `arriving` where a constraint changes sides.
    pub leaving: Vec<f64>,
    /// Event at this point, if any.
    pub event: Option<Event>,
}

/// Path of equilibria of a system.
///
/// The path starts at a given equilibrium. It ends where the control parameter over its scale
/// reaches the target in either direction, where a constraint ends it, or where the load of a
/// system that only pushes returns to zero.
///
/// Between events the active set is fixed and the equations are smooth. A predictor along the
/// tangent is followed by Newton's method for the point at a given distance,
///
/// ```text
/// r(z) = 0,    c·(z − z₀) = s,    z ≈ z₀ + s ż₀/(c·ż₀)                                (N4)
/// ```
///
/// where `c` measures the control parameter alone, or the arc length in the controls where the
/// control parameter is about to turn (Keller 1977; Rheinboldt 1986, isbn 978-0-471-86282-6;
/// Allgower & Georg 2003, doi 10.1137/1.9780898719154). If a constraint would change sides within
/// the step, the solver locates the event, changes the constraint there, and continues in the
/// direction that satisfies the changed constraint. Hence no step crosses a kink, and the path is
/// followed around turning points of the control parameter, of the load and at events.
///
/// A step must not lead to another branch of equilibria. Along a path, and across events, the
/// determinant
///
/// ```text
/// det [∂r/∂z; c]    over equations and unknowns that are active,    c·ż > 0                     (N7)
/// ```
///
/// keeps its sign (Allgower & Georg 2003, section 2.1). A step that ends with the other sign has
/// reached another branch, or returns along the incoming path, and is rejected.
///
/// The iterator ends with the path; [`Continuation::termination`] gives the reason.
#[derive(Clone, Debug)]
pub struct Continuation<S: System> {
    pub(crate) system: S,
    pub(crate) settings: Settings,
    pub(crate) newton: Newton,
    pub(crate) point: Arc<Equilibrium<S::Mode>>,
    /// Guards (N5) at `point` with its active set, and their slopes.
    ///
    /// The slopes are along the outgoing direction.
    pub(crate) guards: Vec<f64>,
    pub(crate) slopes: Vec<f64>,
    /// Cached [`System::coordinates`].
    coordinates: Vec<usize>,
    /// Orientation ([`Newton::is_positive`]) of the outgoing path at `point`.
    pub(crate) is_positive: bool,
    /// False if some event had a second outgoing branch among those evaluated.
    pub(crate) is_unique: bool,
    /// Reversals at friction events since the control parameter peaked.
    pub(crate) reversals: usize,
    /// Number of steps from `point` that undid a change at zero rate.
    ///
    /// An example is slip that ended as its rate vanished.
    pub(crate) undone: usize,
    /// Largest magnitude of the control parameter so far.
    ///
    /// For a path that is turned back, the smallest one with the opposite sign.
    farthest: f64,
    /// Events since the control parameter was at `farthest`.
    returns: Returns,
    /// Limit on the work of the path.
    budget: Budget,
    /// Sign of a load that only pushes.
    ///
    /// The path ends where such a load returns to zero.
    pub(crate) pushes: Option<f64>,
    /// True after [`Continuation::turn_back`]: the path leads away from its target.
    pub(crate) is_back: bool,
    step: f64,
    points: usize,
    pub(crate) termination: Option<Termination>,
}

/// Candidate for the next point.
pub(crate) struct Candidate<M> {
    pub(crate) state: State<M>,
    pub(crate) direction: Vec<f64>,
    pub(crate) event: Option<Event>,
    /// Orientation of the incoming path.
    pub(crate) is_positive: bool,
}

impl<S: System> Continuation<S> {
    /// Creates a path from the equilibrium `start`.
    ///
    /// The control parameter increases at first, unless the load would then have to pull.
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

    /// Continues from `point` with another `system`, such as one with more unknowns.
    ///
    /// The path keeps the outgoing direction of `point`. The state of `point` need only be an
    /// equilibrium of the new system to first order. Returns the previous system.
    pub fn continue_with(&mut self, system: S, mut point: Equilibrium<S::Mode>) -> S {
        // The record of iterations covers steps only, so leave out the iterations of the transfer.
        let history = std::mem::take(&mut self.newton.history);
        let work = self.newton.work;
        self.newton = Newton::new(&system);
        self.newton.work = work;
        self.coordinates = system.coordinates();
        let left = std::mem::replace(&mut self.system, system);
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
        left
    }

    /// Returns the work so far, in the unit of [`Settings::max_work`].
    pub fn work(&self) -> u64 {
        self.newton.work.unknowns / self.settings.refinement()
    }

    /// Returns the reason why the path ended, or `None` while it continues.
    pub fn termination(&self) -> Option<Termination> {
        self.termination
    }

    /// Returns false if some event had a second outgoing branch among those evaluated.
    pub fn is_unique(&self) -> bool {
        self.is_unique
    }

    /// Returns the system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Takes the residual norms of the Newton iterations since the last call.
    pub fn take_history(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.newton.history)
    }

    /// Solves for the equilibrium at a fraction of the way between two points.
    ///
    /// The points are neighbours. Uses the active set and mode of the segment. `None` if Newton's
    /// method fails.
    pub fn between(
        &mut self,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
        fraction: f64,
    ) -> Option<Equilibrium<S::Mode>> {
        self.between_from(from, to, fraction, from)
    }

    /// Computes the length of a segment in units of the directions at its two ends.
    ///
    /// The ends are two neighbouring points; their directions are the outgoing one of `from` and
    /// the incoming one of `to`. A direction times its length is the derivative with respect to the
    /// fraction of [`Continuation::between`].
    pub fn spans(&self, from: &Equilibrium<S::Mode>, to: &Equilibrium<S::Mode>) -> [f64; 2] {
        [&from.leaving, &to.arriving].map(|direction| self.rate_in(from, to, direction))
    }

    /// Computes the length of a segment in units of `direction`.
    ///
    /// The direction times this length is the derivative with respect to the fraction of
    /// [`Continuation::between`].
    pub(crate) fn rate_in(
        &self,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
        direction: &[f64],
    ) -> f64 {
        let condition = self.condition(from);
        (condition.measure(&to.state.z) - condition.value) / condition.measure(direction)
    }

    /// Solves as [`Continuation::between`], starting from `near`.
    ///
    /// `near` is a point of the segment.
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

    /// Solves for the equilibrium near `state` that satisfies a condition.
    ///
    /// Keeps the active set and mode of `state`. `None` if Newton's method fails.
    pub fn solved(
        &mut self,
        state: State<S::Mode>,
        condition: &Condition,
    ) -> Option<Equilibrium<S::Mode>> {
        let iterations = self.newton.history.len();
        let corrected = self.correct(state, condition);
        // The record of iterations covers steps only, so leave out evaluations between points.
        self.newton.history.truncate(iterations);
        let Candidate { state, direction, .. } = corrected.ok()?;
        let (arriving, leaving) = (direction.clone(), direction);
        Some(Equilibrium { state, arriving, leaving, event: None })
    }

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

    /// Returns true if a constraint that ends the path vanishes at the start already.
    fn ends_at_start(&self) -> bool {
        let guards = self.guards.iter().enumerate();
        let mut vanishing = guards.filter(|(_, guard)| **guard <= FLOOR);
        vanishing.any(|(constraint, _)| self.system.ends(&self.point.state, constraint))
    }

    /// Restarts the path at a point.
    ///
    /// The step size is the first one and the point count zero.
    pub(crate) fn restart_at(&mut self, point: Equilibrium<S::Mode>) {
        self.step = self.settings.first_step.min(self.settings.max_step);
        self.points = 0;
        self.farthest = f64::NEG_INFINITY;
        self.returns.clear();
        self.budget.restart(self.newton.work);
        self.set_point(point);
    }

    /// Makes `point` the current point and evaluates its guards.
    fn set_point(&mut self, point: Equilibrium<S::Mode>) {
        let (Self { system, guards, slopes, .. }, Equilibrium { state, leaving, .. }) =
            (&mut *self, &point);
        Newton::guard_slopes(system, state, leaving, guards, slopes);
        self.undone = 0;
        self.point = Arc::new(point);
    }

    fn control_parameter(&self) -> Control {
        self.system.controls()[0]
    }

    /// Computes the control parameter over its scale.
    ///
    /// It is 1 at the target by default.
    pub(crate) fn progress(&self, z: &[f64]) -> f64 {
        z[self.control_parameter().index] / self.control_parameter().scale
    }

    /// Returns the measure of distance from `point`, which increases along the path.
    pub(crate) fn condition(&self, point: &Equilibrium<S::Mode>) -> Condition {
        let control = self.control_parameter();
        let drive = self.progress(&point.leaving);
        let is_hidden = self.is_hidden(&point.leaving);
        // Close to a contact that opens, all controls may reverse together within the shortest
        // steps, whereas the path of all coordinates stays straight.
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
        // Hidden directions are normalised to this length in all coordinates.
        let unit = if is_hidden { HIDDEN.powi(2) } else { length };
        let arc = all.map(|&index| (index, point.leaving[index] / unit)).collect();
        Condition { stand_in: Some(row), ..Condition::through(arc, &point.state.z) }
    }

    /// Solves for the equilibrium at a distance from a point.
    ///
    /// It has the outgoing active set of the point.
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

    /// Extrapolates along the outgoing direction of `near` to meet `condition`.
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

    /// Takes one step and returns the next point, or the reason why the path ends.
    fn advance(&mut self) -> Result<Equilibrium<S::Mode>, Termination> {
        loop {
            if is_interrupted() {
                return Err(Termination::Interrupted);
            }
            let max_work = self.settings.max_work.saturating_mul(self.settings.refinement());
            if self.budget.is_exceeded(self.newton.work, max_work) {
                return Err(Termination::TooMuchWork);
            }
            progress::report_if_due(self.points, self.progress(&self.point.state.z));
            let distance = self.distance();
            let before = self.newton.history.len();
            let attempt = self.attempt(distance);
            let iterations = self.newton.history.len() - before;
            let is_smooth = attempt.as_ref().is_ok_and(|candidate| candidate.event.is_none());
            // An event without an outgoing branch is approached until the step size reaches its
            // minimum, so that the last point shows the state in which the path ends.
            match attempt.map_err(Termination::from).and_then(|candidate| self.accept(candidate)) {
                Ok(point) => {
                    self.lengthen_step(iterations, is_smooth);
                    return Ok(point);
                }
                // A failed attempt leaves the current point unchanged, so try again with a shorter
                // step.
                Err(stop) => {
                    if let Err(stop) = self.shorten_step(distance, stop) {
                        let is_lost = stop == Termination::NoConvergence;
                        let resumed = is_lost.then(|| self.pass_bifurcation()).flatten();
                        return resumed.ok_or(stop);
                    }
                }
            }
        }
    }

    /// Returns the length of the next step, at most the distance to the target.
    fn distance(&self) -> f64 {
        let drive = self.progress(&self.point.leaving);
        let left = self.system.target() - drive.signum() * self.progress(&self.point.state.z);
        // The target limits the step only if the control parameter measures it.
        if drive.abs() >= DRIVES { self.step.min(left) } else { self.step }
    }

    fn shorten_step(&mut self, distance: f64, stop: Termination) -> Result<(), Termination> {
        // Shorten the attempted distance, because the target may have made it shorter than the step
        // size.
        self.step = distance / 3.0;
        if self.step >= self.settings.min_step {
            return Ok(());
        }
        // Slip that ends at zero rate has no equilibrium nearby if, to second order, neither slip
        // nor stick is valid.
        Err(if self.undone >= UNDONE { Termination::Jumps } else { stop })
    }

    /// Resumes the path beyond a bifurcation point just ahead.
    ///
    /// There the orientation (N7) may change on a smooth path, or an extremum of the load has no
    /// tangent, and every shorter step is rejected. The path follows its incoming branch. `None` if
    /// there is no such point, or if the path has no end because its control parameter is constant.
    fn pass_bifurcation(&mut self) -> Option<Equilibrium<S::Mode>> {
        let from = Arc::clone(&self.point);
        if self.progress(&from.leaving).abs() < DRIVES {
            return None;
        }
        for distance in BEYOND_BIFURCATION {
            self.step = distance;
            let Ok(candidate) = self.step_to(&from, distance) else { continue };
            let guards = Newton::guards(&self.system, &candidate.state);
            let is_beyond_event = self.first_violated(&guards).is_some()
                || self.load_reverses(&candidate)
                || self.progress(&candidate.state.z).abs() > self.system.target();
            let slips_back = self.system.monotone().iter().any(|&constraint| {
                let unknown = self.system.constraints()[constraint];
                candidate.state.active[constraint] && candidate.direction[unknown] < 0.0
            });
            let load = self.system.load();
            let is_special = candidate.is_positive != self.is_positive
                || from.leaving[load] * candidate.direction[load] < 0.0;
            let is_valid = !is_beyond_event && !slips_back && !self.bends(&from, &candidate);
            if is_special && is_valid {
                (self.is_positive, self.is_unique) = (candidate.is_positive, false);
                let Candidate { state, direction, .. } = candidate;
                let (arriving, leaving) = (direction.clone(), direction);
                return Some(Equilibrium { state, arriving, leaving, event: None });
            }
        }
        None
    }

    fn lengthen_step(&mut self, iterations: usize, smooth: bool) {
        if smooth && iterations <= 5 {
            // Newton's method doubles the correct digits in each iteration, so five iterations
            // suffice from a predictor with two digits. The length and iterations of a step cut
            // short by an event do not indicate the next step size.
            self.step = (self.step * 1.7).min(self.settings.max_step);
        }
    }

    /// Attempts a step that ends at the event predicted within the given distance.
    ///
    /// Without a predicted event, or if the prediction fails, attempts a step of the full distance
    /// and cuts it short at the first event within it.
    fn attempt(&mut self, distance: f64) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let from = Arc::clone(&self.point);
        // Aiming at the event saves the equilibrium beyond it and the bracketing search.
        let mut candidate = match self.predicted_event(&from, distance) {
            Some(candidate) if !self.strays(&from, &candidate) => candidate,
            _ => self.plain_step(&from, distance)?,
        };
        candidate = self.up_to_turn(&from, candidate)?;
        if self.load_vanishes(&candidate) {
            candidate.event = Some(Event::Unloaded);
        } else if self.load_reverses(&candidate) {
            candidate = self.locate_unloading(&from, &candidate)?;
        }
        // Check again, because the turning point and unloading have moved the end of the step.
        if self.strays(&from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(candidate)
    }

    /// Steps by the given distance, cut short at the first event within it.
    fn plain_step(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let mut candidate = self.step_to(from, distance)?;
        // A path that is turned back starts at its target, up to round-off.
        let round_off = if self.is_back { FLOOR } else { 0.0 };
        if self.progress(&candidate.state.z).abs() > self.system.target() + round_off {
            candidate = self.locate_target(from, &candidate)?;
            if self.is_back {
                candidate.event = Some(Event::Target);
            }
        }
        self.first_event(from, candidate)
    }

    /// Solves for the point between two points with the target control parameter.
    fn locate_target(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let (start, end) = (self.progress(&from.state.z), self.progress(&beyond.state.z));
        // Prescribe the control parameter even if the arc length measured the step, so that the
        // target is met to the last bit.
        let (target, control) = (end.signum() * self.system.target(), self.control_parameter());
        // A path continued with another system may start at its target up to round-off.
        let fraction = if end == start { 0.0 } else { (target - start) / (end - start) };
        let state = from.state.interpolated(&beyond.state, fraction);
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], target);
        self.correct(state, &condition)
    }

    fn accept(
        &mut self,
        candidate: Candidate<S::Mode>,
    ) -> Result<Equilibrium<S::Mode>, Termination> {
        let Candidate { mut state, direction: arriving, mut event, .. } = candidate;
        if let Some(Event::Changed(changes)) = &event
            // A constraint that ends the path does not change sides, because there is no outgoing
            // branch.
            && changes.iter().any(|change| self.system.ends(&state, change.constraint))
        {
            event = Some(Event::Target);
        }
        let leaving = match &mut event {
            Some(Event::Changed(changes)) => {
                let is_positive = self.is_positive;
                let resolved = self.resolve_event(&mut state, &arriving, changes);
                // The step is repeated from the current point, so restore its orientation.
                resolved.inspect_err(|_| self.is_positive = is_positive)?
            }
            _ => arriving.clone(),
        };
        if event.is_none() && self.at_target(&state) {
            event = Some(Event::Target);
        }
        Ok(Equilibrium { state, arriving, leaving, event })
    }

    fn at_target(&self, state: &State<S::Mode>) -> bool {
        !self.is_back && (self.progress(&state.z).abs() - self.system.target()).abs() <= FLOOR
    }

    /// Returns true if the path arrives at its target from within.
    ///
    /// A path that is turned back starts there and leads away from it.
    fn reaches_target(&self, point: &Equilibrium<S::Mode>) -> bool {
        let progress = self.progress(&point.state.z);
        let is_near = (progress.abs() - self.system.target()).abs() <= FLOOR;
        is_near && (!self.is_back || progress * self.progress(&point.arriving) > 0.0)
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
        // Count before the step, so that a path with endless events at one point terminates too.
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
                    // An unloading path that returns to the loading target has reversed at an event
                    // instead of unloading.
                    self.termination =
                        Some(if self.is_back { Termination::Jumps } else { Termination::Reached });
                } else if point.event == Some(Event::Unloaded) {
                    // The load vanished at or next to rest after a reversal. It was not removed:
                    // the path could not continue past the reversal.
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
