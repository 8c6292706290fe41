//! Interface of a problem: equations, tangent, constraints and states.

use std::fmt::Debug;

use crate::block_matrix::Blocks;
use crate::event::Change;
use crate::tangent::Tangent;

/// Largest change of an unknown in the central difference of [`System::slope`].
const DIFFERENCE: f64 = 1e-6;

/// Step along the path direction in the difference quotients of [`System::condition_slopes`].
const ALONG: f64 = 1e-7;

/// Mixed complementarity system with a load parameter.
///
/// `n` unknowns `z`, one of them the load, satisfy `n − 1` equations `r(z) = 0`. The row at the
/// index of the load has no equation; the solver inserts the condition that selects a point of the
/// path there. A *constraint* is an unknown `z_c ≥ 0` that is complementary to its equation. It is
/// active or inactive:
///
/// ```text
/// 0 ≤ z_c  ⟂  r_c(z) ≥ 0 :    active: r_c = 0,    inactive: z_c = 0                          (N1)
/// ```
///
/// The unknowns are numbered so that the tangent `∂r/∂z`, including the column of the load, is a
/// band matrix.
///
/// If a constraint becomes active or inactive, the equations may take another form, for example
/// when a contact passes a corner. The current form is the *mode*, which is a part of the
/// [`State`], not of the system. The mode also stores the history that enters the equations, such
/// as the position at which a contact sticks. The mode changes only at events.
pub trait System {
    /// Form of the equations, and the history that enters the equations.
    ///
    /// Use `()` for a system with a single form of its equations and without history.
    type Mode: Clone + Debug + PartialEq;

    /// Returns the number of unknowns, including the load.
    fn size(&self) -> usize;

    /// Returns the half-bandwidth of the tangent.
    fn half_bandwidth(&self) -> usize;

    /// Returns the block structure of the tangent, or `None` for band matrices only.
    ///
    /// Controls and load must lie in one block: the root or a block before the root. The solver
    /// then eliminates the tangent block by block, and uses a band matrix only if block elimination
    /// is unsafe.
    fn blocks(&self) -> Option<&Blocks> {
        None
    }

    /// Returns true if, in this state, the tangent has no entries outside the block structure.
    fn is_in_blocks(&self, _state: &State<Self::Mode>) -> bool {
        true
    }

    /// Returns the index of the load, which is also the row without an equation.
    fn load(&self) -> usize;

    /// Returns true if the load can push but not pull.
    ///
    /// The path then ends at the point at which the load returns to zero.
    fn load_only_pushes(&self) -> bool {
        false
    }

    /// Returns the target: the magnitude of the control parameter at which the path ends.
    ///
    /// The value is in units of [`Control::scale`]. It is infinite if only a constraint ends the
    /// path.
    fn target(&self) -> f64 {
        1.0
    }

    /// Returns true if the path ends at the event at which this constraint would change.
    fn ends(&self, _state: &State<Self::Mode>, _constraint: usize) -> bool {
        false
    }

    /// Returns the controls, the unknowns that measure progress along the path.
    ///
    /// The first control is the control parameter. The index of each control differs from the index
    /// of the load by at most the half-bandwidth.
    fn controls(&self) -> &[Control];

    /// Returns the unknowns, all of the same unit, that measure the whole deformation.
    ///
    /// The angles between path directions are computed from these unknowns. They also define the
    /// arc length if the system deforms far from the load while the controls hardly change. The
    /// default is an empty list.
    fn coordinates(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Returns the index of the unknown of each constraint, in ascending order.
    ///
    /// The number of a constraint is its position in this list, and in the flags of an active set.
    fn constraints(&self) -> &[usize] {
        &[]
    }

    /// Returns the unknowns that are zero in addition to the unknowns of inactive constraints.
    ///
    /// The solver leaves these unknowns and their equations out of the tangent.
    fn vanishing(&self, _state: &State<Self::Mode>) -> impl Iterator<Item = usize> {
        std::iter::empty()
    }

    /// Returns the numbers of monotone constraints.
    ///
    /// The unknown of a monotone constraint, such as the slip distance of a contact, can only grow
    /// while the constraint is active. If the unknown would decrease, the constraint becomes
    /// inactive, and [`System::transition`] stores the accumulated value in the mode.
    fn monotone(&self) -> &[usize] {
        &[]
    }

    /// Makes all slipping contacts stick before the path is reversed.
    ///
    /// Does nothing by default.
    fn stop_sliding(&self, _state: &mut State<Self::Mode>) {}

    /// Returns the numbers of the constraints that may change together with a constraint.
    ///
    /// With friction these are, for example, all constraints of a pair of scales. By default the
    /// range contains only the constraint itself.
    fn coupled(&self, constraint: usize) -> std::ops::Range<usize> {
        constraint..constraint + 1
    }

    /// Returns the mode of the state of rest.
    fn mode_at_rest(&self) -> Self::Mode;

    /// Returns true if the equations have the same form in two modes, even with another history.
    fn is_same_form(&self, one: &Self::Mode, other: &Self::Mode) -> bool {
        one == other
    }

    /// Evaluates the values and sizes of the equations.
    ///
    /// If the system implements [`System::conditions`], the equations of inactive constraints may
    /// be omitted.
    ///
    /// A change of mode must preserve the sign of the determinant of the tangent, because the
    /// solver detects a step to another branch by this sign.
    fn residual(&self, state: &State<Self::Mode>, residual: &mut Residual) {
        self.linearise(state, residual, &mut |_: usize, _: usize, _: f64| {});
    }

    /// Adds `∂r/∂z`, including its constant part, to a zero matrix.
    ///
    /// The row of the load must stay zero. Rows and columns of inactive constraints may be omitted.
    fn tangent(&self, state: &State<Self::Mode>, matrix: &mut impl Tangent) {
        self.constant_tangent(matrix);
        self.linearise(state, &mut Residual::new(self.size()), matrix);
    }

    /// Adds the part of `∂r/∂z` that is the same in every state.
    fn constant_tangent(&self, _matrix: &mut impl Tangent) {}

    /// Evaluates the equations and adds the state-dependent part of `∂r/∂z` to the matrix.
    ///
    /// The matrix already contains the constant part. A system implements either this function,
    /// which evaluates equations and derivatives in one pass, or both [`System::residual`] and
    /// [`System::tangent`].
    fn linearise(
        &self,
        state: &State<Self::Mode>,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        self.residual(state, residual);
        self.tangent(state, matrix);
    }

    /// Replaces `values` by the value `r_c` of the equation of each constraint.
    ///
    /// The entries of active constraints are not used.
    fn conditions(&self, state: &State<Self::Mode>, values: &mut Vec<f64>) {
        let mut residual = Residual::new(self.size());
        self.residual(state, &mut residual);
        values.clear();
        values.extend(self.constraints().iter().map(|&index| residual.value[index]));
    }

    /// Replaces `values` as [`System::conditions`] does, and `slopes` by their derivatives.
    ///
    /// The derivatives of the values are taken along `direction`.
    fn condition_slopes(
        &self,
        state: &State<Self::Mode>,
        direction: &[f64],
        values: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
    ) {
        self.conditions(state, values);
        self.conditions(&state.moved(ALONG, direction), slopes);
        for (slope, here) in slopes.iter_mut().zip(values) {
            *slope = (*slope - *here) / ALONG;
        }
    }

    /// Returns the value `r_c` of the equation of one constraint.
    fn condition(&self, state: &State<Self::Mode>, constraint: usize) -> f64 {
        let mut values = Vec::new();
        self.conditions(state, &mut values);
        values[constraint]
    }

    /// Returns the derivative of the equation of one constraint along `direction`.
    ///
    /// The default implementation uses central differences.
    fn slope(&self, state: &State<Self::Mode>, constraint: usize, direction: &[f64]) -> f64 {
        let largest = direction.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        if largest == 0.0 {
            return 0.0;
        }
        let step = DIFFERENCE / largest;
        let [ahead, behind] =
            [step, -step].map(|step| self.condition(&state.moved(step, direction), constraint));
        (ahead - behind) / (2.0 * step)
    }

    /// Evaluates the marker `number`, a function that is zero at a special point of the path.
    ///
    /// A zero of a marker is not an event; it can fix a point for derivatives
    /// ([`PathAnchor::Marker`](crate::PathAnchor::Marker)).
    fn marker(&self, _state: &State<Self::Mode>, _number: usize) -> f64 {
        f64::NAN
    }

    /// Evaluates the rate of the quantity `number` along `direction`.
    ///
    /// The rate is zero at an extremum of the quantity
    /// ([`PathAnchor::Stationary`](crate::PathAnchor::Stationary)).
    fn rate(&self, _state: &State<Self::Mode>, _direction: &[f64], _number: usize) -> f64 {
        f64::NAN
    }

    /// Returns true if a constraint does not determine the sign of the outgoing direction.
    ///
    /// The sign then follows from the incoming direction. False by default.
    fn is_neutral(&self, _state: &State<Self::Mode>, _constraint: usize) -> bool {
        false
    }

    /// Completes the change of a constraint between active and inactive in `state`.
    ///
    /// The caller has set the flag of the constraint and set its unknown to zero. A system with
    /// modes sets the next mode, and the unknowns and flags that change with the mode. Returns the
    /// number of the constraint that the outgoing path must satisfy, by default the changed one, or
    /// `None` if the constraint cannot change in this mode.
    fn transition(&self, _state: &mut State<Self::Mode>, change: Change) -> Option<usize> {
        Some(change.constraint)
    }
}

/// Unknown that measures progress along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Index among the unknowns.
    pub index: usize,
    /// Scale of the unknown: progress is measured by `z / scale`.
    ///
    /// With a negative scale the path starts in the direction of decreasing `z`.
    pub scale: f64,
}

/// Values of the equations at a state, and the sizes with which the values are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Value of each equation.
    pub value: Vec<f64>,
    /// Size of each equation: its unit plus the magnitudes of its terms.
    ///
    /// An equation is satisfied if its value is small compared with its size (N2).
    pub size: Vec<f64>,
}

impl Residual {
    /// Creates a residual of `size` equations with values 0 and sizes 1.
    pub fn new(size: usize) -> Self {
        Self { value: vec![0.0; size], size: vec![1.0; size] }
    }

    /// Sets each value to 0 and each size to its entry of `units`.
    pub fn clear(&mut self, units: &[f64]) {
        self.value.fill(0.0);
        self.size.copy_from_slice(units);
    }

    /// Adds a term to the value and its magnitude to the size of an equation.
    #[inline]
    pub fn add(&mut self, row: usize, term: f64) {
        self.value[row] += term;
        self.size[row] += term.abs();
    }

    /// Adds the term `factors[k] · others[k]` to the equation `row + k` for each `k`.
    #[inline]
    pub fn add_products(&mut self, row: usize, factors: &[f64], others: &[f64]) {
        let rows = row..row + factors.len();
        let (value, size) = (&mut self.value[rows.clone()], &mut self.size[rows]);
        let others = &others[..factors.len()];
        for k in 0..factors.len() {
            let term = factors[k] * others[k];
            value[k] += term;
            size[k] += term.abs();
        }
    }

    /// Adds the terms `block[i][j] · others[j]` for all `j` to the equation `row + i` for each `i`.
    #[inline]
    pub fn add_block_products<const R: usize, const C: usize>(
        &mut self,
        row: usize,
        block: &[[f64; C]; R],
        others: &[f64],
    ) {
        let others = &others[..C];
        for (i, factors) in block.iter().enumerate() {
            let terms: [f64; C] = std::array::from_fn(|j| factors[j] * others[j]);
            self.value[row + i] += terms.iter().sum::<f64>();
            self.size[row + i] += terms.iter().map(|term| term.abs()).sum::<f64>();
        }
    }
}

/// State of a system: unknowns, active set and mode.
#[derive(Clone, Debug, PartialEq)]
pub struct State<M = ()> {
    /// Unknowns.
    pub z: Vec<f64>,
    /// Active set: for each constraint, true if it is active.
    pub active: Vec<bool>,
    /// Form of the equations, and the history that enters the equations.
    pub mode: M,
}

impl<M> State<M> {
    /// Returns the state of rest, in which all unknowns are zero and no constraint is active.
    pub fn at_rest(system: &impl System<Mode = M>) -> Self {
        Self {
            z: vec![0.0; system.size()],
            active: vec![false; system.constraints().len()],
            mode: system.mode_at_rest(),
        }
    }
}

impl<M: Clone> State<M> {
    /// Returns the state with its unknowns changed by `factor` times `direction`.
    #[must_use]
    pub fn moved(&self, factor: f64, direction: &[f64]) -> Self {
        let z = self.z.iter().zip(direction).map(|(z, d)| z + factor * d).collect();
        Self { z, active: self.active.clone(), mode: self.mode.clone() }
    }

    /// Returns the state with unknowns interpolated between `self` (0) and `to` (`fraction` = 1).
    ///
    /// Active set and mode are copied from `self`.
    pub(crate) fn interpolated(&self, to: &Self, fraction: f64) -> Self {
        let z = self.z.iter().zip(&to.z).map(|(a, b)| a + fraction * (b - a)).collect();
        Self { z, active: self.active.clone(), mode: self.mode.clone() }
    }
}

/// Returns the unknowns that are zero: of all inactive constraints, and [`System::vanishing`].
pub(crate) fn inactive<'a, S: System>(
    system: &'a S,
    state: &'a State<S::Mode>,
) -> impl Iterator<Item = usize> + 'a {
    let constraints = system.constraints().iter().zip(&state.active);
    let inactive = constraints.filter(|(_, active)| !**active).map(|(&index, _)| index);
    inactive.chain(system.vanishing(state))
}

#[cfg(test)]
mod tests {
    use super::{Control, Residual, State, System, Tangent};
    use approx::assert_relative_eq;

    /// System with one constraint, with the condition `z₀³ ≥ 0`.
    struct Cube;

    impl System for Cube {
        type Mode = ();

        fn size(&self) -> usize {
            3
        }

        fn half_bandwidth(&self) -> usize {
            2
        }

        fn load(&self) -> usize {
            2
        }

        fn controls(&self) -> &[Control] {
            &[]
        }

        fn constraints(&self) -> &[usize] {
            &[1]
        }

        fn mode_at_rest(&self) {}

        fn residual(&self, state: &State, residual: &mut Residual) {
            residual.clear(&[1.0; 3]);
            residual.add(1, state.z[0].powi(3));
        }

        fn tangent(&self, _state: &State, _matrix: &mut impl Tangent) {}
    }

    #[test]
    fn the_relative_error_of_a_slope_does_not_depend_on_the_length_of_the_direction() {
        let state = State { z: vec![2.0, 0.0, 0.0], active: vec![false], mode: () };
        for length in [1e-6, 1.0, 1e6] {
            let slope = Cube.slope(&state, 0, &[-length, 0.0, 0.5 * length]);
            assert_relative_eq!(slope, -12.0 * length, max_relative = 1e-8);
        }
        assert_eq!(Cube.slope(&state, 0, &[0.0; 3]), 0.0);
    }
}
