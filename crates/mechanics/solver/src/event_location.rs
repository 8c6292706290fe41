//! Location of events on the path.

use crate::bracket::Bracket;
use crate::continuation::{Candidate, Continuation, Equilibrium};
use crate::event::{Change, Event};
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure, guard_slope};
use crate::system::{State, System};

/// Largest distance by which an event may lie before the current point.
///
/// Constraints that change sides together are located one after the other, each up to round-off.
const BACKWARD: f64 = 1e-9;

/// Largest distance of a predicted event from the current point, in steps.
const FARTHER: f64 = 1.5;

/// Guards within this distance of zero change sides with the located event.
const TOGETHER: f64 = 1e-10;

/// Slopes below this are zero to first order.
///
/// Rates are near 1 and their round-off near 1e-11.
pub(crate) const NO_RATE: f64 = 1e-6;

/// Largest relative guard of a changed constraint at the restored equilibrium.
///
/// It is relative to 1 plus its slope. If the guard exceeds this, Newton's method converged to a
/// different equilibrium; likewise if any active guard is below zero by more.
pub(crate) const ELSEWHERE: f64 = 1e-4;

/// Relative accuracy of the location of an extremum in its bracket.
const CLOSE: f64 = 1e-9;
/// Maximum number of iterations in the search for an extremum.
const MAX_ROUNDS: usize = 100;

impl<S: System> Continuation<S> {
    /// Locates the event predicted by guards and slopes within a distance.
    ///
    /// `None` if the prediction does not lead to the first event.
    pub(crate) fn predicted_event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Option<Candidate<S::Mode>> {
        let rate = self.condition(from).measure(&from.leaving);
        // Aim at the first event only: later ones occur with a different active set.
        let (constraint, along) = self.first_predicted()?;
        // Leave events beyond the step to a later step, with a better prediction.
        if along * rate > distance {
            return None;
        }
        let state = from.state.moved(along, &from.leaving);
        let located = self.locate_from(from, state, constraint).ok()?;
        let condition = self.condition(from);
        let reached = condition.measure(&located.state.z) - condition.value;
        let within = (0.0..=FARTHER * distance).contains(&reached)
            && self.progress(&located.state.z).abs() <= self.system.target();
        // The prediction is of first order. With a curved guard the zero may lie far beyond, or
        // Newton's method may have converged to another zero.
        if !within || self.turns_sharply(from, &located) {
            return None;
        }
        let guards = Newton::guards(&self.system, &located.state);
        match self.first_violated(&guards) {
            // A guard with increasingly negative slope may vanish before the predicted one.
            Some(earlier) if earlier != constraint => {
                self.locate_first_event(from, located, earlier).ok()
            }
            _ => Some(self.mark_event(located, constraint, &guards)),
        }
    }

    /// Returns the constraint with the first guard zero, by linear extrapolation.
    ///
    /// The second number is its distance in units of the outgoing direction.
    fn first_predicted(&self) -> Option<(usize, f64)> {
        let guards = self.guards.iter().zip(&self.slopes).enumerate();
        let falling = guards.filter(|(_, (guard, slope))| **guard > FLOOR && **slope < 0.0);
        let zeros = falling.map(|(constraint, (guard, slope))| (constraint, guard / -slope));
        zeros.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the first event up to `candidate`, or `candidate` itself.
    pub(crate) fn first_event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        candidate: Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let guards = Newton::guards(&self.system, &candidate.state);
        if let Some(constraint) = self.first_violated(&guards) {
            return self.locate_first_event(from, candidate, constraint);
        }
        // A contact may close and open again within a step, or a force vanish and grow again. All
        // guards at the end of the step are then positive.
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

    /// Returns the constraint violated first between current guards and `after`.
    pub(crate) fn first_violated(&self, after: &[f64]) -> Option<usize> {
        let mut first = (f64::INFINITY, None);
        for (c, (&before, &after)) in self.guards.iter().zip(after).enumerate() {
            // A constraint may start below zero by the error of the event, such as a slip distance
            // that grows at a small rate. It is violated where it falls further.
            let rises = before > -ELSEWHERE && self.slopes[c] > NO_RATE;
            let floor = if rises { FLOOR.max(-before) } else { FLOOR };
            if after < -floor {
                // The secant estimates the order only; the order is checked again at the event.
                let fraction = before.max(0.0) / (before.max(0.0) - after);
                if fraction < first.0 {
                    first = (fraction, Some(c));
                }
            }
        }
        first.1
    }

    /// Estimates where a guard falls below zero and rises again before `candidate`.
    ///
    /// The two events leave no trace in the guards at the ends of the step. Returns fractions of
    /// the step.
    fn dips(
        &mut self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
        after: &[f64],
    ) -> Vec<f64> {
        let condition = self.condition(from);
        let distance = condition.measure(&candidate.state.z) - condition.value;
        let span = distance / condition.measure(&from.leaving);
        // Evaluate the slope at the end only for guards that are predicted to be negative there.
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

    /// Locates the first event before `beyond`, where `constraint` is violated.
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
            // The constraint has just changed sides, or a transition passed the condition to it,
            // and the outgoing direction satisfies it. A step that violates it was too long.
            // Locating its zero would return to the current point and then back along the incoming
            // path.
            let is_sliding = self.system.coupled(constraint).len() > 1;
            let is_at_no_rate = self.slopes[constraint].abs() < NO_RATE;
            self.undone += usize::from(changed && is_sliding && is_at_no_rate);
            return Err(NewtonFailure::TooManyIterations);
        }
        // Each iteration finds an earlier event, so there are at most as many as constraints.
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

    /// Locates the zero of a guard between the current point and `beyond`.
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
        // The guard is already negative by round-off and falls, so its zero is here, however small
        // its slope.
        if reached < -BACKWARD && self.guards[constraint] <= 0.0 && self.slopes[constraint] < 0.0 {
            let (state, direction) = (from.state.clone(), from.leaving.clone());
            return Ok(Candidate { state, direction, event: None, is_positive: self.is_positive });
        }
        // A zero outside the step belongs to another part of the path: the step was too long for
        // this guard.
        if !(-BACKWARD..=span + BACKWARD).contains(&reached) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(located)
    }

    /// Locates the zero of a guard near `state`.
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

    /// Marks the candidate as the event at which `constraint` changes sides.
    ///
    /// Includes other constraints that change sides at the same point.
    fn mark_event(
        &self,
        located: Candidate<S::Mode>,
        constraint: usize,
        guards: &[f64],
    ) -> Candidate<S::Mode> {
        let Candidate { state, direction, is_positive, .. } = located;
        let mut changes = vec![Change { constraint, activated: !state.active[constraint] }];
        // Guards at zero that rise have just changed sides. Change the falling ones together;
        // otherwise a long chain takes a step of zero length for each of its gaps.
        for (other, guard) in guards.iter().enumerate() {
            if other != constraint && guard.abs() <= TOGETHER {
                let rate = guard_slope(&self.system, &state, other, &direction);
                // A small value is not enough: a guard with a small slope may vanish far ahead.
                if rate < 0.0 && *guard <= -rate * BACKWARD {
                    changes.push(Change { constraint: other, activated: !state.active[other] });
                }
            }
        }
        Candidate { state, direction, event: Some(Event::Changed(changes)), is_positive }
    }

    /// Cuts a step short where the rate of the load or of a monotone unknown vanishes.
    pub(crate) fn up_to_turn(
        &mut self,
        from: &Equilibrium<S::Mode>,
        mut candidate: Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let load = self.system.load();
        // A load extremum is a point of the path. Behind it the load must turn, so skip the search.
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

    /// Locates the point where an unknown turns.
    fn locate_extremum(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
        unknown: usize,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let condition = self.condition(from);
        let span = condition.measure(&beyond.state.z) - condition.value;
        let start = from.leaving[unknown];
        // Another bracketing rule would change the last digits of load extrema in stored tables.
        let mut bracket = Bracket::patient((0.0, start), (span, beyond.direction[unknown]));
        for _ in 0..MAX_ROUNDS {
            let distance = bracket.secant();
            let candidate = self.step_to(from, distance)?;
            let rate = candidate.direction[unknown];
            // One criterion suffices: round-off limits the position of a flat extremum, and the
            // rate at a sharp one.
            if bracket.width() <= CLOSE * span || rate.abs() <= CLOSE * start.abs() {
                return Ok(candidate);
            }
            bracket.narrow(distance, rate);
        }
        Err(NewtonFailure::TooManyIterations)
    }

    /// Returns true if a load that only pushes would have to pull at the candidate.
    pub(crate) fn load_reverses(&self, candidate: &Candidate<S::Mode>) -> bool {
        self.pushes.is_some_and(|sign| sign * candidate.state.z[self.system.load()] < 0.0)
    }

    /// Returns true if the load vanishes at an event and would reverse.
    ///
    /// It vanishes up to round-off. The contact that carries the load opens, so the path ends.
    pub(crate) fn load_vanishes(&self, candidate: &Candidate<S::Mode>) -> bool {
        let load = self.system.load();
        matches!(candidate.event, Some(Event::Changed(_)))
            && candidate.state.z[load].abs() <= FLOOR
            && self.pushes.is_some_and(|sign| sign * candidate.direction[load] < 0.0)
    }

    /// Locates the point before `beyond` where the load returns to zero.
    pub(crate) fn locate_unloading(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let load = self.system.load();
        let sign = self.pushes.unwrap_or(1.0);
        let (start, end) = ((sign * from.state.z[load]).max(0.0), sign * beyond.state.z[load]);
        let state = from.state.interpolated(&beyond.state, start / (start - end));
        // The load decreases along the path.
        let mut candidate = self.correct(state, &Condition::new(vec![(load, -sign)], 0.0))?;
        if self.turns_sharply(from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        candidate.event = Some(Event::Unloaded);
        Ok(candidate)
    }
}

/// Returns the fraction at which a cubic dips below zero.
///
/// The cubic passes through two values with their slopes.
pub fn dip([start, end]: [f64; 2], [falling, rising]: [f64; 2]) -> Option<f64> {
    if !(falling < 0.0 && rising > 0.0) {
        return None;
    }
    // start + falling x + square x² + cube x³
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

    /// Finds the minimum of the Hermite cubic by sampling: fraction and value.
    fn lowest(ends: [f64; 2], slopes: [f64; 2]) -> (f64, f64) {
        let values = (0..=1000).map(|i| f64::from(i) / 1000.0).map(|x| {
            // Hermite basis.
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
        // (2x − 1)²
        assert_eq!(dip([1.0, 1.0], [-4.0, 4.0]), None);
        assert_eq!(dip([0.99, 0.99], [-4.0, 4.0]), Some(0.5));
    }
}
