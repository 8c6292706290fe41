//! Rate complementarity problem: the outgoing branch of the path at an event.

use crate::continuation::{Continuation, Equilibrium};
use crate::event::Change;
use crate::event_location::{ELSEWHERE, NO_RATE};
use crate::newton::{Condition, FLOOR, Newton, guard, guard_slope};
use crate::system::{State, System};
use crate::termination::Termination;

/// Distance along the path below which two events coincide.
///
/// Between nearly parallel edges, forces change by 10⁵ over a unit of the path, so even short
/// segments between events must be followed.
const APART: f64 = 1e-10;

/// Two directions are the same branch if their cosine differs from 1 by less.
const SAME_BRANCH: f64 = 1e-6;

/// Largest number of active sets evaluated at an event of a coupled system.
const MOST_WITH_FRICTION: usize = 500;

/// Largest number of reversals before the path is abandoned.
///
/// Reversals count from the last maximum of the control parameter. Known solvable paths need at
/// most two.
const MOST_REVERSALS: usize = 20;

/// Selects the outgoing branch at an event.
///
/// At an event the path has a direction `ż` on each side. Some of the constraints that meet there
/// have both `z_c = 0` and `r_c(z) = 0`. The outgoing direction solves the complementarity problem
/// of the rates,
///
/// ```text
/// ∂r_i/∂z ż = 0     for every equation and every constraint that stays active,
/// ż_c = 0           for every constraint that stays inactive,
/// 0 ≤ ż_c  ⟂  ∂r_c/∂z ż ≥ 0     for those that meet,                                  (N6)
/// ```
///
/// in the mode after the event. The solver uses principal pivoting (Cottle, Pang & Stone 2009,
/// *The Linear Complementarity Problem*, ch. 4, isbn 978-0-89871-686-3):
///
/// 1. A single monotone constraint that turns back needs no search (`end_growth`).
/// 2. Several changes are applied together first, as symmetry requires
///    (`pivot_together`).
/// 3. If the direction then violates one of them, `search_active_sets` changes one
///    constraint after the other, the most violated one first.
impl<S: System> Continuation<S> {
    /// Changes constraints in `state`, at an event, and returns the outgoing direction.
    ///
    /// `arriving` is the incoming direction. `changes` are the constraints about to change sides,
    /// the located one first; they are replaced by the actual changes.
    ///
    /// # Errors
    /// [`Termination::Singular`] if the direction is not unique, [`Termination::Cycling`] or, with
    /// coupled constraints, [`Termination::Jumps`] if every active set violates some constraint.
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
        // Symmetric rows close two contacts at once. Closing one after the other would leave the
        // symmetric path at its first event.
        if changes.len() > 1
            && let Some((next, leaving)) = self.pivot_together(state, arriving, changes)
            && self.cosine(arriving, &leaving) > 0.0
        {
            *state = next;
            return Ok(leaving);
        }
        let together = changes.clone();
        // Opening a contact also ends its stick-slip constraint. Both events coincide up to
        // round-off, so sort them.
        let coupled = self.system.coupled(changes[0].constraint);
        let group = changes.iter().take_while(|change| coupled.contains(&change.constraint));
        let group = group.count();
        changes[..group].sort_by_key(|change| change.constraint);
        let branch = self.best_branch(state, arriving, changes);
        // The contacts of a symmetric row may open together where their corners are at the ends of
        // their edges. An open contact has no such end, so its other change is void.
        if together.len() > 1
            && branch.as_ref().map_or(true, |branch| branch.along < 0.0)
            && let Some(opened) = self.open_together(state, arriving, &together)
        {
            (*state, *changes, self.is_positive) =
                (opened.state, opened.changes, opened.is_positive);
            return Ok(opened.leaving);
        }
        let branch = branch?;
        if branch.along < 0.0 && !self.system.monotone().is_empty() {
            self.reversals += 1;
            if self.reversals > MOST_REVERSALS {
                return Err(Termination::Jumps);
            }
        }
        (*state, *changes, self.is_positive) = (branch.state, branch.changes, branch.is_positive);
        Ok(branch.leaving)
    }

    /// Searches for an outgoing branch from each of the simultaneous changes in turn.
    ///
    /// Stops at the first change that yields a branch without reversal. A reversal may be an
    /// artefact of the order, for example if one corner closes while another opens, so the other
    /// changes are then tried as the first one too.
    fn best_branch(
        &mut self,
        state: &State<S::Mode>,
        arriving: &[f64],
        changes: &[Change],
    ) -> Result<OutgoingBranch<S::Mode>, Termination> {
        let is_single = changes.len() == 1;
        let is_positive = self.is_positive;
        let mut best: Option<OutgoingBranch<S::Mode>> = None;
        let mut failure = Termination::Singular;
        for &change in changes {
            for (from, first) in self.starts(state, changes, change) {
                self.is_positive = is_positive;
                match self.search_active_sets(from, Some(first), arriving, is_single) {
                    Err(termination) => failure = termination,
                    Ok(branch) => best = Some(self.better_branch(best, branch, is_positive)),
                }
            }
            if best.as_ref().is_some_and(|branch| branch.along > 0.0) {
                break;
            }
        }
        best.ok_or(failure)
    }

    /// Returns the branch that keeps the orientation, or else the one that turns less.
    fn better_branch(
        &mut self,
        best: Option<OutgoingBranch<S::Mode>>,
        other: OutgoingBranch<S::Mode>,
        is_positive: bool,
    ) -> OutgoingBranch<S::Mode> {
        let Some(best) = best else { return other };
        self.is_unique &= self.cosine(&best.leaving, &other.leaving) > 1.0 - SAME_BRANCH;
        let rank =
            |branch: &OutgoingBranch<S::Mode>| (branch.is_positive == is_positive, branch.along);
        if rank(&best) < rank(&other) { other } else { best }
    }

    /// Reverses the path at its current point, to follow unloading.
    ///
    /// Slipping contacts stick, the load decreases, and the path ends where the load vanishes.
    pub fn turn_back(&mut self) {
        let mut state = self.point.state.clone();
        self.system.stop_sliding(&mut state);
        self.is_back = true;
        self.pushes = Some(state.z[self.system.load()].signum());
        let back: Vec<f64> = self.point.arriving.iter().map(|rate| -rate).collect();
        // Any constraint at its limit may change, such as a friction force that falls more slowly
        // than the normal force.
        let meeting = (0..self.guards.len()).collect();
        let changes = Vec::new();
        let start =
            ActiveSetCandidate { state, meeting, changes, orienting: None, turns_back: true };
        let branch = self.search_active_sets(start, None, &back, false);
        self.termination = branch.as_ref().err().copied();
        if let Ok(OutgoingBranch { state, leaving, is_positive, .. }) = branch {
            self.is_positive = is_positive;
            self.restart_at(Equilibrium { state, arriving: leaving.clone(), leaving, event: None });
        }
    }

    /// Returns the starts of the search for one of the simultaneous changes.
    ///
    /// The first start is the change itself. Behind it, each coupled constraint that the change
    /// leaves undecided gives another start: a contact that closes with friction may stick or slip
    /// either way, and the search may end at a different branch.
    fn starts(
        &self,
        state: &State<S::Mode>,
        changes: &[Change],
        change: Change,
    ) -> Vec<(ActiveSetCandidate<S::Mode>, Change)> {
        let before = ActiveSetCandidate {
            state: state.clone(),
            meeting: self.meeting(changes.iter().map(|change| change.constraint)),
            changes: Vec::new(),
            orienting: None,
            turns_back: false,
        };
        let coupled = self.system.coupled(change.constraint);
        let after = (coupled.len() > 1).then(|| self.with_change(&before, change));
        let mut starts = vec![(before, change)];
        if let Some(Ok(after)) = after {
            let guards = Newton::guards(&self.system, &after.state);
            for constraint in coupled {
                let is_undecided = constraint != change.constraint
                    && Some(constraint) != after.orienting
                    && guards[constraint].abs() <= FLOOR;
                if is_undecided {
                    let activated = !after.state.active[constraint];
                    starts.push((after.clone(), Change { constraint, activated }));
                }
            }
        }
        starts
    }

    /// Ends the growth of a monotone unknown at the point where its rate vanishes.
    ///
    /// The rate vanishes on both sides, so the path continues in its incoming direction. The slope
    /// of the changed condition is zero along that direction and does not determine its sign.
    fn end_growth(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        change: Change,
    ) -> Result<Vec<f64>, Termination> {
        // A zero rate satisfies both sides of the complementarity, so no search is needed.
        let orienting = self.pivot(state, change).ok_or(Termination::Singular)?;
        let controls = self.system.controls();
        let row = controls.iter().map(|c| (c.index, arriving[c.index] / c.scale.powi(2))).collect();
        let condition = Condition::through(row, &state.z);
        let direction = self.newton.solve(&self.system, state, &condition, &self.settings)?;
        let direction = self.normalised(direction);
        if guard_slope(&self.system, state, orienting, &direction) >= -NO_RATE {
            return Ok(direction);
        }
        // The controls reverse together with the unknown, as at a kink, so the direction that they
        // orient points backwards.
        let direction = opposite(direction);
        self.is_positive = self.newton.is_positive(&condition, &direction);
        Ok(direction)
    }

    /// Applies deactivations, then the changes that remain possible, and keeps the direction.
    ///
    /// `None` if one of them is violated or the path reverses.
    fn open_together(
        &mut self,
        state: &State<S::Mode>,
        arriving: &[f64],
        changes: &[Change],
    ) -> Option<OutgoingBranch<S::Mode>> {
        let mut opened = state.clone();
        let mut made = Vec::with_capacity(changes.len());
        for activated in [false, true] {
            for &change in changes.iter().filter(|change| change.activated == activated) {
                let mut next = opened.clone();
                if self.pivot(&mut next, change).is_some() {
                    opened = next;
                    made.push(change);
                }
            }
        }
        let (state, leaving) = self.pivot_together(state, arriving, &made)?;
        let (along, is_positive) = (self.cosine(arriving, &leaving), self.is_positive);
        let branch = OutgoingBranch { state, leaving, changes: made, is_positive, along };
        Some(branch).filter(|branch| branch.along > 0.0)
    }

    /// Applies all `changes` and returns state and direction.
    ///
    /// `None` if a change is violated.
    fn pivot_together(
        &mut self,
        state: &State<S::Mode>,
        arriving: &[f64],
        changes: &[Change],
    ) -> Option<(State<S::Mode>, Vec<f64>)> {
        let mut next = state.clone();
        let mut valid = Vec::with_capacity(changes.len());
        for &change in changes {
            valid.push(self.pivot(&mut next, change)?);
        }
        let leaving = self.direction(&mut next, arriving, valid.first().copied()).ok()?;
        // Every change must be valid after the event, even if its guard is not zero.
        // Counterexample: two corners reach the ends of their edges within round-off. If both
        // change, stiff contacts turn this round-off into a decreasing force.
        for &constraint in &valid {
            if guard_slope(&self.system, &next, constraint, &leaving) < -FLOOR {
                return None;
            }
        }
        let meeting = self.meeting(valid);
        self.violated(&next, &leaving, &meeting).is_empty().then_some((next, leaving))
    }

    /// Searches depth-first for an active set with a valid outgoing direction.
    ///
    /// ```text
    /// start ─► take the next candidate ─► evaluate it ─► violated constraints?  none ─► branch
    ///                    ▲                                      │ some
    ///                    └── add one candidate for each, the most violated one next
    /// ```
    ///
    /// A changed constraint may change back. If that leads to an active set evaluated before, the
    /// search continues with the next violated constraint. `is_single` marks an event with a single
    /// change: without coupled constraints a failure then has no alternative.
    fn search_active_sets(
        &mut self,
        start: ActiveSetCandidate<S::Mode>,
        change: Option<Change>,
        arriving: &[f64],
        is_single: bool,
    ) -> Result<OutgoingBranch<S::Mode>, Termination> {
        let has_coupled =
            (0..self.guards.len()).any(|constraint| self.system.coupled(constraint).len() > 1);
        let limit = self.most_active_sets(has_coupled);
        let mut failure = if has_coupled { Termination::Jumps } else { Termination::Cycling };
        let mut evaluated = Vec::new();
        let mut stack = vec![(start, change)];
        while let Some((from, change)) = stack.pop() {
            if evaluated.len() >= limit {
                break;
            }
            let (candidate, leaving) = match self.evaluate(from, change, arriving, &mut evaluated) {
                Ok(solved) => solved,
                Err(termination) if is_single && !has_coupled => return Err(termination),
                Err(Termination::NoConvergence) => {
                    failure = Termination::NoConvergence;
                    continue;
                }
                Err(_) => continue,
            };
            let violated = self.violated(&candidate.state, &leaving, &candidate.meeting);
            if violated.is_empty() {
                let (along, is_positive) = (self.cosine(arriving, &leaving), self.is_positive);
                // With all changes undone, a reversed direction is the incoming path.
                if candidate.changes.is_empty() && along < 0.0 && change.is_some() {
                    continue;
                }
                let ActiveSetCandidate { state, changes, .. } = candidate;
                return Ok(OutgoingBranch { state, leaving, changes, is_positive, along });
            }
            // In reverse, so that the most violated constraint is on top of the stack.
            for constraint in violated.into_iter().rev() {
                let activated = !candidate.state.active[constraint];
                stack.push((candidate.clone(), Some(Change { constraint, activated })));
            }
        }
        Err(failure)
    }

    /// Applies a change to a candidate and solves for its outgoing direction.
    ///
    /// # Errors
    /// [`Termination::Cycling`] if this active set and mode are among those `evaluated` before, or
    /// the failure of the change or of the solve.
    fn evaluate(
        &mut self,
        from: ActiveSetCandidate<S::Mode>,
        change: Option<Change>,
        arriving: &[f64],
        evaluated: &mut Vec<(Vec<bool>, S::Mode)>,
    ) -> Result<(ActiveSetCandidate<S::Mode>, Vec<f64>), Termination> {
        let mut candidate = match change {
            Some(change) => self.with_change(&from, change)?,
            None => from,
        };
        let state = &mut candidate.state;
        let is_evaluated = evaluated.iter().any(|(active, mode)| {
            *active == state.active && self.system.is_same_form(mode, &state.mode)
        });
        if is_evaluated {
            return Err(Termination::Cycling);
        }
        evaluated.push((state.active.clone(), state.mode.clone()));
        let leaving = self.direction(state, arriving, candidate.orienting)?;
        Ok((candidate, leaving))
    }

    /// Returns a candidate with one more change.
    fn with_change(
        &self,
        from: &ActiveSetCandidate<S::Mode>,
        change: Change,
    ) -> Result<ActiveSetCandidate<S::Mode>, Termination> {
        let mut next = from.clone();
        let valid = self.pivot(&mut next.state, change).ok_or(Termination::Singular)?;
        // A transition may pass the condition on, for example from a corner to the next edge.
        if !next.meeting.contains(&valid) {
            next.meeting.extend(self.system.coupled(valid));
        }
        toggle(&mut next.changes, change);
        if next.turns_back {
            next.orienting = None;
            return Ok(next);
        }
        // A friction change at another contact is a consequence of the event and must not orient
        // the path: keep the constraint of the event itself.
        let coupled = self.system.coupled(change.constraint);
        next.orienting = next
            .orienting
            .filter(|orienting| coupled.len() > 1 && !coupled.contains(orienting))
            .or(Some(valid));
        Ok(next)
    }

    /// Returns the constraints that may change sides together with the given ones.
    fn meeting(&self, constraints: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut meeting: Vec<usize> = Vec::new();
        for constraint in constraints {
            if !meeting.contains(&constraint) {
                meeting.extend(self.system.coupled(constraint));
            }
        }
        meeting
    }

    /// Changes the side of a constraint.
    ///
    /// Returns the constraint with the condition that the outgoing path must satisfy, or `None` if
    /// the mode does not allow the change.
    fn pivot(&self, state: &mut State<S::Mode>, change: Change) -> Option<usize> {
        state.active[change.constraint] = change.activated;
        state.z[self.system.constraints()[change.constraint]] = 0.0;
        self.system.transition(state, change)
    }

    /// Restores equilibrium after a transition and solves for the outgoing direction.
    ///
    /// The guard of the `orienting` constraint increases along the direction. Without one, or with a
    /// neutral one, the direction follows `arriving`.
    fn direction(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        orienting: Option<usize>,
    ) -> Result<Vec<f64>, Termination> {
        let mut failure = Termination::Singular;
        let orienting = orienting.filter(|&number| !self.system.is_neutral(state, number));
        // A corner that closes may turn the path by a right angle. Then the arc length is constant
        // to first order, and only one of the controls still grows.
        for condition in self.measures(state, arriving) {
            let mut trial = state.clone();
            let solved = self.newton.solve(&self.system, &mut trial, &condition, &self.settings);
            let Ok(direction) = solved else { continue };
            let mut direction = self.normalised(direction);
            let slope = orienting.map_or(1.0, |c| guard_slope(&self.system, &trial, c, &direction));
            // A zero slope does not determine the sign of the direction.
            if slope == 0.0 || !direction.iter().all(|x| x.is_finite()) {
                continue;
            }
            let is_near = orienting.is_none_or(|constraint| {
                guard(&self.system, &trial, constraint).abs() <= ELSEWHERE * (1.0 + slope.abs())
            });
            if !is_near {
                failure = Termination::NoConvergence;
                continue;
            }
            if slope < 0.0 {
                direction = opposite(direction);
            }
            if self.is_elsewhere(&trial, &direction) {
                failure = Termination::NoConvergence;
                continue;
            }
            // The equations change at an event, the only point where the sign of (N7) may change.
            self.is_positive = self.newton.is_positive(&condition, &direction);
            *state = trial;
            return Ok(direction);
        }
        Err(failure)
    }

    /// Returns true if an equilibrium violates an active constraint by more than round-off.
    fn is_elsewhere(&self, state: &State<S::Mode>, direction: &[f64]) -> bool {
        // Inactive constraints need the geometry of all contacts, so the next step checks them.
        let constraints = self.system.constraints().iter().zip(&state.active);
        let mut active = constraints.filter(|(_, active)| **active);
        active.any(|(&index, _)| state.z[index] < -ELSEWHERE * (1.0 + direction[index].abs()))
    }

    /// Returns measures of distance along the path, the most likely to increase first.
    fn measures(&self, state: &State<S::Mode>, direction: &[f64]) -> Vec<Condition> {
        let controls = self.system.controls();
        let arc =
            controls.iter().map(|c| (c.index, direction[c.index] / c.scale.powi(2))).collect();
        let single = controls.iter().map(|c| vec![(c.index, 1.0 / c.scale)]);
        let rows = std::iter::once(arc).chain(single);
        rows.map(|row| Condition::through(row, &state.z)).collect()
    }

    /// Returns the constraints that a direction violates at once, most violated first.
    ///
    /// Checks the given constraints and all active monotone ones.
    fn violated(
        &mut self,
        state: &State<S::Mode>,
        direction: &[f64],
        constraints: &[usize],
    ) -> Vec<usize> {
        let mut violated: Vec<(usize, f64)> = Vec::new();
        for &constraint in constraints {
            let slope = guard_slope(&self.system, state, constraint, direction);
            if slope < -FLOOR && guard(&self.system, state, constraint) <= -slope * APART {
                violated.push((constraint, slope));
            }
        }
        // A monotone unknown must not decrease after a kink, even if it is not zero.
        for &constraint in self.system.monotone() {
            let rate = direction[self.system.constraints()[constraint]];
            if state.active[constraint] && rate < -FLOOR {
                violated.push((constraint, rate));
            }
        }
        violated.sort_by(|a, b| a.1.total_cmp(&b.1));
        violated.dedup_by_key(|(constraint, _)| *constraint);
        violated.into_iter().map(|(constraint, _)| constraint).collect()
    }

    /// Returns the largest number of active sets to evaluate at an event.
    fn most_active_sets(&self, has_coupled: bool) -> usize {
        // Each constraint may change and change back; the constant allows for short rows. Coupled
        // constraints make the search a tree, in which solvable events need some dozens of sets.
        let most = 2 * self.guards.len() + 8;
        if has_coupled { most.min(MOST_WITH_FRICTION) } else { most }
    }
}

/// State at an event after changes of some constraints.
#[derive(Clone)]
struct ActiveSetCandidate<M> {
    state: State<M>,
    /// Constraints that may be violated at the event.
    meeting: Vec<usize>,
    /// Changes made so far.
    changes: Vec<Change>,
    /// Constraint with a guard that must increase along the outgoing direction.
    orienting: Option<usize>,
    /// True if the path is turned back.
    ///
    /// Its direction is then given and no constraint orients it.
    turns_back: bool,
}

/// Outgoing branch at an event.
struct OutgoingBranch<M> {
    state: State<M>,
    leaving: Vec<f64>,
    /// Constraints that have changed sides.
    changes: Vec<Change>,
    /// Orientation (N7) after the event.
    is_positive: bool,
    /// Cosine of the angle by which the path turns.
    along: f64,
}

/// Returns the reversed direction.
fn opposite(direction: Vec<f64>) -> Vec<f64> {
    direction.into_iter().map(|x| -x).collect()
}

/// Adds a change, or removes the earlier change that it undoes.
///
/// Both belong to the same constraint.
fn toggle(changes: &mut Vec<Change>, change: Change) {
    match changes.iter().position(|earlier| earlier.constraint == change.constraint) {
        Some(undone) => drop(changes.remove(undone)),
        None => changes.push(change),
    }
}
