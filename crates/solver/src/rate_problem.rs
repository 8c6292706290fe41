//! The rate complementarity problem: which way the path goes on where constraints change sides.

use crate::event::Change;
use crate::newton::{Condition, FLOOR, Newton, guard_slope};
use crate::path::Path;
use crate::stop::Stop;
use crate::system::{State, System};

/// Events at least this far apart happen one after the other: where edges are nearly parallel forces
/// change by 10⁵ over a unit of the path, and not even a short way may be skipped.
const APART: f64 = 1e-10;

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
impl<S: System> Path<S> {
    /// Lets constraints change sides in `state`, an equilibrium in which the path arrives along `arriving`, and returns the
    /// direction in which it goes on. `changes` are the constraints that are about to change sides, the first of them for
    /// certain; they are replaced by those that have.
    ///
    /// # Errors
    /// [`Stop::Singular`] if there is no single direction, [`Stop::Cycling`] if no set of changes makes all valid.
    pub(crate) fn resolve_event(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        changes: &mut Vec<Change>,
    ) -> Result<Vec<f64>, Stop> {
        if let [change] = changes[..]
            && !change.activated
            && self.system.growing().contains(&change.constraint)
        {
            return self.stop_growing(state, arriving, change);
        }
        // Symmetric rows close two contacts at once. One after the other would leave the symmetric path at its first
        // event.
        if changes.len() > 1
            && let Some((next, leaving)) = self.pivot_together(state, arriving, changes)
        {
            *state = next;
            return Ok(leaving);
        }
        let mut found: Option<Resolved<S::Mode>> = None;
        let mut failure = Stop::Singular;
        let before = self.is_positive;
        for start in self.starts(state, changes[0]) {
            self.is_positive = before;
            match self.pivot_in_turn(state, arriving, changes, &start) {
                Err(stop) => failure = stop,
                Ok(resolved) => {
                    let worth = |way: &Resolved<S::Mode>| (way.is_positive == before, way.along);
                    if found.as_ref().is_none_or(|best| worth(best) < worth(&resolved)) {
                        found = Some(resolved);
                    }
                }
            }
        }
        let Resolved { state: next, leaving, changes: made, is_positive, .. } =
            found.ok_or(failure)?;
        (*state, *changes, self.is_positive) = (next, made, is_positive);
        Ok(leaving)
    }

    /// The changes with which pivoting may begin: that of the event, or that and one of a companion which it leaves undecided. What
    /// closes with friction may stick, or slip either way, and another beginning may come to another end.
    fn starts(&self, state: &State<S::Mode>, change: Change) -> Vec<Vec<Change>> {
        let mut starts = vec![vec![change]];
        let companions = self.system.companions(change.constraint);
        let mut after = state.clone();
        if companions.len() > 1
            && let Some(valid) = self.pivot(&mut after, change)
        {
            let guards = Newton::guards(&self.system, &after);
            let is_undecided = |c: &usize| {
                *c != change.constraint && *c != valid && guards[*c].abs() <= FLOOR
            };
            starts.extend(companions.filter(is_undecided).map(|constraint| {
                vec![change, Change { constraint, activated: !after.active[constraint] }]
            }));
        }
        starts
    }

    /// Stops what only grows where it turns back. Its rate vanishes there, so the path goes on as it came: on both sides of the event
    /// the direction is the same, and the condition of the constraint, whose slope is zero along it, says nothing about its sign.
    fn stop_growing(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        change: Change,
    ) -> Result<Vec<f64>, Stop> {
        // No complementarity problem is left to solve: a rate of zero satisfies both sides.
        self.pivot(state, change).ok_or(Stop::Singular)?;
        let controls = self.system.controls();
        let row = controls.iter().map(|c| (c.index, arriving[c.index] / c.scale.powi(2))).collect();
        let condition = Condition::through(row, &state.z);
        let direction = self.newton.solve(&self.system, state, &condition, &self.settings)?;
        Ok(self.normalised(direction))
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
        let leaving = self.direction(&mut next, arriving, valid[0]).ok()?;
        let meeting = self.meeting(valid);
        self.most_violated(&next, &leaving, &meeting).is_none().then_some((next, leaving))
    }

    /// Lets the changes of `start` happen and then, while the direction violates one of the constraints that meet, the one
    /// that it violates fastest. A constraint that has changed sides may have to change back.
    fn pivot_in_turn(
        &mut self,
        state: &State<S::Mode>,
        arriving: &[f64],
        changes: &[Change],
        start: &[Change],
    ) -> Result<Resolved<S::Mode>, Stop> {
        let mut state = state.clone();
        let mut meeting = self.meeting(changes.iter().map(|change| change.constraint));
        let mut made = Vec::new();
        let mut waiting = start.iter().copied();
        let mut next = waiting.next().ok_or(Stop::Singular)?;
        for _ in 0..self.most_changes() {
            let valid = self.pivot(&mut state, next).ok_or(Stop::Singular)?;
            // A transition may hand the condition on, from a corner to the edge behind it, say.
            if !meeting.contains(&valid) {
                meeting.extend(self.system.companions(valid));
            }
            toggle(&mut made, next);
            if let Some(change) = waiting.next() {
                next = change;
                continue;
            }
            let leaving = self.direction(&mut state, arriving, valid)?;
            let Some(constraint) = self.most_violated(&state, &leaving, &meeting) else {
                let along = self.cosine(arriving, &leaving);
                let is_positive = self.is_positive;
                return Ok(Resolved { state, leaving, changes: made, is_positive, along });
            };
            next = Change { constraint, activated: !state.active[constraint] };
        }
        Err(Stop::Cycling)
    }

    /// The constraints that may change sides where these do.
    fn meeting(&self, changes: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut meeting: Vec<usize> = Vec::new();
        for change in changes {
            if !meeting.contains(&change) {
                meeting.extend(self.system.companions(change));
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

    /// The direction in which a constraint that has just changed sides stays valid. A transition may have disturbed
    /// the equilibrium; it is restored first.
    fn direction(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        valid: usize,
    ) -> Result<Vec<f64>, Stop> {
        // A corner that closes may turn the path so far that it goes on at right angles to the direction in which it
        // came; then one of the controls alone still grows.
        for condition in self.measures(state, arriving) {
            let mut trial = state.clone();
            let solved = self.newton.solve(&self.system, &mut trial, &condition, &self.settings);
            let Ok(direction) = solved else { continue };
            let mut direction = self.normalised(direction);
            let slope = guard_slope(&self.system, &trial, valid, &direction);
            // At a slope of zero neither sign of the direction is the valid one.
            if slope == 0.0 || !direction.iter().all(|x| x.is_finite()) {
                continue;
            }
            if slope < 0.0 {
                direction = direction.into_iter().map(|x| -x).collect();
            }
            // Here alone the sign of (N7) may be another: the equations behind the event are others.
            self.is_positive = self.newton.is_positive(&condition, &direction);
            *state = trial;
            return Ok(direction);
        }
        Err(Stop::Singular)
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

    /// The constraint that a direction violates fastest, of those that it violates at no distance.
    fn most_violated(
        &mut self,
        state: &State<S::Mode>,
        direction: &[f64],
        constraints: &[usize],
    ) -> Option<usize> {
        let guards = Newton::guards(&self.system, state);
        let slopes =
            constraints.iter().map(|&c| (c, guard_slope(&self.system, state, c, direction)));
        let meeting = slopes.filter(|&(c, slope)| slope < -FLOOR && guards[c] <= -slope * APART);
        // What only grows may not turn back at a kink either, however far it has come.
        let growing = self.system.growing().iter().filter(|&&c| state.active[c]);
        let growing = growing.map(|&c| (c, direction[self.system.constraints()[c]]));
        let turned = growing.filter(|&(_, rate)| rate < -FLOOR);
        meeting.chain(turned).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(c, _)| c)
    }

    /// More pivots than this do not happen at one place.
    fn most_changes(&self) -> usize {
        // Each constraint may change and change back; the rest is for rows of a few scales.
        2 * self.guards.len() + 8
    }
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

/// Adds a change to those made, or takes away the one that it undoes.
fn toggle(changes: &mut Vec<Change>, change: Change) {
    match changes.iter().position(|made| made.constraint == change.constraint) {
        Some(undone) => drop(changes.remove(undone)),
        None => changes.push(change),
    }
}
