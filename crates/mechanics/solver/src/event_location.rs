//! Location of events on the path: zeros of guards, extrema, and the end of unloading.

use crate::bracket::Bracket;
use crate::continuation::{Candidate, Continuation, Equilibrium};
use crate::event::{Change, Event};
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure, guard_slope};
use crate::system::{State, System};

/// Largest distance by which an event may lie before the current point.
///
/// Coinciding events are located one after the other with round-off errors, so the second event may
/// lie slightly before the first.
const BACKWARD: f64 = 1e-9;

/// Largest distance of a predicted event from the current point, in units of the step length.
const FARTHER: f64 = 1.5;

/// Largest magnitude of the guard of a constraint that changes together with a located event.
const TOGETHER: f64 = 1e-10;

/// Largest magnitude of the slope of a guard that counts as zero.
///
/// Typical slopes are of order 1 and their round-off of order 1e-11.
pub(crate) const NO_RATE: f64 = 1e-6;

/// Largest guard of a changed constraint after equilibrium has been restored at an event.
///
/// The limit is multiplied by 1 plus the slope of the guard. If the guard is larger, or the guard
/// of any active constraint is negative by more, Newton's method has converged to a different
/// equilibrium.
pub(crate) const ELSEWHERE: f64 = 1e-4;

/// Tolerance for the location of an extremum.
///
/// The search ends if the width of the bracket divided by its initial width, or the rate of the
/// unknown divided by its rate at the start of the step, is at most this number.
const CLOSE: f64 = 1e-9;
/// Maximum number of iterations in the search for an extremum.
const MAX_ROUNDS: usize = 100;

impl<S: System> Continuation<S> {
    /// Locates the event that guards and slopes predict within `distance`.
    ///
    /// `None` if no event is predicted, or if the prediction does not lead to the first event.
    pub(crate) fn predicted_event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Option<Candidate<S::Mode>> {
        let rate = self.condition(from).measure(&from.leaving);
        // Predict only the first event, because later events occur with a different active set.
        let (constraint, along) = self.first_predicted()?;
        // Later steps predict events beyond this step more accurately.
        if along * rate > distance {
            return None;
        }
        let state = from.state.moved(along, &from.leaving);
        let located = self.locate_from(from, state, constraint).ok()?;
        let condition = self.condition(from);
        let reached = condition.measure(&located.state.z) - condition.value;
        let within = (0.0..=FARTHER * distance).contains(&reached)
            && self.progress(&located.state.z).abs() <= self.system.target();
        // The prediction is linear. If the guard is curved, its zero may lie far beyond the step,
        // or Newton's method may have converged to another zero.
        if !within || self.turns_sharply(from, &located) {
            return None;
        }
        let guards = Newton::guards(&self.system, &located.state);
        match self.first_violated(&guards) {
            // The guard of another constraint may decrease faster than predicted and reach zero
            // earlier.
            Some(earlier) if earlier != constraint => {
                self.locate_first_event(from, located, earlier).ok()
            }
            _ => Some(self.mark_event(located, constraint, &guards)),
        }
    }

    /// Locates the event of `constraint` near `state`, anywhere on the smooth path ahead.
    ///
    /// `None` if Newton's method fails, or if another constraint is violated at the event.
    pub(crate) fn known_event(
        &mut self,
        state: State<S::Mode>,
        constraint: usize,
    ) -> Option<Candidate<S::Mode>> {
        let from = self.point_shared();
        let located = self.locate_from(&from, state, constraint).ok()?;
        let ahead = self.condition(&from);
        let is_ahead = ahead.measure(&located.state.z) > ahead.value
            && self.progress(&located.state.z).abs() <= self.system.target()
            && located.is_positive == self.is_positive;
        let guards = Newton::guards(&self.system, &located.state);
        let is_first = self.first_violated(&guards).is_none_or(|first| first == constraint);
        (is_ahead && is_first).then(|| self.mark_event(located, constraint, &guards))
    }

    /// Returns the constraint with the guard that reaches zero first by linear extrapolation.
    ///
    /// The second value is the distance of this zero in units of the outgoing direction.
    fn first_predicted(&self) -> Option<(usize, f64)> {
        let guards = self.guards.iter().zip(&self.slopes).enumerate();
        let falling = guards.filter(|(_, (guard, slope))| **guard > FLOOR && **slope < 0.0);
        let zeros = falling.map(|(constraint, (guard, slope))| (constraint, guard / -slope));
        zeros.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the first event between `from` and `candidate`, or `candidate` if there is none.
    pub(crate) fn first_event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        candidate: Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let guards = Newton::guards(&self.system, &candidate.state);
        if let Some(constraint) = self.first_violated(&guards) {
            return self.locate_first_event(from, candidate, constraint);
        }
        // A contact may close and open again within a step, or a force may vanish and grow again.
        // All guards are then positive at the end of the step.
        for fraction in self.dips(from, &candidate, &guards) {
            let condition = self.condition(from);
            let distance = condition.measure(&candidate.state.z) - condition.value;
            let inside = self.step_to(from, fraction * distance)?;
            let guards = Newton::guards(&self.system, &inside.state);
            if let Some(constraint) = self.first_violated(&guards) {
                return self.locate_first_event(from, inside, constraint);
            }
        }
        Ok(candidate)
    }

    /// Returns the constraint that is violated first within a step.
    ///
    /// `after` contains the guards at the end of the step. `None` if no constraint is violated.
    pub(crate) fn first_violated(&self, after: &[f64]) -> Option<usize> {
        let mut first = (f64::INFINITY, None);
        for (c, (&before, &after)) in self.guards.iter().zip(after).enumerate() {
            // Because of the error of the last event, a rising guard, such as a slip distance that
            // grows slowly, may be slightly negative at the start of the step. Its constraint is
            // violated only if the guard decreases further.
            let rises = before > -ELSEWHERE && self.slopes[c] > NO_RATE;
            let floor = if rises { FLOOR.max(-before) } else { FLOOR };
            if after < -floor {
                // The secant only estimates which zero is first. Callers check this at the event.
                let fraction = before.max(0.0) / (before.max(0.0) - after);
                if fraction < first.0 {
                    first = (fraction, Some(c));
                }
            }
        }
        first.1
    }

    /// Estimates where a guard falls below zero and rises above zero again before `candidate`.
    ///
    /// Such a guard is positive at both ends of the step. `after` contains the guards at the end of
    /// the step. Returns the fraction of the step for each such guard.
    fn dips(
        &mut self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
        after: &[f64],
    ) -> Vec<f64> {
        let condition = self.condition(from);
        let distance = condition.measure(&candidate.state.z) - condition.value;
        let span = distance / condition.measure(&from.leaving);
        // The slope at the end of the step is needed only for guards that are predicted to be
        // negative there.
        let arriving = distance / condition.measure(&candidate.direction);
        let mut dips = Vec::new();
        for (c, &after) in after.iter().enumerate() {
            let (before, fall) = (self.guards[c], self.slopes[c] * span);
            if before > FLOOR && before + fall < 0.0 {
                let slope = guard_slope(&self.system, &candidate.state, c, &candidate.direction);
                dips.extend(dip([before, after], [fall, slope * arriving]));
            }
        }
        dips
    }

    /// Locates the first event before `beyond`, a point at which `constraint` is violated.
    fn locate_first_event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        mut beyond: Candidate<S::Mode>,
        mut constraint: usize,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let changed = match &from.event {
            Some(Event::Changed(all)) => all.iter().any(|change| change.constraint == constraint),
            _ => false,
        };
        let rises = self.guards[constraint] <= TOGETHER && self.slopes[constraint] > 0.0;
        if changed || rises {
            // The constraint has changed at the current point, or its guard is zero there after a
            // transition. The outgoing direction satisfies the constraint, so a step that violates
            // the constraint was too long. A search for the zero of the guard would return to the
            // current point, and the path would then reverse.
            let is_sliding = self.system.coupled(constraint).len() > 1;
            let is_at_no_rate = self.slopes[constraint].abs() < NO_RATE;
            self.undone += usize::from(changed && is_sliding && is_at_no_rate);
            return Err(NewtonFailure::TooManyIterations);
        }
        // Each iteration finds an earlier event of another constraint, so the number of iterations
        // is limited by the number of constraints.
        for _ in 0..=self.guards.len() {
            let located = self.locate(from, &beyond, constraint)?;
            let guards = Newton::guards(&self.system, &located.state);
            match self.first_violated(&guards) {
                Some(earlier) if earlier != constraint => constraint = earlier,
                _ => return Ok(self.mark_event(located, constraint, &guards)),
            }
            beyond = located;
        }
        Err(NewtonFailure::TooManyIterations)
    }

    /// Locates the zero of the guard of `constraint` between the current point and `beyond`.
    fn locate(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
        constraint: usize,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let condition = self.condition(from);
        let before = self.guards[constraint].max(0.0);
        let after = Newton::guards(&self.system, &beyond.state)[constraint];
        let state = from.state.interpolated(&beyond.state, before / (before - after));
        let located = self.locate_from(from, state, constraint)?;
        let span = condition.measure(&beyond.state.z) - condition.value;
        let reached = condition.measure(&located.state.z) - condition.value;
        // The guard is zero or negative by round-off at the current point and decreases, so the
        // event is at the current point, even if a small slope places the zero farther back.
        if reached < -BACKWARD && self.guards[constraint] <= 0.0 && self.slopes[constraint] < 0.0 {
            let (state, direction) = (from.state.clone(), from.leaving.clone());
            return Ok(Candidate { state, direction, event: None, is_positive: self.is_positive });
        }
        // A zero outside the step belongs to another part of the path, so the step was too long.
        if !(-BACKWARD..=span + BACKWARD).contains(&reached) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(located)
    }

    /// Locates the zero of the guard of `constraint` near `state`.
    fn locate_from(
        &mut self,
        from: &Equilibrium<S::Mode>,
        mut state: State<S::Mode>,
        constraint: usize,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let condition = self.condition(from);
        let direction =
            self.newton.locate(&self.system, &mut state, &condition, constraint, &self.settings)?;
        let is_positive = self.newton.is_positive(&condition, &direction);
        Ok(Candidate { state, direction: self.normalised(direction), event: None, is_positive })
    }

    /// Marks the candidate as the event of `constraint`.
    ///
    /// The event includes all other constraints that change at the same point. `guards` are the
    /// guards at this point.
    fn mark_event(
        &self,
        located: Candidate<S::Mode>,
        constraint: usize,
        guards: &[f64],
    ) -> Candidate<S::Mode> {
        let Candidate { state, direction, is_positive, .. } = located;
        let mut changes = vec![Change { constraint, activated: !state.active[constraint] }];
        // Rising guards at zero belong to constraints that have just changed. The constraints of
        // falling guards change together; otherwise a long chain would need a step of zero length
        // for each of its gaps.
        for (other, guard) in guards.iter().enumerate() {
            if other != constraint && guard.abs() <= TOGETHER {
                let rate = guard_slope(&self.system, &state, other, &direction);
                // A small value is not sufficient, because a guard with a small slope may reach
                // zero far ahead.
                if rate < 0.0 && *guard <= -rate * BACKWARD {
                    changes.push(Change { constraint: other, activated: !state.active[other] });
                }
            }
        }
        Candidate { state, direction, event: Some(Event::Changed(changes)), is_positive }
    }

    /// Shortens a step to the point at which the rate of the load or a monotone unknown is zero.
    pub(crate) fn up_to_turn(
        &mut self,
        from: &Equilibrium<S::Mode>,
        mut candidate: Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let load = self.system.load();
        // Each load extremum becomes a point of the path. If the step starts at a load extremum,
        // the rate of the load changes sign there, so no search is needed.
        let turns = from.leaving[load] * candidate.direction[load] < 0.0;
        if turns && from.event != Some(Event::LoadExtremum) {
            candidate = self.locate_extremum(from, &candidate, load)?;
            candidate.event = Some(Event::LoadExtremum);
        }
        for number in 0..self.system.monotone().len() {
            let constraint = self.system.monotone()[number];
            let unknown = self.system.constraints()[constraint];
            let grows = from.state.active[constraint] && from.leaving[unknown] > 0.0;
            if grows && candidate.direction[unknown] < 0.0 {
                candidate = self.locate_extremum(from, &candidate, unknown)?;
                candidate.event =
                    Some(Event::Changed(vec![Change { constraint, activated: false }]));
            }
        }
        Ok(candidate)
    }

    /// Locates the point before `beyond` at which the rate of an unknown is zero.
    fn locate_extremum(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
        unknown: usize,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let condition = self.condition(from);
        let span = condition.measure(&beyond.state.z) - condition.value;
        let start = from.leaving[unknown];
        // Another halving rule would change the last digits of load extrema in stored tables.
        let mut bracket = Bracket::illinois((0.0, start), (span, beyond.direction[unknown]));
        for _ in 0..MAX_ROUNDS {
            let distance = bracket.secant();
            let candidate = self.step_to(from, distance)?;
            let rate = candidate.direction[unknown];
            // One of the two criteria suffices: round-off limits the accuracy of the position at a
            // flat extremum, and the accuracy of the rate at a sharp extremum.
            if bracket.width() <= CLOSE * span || rate.abs() <= CLOSE * start.abs() {
                return Ok(candidate);
            }
            bracket.narrow(distance, rate);
        }
        Err(NewtonFailure::TooManyIterations)
    }

    /// Returns true if a load that can only push would have to pull at the candidate.
    pub(crate) fn load_reverses(&self, candidate: &Candidate<S::Mode>) -> bool {
        self.pushes.is_some_and(|sign| sign * candidate.state.z[self.system.load()] < 0.0)
    }

    /// Returns true if the load is zero up to round-off at an event and would reverse beyond it.
    ///
    /// At such an event the contact that carries the load opens, so the path ends.
    pub(crate) fn load_vanishes(&self, candidate: &Candidate<S::Mode>) -> bool {
        let load = self.system.load();
        matches!(candidate.event, Some(Event::Changed(_)))
            && candidate.state.z[load].abs() <= FLOOR
            && self.pushes.is_some_and(|sign| sign * candidate.direction[load] < 0.0)
    }

    /// Locates the point before `beyond` at which the load returns to zero.
    pub(crate) fn locate_unloading(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let load = self.system.load();
        let sign = self.pushes.unwrap_or(1.0);
        let (start, end) = ((sign * from.state.z[load]).max(0.0), sign * beyond.state.z[load]);
        let state = from.state.interpolated(&beyond.state, start / (start - end));
        // The condition measures the path by the negative load, because the load decreases.
        let mut candidate = self.correct(state, &Condition::new(vec![(load, -sign)], 0.0))?;
        if self.turns_sharply(from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        candidate.event = Some(Event::Unloaded);
        Ok(candidate)
    }
}

/// Returns the position of the minimum of a cubic on `0..1` if the minimum is negative.
///
/// `start` and `end` are the values of the cubic at 0 and 1, `falling` and `rising` its slopes
/// there. `None` if the minimum is not negative, or if there is no minimum inside.
pub fn dip([start, end]: [f64; 2], [falling, rising]: [f64; 2]) -> Option<f64> {
    if !(falling < 0.0 && rising > 0.0) {
        return None;
    }
    // Coefficients of the cubic start + falling x + square x² + cube x³.
    let square = 3.0 * (end - start) - 2.0 * falling - rising;
    let cube = 2.0 * (start - end) + falling + rising;
    let x = -falling / (square + (square * square - 3.0 * cube * falling).sqrt());
    let lowest = start + x * (falling + x * (square + x * cube));
    (lowest < 0.0 && 0.0 < x && x < 1.0).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::dip;
    use proptest::prelude::*;

    /// Returns position and value of the minimum of the cubic, found by sampling.
    fn lowest(ends: [f64; 2], slopes: [f64; 2]) -> (f64, f64) {
        let values = (0..=1000).map(|i| f64::from(i) / 1000.0).map(|x| {
            // Hermite basis: functions for the two values, then for the two slopes.
            let [a, b] = [(1.0 + 2.0 * x) * (1.0 - x).powi(2), x * x * (3.0 - 2.0 * x)];
            let [c, d] = [x * (1.0 - x).powi(2), x * x * (x - 1.0)];
            (x, ends[0] * a + ends[1] * b + slopes[0] * c + slopes[1] * d)
        });
        values.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    }

    proptest! {
        #[test]
        fn a_dip_lies_at_the_minimum_of_the_cubic(
            start in 0.0_f64..1.0, end in 0.0_f64..1.0, falling in -5.0_f64..-0.1, rising in 0.1_f64..5.0,
        ) {
            let (fraction, value) = lowest([start, end], [falling, rising]);
            match dip([start, end], [falling, rising]) {
                Some(x) => prop_assert!((x - fraction).abs() < 2e-3 && value < 1e-5, "{x} {fraction} {value}"),
                None => prop_assert!(value > -1e-5, "{fraction} {value}"),
            }
        }

        #[test]
        fn a_guard_that_does_not_fall_and_rise_has_no_dip(
            ends in prop::array::uniform2(0.0_f64..1.0), slopes in prop::array::uniform2(0.0_f64..5.0),
        ) {
            prop_assert_eq!(dip(ends, slopes), None);
            prop_assert_eq!(dip(ends, slopes.map(|slope| -slope)), None);
        }
    }

    #[test]
    fn a_guard_that_only_touches_zero_has_no_dip() {
        // The guard (2x − 1)² is zero at x = 1/2, but never negative.
        assert_eq!(dip([1.0, 1.0], [-4.0, 4.0]), None);
        assert_eq!(dip([0.99, 0.99], [-4.0, 4.0]), Some(0.5));
    }
}
