//! Choice of the outgoing branch at an event by solving the rate complementarity problem.

use crate::continuation::{Continuation, Equilibrium};
use crate::event::Change;
use crate::event_location::{ELSEWHERE, NO_RATE};
use crate::newton::{Condition, FLOOR, Newton, guard, guard_slope};
use crate::system::{State, System};
use crate::termination::Termination;

/// Distance along the path below which two events coincide.
///
/// The distance is small because forces between nearly parallel edges change by 10⁵ per unit of the
/// path, so the path must be followed also between close events.
const APART: f64 = 1e-10;

/// Largest difference from 1 of the cosine of the angle between directions of the same branch.
const SAME_BRANCH: f64 = 1e-6;

/// Largest number of active sets evaluated at an event if constraints are coupled by friction.
const MOST_WITH_FRICTION: usize = 500;

/// Largest number of reversals at events before the path is abandoned.
///
/// The count starts at the last maximum of the control parameter. Known solvable paths need at most
/// two reversals.
const MOST_REVERSALS: usize = 20;

/// Choice of the outgoing branch at an event.
///
/// At an event the path has an incoming and an outgoing direction `ż`. A constraint is
/// *undecided* if both `z_c = 0` and `r_c(z) = 0` there, so that it may become active or inactive.
/// The outgoing direction solves the complementarity problem of the rates
///
/// ```text
/// ∂r_i/∂z ż = 0     for every equation and every other active constraint,
/// ż_c = 0           for every other inactive constraint,
/// 0 ≤ ż_c  ⟂  ∂r_c/∂z ż ≥ 0     for the undecided constraints                        (N6)
/// ```
///
/// in the mode after the event. The solver uses principal pivoting (Cottle, Pang & Stone 2009,
/// *The Linear Complementarity Problem*, ch. 4, isbn 978-0-89871-686-3):
///
/// 1. If the unknown of a single monotone constraint stops growing, no search is needed
///    (`end_growth`).
/// 2. Several changes are first applied together, as symmetry requires (`pivot_together`).
/// 3. If the resulting direction violates a changed constraint, `search_active_sets` changes one
///    constraint after the other, the most violated constraint first.
impl<S: System> Continuation<S> {
    /// Changes the constraints of `state` at an event and returns the outgoing direction.
    ///
    /// `arriving` is the incoming direction. `changes` are the changes expected at the event, with
    /// the located change first; they are replaced by the actual changes.
    ///
    /// # Errors
    /// [`Termination::Singular`] if the direction is not unique. If every evaluated active set
    /// violates some constraint, [`Termination::Jumps`] with coupled constraints, else
    /// [`Termination::Cycling`].
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
        // In a symmetric row two contacts close at once. If they closed one after the other, the
        // path would lose its symmetry.
        if changes.len() > 1
            && let Some((next, leaving)) = self.pivot_together(state, arriving, changes)
            && self.cosine(arriving, &leaving) > 0.0
        {
            *state = next;
            return Ok(leaving);
        }
        let together = changes.clone();
        // The opening of a contact also ends its stick-slip constraint. Both events coincide up to
        // round-off, so their order is set by the number of the constraint.
        let coupled = self.system.coupled(changes[0].constraint);
        let group = changes.iter().take_while(|change| coupled.contains(&change.constraint));
        let group = group.count();
        changes[..group].sort_by_key(|change| change.constraint);
        let branch = self.best_branch(state, arriving, changes);
        // In a symmetric row several contacts may open at once while their corners are at the ends
        // of their edges. Only the opening is then applied, because an open contact has no corner.
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

    /// Returns the best outgoing branch of searches that start with one of the given changes.
    ///
    /// Stops at the first change that leads to a branch without reversal. A reversal may be an
    /// artefact of the order of the changes, for example if one contact closes while another one
    /// opens. In this case the search also starts with each of the other changes.
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

    /// Returns the better of two branches, and sets `is_unique` to false if the branches differ.
    ///
    /// A branch with the orientation `is_positive` is better than a branch with the other one. If
    /// both orientations are equal, the branch that turns by the smaller angle is better.
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

    /// Reverses the path at its current point to follow unloading.
    ///
    /// All slipping contacts stick, and the path continues in the direction of decreasing load. It
    /// ends where the load is zero.
    pub fn turn_back(&mut self) {
        let mut state = self.point.state.clone();
        self.system.stop_sliding(&mut state);
        self.is_back = true;
        self.pushes = Some(state.z[self.system.load()].signum());
        let back: Vec<f64> = self.point.arriving.iter().map(|rate| -rate).collect();
        // Every constraint with a zero guard may change. For example, a contact continues to slip
        // if its normal force decreases faster than its friction.
        let undecided = (0..self.guards.len()).collect();
        let changes = Vec::new();
        let start =
            ActiveSetCandidate { state, undecided, changes, orienting: None, turns_back: true };
        let branch = self.search_active_sets(start, None, &back, false);
        self.termination = branch.as_ref().err().copied();
        if let Ok(OutgoingBranch { state, leaving, is_positive, .. }) = branch {
            self.is_positive = is_positive;
            self.restart_at(Equilibrium { state, arriving: leaving.clone(), leaving, event: None });
        }
    }

    /// Returns the starting points of the search for one of the simultaneous changes.
    ///
    /// The first starting point is `change` itself. After `change`, other coupled constraints may
    /// have a zero guard, so that they may be active or inactive: a contact that closes with
    /// friction may stick or slip in either direction. Each such constraint is another starting
    /// point, because the search may end at a different branch.
    fn starts(
        &self,
        state: &State<S::Mode>,
        changes: &[Change],
        change: Change,
    ) -> Vec<(ActiveSetCandidate<S::Mode>, Change)> {
        let before = ActiveSetCandidate {
            state: state.clone(),
            undecided: self.undecided(changes.iter().map(|change| change.constraint)),
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

    /// Deactivates a monotone constraint at the point at which the rate of its unknown is zero.
    ///
    /// The rate is zero before and after the event, so the path continues in its incoming
    /// direction. The slope of the changed guard is zero along this direction, so it does not
    /// determine the sign of the direction.
    fn end_growth(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        change: Change,
    ) -> Result<Vec<f64>, Termination> {
        // With a zero rate, the constraint may be active or inactive in (N6), so no search is
        // needed.
        let orienting = self.pivot(state, change).ok_or(Termination::Singular)?;
        let controls = self.system.controls();
        let row = controls.iter().map(|c| (c.index, arriving[c.index] / c.scale.powi(2))).collect();
        let condition = Condition::through(row, &state.z);
        let direction = self.newton.solve(&self.system, state, &condition, &self.settings)?;
        let direction = self.normalised(direction);
        if guard_slope(&self.system, state, orienting, &direction) >= -NO_RATE {
            return Ok(direction);
        }
        // The controls reverse together with the unknown, as at a kink, so a direction along which
        // the controls continue points backwards.
        let direction = opposite(direction);
        self.is_positive = self.newton.is_positive(&condition, &direction);
        Ok(direction)
    }

    /// Applies all deactivations, then the other changes that are still possible.
    ///
    /// Returns the resulting branch, or `None` if it violates a change or reverses the path.
    fn open_together(
        &mut self,
        state: &State<S::Mode>,
        arriving: &[f64],
        changes: &[Change],
    ) -> Option<OutgoingBranch<S::Mode>> {
        let mut opened = state.clone();
        let mut applied = Vec::with_capacity(changes.len());
        for activated in [false, true] {
            for &change in changes.iter().filter(|change| change.activated == activated) {
                let mut next = opened.clone();
                if self.pivot(&mut next, change).is_some() {
                    opened = next;
                    applied.push(change);
                }
            }
        }
        let (state, leaving) = self.pivot_together(state, arriving, &applied)?;
        let (along, is_positive) = (self.cosine(arriving, &leaving), self.is_positive);
        let branch = OutgoingBranch { state, leaving, changes: applied, is_positive, along };
        Some(branch).filter(|branch| branch.along > 0.0)
    }

    /// Applies all `changes` and returns the resulting state and outgoing direction.
    ///
    /// `None` if the direction violates a changed constraint.
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
        // The guard of every changed constraint must increase after the event, even if it is not
        // zero. Counterexample: two corners reach the ends of their edges within round-off. If both
        // change, this round-off leads to a decreasing force, because the contacts are stiff.
        for &constraint in &valid {
            if guard_slope(&self.system, &next, constraint, &leaving) < -FLOOR {
                return None;
            }
        }
        let undecided = self.undecided(valid);
        self.violated(&next, &leaving, &undecided).is_empty().then_some((next, leaving))
    }

    /// Searches depth-first for an active set with a valid outgoing direction.
    ///
    /// ```text
    /// start ─► next candidate ─► evaluate direction ─► violated constraints?  none ─► branch
    ///                ▲                                        │ some
    ///                └── add one candidate for each, the most violated constraint next
    /// ```
    ///
    /// A changed constraint may change back. If this leads to an active set that has already been
    /// evaluated, the search continues with the next violated constraint. `is_single` is true at an
    /// event with a single change; without coupled constraints the first failure is then final.
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
            let violated = self.violated(&candidate.state, &leaving, &candidate.undecided);
            if violated.is_empty() {
                let (along, is_positive) = (self.cosine(arriving, &leaving), self.is_positive);
                // If all changes have been undone, a reversed direction is the incoming path.
                if candidate.changes.is_empty() && along < 0.0 && change.is_some() {
                    continue;
                }
                let ActiveSetCandidate { state, changes, .. } = candidate;
                return Ok(OutgoingBranch { state, leaving, changes, is_positive, along });
            }
            // Push in reverse order, so that the most violated constraint is on top of the stack.
            for constraint in violated.into_iter().rev() {
                let activated = !candidate.state.active[constraint];
                stack.push((candidate.clone(), Some(Change { constraint, activated })));
            }
        }
        Err(failure)
    }

    /// Applies a change to the candidate `from` and solves for its outgoing direction.
    ///
    /// # Errors
    /// [`Termination::Cycling`] if `evaluated` already contains the active set and form of the
    /// equations. Otherwise the failure of the change or of Newton's method.
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

    /// Returns the candidate `from` with one more change.
    ///
    /// # Errors
    /// If the mode does not allow the change.
    fn with_change(
        &self,
        from: &ActiveSetCandidate<S::Mode>,
        change: Change,
    ) -> Result<ActiveSetCandidate<S::Mode>, Termination> {
        let mut next = from.clone();
        let valid = self.pivot(&mut next.state, change).ok_or(Termination::Singular)?;
        // After a transition another constraint may limit the path, for example the contact with
        // the next edge after a contact between two corners.
        if !next.undecided.contains(&valid) {
            next.undecided.extend(self.system.coupled(valid));
        }
        toggle(&mut next.changes, change);
        if next.turns_back {
            next.orienting = None;
            return Ok(next);
        }
        // A change of friction at another contact is a consequence of the event and must not orient
        // the path. The constraint of the event itself remains the orienting one.
        let coupled = self.system.coupled(change.constraint);
        next.orienting = next
            .orienting
            .filter(|orienting| coupled.len() > 1 && !coupled.contains(orienting))
            .or(Some(valid));
        Ok(next)
    }

    /// Returns the given constraints and all constraints that are coupled with them.
    fn undecided(&self, constraints: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut undecided: Vec<usize> = Vec::new();
        for constraint in constraints {
            if !undecided.contains(&constraint) {
                undecided.extend(self.system.coupled(constraint));
            }
        }
        undecided
    }

    /// Applies a change to `state`.
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
    /// The guard of the constraint `orienting` increases along the direction. If `orienting` is
    /// `None` or neutral, the sign of the direction follows from `arriving`.
    fn direction(
        &mut self,
        state: &mut State<S::Mode>,
        arriving: &[f64],
        orienting: Option<usize>,
    ) -> Result<Vec<f64>, Termination> {
        let mut failure = Termination::Singular;
        let orienting = orienting.filter(|&number| !self.system.is_neutral(state, number));
        // At the closing of a contact the path may turn by a right angle. The arc length along
        // `arriving` is then constant to first order, and only a single control still changes.
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
            // The orientation (N7) is set here, because it may change only where the equations
            // change, at an event.
            self.is_positive = self.newton.is_positive(&condition, &direction);
            *state = trial;
            return Ok(direction);
        }
        Err(failure)
    }

    /// Returns true if Newton's method has converged to a different equilibrium.
    ///
    /// The criterion is the violation of an active constraint by more than [`ELSEWHERE`].
    fn is_elsewhere(&self, state: &State<S::Mode>, direction: &[f64]) -> bool {
        // Inactive constraints are expensive, because they require the geometry of all contacts.
        // The next step checks them.
        let constraints = self.system.constraints().iter().zip(&state.active);
        let mut active = constraints.filter(|(_, active)| **active);
        active.any(|(&index, _)| state.z[index] < -ELSEWHERE * (1.0 + direction[index].abs()))
    }

    /// Returns conditions that may measure the distance along the path beyond an event.
    ///
    /// The first condition, the arc length in the controls, is the most likely to increase; the
    /// others measure a single control.
    fn measures(&self, state: &State<S::Mode>, direction: &[f64]) -> Vec<Condition> {
        let controls = self.system.controls();
        let arc =
            controls.iter().map(|c| (c.index, direction[c.index] / c.scale.powi(2))).collect();
        let single = controls.iter().map(|c| vec![(c.index, 1.0 / c.scale)]);
        let rows = std::iter::once(arc).chain(single);
        rows.map(|row| Condition::through(row, &state.z)).collect()
    }

    /// Returns the constraints that a direction violates, the most violated constraint first.
    ///
    /// Checks the given constraints, as far as their guards are zero, and all active monotone ones.
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
        // The unknown of a monotone constraint must not decrease, even if it is not zero.
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
        // Each constraint may change and change back; the constant is an allowance for short rows.
        // With coupled constraints the search is a tree, and known solvable events need some dozens
        // of active sets.
        let most = 2 * self.guards.len() + 8;
        if has_coupled { most.min(MOST_WITH_FRICTION) } else { most }
    }
}

/// State at an event after changes of some constraints, as a candidate for the outgoing branch.
#[derive(Clone)]
struct ActiveSetCandidate<M> {
    /// State with the changed constraints.
    state: State<M>,
    /// Constraints that may change at the event, and that the outgoing direction might violate.
    undecided: Vec<usize>,
    /// Changes applied so far.
    changes: Vec<Change>,
    /// Constraint with the guard that must increase along the outgoing direction.
    orienting: Option<usize>,
    /// True if the path is turned back for unloading.
    ///
    /// The sign of the direction is then given, and no constraint determines it.
    turns_back: bool,
}

/// Outgoing branch at an event.
struct OutgoingBranch<M> {
    /// State with the outgoing active set and mode.
    state: State<M>,
    /// Outgoing direction.
    leaving: Vec<f64>,
    /// Constraints that have become active or inactive.
    changes: Vec<Change>,
    /// Orientation (N7) after the event.
    is_positive: bool,
    /// Cosine of the angle between incoming and outgoing direction; negative for a reversal.
    along: f64,
}

/// Returns the negative direction.
fn opposite(direction: Vec<f64>) -> Vec<f64> {
    direction.into_iter().map(|x| -x).collect()
}

/// Adds a change to the list, or removes an earlier change of the same constraint.
///
/// A second change of a constraint undoes the first one.
fn toggle(changes: &mut Vec<Change>, change: Change) {
    match changes.iter().position(|earlier| earlier.constraint == change.constraint) {
        Some(undone) => drop(changes.remove(undone)),
        None => changes.push(change),
    }
}
