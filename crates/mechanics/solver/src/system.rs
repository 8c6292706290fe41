//! The problem interface: equations, tangent, constraints, and the states of a system.

use std::fmt::Debug;

use crate::block_matrix::Blocks;
use crate::event::Change;
use crate::tangent::Tangent;

/// Largest change of an unknown over which a slope is a difference.
const DIFFERENCE: f64 = 1e-6;

/// Part of the path over which the slopes of all conditions are differences.
const ALONG: f64 = 1e-7;

/// A mixed complementarity system with a load parameter.
///
/// `n` unknowns `z`, of which one is the load, in `n − 1` equations `r(z) = 0`; the row that is
/// missing, at the index of the load, is taken by the condition that picks a point of the path. A
/// *constraint* is an unknown `z_c ≥ 0` that is complementary to its equation,
///
/// ```text
/// 0 ≤ z_c  ⟂  r_c(z) ≥ 0 :    r_c = 0 where it is active,  z_c = 0 where it is not.          (N1)
/// ```
///
/// Unknowns are numbered so that the tangent `∂r/∂z` is a band matrix, the column of the load included.
///
/// Where a constraint changes sides the equations may take another form, such as those of a contact that passes a
/// corner. Which form holds is the *mode*. It is a part of the [`State`]; the system itself never changes. What the equations keep of
/// the way to a state is in the mode too: the place at which something sticks, say. It changes at events only.
pub trait System {
    /// Which of several forms the equations have, with the history that they keep; `()` for a system whose equations have one form
    /// and no history.
    type Mode: Clone + Debug + PartialEq;

    /// Number of unknowns, the load included.
    fn size(&self) -> usize;

    /// Half-bandwidth of the tangent.
    fn half_bandwidth(&self) -> usize;

    /// The blocks of the tangent, if it has some and the controls and the load are in one of them, the root or one before it. The tangent is
    /// then eliminated block by block, and as a band matrix only where that is not safe.
    fn blocks(&self) -> Option<&Blocks> {
        None
    }

    /// Whether the equations in this state couple unknowns within the blocks only.
    fn is_in_blocks(&self, _state: &State<Self::Mode>) -> bool {
        true
    }

    /// Index of the load among the unknowns, and of the row without an equation.
    fn load(&self) -> usize;

    /// Whether the load only pushes: the path then ends where the load comes back to zero.
    fn load_only_pushes(&self) -> bool {
        false
    }

    /// The control parameter, over its scale, at which the path ends; infinite if a constraint alone ends it.
    fn target(&self) -> f64 {
        1.0
    }

    /// Whether the path ends at a state in which this constraint would change sides.
    fn ends(&self, _state: &State<Self::Mode>, _constraint: usize) -> bool {
        false
    }

    /// The coordinates that measure progress along the path; the first is the control parameter. All lie within a
    /// half-bandwidth of the load.
    fn controls(&self) -> &[Control];

    /// The unknowns of one unit in all of which the path is measured besides: how far it turns, and its arc length where
    /// something gives way of which the controls show next to nothing. None unless the system knows better.
    fn coordinates(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Indices of the constraints among the unknowns, in ascending order. An active set is a flag for each.
    fn constraints(&self) -> &[usize] {
        &[]
    }

    /// Unknowns that vanish in a state besides those of its inactive constraints, and are not solved for.
    fn vanishing(&self, _state: &State<Self::Mode>) -> impl Iterator<Item = usize> {
        std::iter::empty()
    }

    /// Numbers of the constraints whose unknown, once active, only grows, such as the way that something has slid with friction. Where
    /// it turns back the constraint becomes inactive, and its transition keeps in the mode how far it has come.
    fn monotone(&self) -> &[usize] {
        &[]
    }

    /// Lets everything stick that slides, where a path turns back. Nothing does unless the system knows better.
    fn stop_sliding(&self, _state: &mut State<Self::Mode>) {}

    /// Constraints that may change sides where this one does, because of it: what was at rest may begin to slip, say. Itself alone unless
    /// the system knows of others.
    fn coupled(&self, constraint: usize) -> std::ops::Range<usize> {
        constraint..constraint + 1
    }

    /// The mode of the state of rest.
    fn mode_at_rest(&self) -> Self::Mode;

    /// Whether the equations have the same form in two modes, whatever each has kept of its way.
    fn is_same_form(&self, one: &Self::Mode, other: &Self::Mode) -> bool {
        one == other
    }

    /// Evaluates the equations. Those of inactive constraints may be left out by a system that has
    /// [`System::conditions`] of its own.
    ///
    /// Across a change of mode the equations keep the sign of their determinant: a path that has come to another branch is known by it.
    fn residual(&self, state: &State<Self::Mode>, residual: &mut Residual) {
        self.linearise(state, residual, &mut |_: usize, _: usize, _: f64| {});
    }

    /// Adds `∂r/∂z` to a zero matrix, its constant part included; nothing to the row of the load. Rows and columns of inactive constraints
    /// may be left out.
    fn tangent(&self, state: &State<Self::Mode>, matrix: &mut impl Tangent) {
        self.constant_tangent(matrix);
        self.linearise(state, &mut Residual::new(self.size()), matrix);
    }

    /// Adds the part of `∂r/∂z` that is the same in every state.
    fn constant_tangent(&self, _matrix: &mut impl Tangent) {}

    /// Evaluates the equations and adds `∂r/∂z` to a matrix that holds its constant part: both at once by a system that has this function in
    /// the place of the other two.
    fn linearise(
        &self,
        state: &State<Self::Mode>,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        self.residual(state, residual);
        self.tangent(state, matrix);
    }

    /// Replaces `values` by the values of the equations of all constraints. Those of active ones may have any value.
    fn conditions(&self, state: &State<Self::Mode>, values: &mut Vec<f64>) {
        let mut residual = Residual::new(self.size());
        self.residual(state, &mut residual);
        values.clear();
        values.extend(self.constraints().iter().map(|&index| residual.value[index]));
    }

    /// Replaces `values` as [`System::conditions`] does, and `slopes` by their derivatives along `direction`.
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

    /// Value of the equation of a constraint (its number).
    fn condition(&self, state: &State<Self::Mode>, constraint: usize) -> f64 {
        let mut values = Vec::new();
        self.conditions(state, &mut values);
        values[constraint]
    }

    /// Derivative of the equation of a constraint (its number) along `direction`; by differences
    /// unless the system knows better.
    fn slope(&self, state: &State<Self::Mode>, constraint: usize, direction: &[f64]) -> f64 {
        let largest = direction.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        if largest == 0.0 {
            return 0.0;
        }
        let step = DIFFERENCE / largest;
        let at = |step: f64| self.condition(&state.moved(step, direction), constraint);
        (at(step) - at(-step)) / (2.0 * step)
    }

    /// A number, one of several, by which a place of the path may be known that is no event: it vanishes there.
    fn marker(&self, _state: &State<Self::Mode>, _number: usize) -> f64 {
        f64::NAN
    }

    /// The rate of a quantity, one of several, along `direction`: a place of the path may be one where it vanishes.
    fn rate(&self, _state: &State<Self::Mode>, _direction: &[f64], _number: usize) -> f64 {
        f64::NAN
    }

    /// Completes the change of a constraint that has just changed sides in `state`: its flag is the new one and its
    /// unknown is zero. A system with modes gives the state the mode that follows, and unknowns and flags the parts that
    /// they have in it. Returns the constraint whose condition has to hold as the path goes on, or `None` if the
    /// constraint cannot change sides in this mode.
    fn transition(&self, _state: &mut State<Self::Mode>, change: Change) -> Option<usize> {
        Some(change.constraint)
    }
}

/// A coordinate that measures progress along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Index among the unknowns.
    pub index: usize,
    /// Scale of the coordinate: the path is measured in `z / scale`. A negative scale turns the direction round.
    pub scale: f64,
}

/// The values of the equations at a state, and the sizes that they are compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Value of each equation.
    pub value: Vec<f64>,
    /// Size of each equation: a unit plus the magnitudes of its terms. An equation is satisfied
    /// where its value is small against its size.
    pub size: Vec<f64>,
}

impl Residual {
    /// Values of zero and sizes of 1, of `size` equations.
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

    /// Adds `factors` times the first of `others` to the equations from `row` on.
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

    /// Adds the product of a block with the first of `others` to the equations from `row` on.
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

/// A state of a system: the unknowns, which constraints are active, and the form of the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct State<M = ()> {
    /// The unknowns.
    pub z: Vec<f64>,
    /// A flag for each constraint.
    pub active: Vec<bool>,
    /// Which form the equations have, and their history.
    pub mode: M,
}

impl<M> State<M> {
    /// The state of rest: every unknown zero, no constraint active.
    pub fn at_rest(system: &impl System<Mode = M>) -> Self {
        Self {
            z: vec![0.0; system.size()],
            active: vec![false; system.constraints().len()],
            mode: system.mode_at_rest(),
        }
    }
}

impl<M: Clone> State<M> {
    /// The state whose unknowns differ by `factor` times `direction`.
    #[must_use]
    pub fn moved(&self, factor: f64, direction: &[f64]) -> Self {
        let z = self.z.iter().zip(direction).map(|(z, d)| z + factor * d).collect();
        Self { z, active: self.active.clone(), mode: self.mode.clone() }
    }

    /// The state whose unknowns lie between those of this one and `to`.
    pub(crate) fn interpolated(&self, to: &Self, fraction: f64) -> Self {
        let z = self.z.iter().zip(&to.z).map(|(a, b)| a + fraction * (b - a)).collect();
        Self { z, active: self.active.clone(), mode: self.mode.clone() }
    }
}

/// Unknowns of the inactive constraints, and others that vanish.
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

    /// A constraint whose equation is `u³`.
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
