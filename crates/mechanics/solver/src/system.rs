//! Problem interface: equations, tangent, constraints and states of a system.

use std::fmt::Debug;

use crate::block_matrix::Blocks;
use crate::event::Change;
use crate::tangent::Tangent;

/// Largest change of an unknown in the difference quotient of a slope.
const DIFFERENCE: f64 = 1e-6;

/// Step of the difference quotients of all conditions, as a fraction of the path.
const ALONG: f64 = 1e-7;

/// Mixed complementarity system with a load parameter.
///
/// `n` unknowns `z`, one of them the load, satisfy `n − 1` equations `r(z) = 0`. The row at the
/// index of the load has no equation; there the solver inserts the condition that selects a point
/// of the path. A *constraint* is an unknown `z_c ≥ 0` that is complementary to its equation,
///
/// ```text
/// 0 ≤ z_c  ⟂  r_c(z) ≥ 0 :    r_c = 0 where it is active,  z_c = 0 where it is not.          (N1)
/// ```
///
/// The unknowns are numbered so that the tangent `∂r/∂z`, including the column of the load, is a
/// band matrix.
///
/// Where a constraint changes sides, the equations may take another form, for example as a contact
/// passes a corner. The current form is the *mode*, a part of the [`State`]; the system itself
/// never changes. The mode also stores the history that enters the equations, such as the position
/// at which a contact sticks. The mode changes only at events.
pub trait System {
    /// Form of the equations, with their history.
    ///
    /// Use `()` for a system with one form of its equations and no history.
    type Mode: Clone + Debug + PartialEq;

    /// Returns the number of unknowns, including the load.
    fn size(&self) -> usize;

    /// Returns the half-bandwidth of the tangent.
    fn half_bandwidth(&self) -> usize;

    /// Returns the block structure of the tangent, if any.
    ///
    /// Controls and load must lie in one block, which is the root or a block before it. The solver
    /// then eliminates the tangent block by block, and as a band matrix only where block
    /// elimination is unsafe.
    fn blocks(&self) -> Option<&Blocks> {
        None
    }

    /// Returns true if the equations couple unknowns within the block structure only.
    fn is_in_blocks(&self, _state: &State<Self::Mode>) -> bool {
        true
    }

    /// Returns the index of the load, which is also the row without an equation.
    fn load(&self) -> usize;

    /// Returns true if the load only pushes.
    ///
    /// The path then ends where the load returns to zero.
    fn load_only_pushes(&self) -> bool {
        false
    }

    /// Returns the magnitude of the control parameter, over its scale, at which the path ends.
    ///
    /// Infinite if only a constraint ends the path.
    fn target(&self) -> f64 {
        1.0
    }

    /// Returns true if the path ends where this constraint would change sides.
    fn ends(&self, _state: &State<Self::Mode>, _constraint: usize) -> bool {
        false
    }

    /// Returns the coordinates that measure progress along the path.
    ///
    /// The first is the control parameter. All lie within a half-bandwidth of the load.
    fn controls(&self) -> &[Control];

    /// Returns unknowns of equal unit that measure the whole deformation.
    ///
    /// They measure the turning of the path, and its arc length where deformation far from the load
    /// hardly moves the controls. Empty by default.
    fn coordinates(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Returns the indices of the constraints among the unknowns, in ascending order.
    ///
    /// An active set has one flag per constraint.
    fn constraints(&self) -> &[usize] {
        &[]
    }

    /// Returns unknowns that vanish in a state in addition to the inactive constraints.
    ///
    /// The solver leaves them out.
    fn vanishing(&self, _state: &State<Self::Mode>) -> impl Iterator<Item = usize> {
        std::iter::empty()
    }

    /// Returns the numbers of constraints with an unknown that only grows.
    ///
    /// It grows while the constraint is active. An example is the slip distance of a friction
    /// contact. Where such an unknown would decrease, the constraint becomes inactive, and its
    /// transition stores the accumulated value in the mode.
    fn monotone(&self) -> &[usize] {
        &[]
    }

    /// Makes all slipping contacts stick, where a path is turned back.
    ///
    /// Does nothing by default.
    fn stop_sliding(&self, _state: &mut State<Self::Mode>) {}

    /// Returns the constraints that may change sides as a consequence of this one.
    ///
    /// For example, a sticking contact may begin to slip. By default the range holds only the
    /// constraint itself.
    fn coupled(&self, constraint: usize) -> std::ops::Range<usize> {
        constraint..constraint + 1
    }

    /// Returns the mode of the state of rest.
    fn mode_at_rest(&self) -> Self::Mode;

    /// Returns true if the equations have the same form in two modes.
    ///
    /// Their history may differ.
    fn is_same_form(&self, one: &Self::Mode, other: &Self::Mode) -> bool {
        one == other
    }

    /// Evaluates the equations.
    ///
    /// A system with its own [`System::conditions`] may omit the equations of inactive constraints.
    ///
    /// A change of mode must preserve the sign of the determinant of the equations, by which the
    /// solver detects a step to another branch.
    fn residual(&self, state: &State<Self::Mode>, residual: &mut Residual) {
        self.linearise(state, residual, &mut |_: usize, _: usize, _: f64| {});
    }

    /// Adds `∂r/∂z`, including its constant part, to a zero matrix.
    ///
    /// Adds nothing to the row of the load. Rows and columns of inactive constraints may be
    /// omitted.
    fn tangent(&self, state: &State<Self::Mode>, matrix: &mut impl Tangent) {
        self.constant_tangent(matrix);
        self.linearise(state, &mut Residual::new(self.size()), matrix);
    }

    /// Adds the part of `∂r/∂z` that is the same in every state.
    fn constant_tangent(&self, _matrix: &mut impl Tangent) {}

    /// Evaluates the equations and adds `∂r/∂z` to the matrix.
    ///
    /// The matrix already holds its constant part. A system may implement this function, which does
    /// both in one pass, instead of [`System::residual`] and [`System::tangent`].
    fn linearise(
        &self,
        state: &State<Self::Mode>,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        self.residual(state, residual);
        self.tangent(state, matrix);
    }

    /// Replaces `values` by the values of the equations of all constraints.
    ///
    /// Entries of active constraints are ignored.
    fn conditions(&self, state: &State<Self::Mode>, values: &mut Vec<f64>) {
        let mut residual = Residual::new(self.size());
        self.residual(state, &mut residual);
        values.clear();
        values.extend(self.constraints().iter().map(|&index| residual.value[index]));
    }

    /// Replaces `values` as [`System::conditions`], and `slopes` by derivatives.
    ///
    /// The derivatives are along `direction`.
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

    /// Evaluates the equation of a constraint, given by its number.
    fn condition(&self, state: &State<Self::Mode>, constraint: usize) -> f64 {
        let mut values = Vec::new();
        self.conditions(state, &mut values);
        values[constraint]
    }

    /// Evaluates the derivative of the equation of a constraint along `direction`.
    ///
    /// By central differences unless overridden.
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

    /// Evaluates a marker, a function that vanishes at a special point.
    ///
    /// A marker that vanishes is not an event.
    fn marker(&self, _state: &State<Self::Mode>, _number: usize) -> f64 {
        f64::NAN
    }

    /// Evaluates the rate of a quantity along `direction`; it vanishes at an extremum.
    fn rate(&self, _state: &State<Self::Mode>, _direction: &[f64], _number: usize) -> f64 {
        f64::NAN
    }

    /// Returns true if the condition of a constraint does not determine the outgoing direction.
    ///
    /// The path then keeps its incoming direction. False by default.
    fn is_neutral(&self, _state: &State<Self::Mode>, _constraint: usize) -> bool {
        false
    }

    /// Completes a change of sides in `state`, with the flag set and the unknown zero.
    ///
    /// A system with modes sets the next mode and the unknowns and flags that change with it.
    /// Returns the constraint with the condition that the outgoing path must satisfy, or `None` if
    /// the constraint cannot change sides in this mode.
    fn transition(&self, _state: &mut State<Self::Mode>, change: Change) -> Option<usize> {
        Some(change.constraint)
    }
}

/// Coordinate that measures progress along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Index among the unknowns.
    pub index: usize,
    /// Scale of the coordinate: the path is measured in `z / scale`.
    ///
    /// A negative scale reverses it.
    pub scale: f64,
}

/// Values of the equations at a state, with the sizes of their terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Value of each equation.
    pub value: Vec<f64>,
    /// Size of each equation: one unit plus the magnitudes of its terms.
    ///
    /// An equation is satisfied if its value is small compared with its size.
    pub size: Vec<f64>,
}

impl Residual {
    /// Creates a residual of `size` equations with values of zero and sizes of 1.
    pub fn new(size: usize) -> Self {
        Self { value: vec![0.0; size], size: vec![1.0; size] }
    }

    /// Sets every value to zero and the sizes to `units`.
    pub fn clear(&mut self, units: &[f64]) {
        self.value.fill(0.0);
        self.size.copy_from_slice(units);
    }

    /// Adds a term to an equation.
    #[inline]
    pub fn add(&mut self, row: usize, term: f64) {
        self.value[row] += term;
        self.size[row] += term.abs();
    }

    /// Adds the term `factors[k] · others[k]` to each equation `row + k`.
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

    /// Adds the terms `block[i][j] · others[j]` to each equation `row + i`.
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
    /// Active set: one flag per constraint.
    pub active: Vec<bool>,
    /// Form of the equations, with their history.
    pub mode: M,
}

impl<M> State<M> {
    /// Returns the state of rest: every unknown zero, no constraint active.
    pub fn at_rest(system: &impl System<Mode = M>) -> Self {
        Self {
            z: vec![0.0; system.size()],
            active: vec![false; system.constraints().len()],
            mode: system.mode_at_rest(),
        }
    }
}

impl<M: Clone> State<M> {
    /// Returns the state shifted by `factor` times `direction`.
    #[must_use]
    pub fn moved(&self, factor: f64, direction: &[f64]) -> Self {
        let z = self.z.iter().zip(direction).map(|(z, d)| z + factor * d).collect();
        Self { z, active: self.active.clone(), mode: self.mode.clone() }
    }

    /// Returns the state with unknowns interpolated between this one and `to`.
    pub(crate) fn interpolated(&self, to: &Self, fraction: f64) -> Self {
        let z = self.z.iter().zip(&to.z).map(|(a, b)| a + fraction * (b - a)).collect();
        Self { z, active: self.active.clone(), mode: self.mode.clone() }
    }
}

/// Returns the unknowns of inactive constraints, and others that vanish.
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

    /// System with one constraint, of equation `u³`.
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
    fn a_slope_by_differences_is_as_exact_along_any_length() {
        let state = State { z: vec![2.0, 0.0, 0.0], active: vec![false], mode: () };
        for length in [1e-6, 1.0, 1e6] {
            let slope = Cube.slope(&state, 0, &[-length, 0.0, 0.5 * length]);
            assert_relative_eq!(slope, -12.0 * length, max_relative = 1e-8);
        }
        assert_eq!(Cube.slope(&state, 0, &[0.0; 3]), 0.0);
    }
}
