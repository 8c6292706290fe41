//! Steps of a path: choice of the length, attempt, and acceptance of a step.

use std::sync::Arc;

use super::{Candidate, Continuation, DRIVES, Equilibrium};
use crate::event::Event;
use crate::interruption::is_interrupted;
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure};
use crate::progress;
use crate::system::{State, System};
use crate::termination::Termination;

/// Number of failed steps, each undoing the last change, after which the path ends as `Jumps`.
///
/// Each step is a third of the previous step. If the first step was merely too long, a smaller
/// number of reductions suffices.
const UNDONE: usize = 5;

/// Step lengths for resuming the path beyond a bifurcation point, in the order of preference.
///
/// With shorter steps Newton's method hardly separates the branches.
const BEYOND_BIFURCATION: [f64; 3] = [1e-4, 1e-5, 1e-6];

impl<S: System> Continuation<S> {
    /// Takes one step and returns the next point, or the reason why the path ends.
    pub(super) fn advance(&mut self) -> Result<Equilibrium<S::Mode>, Termination> {
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
            // If an event has no outgoing branch, the path approaches the event until the step size
            // reaches its minimum, so that the last point shows the state in which the path ends.
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
        let remaining = self.system.target() - drive.signum() * self.progress(&self.point.state.z);
        // The target limits the step only if the control parameter changes along the path.
        if drive.abs() >= DRIVES { self.step.min(remaining) } else { self.step }
    }

    /// Reduces the step size after a failed attempt to step by `distance`.
    ///
    /// # Errors
    /// If the step size would fall below its minimum: the reason `stop` of the failure, or
    /// [`Termination::Jumps`].
    fn shorten_step(&mut self, distance: f64, stop: Termination) -> Result<(), Termination> {
        // The target may have limited the attempted distance, so reduce this distance instead of
        // the step size.
        self.step = distance / 3.0;
        if self.step >= self.settings.min_step {
            return Ok(());
        }
        // After slip has ended at zero rate, there may be no equilibrium nearby, because to second
        // order neither slip nor stick is valid.
        Err(if self.undone >= UNDONE { Termination::Jumps } else { stop })
    }

    /// Returns a point on the incoming branch beyond a bifurcation point just ahead.
    ///
    /// At a bifurcation point of a smooth path the orientation (N7) may change, or the tangent at
    /// an extremum of the load is singular, so that every shorter step is rejected. `None` if there
    /// is no such point ahead, or if the control parameter is nearly constant along the path, which
    /// then might never end.
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
                return Some(candidate.into());
            }
        }
        None
    }

    /// Increases the step size after a step without event (`smooth`) and with few iterations.
    fn lengthen_step(&mut self, iterations: usize, smooth: bool) {
        if smooth && iterations <= 5 {
            // Newton's method doubles the number of correct digits in each iteration, so five
            // iterations suffice from a predictor with two digits. A step to an event indicates
            // nothing about the next step size.
            self.step = (self.step * 1.7).min(self.settings.max_step);
        }
    }

    /// Attempts a step to the event that is predicted within the given distance.
    ///
    /// If no event is predicted or the prediction fails, attempts a step of the full distance and
    /// ends this step at the first event.
    fn attempt(&mut self, distance: f64) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let from = Arc::clone(&self.point);
        // A direct step to the event saves the equilibrium beyond the event and the search for the
        // event between both points.
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
        // Check again, because an extremum or the end of unloading may have moved the end of the
        // step.
        if self.strays(&from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(candidate)
    }

    /// Steps by the given distance, or to the target or the first event within it.
    fn plain_step(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let mut candidate = self.step_to(from, distance)?;
        // A path that is turned back starts at its target up to round-off.
        let round_off = if self.is_back { FLOOR } else { 0.0 };
        if self.progress(&candidate.state.z).abs() > self.system.target() + round_off {
            candidate = self.locate_target(from, &candidate)?;
            if self.is_back {
                candidate.event = Some(Event::Target);
            }
        }
        self.first_event(from, candidate)
    }

    /// Solves for the point between two points at which the control parameter is at its target.
    fn locate_target(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let (start, end) = (self.progress(&from.state.z), self.progress(&beyond.state.z));
        // Prescribe the control parameter even if the arc length measured the step, so that the
        // control parameter equals its target to the last bit.
        let (target, control) = (end.signum() * self.system.target(), self.control_parameter());
        // A path continued with another system may start at its target up to round-off.
        let fraction = if end == start { 0.0 } else { (target - start) / (end - start) };
        let state = from.state.interpolated(&beyond.state, fraction);
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], target);
        self.correct(state, &condition)
    }

    /// Completes a candidate to a point of the path: resolves its event and finds the direction.
    ///
    /// # Errors
    /// If the event has no outgoing branch.
    pub(super) fn accept(
        &mut self,
        candidate: Candidate<S::Mode>,
    ) -> Result<Equilibrium<S::Mode>, Termination> {
        let Candidate { mut state, direction: arriving, mut event, .. } = candidate;
        if let Some(Event::Changed(changes)) = &event
            // A constraint that ends the path is not changed, because there is no outgoing branch.
            && changes.iter().any(|change| self.system.ends(&state, change.constraint))
        {
            event = Some(Event::Target);
        }
        let leaving = match &mut event {
            Some(Event::Changed(changes)) => {
                let is_positive = self.is_positive;
                let resolved = self.resolve_event(&mut state, &arriving, changes);
                // The step will be repeated from the current point, so restore the orientation
                // there.
                resolved.inspect_err(|_| self.is_positive = is_positive)?
            }
            _ => arriving.clone(),
        };
        if event.is_none() && self.at_target(&state) {
            event = Some(Event::Target);
        }
        Ok(Equilibrium { state, arriving, leaving, event })
    }

    /// Returns true if a path that was not turned back is at its target.
    fn at_target(&self, state: &State<S::Mode>) -> bool {
        !self.is_back && (self.progress(&state.z).abs() - self.system.target()).abs() <= FLOOR
    }

    /// Returns true if the path reaches its target at `point`.
    ///
    /// A path that is turned back starts at its target, which does not count.
    pub(super) fn reaches_target(&self, point: &Equilibrium<S::Mode>) -> bool {
        let progress = self.progress(&point.state.z);
        let is_near = (progress.abs() - self.system.target()).abs() <= FLOOR;
        is_near && (!self.is_back || progress * self.progress(&point.arriving) > 0.0)
    }
}
