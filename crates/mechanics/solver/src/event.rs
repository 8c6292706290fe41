//! Events on the path: where they are.

use crate::bracket::Bracket;
use crate::continuation::{Candidate, Continuation, Equilibrium};
use crate::newton::{Condition, FLOOR, Newton, NewtonFailure, guard_slope};
use crate::system::{State, System};

/// An event may lie this far before the point reached: constraints that change sides together are
/// found one after the other, and each only to round-off.
const BACKWARD: f64 = 1e-9;

/// A predicted event may lie at this part of the step that was to be taken.
const FARTHER: f64 = 1.5;

/// Guards as close to zero as this at an event may change sides with the one that was located.
const TOGETHER: f64 = 1e-10;

/// A guard that changes more slowly than this does not change to first order: rates are near 1, and round-off of them near 1e-11.
pub(crate) const NO_RATE: f64 = 1e-6;

/// The place of a load extremum is known to this part of its bracket, after at most so many rounds.
const CLOSE: f64 = 1e-9;
const MAX_ROUNDS: usize = 100;

/// An event at a point of the path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Constraints change sides: several where symmetry makes them do so together.
    Changed(Vec<Change>),
    /// The load has a maximum or a minimum.
    LoadExtremum,
    /// The load, which only pushes, has come back to zero.
    Unloaded,
    /// The control parameter has reached its target.
    Target,
}

/// A constraint that changes sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// Number of the constraint.
    pub constraint: usize,
    /// Whether the constraint becomes active; else it becomes inactive.
    pub activated: bool,
}

impl<S: System> Continuation<S> {
    /// The event that guards and their slopes predict within a distance, if it is the first one and not far from there.
    pub(crate) fn predicted_event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        distance: f64,
    ) -> Option<Candidate<S::Mode>> {
        let rate = self.condition(from).measure(&from.leaving);
        // Only the first one is aimed at: what happens behind it happens with another active set.
        let (constraint, along) = self.first_predicted()?;
        // What lies beyond the step is for a later one, which predicts it from nearer.
        if along * rate > distance {
            return None;
        }
        let state = from.state.moved(along, &from.leaving);
        let located = self.locate_from(from, state, constraint).ok()?;
        let condition = self.condition(from);
        let reached = condition.measure(&located.state.z) - condition.value;
        let within = (0.0..=FARTHER * distance).contains(&reached)
            && self.progress(&located.state.z) <= self.system.target();
        // The prediction is of first order. Where the guard bends, its zero may lie far beyond, or Newton's method may
        // have come to another one.
        if !within || self.turns_sharply(from, &located) {
            return None;
        }
        let guards = Newton::guards(&self.system, &located.state);
        match self.first_violated(&guards) {
            // A guard that falls ever faster may get to zero before the one that was predicted.
            Some(earlier) if earlier != constraint => self.event(from, located, earlier).ok(),
            _ => Some(self.changed(located, constraint, &guards)),
        }
    }

    /// The constraint whose guard vanishes first if all go on as they change now, and where, in units of the direction in which
    /// the path leaves.
    fn first_predicted(&self) -> Option<(usize, f64)> {
        let guards = self.guards.iter().zip(&self.slopes).enumerate();
        let falling = guards.filter(|(_, (guard, slope))| **guard > FLOOR && **slope < 0.0);
        let places = falling.map(|(constraint, (guard, slope))| (constraint, guard / -slope));
        places.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The first event between the point reached and `candidate`, or `candidate` where there is none.
    pub(crate) fn first_event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        candidate: Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let guards = Newton::guards(&self.system, &candidate.state);
        if let Some(constraint) = self.first_violated(&guards) {
            return self.event(from, candidate, constraint);
        }
        // A contact may close and open again within a step, or a force come to zero and grow anew: then all guards at
        // its end are sound.
        for fraction in self.dips(from, &candidate, &guards) {
            let condition = self.condition(from);
            let distance = condition.measure(&candidate.state.z) - condition.value;
            let inside = self.trial(from, fraction * distance)?;
            let guards = Newton::guards(&self.system, &inside.state);
            if let Some(constraint) = self.first_violated(&guards) {
                return self.event(from, inside, constraint);
            }
        }
        Ok(candidate)
    }

    /// The constraint that is violated first on the way from the point reached to where the guards are `after`.
    fn first_violated(&self, after: &[f64]) -> Option<usize> {
        let mut first = (f64::INFINITY, None);
        for (c, (&before, &after)) in self.guards.iter().zip(after).enumerate() {
            if after < -FLOOR {
                // By the secant. It only sets an order: whether one lies before the other is asked again at the event.
                let fraction = before.max(0.0) / (before.max(0.0) - after);
                if fraction < first.0 {
                    first = (fraction, Some(c));
                }
            }
        }
        first.1
    }

    /// Where, on the way from the point reached to `candidate`, a guard seems to fall below zero and to rise
    /// again: two events within a step, of which its ends show nothing.
    fn dips(
        &mut self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
        after: &[f64],
    ) -> Vec<f64> {
        let condition = self.condition(from);
        let distance = condition.measure(&candidate.state.z) - condition.value;
        let span = distance / condition.measure(&from.leaving);
        // Of these alone the slope at the end is worked out: a guard that would still be positive there is not
        // expected to dip.
        let falls =
            |c: &usize| self.guards[*c] > FLOOR && self.guards[*c] + self.slopes[*c] * span < 0.0;
        let falling: Vec<usize> = (0..after.len()).filter(falls).collect();
        let arriving = distance / condition.measure(&candidate.direction);
        let dips = falling.into_iter().filter_map(|c| {
            let slope = guard_slope(&self.system, &candidate.state, c, &candidate.direction);
            let ends = [self.guards[c], after[c]];
            dip(ends, [self.slopes[c] * span, slope * arriving])
        });
        dips.collect()
    }

    /// The first event between the point reached and `beyond`, where `constraint` is violated.
    fn event(
        &mut self,
        from: &Equilibrium<S::Mode>,
        mut beyond: Candidate<S::Mode>,
        mut constraint: usize,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let is_it = |change: &Change| change.constraint == constraint;
        let changed = matches!(&from.event, Some(Event::Changed(all)) if all.iter().any(is_it));
        let rises = self.guards[constraint] <= TOGETHER && self.slopes[constraint] > 0.0;
        if changed || rises {
            // It has just changed sides, or is the one whose condition a contact has passed to, and the path leaves in the
            // direction in which it stays valid: a step that ends otherwise was too long. To look for its zero would lead back
            // to where the path is, and from there the way that it came.
            let is_sliding = self.system.coupled(constraint).len() > 1;
            let is_at_no_rate = self.slopes[constraint].abs() < NO_RATE;
            self.undone += usize::from(changed && is_sliding && is_at_no_rate);
            return Err(NewtonFailure::TooManyIterations);
        }
        // Each round finds an event before the last one, so as many rounds as constraints do.
        for _ in 0..=self.guards.len() {
            let located = self.locate(from, &beyond, constraint)?;
            let guards = Newton::guards(&self.system, &located.state);
            match self.first_violated(&guards) {
                Some(earlier) if earlier != constraint => constraint = earlier,
                _ => return Ok(self.changed(located, constraint, &guards)),
            }
            beyond = located;
        }
        Err(NewtonFailure::TooManyIterations)
    }

    /// The place between the point reached and `beyond` where the guard of a constraint vanishes.
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
        // A guard that is below zero by round-off already, and falls, has had its zero here, however slowly it changes.
        if reached < -BACKWARD && self.guards[constraint] <= 0.0 && self.slopes[constraint] < 0.0 {
            let (state, direction) = (from.state.clone(), from.leaving.clone());
            return Ok(Candidate { state, direction, event: None, is_positive: self.is_positive });
        }
        // A zero outside of the step belongs to another part of the path: the step was too long for its guard.
        if !(-BACKWARD..=span + BACKWARD).contains(&reached) {
            return Err(NewtonFailure::TooManyIterations);
        }
        Ok(located)
    }

    /// The place near `state` where the guard of a constraint vanishes.
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

    /// The candidate as an event: one constraint changes sides, others may do so with it.
    fn changed(
        &self,
        located: Candidate<S::Mode>,
        constraint: usize,
        guards: &[f64],
    ) -> Candidate<S::Mode> {
        let Candidate { state, direction, is_positive, .. } = located;
        let closing = |c: usize| {
            // Near zero is not enough: a guard that falls slowly there may have its event far ahead.
            let falls_to = |rate: f64| rate < 0.0 && guards[c] <= -rate * BACKWARD;
            guards[c].abs() <= TOGETHER
                && falls_to(guard_slope(&self.system, &state, c, &direction))
        };
        // A guard that is zero and rises has just changed sides, and stays.
        // Together, or a long chain would take a step of no length for each of its gaps.
        let others = (0..guards.len()).filter(|&c| c != constraint && closing(c));
        let changes = std::iter::once(constraint)
            .chain(others)
            .map(|constraint| Change { constraint, activated: !state.active[constraint] })
            .collect();
        Candidate { state, direction, event: Some(Event::Changed(changes)), is_positive }
    }

    /// Cuts a step short where a rate vanishes within it: that of the load, or that of a constraint whose unknown only grows.
    pub(crate) fn up_to_turn(
        &mut self,
        from: &Equilibrium<S::Mode>,
        mut candidate: Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let load = self.system.load();
        // An extremum that has been found is a point of the path; from there the load must turn, and is not looked for
        // again.
        let turns = from.leaving[load] * candidate.direction[load] < 0.0;
        if turns && from.event != Some(Event::LoadExtremum) {
            candidate = self.extremum(from, &candidate, load)?;
            candidate.event = Some(Event::LoadExtremum);
        }
        for number in 0..self.system.monotone().len() {
            let constraint = self.system.monotone()[number];
            let unknown = self.system.constraints()[constraint];
            let grows = from.state.active[constraint] && from.leaving[unknown] > 0.0;
            if grows && candidate.direction[unknown] < 0.0 {
                candidate = self.extremum(from, &candidate, unknown)?;
                candidate.event =
                    Some(Event::Changed(vec![Change { constraint, activated: false }]));
            }
        }
        Ok(candidate)
    }

    /// The point where an unknown turns.
    fn extremum(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
        unknown: usize,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let condition = self.condition(from);
        let span = condition.measure(&beyond.state.z) - condition.value;
        let start = from.leaving[unknown];
        // Not halved every time: extrema of the load are kept to the last digit of what they were with this rule.
        let mut bracket = Bracket::patient((0.0, start), (span, beyond.direction[unknown]));
        for _ in 0..MAX_ROUNDS {
            let distance = bracket.secant();
            let candidate = self.trial(from, distance)?;
            let rate = candidate.direction[unknown];
            // Either will do: near a flat top the place is hard to tell, at a sharp one the rate is.
            if bracket.width() <= CLOSE * span || rate.abs() <= CLOSE * start.abs() {
                return Ok(candidate);
            }
            bracket.narrow(distance, rate);
        }
        Err(NewtonFailure::TooManyIterations)
    }

    /// Whether a load that only pushes would have to pull at the candidate.
    pub(crate) fn pulls(&self, candidate: &Candidate<S::Mode>) -> bool {
        self.pushes.is_some_and(|sign| sign * candidate.state.z[self.system.load()] < 0.0)
    }

    /// Whether what carries the load lets go of it at the candidate, to round-off: the path ends there as where it pulls.
    pub(crate) fn lets_go(&self, candidate: &Candidate<S::Mode>) -> bool {
        let load = self.system.load();
        matches!(candidate.event, Some(Event::Changed(_)))
            && candidate.state.z[load].abs() <= FLOOR
            && self.pushes.is_some_and(|sign| sign * candidate.direction[load] < 0.0)
    }

    /// The point before `beyond` where the load comes back to zero.
    pub(crate) fn unloaded(
        &mut self,
        from: &Equilibrium<S::Mode>,
        beyond: &Candidate<S::Mode>,
    ) -> Result<Candidate<S::Mode>, NewtonFailure> {
        let load = self.system.load();
        let sign = self.pushes.unwrap_or(1.0);
        let (start, end) = ((sign * from.state.z[load]).max(0.0), sign * beyond.state.z[load]);
        let state = from.state.interpolated(&beyond.state, start / (start - end));
        // The load falls as the path goes on.
        let mut candidate = self.correct(state, &Condition::new(vec![(load, -sign)], 0.0))?;
        if self.turns_sharply(from, &candidate) {
            return Err(NewtonFailure::TooManyIterations);
        }
        candidate.event = Some(Event::Unloaded);
        Ok(candidate)
    }
}

/// Where, as a part of the way, the cubic through two values with two slopes dips below zero.
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

    /// The part of the way at which the cubic `value + slope x + …` through both ends is lowest, by looking.
    fn lowest(ends: [f64; 2], slopes: [f64; 2]) -> (f64, f64) {
        let cubic = |x: f64| {
            // Hermite's basis.
            let [a, b] = [(1.0 + 2.0 * x) * (1.0 - x).powi(2), x * x * (3.0 - 2.0 * x)];
            let [c, d] = [x * (1.0 - x).powi(2), x * x * (x - 1.0)];
            ends[0] * a + ends[1] * b + slopes[0] * c + slopes[1] * d
        };
        let places = (0..=1000).map(|i| f64::from(i) / 1000.0);
        places.map(|x| (x, cubic(x))).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    }

    proptest! {
        #[test]
        fn a_dip_is_where_the_cubic_is_lowest(
            start in 0.0_f64..1.0, end in 0.0_f64..1.0, falling in -5.0_f64..-0.1, rising in 0.1_f64..5.0,
        ) {
            let (place, value) = lowest([start, end], [falling, rising]);
            match dip([start, end], [falling, rising]) {
                Some(x) => prop_assert!((x - place).abs() < 2e-3 && value < 1e-5, "{x} {place} {value}"),
                None => prop_assert!(value > -1e-5, "{place} {value}"),
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
