//! Newton's method for a single equilibrium.

use crate::linear::SingularMatrix;
use crate::settings::Settings;
use crate::system::{Residual, State, System, inactive};
use crate::tangent_solver::TangentSolver;

/// Round-off of a guard (N5): a constraint is violated if its guard is below `-FLOOR`.
pub(crate) const FLOOR: f64 = 1e-12;

/// Half-bandwidth at which the work per unknown counts double.
const FULL_BANDWIDTH: usize = 128;

/// Work of Newton's method as counts, which do not depend on the machine.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Number of factorised tangents.
    pub(crate) tangents: u64,
    /// Sum of the numbers of unknowns of these tangents, weighted by the bandwidth.
    pub(crate) unknowns: u64,
}

/// Condition `Σ c_k z_k = value` that selects a point of the path.
///
/// In the tangent, the condition is the row of the load. The indices of its unknowns must differ
/// from the index of the load by at most the half-bandwidth, unless there is a stand-in row.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Index and coefficient of each unknown in the left-hand side.
    pub row: Vec<(usize, f64)>,
    /// Right-hand side.
    pub value: f64,
    /// Stand-in row for the tangent if `row` contains unknowns far from the load.
    pub stand_in: Option<Vec<(usize, f64)>>,
}

impl Condition {
    /// Creates a condition with the left-hand side `row` and the value that it has at `z`.
    pub fn through(row: Vec<(usize, f64)>, z: &[f64]) -> Self {
        let condition = Self::new(row, 0.0);
        Self { value: condition.measure(z), ..condition }
    }

    /// Creates a condition with the left-hand side `row` and the right-hand side `value`.
    pub fn new(row: Vec<(usize, f64)>, value: f64) -> Self {
        Self { row, value, stand_in: None }
    }

    /// Returns the row of the condition in the tangent.
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

/// Newton's method for the equilibria of one system, with reusable storage.
#[derive(Clone, Debug)]
pub struct Newton {
    /// Factors of the last tangent.
    pub(crate) solver: TangentSolver,
    /// Values and sizes of the equations in the current iteration.
    residual: Residual,
    /// Negative residual, then the Newton step.
    step: Vec<f64>,
    /// Residual norm of every iteration since the history was last cleared.
    pub(crate) history: Vec<f64>,
    /// Work so far.
    pub(crate) work: Work,
    /// Number of unknowns of one tangent, weighted by the bandwidth.
    of_tangent: u64,
}

impl Newton {
    /// Creates storage for a system with the size and bandwidth of `system`.
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

    /// Changes `state` to the equilibrium that satisfies `condition`.
    ///
    /// Returns the direction `∂z/∂value` of the path at this equilibrium. Active set and mode are
    /// fixed, so the equations are smooth; the caller checks the inequalities of (N1).
    ///
    /// # Errors
    /// If the iteration does not converge; `state` is then the last iterate.
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
            // `norm` is the norm before this step. Even if it is within tolerance, the step is
            // added to improve the state.
            self.solver.solve(&mut self.step);
            add(&mut state.z, 1.0, &self.step);
            if condition.stand_in.is_some() {
                // The step does not change the left-hand side of the stand-in row. A motion along
                // the path then satisfies the condition itself.
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

    /// Changes `state` to the point of the path at which the guard of a constraint is zero.
    ///
    /// The guard (N5) is the unknown of an active constraint or the equation of an inactive one.
    /// `condition` only defines the measure of distance along the path. Returns the direction of
    /// the path as [`Newton::solve`] does.
    ///
    /// # Errors
    /// If the iteration does not converge; `state` is then the last iterate.
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
            // The condition is satisfied at the current state, so that only the guard determines
            // the motion along the path.
            condition.value = condition.measure(&state.z);
            let norm = self.evaluate(system, state, &condition)?;
            let guard = guard(system, state, constraint);
            self.solver.solve(&mut self.step);
            let direction = self.direction(system, &condition);
            let change = guard_slope(system, state, constraint, &self.step);
            let slope = guard_slope(system, state, constraint, &direction);
            // Distance to the zero of the guard, to first order, after the Newton step for the
            // residual of this iterate.
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

    /// Computes the direction of the path at an equilibrium.
    ///
    /// The left-hand side of `condition` grows by 1 along this direction.
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
        // The factorisation of a nearly singular tangent may succeed, but the solution may then not
        // be finite.
        if direction.iter().all(|x| x.is_finite()) {
            Ok(direction)
        } else {
            Err(NewtonFailure::NotFinite)
        }
    }

    /// Returns true if the orientation (N7) of the path, constant between events, is positive.
    ///
    /// The orientation is the sign of the determinant of the last factorised tangent, with the sign
    /// of the row of `condition` chosen so that its left-hand side grows along `direction`.
    pub(crate) fn is_positive(&self, condition: &Condition, direction: &[f64]) -> bool {
        // A negative row defines the same condition but changes the sign of the determinant.
        let row = condition.row_in_tangent().iter();
        let growth: f64 = row.map(|&(index, coefficient)| coefficient * direction[index]).sum();
        (growth > 0.0) != self.solver.is_negative()
    }

    /// Returns the guard (N5) of each constraint: `z_c` if it is active, `r_c` if not.
    ///
    /// A constraint becomes active or inactive where its guard is zero.
    pub fn guards<S: System>(system: &S, state: &State<S::Mode>) -> Vec<f64> {
        let mut guards = Vec::with_capacity(state.active.len());
        system.conditions(state, &mut guards);
        replace_active(system, state, &state.z, &mut guards);
        guards
    }

    /// Replaces `guards` by the guards of a state, and `slopes` by their derivatives.
    ///
    /// The derivatives are taken along `direction`.
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

    /// Adds one tangent to the work.
    fn count_tangent(&mut self) {
        self.work.tangents += 1;
        self.work.unknowns += self.of_tangent;
    }

    /// Evaluates the equations, factorises their tangent and returns the norm of the residual.
    ///
    /// Sets `step` to the negative residual. The norm is the largest ratio of value to size of an
    /// equation.
    fn evaluate<S: System>(
        &mut self,
        system: &S,
        state: &State<S::Mode>,
        condition: &Condition,
    ) -> Result<f64, NewtonFailure> {
        self.count_tangent();
        let residual = &mut self.residual;
        let row = condition.row_in_tangent();
        // Return the error of a singular tangent last, because an equation that is not finite would
        // be its cause.
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
            // The tangent contains the stand-in row, and the step must not change its left-hand
            // side.
            self.step[load] = 0.0;
        }
        self.history.push(norm);
        factorised?;
        Ok(norm)
    }

    /// Computes the direction along which the left-hand side of `condition` grows by 1.
    fn direction<S: System>(&mut self, system: &S, condition: &Condition) -> Vec<f64> {
        let mut direction = self.solver.solve_unit(system.load(), system.size());
        if condition.stand_in.is_some() {
            let growth = condition.measure(&direction);
            for x in &mut direction {
                // Along the result of `solve_unit` the left-hand side of the stand-in row grows by
                // 1, so scale it for the actual condition.
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

/// Returns the guard (N5) of one constraint: `z_c` if it is active, `r_c` if not.
pub(crate) fn guard<S: System>(system: &S, state: &State<S::Mode>, constraint: usize) -> f64 {
    if state.active[constraint] {
        state.z[system.constraints()[constraint]]
    } else {
        system.condition(state, constraint)
    }
}

/// Returns the derivative of the guard (N5) of one constraint along a direction.
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

/// Sets the unknowns of inactive constraints, and [`System::vanishing`], to zero.
///
/// Newton's method does not change these unknowns.
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

/// Adds `factor` times `step` to `z`.
fn add(z: &mut [f64], factor: f64, step: &[f64]) {
    for (z, step) in z.iter_mut().zip(step) {
        *z += factor * step;
    }
}
