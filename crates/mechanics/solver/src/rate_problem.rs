//! The rate complementarity problem: which way the path goes on where constraints change sides.

use crate::continuation::{Continuation, Equilibrium};
use crate::event::{Change, NO_RATE};
use crate::newton::{Condition, FLOOR, Newton, guard, guard_slope};
use crate::system::{State, System};
use crate::termination::Termination;

/// Events at least this far apart happen one after the other: where edges are nearly parallel forces
/// change by 10⁵ over a unit of the path, and not even a short way may be skipped.
const APART: f64 = 1e-10;

/// Where the guard of what has just changed sides is off zero by more than this, and by more than it changes over such a distance, the
/// equilibrium that was restored is another one.
const ELSEWHERE: f64 = 1e-4;

/// Directions whose cosine differs from 1 by less are one way on.
const SAME_WAY: f64 = 1e-6;

/// More sets of changes than this are not tried where constraints have companions.
const MOST_WITH_FRICTION: usize = 500;

/// More often than this no path turns round before it comes farther. Those that are known to come through do so once or twice.
const MOST_REVERSALS: usize = 20;

/// At an event the path has a direction `ż` on each side. Of the constraints that meet there, some are at
/// `z_c = 0` and `r_c(z) = 0` at once, and the direction in which the path goes on solves the complementarity
/// problem of the rates,
///
/// ```text
/// ∂r_i/∂z ż = 0     for every equation and every constraint that stays active,
/// ż_c = 0           for every constraint that stays inactive,
/// 0 ≤ ż_c  ⟂  ∂r_c/∂z ż ≥ 0     for those that meet,                                  (N6)
/// ```
///
/// whose equations may besides have another mode after the event. It is solved by principal pivoting (Cottle, Pang &
/// Stone 2009, *The Linear Complementarity Problem*, ch. 4, isbn 978-0-89871-686-3): first all constraints that are about
/// to change sides do so at once, as they do by symmetry; if the direction then violates one of them, they do so one by one,
/// the one that is violated fastest first.
impl<S: System> Continuation<S> {
    /// Lets constraints change sides in `state`, an equilibrium in which the path arrives along `arriving`, and returns the
    /// direction in which it goes on. `changes` are the constraints that are about to change sides, the first of them for
    /// certain; they are replaced by those that have.
    ///
    /// # Errors
    /// [`Termination::Singular`] if there is no single direction, [`Termination::Cycling`] if no set of changes makes all valid.
    pub(crate) fn resolve_event(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        changes: &mut Vec<Change>,
    ) -> Result<Vec<f64>, Termination> {
        if let [change] = changes[..]
            && !change.activated
            && self.system.monotone().contains(&change.constraint)
        {
            return self.end_growth(state, arriving, change);
        }
        // Symmetric rows close two contacts at once. One after the other would leave the symmetric path at its first
        // event.
        if changes.len() > 1
            && let Some((next, leaving)) = self.pivot_together(state, arriving, changes)
            && self.cosine(arriving, &leaving) > 0.0
        {
            *state = next;
            return Ok(leaving);
        }
        // What bears friction lets go of it as it opens: round-off alone says which of the two comes first.
        let companions = self.system.coupled(changes[0].constraint);
        let group = changes.iter().take_while(|change| companions.contains(&change.constraint));
        let group = group.count();
        changes[..group].sort_by_key(|change| change.constraint);
        let mut found: Option<Resolved<S::Mode>> = None;
        let mut failure = Termination::Singular;
        let before = self.is_positive;
        // Of changes that happen at once one may turn the path round, as a corner that closes where another lets go: only then is it asked
        // what comes of beginning with another of them.
        for change in changes.clone() {
            for (from, first) in self.starts(state, changes, change) {
                self.is_positive = before;
                match self.pivot_from(from, Some(first), arriving, changes.len() == 1) {
                    Err(stop) => failure = stop,
                    Ok(way) => found = Some(self.better_way(found, way, before)),
                }
            }
            if found.as_ref().is_some_and(|way| way.along > 0.0) {
                break;
            }
        }
        let Resolved { state: next, leaving, changes: made, is_positive, along } =
            found.ok_or(failure)?;
        if along < 0.0 && !self.system.monotone().is_empty() {
            self.reversals += 1;
            if self.reversals > MOST_REVERSALS {
                return Err(Termination::Jumps);
            }
        }
        (*state, *changes, self.is_positive) = (next, made, is_positive);
        Ok(leaving)
    }

    /// Of two ways on the one that keeps the orientation, or else turns less.
    fn better_way(
        &mut self,
        found: Option<Resolved<S::Mode>>,
        other: Resolved<S::Mode>,
        is_positive: bool,
    ) -> Resolved<S::Mode> {
        let Some(found) = found else { return other };
        self.is_unique &= self.cosine(&found.leaving, &other.leaving) > 1.0 - SAME_WAY;
        let worth = |way: &Resolved<S::Mode>| (way.is_positive == is_positive, way.along);
        if worth(&found) < worth(&other) { other } else { found }
    }

    /// Turns the path back where it stands: what slides sticks, the load falls, and the path ends where that comes to zero.
    pub fn turn_back(&mut self) {
        let mut state = self.point.state.clone();
        self.system.stop_sliding(&mut state);
        self.is_back = true;
        self.pushes = Some(state.z[self.system.load()].signum());
        let back: Vec<f64> = self.point.arriving.iter().map(|rate| -rate).collect();
        // Everything may change that is at its limit, such as what falls faster than what it bears.
        let meeting = (0..self.guards.len()).collect();
        let first = Pivoted { state, meeting, made: Vec::new(), holds: None, turns_back: true };
        let resolved = self.pivot_from(first, None, &back, false);
        self.termination = resolved.as_ref().err().copied();
        if let Ok(Resolved { state, leaving, is_positive, .. }) = resolved {
            self.is_positive = is_positive;
            self.begin(Equilibrium { state, arriving: leaving.clone(), leaving, event: None });
        }
    }

    /// Where pivoting may begin: with the change of the event, or behind it with one of a companion which it leaves undecided. What
    /// closes with friction may stick, or slip either way, and another beginning may come to another end.
    fn starts(
        &self,
        state: &State<S::Mode>,
        changes: &[Change],
        change: Change,
    ) -> Vec<(Pivoted<S::Mode>, Change)> {
        let meeting = self.meeting(changes.iter().map(|change| change.constraint));
        let (state, made) = (state.clone(), Vec::new());
        let before = Pivoted { state, meeting, made, holds: None, turns_back: false };
        let mut starts = Vec::new();
        let companions = self.system.coupled(change.constraint);
        if companions.len() > 1
            && let Ok(after) = self.pivoted(&before, change)
        {
            let guards = Newton::guards(&self.system, &after.state);
            let is_undecided = |&c: &usize| {
                c != change.constraint && Some(c) != after.holds && guards[c].abs() <= FLOOR
            };
            starts.extend(companions.filter(is_undecided).map(|constraint| {
                let activated = !after.state.active[constraint];
                (after.clone(), Change { constraint, activated })
            }));
        }
        starts.insert(0, (before, change));
        starts
    }

    /// Stops what only grows where it turns back. Its rate vanishes there, so the path goes on as it came: on both sides of the event
    /// the direction is the same, and the condition of the constraint, whose slope is zero along it, says nothing about its sign.
    fn end_growth(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        change: Change,
    ) -> Result<Vec<f64>, Termination> {
        // No complementarity problem is left to solve: a rate of zero satisfies both sides.
        let valid = self.pivot(state, change).ok_or(Termination::Singular)?;
        let controls = self.system.controls();
        let row = controls.iter().map(|c| (c.index, arriving[c.index] / c.scale.powi(2))).collect();
        let condition = Condition::through(row, &state.z);
        let direction = self.newton.solve(&self.system, state, &condition, &self.settings)?;
        let direction = self.normalised(direction);
        if guard_slope(&self.system, state, valid, &direction) >= -NO_RATE {
            return Ok(direction);
        }
        // All controls turn back with it, as if at a kink, and do not tell which way the path goes.
        let direction = opposite(direction);
        self.is_positive = self.newton.is_positive(&condition, &direction);
        Ok(direction)
    }

    /// State and direction after all of `changes`. `None` if the direction violates one of them.
    fn pivot_together(
        &mut self,
        state: &State<S::Mode>,
        arriving: &[f64],
        changes: &[Change],
    ) -> Option<(State<S::Mode>, Vec<f64>)> {
        let mut next = state.clone();
        let valid: Option<Vec<usize>> =
            changes.iter().map(|&change| self.pivot(&mut next, change)).collect();
        let valid = valid?;
        let leaving = self.direction(&mut next, arriving, valid.first().copied()).ok()?;
        // All of them happen here, so that each has to hold from here on. Two corners that come to the ends of their edges within round-off
        // hold each other by stiff contacts, if both change: what was round-off of a place is a force, which falls.
        let falls = |&c: &usize| guard_slope(&self.system, &next, c, &leaving) < -FLOOR;
        if valid.iter().any(falls) {
            return None;
        }
        let meeting = self.meeting(valid);
        self.violated(&next, &leaving, &meeting).is_empty().then_some((next, leaving))
    }

    /// Tries one set of changes after the other, beginning with those of a state and one more: while the direction violates one of the
    /// constraints that meet, the one that it violates fastest changes. A constraint that has changed sides may have to change back; where
    /// that leads to a set of changes that has been tried, others that are violated change instead. `is_single` tells of an event that is
    /// one change.
    fn pivot_from(
        &mut self,
        first: Pivoted<S::Mode>,
        change: Option<Change>,
        arriving: &[f64],
        is_single: bool,
    ) -> Result<Resolved<S::Mode>, Termination> {
        let mut waiting = vec![(first, change)];
        let mut tried = Vec::new();
        let has_companions =
            (0..self.guards.len()).any(|other| self.system.coupled(other).len() > 1);
        let mut failure = if has_companions { Termination::Jumps } else { Termination::Cycling };
        while let Some((from, change)) = waiting.pop() {
            if tried.len() >= self.most_changes(has_companions) {
                break;
            }
            let pivoted = match change {
                Some(change) => self.pivoted(&from, change),
                None => Ok(from),
            };
            let way = pivoted.and_then(|mut at| {
                let is_known = tried.iter().any(|(active, mode)| {
                    *active == at.state.active && self.system.is_same_form(mode, &at.state.mode)
                });
                if is_known {
                    return Err(Termination::Cycling);
                }
                tried.push((at.state.active.clone(), at.state.mode.clone()));
                let leaving = self.direction(&mut at.state, arriving, at.holds)?;
                Ok((at, leaving))
            });
            let (at, leaving) = match way {
                Ok(way) => way,
                // Without companions there is one way to go on, and it has failed.
                Err(stop) if is_single && !has_companions => return Err(stop),
                Err(Termination::NoConvergence) => {
                    failure = Termination::NoConvergence;
                    continue;
                }
                Err(_) => continue,
            };
            let violated = self.violated(&at.state, &leaving, &at.meeting);
            if violated.is_empty() {
                let (along, is_positive) = (self.cosine(arriving, &leaving), self.is_positive);
                // Where all changes are undone the way back is none on.
                if at.made.is_empty() && along < 0.0 && change.is_some() {
                    continue;
                }
                let Pivoted { state, made: changes, .. } = at;
                return Ok(Resolved { state, leaving, changes, is_positive, along });
            }
            let next = violated
                .into_iter()
                .map(|constraint| Change { constraint, activated: !at.state.active[constraint] });
            // The one that is violated fastest is tried next.
            waiting.extend(next.rev().map(|change| (at.clone(), Some(change))));
        }
        Err(failure)
    }

    /// What one change more makes of a set of changes.
    fn pivoted(
        &self,
        from: &Pivoted<S::Mode>,
        change: Change,
    ) -> Result<Pivoted<S::Mode>, Termination> {
        let mut next = from.clone();
        let valid = self.pivot(&mut next.state, change).ok_or(Termination::Singular)?;
        // A transition may hand the condition on, from a corner to the edge behind it, say.
        if !next.meeting.contains(&valid) {
            next.meeting.extend(self.system.coupled(valid));
        }
        toggle(&mut next.made, change);
        // What changes elsewhere because of friction does not tell which way the path goes: that is said by what has happened.
        let companions = self.system.coupled(change.constraint);
        let is_elsewhere = |holds: &usize| companions.len() > 1 && !companions.contains(holds);
        next.holds = next.holds.filter(is_elsewhere).or(Some(valid)).filter(|_| !next.turns_back);
        Ok(next)
    }

    /// The constraints that may change sides where these do.
    fn meeting(&self, changes: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut meeting: Vec<usize> = Vec::new();
        for change in changes {
            if !meeting.contains(&change) {
                meeting.extend(self.system.coupled(change));
            }
        }
        meeting
    }

    /// Lets a constraint change sides. Returns the one whose condition has to hold as the path goes on, or `None` if the
    /// mode does not allow the change.
    fn pivot(&self, state: &mut State<S::Mode>, change: Change) -> Option<usize> {
        state.active[change.constraint] = change.activated;
        state.z[self.system.constraints()[change.constraint]] = 0.0;
        self.system.transition(state, change)
    }

    /// The direction in which a constraint that has just changed sides stays valid, or without one that along `arriving`. A transition may
    /// have disturbed the equilibrium; it is restored first.
    fn direction(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        valid: Option<usize>,
    ) -> Result<Vec<f64>, Termination> {
        let mut failure = Termination::Singular;
        // A corner that closes may turn the path so far that it goes on at right angles to the direction in which it
        // came; then one of the controls alone still grows.
        for condition in self.measures(state, arriving) {
            let mut trial = state.clone();
            let solved = self.newton.solve(&self.system, &mut trial, &condition, &self.settings);
            let Ok(direction) = solved else { continue };
            let mut direction = self.normalised(direction);
            let slope =
                valid.map_or(1.0, |valid| guard_slope(&self.system, &trial, valid, &direction));
            // At a slope of zero neither sign of the direction is the valid one.
            if slope == 0.0 || !direction.iter().all(|x| x.is_finite()) {
                continue;
            }
            let vanishes = |valid: usize| {
                guard(&self.system, &trial, valid).abs() <= ELSEWHERE * (1.0 + slope.abs())
            };
            if !valid.is_none_or(vanishes) {
                failure = Termination::NoConvergence;
                continue;
            }
            if slope < 0.0 {
                direction = opposite(direction);
            }
            // Here alone the sign of (N7) may be another: the equations behind the event are others.
            self.is_positive = self.newton.is_positive(&condition, &direction);
            *state = trial;
            return Ok(direction);
        }
        Err(failure)
    }

    /// Ways to measure distance along the path, the likeliest to increase first.
    fn measures(&self, state: &State<S::Mode>, direction: &[f64]) -> Vec<Condition> {
        let controls = self.system.controls();
        let arc =
            controls.iter().map(|c| (c.index, direction[c.index] / c.scale.powi(2))).collect();
        let single = controls.iter().map(|c| vec![(c.index, 1.0 / c.scale)]);
        let rows = std::iter::once(arc).chain(single);
        rows.map(|row| Condition::through(row, &state.z)).collect()
    }

    /// The constraints that a direction violates, of those that it violates at no distance, the one that it violates fastest first.
    fn violated(
        &mut self,
        state: &State<S::Mode>,
        direction: &[f64],
        constraints: &[usize],
    ) -> Vec<usize> {
        let slopes =
            constraints.iter().map(|&c| (c, guard_slope(&self.system, state, c, direction)));
        let is_violated = |&(c, slope): &(usize, f64)| {
            slope < -FLOOR && guard(&self.system, state, c) <= -slope * APART
        };
        let meeting = slopes.filter(is_violated);
        // What only grows may not turn back at a kink either, however far it has come.
        let growing = self.system.monotone().iter().filter(|&&c| state.active[c]);
        let growing = growing.map(|&c| (c, direction[self.system.constraints()[c]]));
        let turned = growing.filter(|&(_, rate)| rate < -FLOOR);
        let mut violated: Vec<(usize, f64)> = meeting.chain(turned).collect();
        violated.sort_by(|a, b| a.1.total_cmp(&b.1));
        violated.dedup_by_key(|(constraint, _)| *constraint);
        violated.into_iter().map(|(constraint, _)| constraint).collect()
    }

    /// More pivots than this do not happen at one place.
    fn most_changes(&self, has_companions: bool) -> usize {
        // Each constraint may change and change back; the rest is for rows of a few scales. With friction sets of changes form a tree,
        // whose ways on are found within some dozens if there are any.
        let most = 2 * self.guards.len() + 8;
        if has_companions { most.min(MOST_WITH_FRICTION) } else { most }
    }
}

/// A state at an event after some changes.
#[derive(Clone)]
struct Pivoted<M> {
    state: State<M>,
    /// The constraints that may be violated there.
    meeting: Vec<usize>,
    /// The changes made so far.
    made: Vec<Change>,
    /// The constraint that has to hold as the path goes on.
    holds: Option<usize>,
    /// Whether the path turns back, so that it is its direction that is given, and no constraint.
    turns_back: bool,
}

/// A way on from an event.
struct Resolved<M> {
    state: State<M>,
    leaving: Vec<f64>,
    /// The constraints that have changed sides.
    changes: Vec<Change>,
    /// The orientation (N7) behind the event.
    is_positive: bool,
    /// Cosine of the angle by which the path turns.
    along: f64,
}

fn opposite(direction: Vec<f64>) -> Vec<f64> {
    direction.into_iter().map(|x| -x).collect()
}

/// Adds a change to those made, or takes away the one that it undoes.
fn toggle(changes: &mut Vec<Change>, change: Change) {
    match changes.iter().position(|made| made.constraint == change.constraint) {
        Some(undone) => drop(changes.remove(undone)),
        None => changes.push(change),
    }
}
