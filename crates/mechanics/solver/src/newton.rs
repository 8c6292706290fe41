//! Newton's method for a single equilibrium.

use crate::linear::SingularMatrix;
use crate::settings::Settings;
use crate::system::{Residual, State, System, inactive};
use crate::tangent_solver::TangentSolver;

/// A guard (N5) below minus this is violated; smaller violations are round-off.
pub(crate) const FLOOR: f64 = 1e-12;

/// Half-bandwidth with which an unknown counts twice.
const FULL_BANDWIDTH: usize = 128;

/// Work of Newton's method, independent of the machine.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Number of factorised tangents.
    pub(crate) tangents: u64,
    /// Unknowns of these tangents, weighted by the bandwidth.
    pub(crate) unknowns: u64,
}

/// Condition `Σ c_k z_k = value` that selects a point of the path.
///
/// The condition takes the row of the load in the tangent. Its unknowns must lie within a
/// half-bandwidth of the load, unless a stand-in row is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Indices and coefficients of the left-hand side.
    pub row: Vec<(usize, f64)>,
    /// Right-hand side.
    pub value: f64,
    /// Row for the tangent if the condition involves unknowns far from the load.
    pub stand_in: Option<Vec<(usize, f64)>>,
}

impl Condition {
    /// Creates the condition with this left-hand side that `z` satisfies.
    pub fn through(row: Vec<(usize, f64)>, z: &[f64]) -> Self {
        let condition = Self::new(row, 0.0);
        Self { value: condition.measure(z), ..condition }
    }

    /// Creates the condition with this left-hand side and right-hand side.
    pub fn new(row: Vec<(usize, f64)>, value: f64) -> Self {
        Self { row, value, stand_in: None }
    }

    fn row_in_tangent(&self) -> &[(usize, f64)] {
        self.stand_in.as_ref().unwrap_or(&self.row)
    }

    /// Evaluates the left-hand side at `z`.
    pub fn measure(&self, z: &[f64]) -> f64 {
        self.row.iter().map(|&(index, coefficient)| coefficient * z[index]).sum()
    }
}

/// Reason why Newton's method did not reach an equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NewtonFailure {
    /// The tangent is singular.
    #[error(transparent)]
    Singular(#[from] SingularMatrix),
    /// An equation has no finite value.
    #[error("the residual is not a finite number")]
    NotFinite,
    /// The iteration reached its limit.
    #[error("the residual did not fall below the tolerance")]
    TooManyIterations,
}

/// Newton solver for one system, with storage that is reused between solves.
#[derive(Clone, Debug)]
pub struct Newton {
    /// Holds the factors of the last tangent.
    pub(crate) solver: TangentSolver,
    residual: Residual,
    step: Vec<f64>,
    /// Residual norm of every iteration since the history was last taken.
    pub(crate) history: Vec<f64>,
    /// Work so far.
    pub(crate) work: Work,
    /// Work of one tangent.
    of_tangent: u64,
}

impl Newton {
    /// Creates storage for systems of this shape.
    pub fn new(system: &impl System) -> Self {
        let size = system.size();
        Self {
            solver: TangentSolver::new(system),
            residual: Residual::new(size),
            step: vec![0.0; size],
            history: Vec::new(),
            work: Work::default(),
            of_tangent: (size + size * system.half_bandwidth() / FULL_BANDWIDTH) as u64,
        }
    }

    /// Moves `state` to the equilibrium that satisfies `condition`.
    ///
    /// Returns the direction of the path there, `∂z/∂value`. Active set and mode are fixed, so that
    /// the equations are smooth; the caller checks the signs of (N1).
    ///
    /// # Errors
    /// If the iteration does not converge; `state` then holds some iterate.
    pub fn solve<S: System>(
        &mut self,
        system: &S,
        state: &mut State<S::Mode>,
        condition: &Condition,
        settings: &Settings,
    ) -> Result<Vec<f64>, NewtonFailure> {
        rest(system, state);
        for _ in 0..=settings.max_iterations {
            let norm = self.evaluate(system, state, condition)?;
            // `norm` is the norm before this step. A state within tolerance is still improved by
            // the step.
            self.solver.solve(&mut self.step);
            add(&mut state.z, 1.0, &self.step);
            if condition.stand_in.is_some() {
                // The step preserved the left-hand side of the stand-in. Meet the condition itself
                // by moving along the path.
                let direction = self.direction(system, condition);
                let left = condition.value - condition.measure(&state.z);
                add(&mut state.z, left, &direction);
            }
            if norm <= settings.tolerance {
                return Ok(self.direction(system, condition));
            }
        }
        Err(NewtonFailure::TooManyIterations)
    }

    /// Moves `state` along the path to where a constraint is about to change sides.
    ///
    /// There the unknown of an active constraint, or the equation of an inactive one, vanishes.
    /// `condition` only defines how the path is measured. Returns the direction of the path as
    /// [`Newton::solve`].
    ///
    /// # Errors
    /// If the iteration does not converge; `state` then holds some iterate.
    pub fn locate<S: System>(
        &mut self,
        system: &S,
        state: &mut State<S::Mode>,
        condition: &Condition,
        constraint: usize,
        settings: &Settings,
    ) -> Result<Vec<f64>, NewtonFailure> {
        let mut condition = condition.clone();
        rest(system, state);
        for _ in 0..=settings.max_iterations {
            // Satisfy the condition at the current state, so that only the guard determines the
            // distance.
            condition.value = condition.measure(&state.z);
            let norm = self.evaluate(system, state, &condition)?;
            let guard = guard(system, state, constraint);
            self.solver.solve(&mut self.step);
            let direction = self.direction(system, &condition);
            let change = guard_slope(system, state, constraint, &self.step);
            let slope = guard_slope(system, state, constraint, &direction);
            // First-order zero of the guard along the path, corrected for the residual of this
            // iterate.
            let distance = -(guard + change) / slope;
            if !distance.is_finite() {
                return Err(NewtonFailure::NotFinite);
            }
            add(&mut state.z, 1.0, &self.step);
            add(&mut state.z, distance, &direction);
            if norm <= settings.tolerance && guard.abs() <= settings.tolerance {
                return Ok(direction);
            }
        }
        Err(NewtonFailure::TooManyIterations)
    }

    /// Computes the direction of the path at an equilibrium, measured by `condition`.
    ///
    /// # Errors
    /// If the tangent is singular or the residual is not finite.
    pub fn tangent<S: System>(
        &mut self,
        system: &S,
        state: &State<S::Mode>,
        condition: &Condition,
    ) -> Result<Vec<f64>, NewtonFailure> {
        self.count_tangent();
        let residual = &mut self.residual;
        self.solver.factorise(system, state, condition.row_in_tangent(), residual)?;
        let direction = self.direction(system, condition);
        // A nearly singular tangent may have factors, but its solution is then not finite.
        if direction.iter().all(|x| x.is_finite()) {
            Ok(direction)
        } else {
            Err(NewtonFailure::NotFinite)
        }
    }

    /// Returns the orientation of the path, which is constant between events.
    ///
    /// This is the sign of the determinant of the last tangent if its condition increases along
    /// `direction`. True if positive.
    pub(crate) fn is_positive(&self, condition: &Condition, direction: &[f64]) -> bool {
        // Negating the row leaves the condition unchanged but flips the determinant.
        let row = condition.row_in_tangent().iter();
        let growth: f64 = row.map(|&(index, coefficient)| coefficient * direction[index]).sum();
        (growth > 0.0) != self.solver.is_negative()
    }

    /// Evaluates the guards (N5) of all constraints: `z_c` if active, `r_c` if not.
    ///
    /// A guard vanishes where its constraint changes sides.
    pub fn guards<S: System>(system: &S, state: &State<S::Mode>) -> Vec<f64> {
        let mut guards = Vec::with_capacity(state.active.len());
        system.conditions(state, &mut guards);
        replace_active(system, state, &state.z, &mut guards);
        guards
    }

    /// Replaces `guards` by the guards of a state, and `slopes` by their rates.
    ///
    /// The rates are along a direction.
    pub(crate) fn guard_slopes<S: System>(
        system: &S,
        state: &State<S::Mode>,
        direction: &[f64],
        guards: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
    ) {
        system.condition_slopes(state, direction, guards, slopes);
        replace_active(system, state, &state.z, guards);
        replace_active(system, state, direction, slopes);
    }

    fn count_tangent(&mut self) {
        self.work.tangents += 1;
        self.work.unknowns += self.of_tangent;
    }

    /// Evaluates the equations and factorises their tangent.
    ///
    /// Leaves the negative values in `step` and returns their norm.
    fn evaluate<S: System>(
        &mut self,
        system: &S,
        state: &State<S::Mode>,
        condition: &Condition,
    ) -> Result<f64, NewtonFailure> {
        self.count_tangent();
        let residual = &mut self.residual;
        let row = condition.row_in_tangent();
        // Report a singular tangent last: a non-finite equation is the cause if both occur.
        let factorised = self.solver.factorise(system, state, row, residual);
        let load = system.load();
        residual.value[load] = condition.measure(&state.z) - condition.value;
        residual.size[load] = condition.row.iter().map(|(_, c)| c.abs()).sum();
        for index in inactive(system, state) {
            residual.value[index] = 0.0;
        }
        let mut norm = 0.0_f64;
        for ((step, value), size) in self.step.iter_mut().zip(&residual.value).zip(&residual.size) {
            *step = -value;
            let ratio = (value / size).abs();
            if !ratio.is_finite() {
                return Err(NewtonFailure::NotFinite);
            }
            norm = norm.max(ratio);
        }
        if condition.stand_in.is_some() {
            // The tangent contains the stand-in row, and the step must preserve its left-hand side.
            self.step[load] = 0.0;
        }
        self.history.push(norm);
        factorised?;
        Ok(norm)
    }

    /// Computes the direction along which the condition's left-hand side grows by 1.
    fn direction<S: System>(&mut self, system: &S, condition: &Condition) -> Vec<f64> {
        let mut direction = self.solver.solve_unit(system.load(), system.size());
        if condition.stand_in.is_some() {
            let growth = condition.measure(&direction);
            for x in &mut direction {
                // `solve_unit` has applied the unit right-hand side to the stand-in row, so
                // normalise by the actual condition.
                *x /= growth;
            }
        }
        direction
    }
}

/// Replaces the entries of active constraints by the entries of their unknowns.
fn replace_active<S: System>(
    system: &S,
    state: &State<S::Mode>,
    unknowns: &[f64],
    entries: &mut [f64],
) {
    let constraints = system.constraints().iter().zip(&state.active);
    for ((&index, &active), entry) in constraints.zip(entries) {
        if active {
            *entry = unknowns[index];
        }
    }
}

/// Evaluates a guard (N5), which vanishes where the constraint changes sides.
pub(crate) fn guard<S: System>(system: &S, state: &State<S::Mode>, constraint: usize) -> f64 {
    if state.active[constraint] {
        state.z[system.constraints()[constraint]]
    } else {
        system.condition(state, constraint)
    }
}

/// Evaluates the derivative of a guard along a direction.
pub(crate) fn guard_slope<S: System>(
    system: &S,
    state: &State<S::Mode>,
    constraint: usize,
    direction: &[f64],
) -> f64 {
    if state.active[constraint] {
        direction[system.constraints()[constraint]]
    } else {
        system.slope(state, constraint, direction)
    }
}

/// Sets the unknowns of inactive constraints, and others that vanish, to zero.
///
/// The iteration does not change them.
fn rest<S: System>(system: &S, state: &mut State<S::Mode>) {
    for (&index, active) in system.constraints().iter().zip(&state.active) {
        if !active {
            state.z[index] = 0.0;
        }
    }
    let vanishing: Vec<_> = system.vanishing(state).collect();
    for index in vanishing {
        state.z[index] = 0.0;
    }
}

fn add(z: &mut [f64], factor: f64, step: &[f64]) {
    for (z, step) in z.iter_mut().zip(step) {
        *z += factor * step;
    }
}
