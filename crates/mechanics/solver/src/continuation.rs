//! The equilibrium path: an iterator over its points.

mod direction;

use std::sync::Arc;

use self::direction::{HIDDEN, SHORT};
use crate::event::Event;
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure};
use crate::progress;
use crate::settings::Settings;
use crate::system::{Control, State, System};
use crate::termination::Termination;

/// The control parameter prescribes the next point while it makes up at least this part of the
/// direction of the path; where it makes up less, because it is about to turn, the arc length does: a step of the control
/// parameter would there be more than twenty times as long along the path.
const DRIVES: f64 = 0.05;

/// So many steps, each a third of the one before, tell that a change is undone at any distance: a step that was too long is short enough
/// before.
const UNDONE: usize = 5;

/// An equilibrium of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium<M = ()> {
    /// The equilibrium. Where a constraint changes sides, active set and mode are those with which the path goes on.
    pub state: State<M>,
    /// Direction in which the path arrives, of unit length in the controls.
    pub arriving: Vec<f64>,
    /// Direction in which the path goes on; another one than that of arrival where a constraint changes sides.
    pub leaving: Vec<f64>,
    /// The event at this point, if there is one.
    pub event: Option<Event>,
}

/// The path of equilibria of a system, from a first one until the control parameter reaches its
/// target, one scale, or a load that only pushes comes back to zero.
///
/// Between events the active set is held and the equations are smooth: a predictor along the
/// tangent, then Newton's method for the point at a given distance,
///
/// ```text
/// r(z) = 0,    c·(z − z₀) = s,    z ≈ z₀ + s ż₀/(c·ż₀)                                (N4)
/// ```
///
/// where `c` measures the control parameter alone, or the arc length in the controls where the control parameter is
/// about to turn (Keller 1977; Rheinboldt 1986, isbn 978-0-471-86282-6; Allgower & Georg 2003, doi
/// 10.1137/1.9780898719154). Where a constraint would change sides within the step, the event itself is
/// solved for, the constraint changes sides there, and the path goes on in the direction in which the
/// constraint stays valid. So no step straddles a kink, and a turning path (in the control parameter, in the load, or
/// at an event) is followed round.
///
/// A step must not lead to another branch of equilibria. Along a path, and across events, the determinant
///
/// ```text
/// det [∂r/∂z; c]    over equations and unknowns that are active,    c·ż > 0                     (N7)
/// ```
///
/// keeps its sign (Allgower & Georg 2003, section 2.1), so a step that ends with another one has gone astray, and no path comes
/// back to where it began by the way that it went.
///
/// The iterator ends where the path does; [`Continuation::stop`] then tells why.
#[derive(Clone, Debug)]
pub struct Continuation<S: System> {
    pub(crate) system: S,
    pub(crate) settings: Settings,
    pub(crate) newton: Newton,
    pub(crate) point: Arc<Equilibrium<S::Mode>>,
    /// The guards (N5) at `point`, with its active set, and how fast they change as the path leaves.
    pub(crate) guards: Vec<f64>,
    pub(crate) slopes: Vec<f64>,
    /// [`System::coordinates`].
    coordinates: Vec<usize>,
    /// The orientation ([`Newton::is_positive`]) with which the path leaves `point`.
    pub(crate) is_positive: bool,
    /// Whether no event had another way on among those that were looked at.
    pub(crate) is_unique: bool,
    /// How often an event of constraints that rub has turned the path round since it was farthest.
    pub(crate) reversals: usize,
    /// How often a step from `point` has undone what had just changed there at no rate: sliding that stopped as its rate vanished.
    pub(crate) undone: usize,
    /// The largest value of the control parameter so far.
    farthest: f64,
    /// The sign of a load that only pushes: the path ends where it comes back to zero.
    pub(crate) pushes: Option<f64>,
    /// Whether the path has been turned back, away from its target.
    pub(crate) is_back: bool,
    step: f64,
    points: usize,
    pub(crate) termination: Option<Termination>,
}

/// A candidate for the next point.
pub(crate) struct Candidate<M> {
    pub(crate) state: State<M>,
    pub(crate) direction: Vec<f64>,
    pub(crate) event: Option<Event>,
    /// The orientation with which the path arrives.
    pub(crate) is_positive: bool,
}

impl<S: System> Continuation<S> {
    /// A path from the equilibrium `start` in the direction in which the control parameter grows.
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
            pushes: None,
            is_back: false,
            step: settings.first_step.min(settings.max_step),
            points: 0,
            termination: None,
        };
        path.pushes = path.system.load_only_pushes().then_some(1.0);
        path.start(point);
        path
    }

    /// The point that the path has reached.
    pub fn point(&self) -> &Equilibrium<S::Mode> {
        &self.point
    }

    /// The point that the path has reached, shared.
    pub fn point_shared(&self) -> Arc<Equilibrium<S::Mode>> {
        Arc::clone(&self.point)
    }

    /// Goes on from `point` with another `system`: one that has more unknowns, say. The path goes on in the direction in which
    /// it left `point`, whose state need be an equilibrium of the system to first order only. Returns the system that was left.
    pub fn go_on(&mut self, system: S, mut point: Equilibrium<S::Mode>) -> S {
        // Kept apart: the iterations by which the path goes over to another system belong to no step.
        let history = std::mem::take(&mut self.newton.history);
        self.newton = Newton::new(&system);
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
        self.stand(point);
        left
    }

    /// Why the path ended; `None` while it has not.
    pub fn termination(&self) -> Option<Termination> {
        self.termination
    }

    /// Whether no event of the path had another way on, among those that were looked at.
    pub fn is_unique(&self) -> bool {
        self.is_unique
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Takes the residual norms of the Newton iterations since the last call.
    pub fn take_history(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.newton.history)
    }

    /// The equilibrium at a fraction of the way between two neighbouring points, with the active set
    /// and the mode between them. `None` where Newton's method does not get there.
    pub fn between(
        &mut self,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
        fraction: f64,
    ) -> Option<Equilibrium<S::Mode>> {
        self.between_from(from, to, fraction, from)
    }

    /// How far the path goes between two neighbouring points, in units of the direction in which it leaves the one and of that
    /// in which it arrives at the other: a direction times its factor is the rate of change with the fraction of [`Continuation::between`].
    pub fn spans(&self, from: &Equilibrium<S::Mode>, to: &Equilibrium<S::Mode>) -> [f64; 2] {
        [&from.leaving, &to.arriving].map(|direction| self.rate_in(from, to, direction))
    }

    /// The rate of change with the fraction of [`Continuation::between`], in units of a direction of the path.
    pub(crate) fn rate_in(
        &self,
        from: &Equilibrium<S::Mode>,
        to: &Equilibrium<S::Mode>,
        direction: &[f64],
    ) -> f64 {
        let condition = self.condition(from);
        (condition.measure(&to.state.z) - condition.value) / condition.measure(direction)
    }

    /// The equilibrium of [`Continuation::between`], reached from `near`, a point between the two.
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
        self.solved(Self::towards(near, &condition), &condition)
    }

    /// The equilibrium near `state`, with its active set and mode, at which a condition holds. `None` where Newton's method does not
    /// get there.
    pub fn solved(
        &mut self,
        state: State<S::Mode>,
        condition: &Condition,
    ) -> Option<Equilibrium<S::Mode>> {
        let iterations = self.newton.history.len();
        let found = self.correct(state, condition);
        // What is looked at between points belongs to no step, and the record of iterations is one of steps.
        self.newton.history.truncate(iterations);
        let Candidate { state, direction, .. } = found.ok()?;
        let (arriving, leaving) = (direction.clone(), direction);
        Some(Equilibrium { state, arriving, leaving, event: None })
    }

    fn start(&mut self, mut point: Equilibrium<S::Mode>) {
        let control = self.control_parameter();
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], 0.0);
        match self.newton.tangent(&self.system, &point.state, &condition) {
            Ok(direction) => {
                self.is_positive = self.newton.is_positive(&condition, &direction);
                point.leaving = self.normalised(direction);
                point.arriving.clone_from(&point.leaving);
            }
            Err(failure) => self.termination = Some(Termination::from(failure)),
        }
        self.stand(point);
    }

    /// Begins at a point anew.
    pub(crate) fn begin(&mut self, point: Equilibrium<S::Mode>) {
        self.step = self.settings.first_step.min(self.settings.max_step);
        self.points = 0;
        self.stand(point);
    }

    /// Makes `point` the one that the path has reached.
    fn stand(&mut self, point: Equilibrium<S::Mode>) {
        let (Self { system, guards, slopes, .. }, Equilibrium { state, leaving, .. }) =
            (&mut *self, &point);
        Newton::guard_slopes(system, state, leaving, guards, slopes);
        self.undone = 0;
        self.point = Arc::new(point);
    }

    fn control_parameter(&self) -> Control {
        self.system.controls()[0]
    }

    /// The control parameter over its scale: 1 at the target.
    pub(crate) fn progress(&self, z: &[f64]) -> f64 {
        z[self.control_parameter().index] / self.control_parameter().scale
    }

    /// The measure of distance from `point`, which increases along the path.
    pub(crate) fn condition(&self, point: &Equilibrium<S::Mode>) -> Condition {
        let control = self.control_parameter();
        let drive = self.progress(&point.leaving);
        let is_hidden = self.is_hidden(&point.leaving);
        // Next to where a contact gives way all controls may turn back together, within the shortest steps: in all coordinates the path goes
        // straight on there.
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
        // A path that is hidden has this length.
        let unit = if is_hidden { HIDDEN.powi(2) } else { length };
        let arc = all.map(|&index| (index, point.leaving[index] / unit)).collect();
        Condition { stand_in: Some(row), ..Condition::through(arc, &point.state.z) }
    }

    /// The equilibrium at a distance from a point, with the active set with which it is left.
    pub(crate) fn trial(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let mut condition = self.condition(from);
        condition.value += distance;
        let candidate = self.correct(Self::towards(from, &condition), &condition)?;
        if self.turns_sharply(from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(candidate)
    }

    /// The state that satisfies `condition` in the direction in which the path leaves `near`.
    fn towards(near: &Equilibrium<S::Mode>, condition: &Condition) -> State<S::Mode> {
        let distance = condition.value - condition.measure(&near.state.z);
        let factor = distance / condition.measure(&near.leaving);
        near.state.moved(factor, &near.leaving)
    }

    pub(crate) fn correct(
        &mut self,
        mut state: State<S::Mode>,
        condition: &Condition,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let direction = self.newton.solve(&self.system, &mut state, condition, &self.settings)?;
        let is_positive = self.newton.is_positive(condition, &direction);
        Ok(Candidate { state, direction: self.normalised(direction), event: None, is_positive })
    }

    /// The next point of the path, or why there is none.
    fn advance(&mut self) -> Result<Equilibrium<S::Mode>, Termination> {
        loop {
            progress::report_if_due(self.points, self.progress(&self.point.state.z));
            let distance = self.distance();
            let before = self.newton.history.len();
            let attempt = self.attempt(distance);
            let iterations = self.newton.history.len() - before;
            let is_smooth = attempt.as_ref().is_ok_and(|candidate| candidate.event.is_none());
            // An event from which no direction leads on is come to as near as steps may be short: whoever asks why the path ends
            // there sees the state in which it does.
            match attempt.map_err(Termination::from).and_then(|candidate| self.accept(candidate)) {
                Ok(point) => {
                    self.adapt(iterations, is_smooth);
                    return Ok(point);
                }
                // Nothing has moved: the path still stands at its point, and tries again from there.
                Err(stop) => self.shorten(distance, stop)?,
            }
        }
    }

    /// The next distance: the step, but not past the target.
    fn distance(&self) -> f64 {
        let drive = self.progress(&self.point.leaving);
        let left = self.system.target() - self.progress(&self.point.state.z);
        // Where the path runs away from its target, or the arc length measures the step, there is nothing to stop at.
        if drive >= DRIVES { self.step.min(left) } else { self.step }
    }

    fn shorten(&mut self, distance: f64, stop: Termination) -> Result<(), Termination> {
        // A third of what was tried, which the target may have made shorter than the step.
        self.step = distance / 3.0;
        if self.step >= self.settings.min_step {
            return Ok(());
        }
        // Sliding that has come to a stop may neither go on nor stick: to second order, which is what is left where its rate vanishes,
        // both are wrong. Then no equilibrium is near that would lead on.
        Err(if self.undone >= UNDONE { Termination::Jumps } else { stop })
    }

    fn adapt(&mut self, iterations: usize, smooth: bool) {
        if smooth && iterations <= 5 {
            // Newton's method doubles its digits with each iteration: five are what a start needs that was two digits
            // good. Of a step that an event cut short, neither length nor iterations tell how far the next one may go.
            self.step = (self.step * 1.7).min(self.settings.max_step);
        }
    }

    /// A step that ends at the event that is predicted within the given distance. Where none is, or the prediction fails, a
    /// step of this distance, cut short at the first event within it.
    fn attempt(&mut self, distance: f64) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let from = Arc::clone(&self.point);
        // Aiming at the event saves the equilibrium beyond it and the search between.
        let mut candidate = match self.predicted_event(&from, distance) {
            Some(candidate) if !self.strays(&from, &candidate) => candidate,
            _ => self.plain_step(&from, distance)?,
        };
        candidate = self.up_to_turn(&from, candidate)?;
        if self.lets_go(&candidate) {
            candidate.event = Some(Event::Unloaded);
        } else if self.pulls(&candidate) {
            candidate = self.unloaded(&from, &candidate)?;
        }
        // Asked once more, since turns and unloading have moved the end of the step.
        if self.strays(&from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(candidate)
    }

    /// A step of the given distance, cut short at the first event within it.
    fn plain_step(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let mut candidate = self.trial(from, distance)?;
        if self.progress(&candidate.state.z) > self.system.target() {
            candidate = self.target(from, &candidate)?;
        }
        self.first_event(from, candidate)
    }

    /// The point between two where the control parameter is at its target.
    fn target(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let (start, end) = (self.progress(&from.state.z), self.progress(&beyond.state.z));
        // The control parameter itself, even if the step was measured by the arc length: the target is met to the last
        // bit.
        let (target, control) = (self.system.target(), self.control_parameter());
        let state = from.state.interpolated(&beyond.state, (target - start) / (end - start));
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], target);
        self.correct(state, &condition)
    }

    fn accept(
        &mut self,
        candidate: Candidate<S::Mode>,
    ) -> Result<Equilibrium<S::Mode>, Termination> {
        let Candidate { mut state, direction: arriving, mut event, .. } = candidate;
        if let Some(Event::Changed(changes)) = &event
            // What ends the path is not let go or closed: there is no direction in which it would go on.
            && changes.iter().any(|change| self.system.ends(&state, change.constraint))
        {
            event = Some(Event::Target);
        }
        let leaving = match &mut event {
            Some(Event::Changed(changes)) => {
                let is_positive = self.is_positive;
                let resolved = self.resolve_event(&mut state, &arriving, changes);
                // The step is tried again from where the path stands, with the orientation that it has there.
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
        !self.is_back && (self.progress(&state.z) - self.system.target()).abs() <= FLOOR
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
        // Counted before the step, so that a path that finds event upon event in one place ends, too.
        self.points += 1;
        match self.advance() {
            Ok(point) => {
                let progress = self.progress(&point.state.z);
                if progress > self.farthest + FLOOR {
                    (self.farthest, self.reversals) = (progress, 0);
                }
                if point.event == Some(Event::Target) || self.at_target(&point.state) {
                    // On its way back a path that rises to its target again has turned round.
                    self.termination =
                        Some(if self.is_back { Termination::Jumps } else { Termination::Reached });
                } else if point.event == Some(Event::Unloaded) {
                    // Back at rest, or next to it: nobody took the load away, it fell because the path could not go on where it turned.
                    let is_at_rest = progress < 0.01 * self.system.target();
                    let has_turned = self.reversals > 0 && is_at_rest && !self.is_back;
                    self.termination =
                        Some(if has_turned { Termination::Jumps } else { Termination::Unloaded });
                }
                self.stand(point.clone());
                Some(point)
            }
            Err(stop) => {
                self.termination = Some(stop);
                None
            }
        }
    }
}
