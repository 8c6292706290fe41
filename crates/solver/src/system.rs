//! What the solver is told of a problem.

use crate::linear::BandMatrix;

/// Largest change of an unknown over which a slope is a difference.
const DIFFERENCE: f64 = 1e-6;

/// A mixed complementarity system with a load parameter.
///
/// `n` unknowns `z`, of which one is the load, in `n − 1` equations `r(z) = 0`; the row that is
/// missing, at the index of the load, is taken by the condition that picks a point of the path. A
/// *constraint* is an unknown `z_c ≥ 0` that is complementary to its equation,
///
/// ```text
/// 0 ≤ z_c  ⟂  r_c(z) ≥ 0 :    r_c = 0 where it is active,  z_c = 0 where it is not.
/// ```
///
/// Unknowns are numbered so that the tangent `∂r/∂z` is a band matrix, the column of the load included.
pub trait System: Clone {
    /// Number of unknowns, the load included.
    fn size(&self) -> usize;

    /// Half-bandwidth of the tangent.
    fn half_bandwidth(&self) -> usize;

    /// Index of the load among the unknowns, and of the row without an equation.
    fn load(&self) -> usize;

    /// The coordinates that measure progress along the path; the first drives it. All lie within a
    /// half-bandwidth of the load.
    fn controls(&self) -> &[Control];

    /// Indices of the constraints among the unknowns, in ascending order. An active set is a flag for each.
    fn constraints(&self) -> &[usize] {
        &[]
    }

    /// Evaluates the equations. A constraint's equation is evaluated whether active or not; the
    /// flags tell which unknowns are known to vanish.
    fn residual(&self, z: &[f64], active: &[bool], residual: &mut Residual);

    /// Adds `∂r/∂z` to a zero matrix. Rows and columns of inactive constraints may be left out.
    fn tangent(&self, z: &[f64], active: &[bool], matrix: &mut BandMatrix);

    /// Derivative of the equation of a constraint (its number) along `direction`; by differences
    /// unless the system knows better.
    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64 {
        let largest = direction.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        if largest == 0.0 {
            return 0.0;
        }
        let (step, index) = (DIFFERENCE / largest, self.constraints()[constraint]);
        let mut residual = Residual::new(self.size());
        let mut at = |step: f64| {
            let z: Vec<f64> = state.z.iter().zip(direction).map(|(z, d)| z + step * d).collect();
            self.residual(&z, &state.active, &mut residual);
            residual.value[index]
        };
        (at(step) - at(-step)) / (2.0 * step)
    }

    /// Called where a constraint (its number) has just changed sides: the place to give unknowns other
    /// parts. Returns the constraint that has to stay valid as the path goes on.
    fn exchange(&mut self, _state: &mut State, constraint: usize) -> usize {
        constraint
    }
}

/// A coordinate that measures progress along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Index among the unknowns.
    pub index: usize,
    /// Its scale: the path is measured in `z / scale`. A negative scale turns the direction round.
    pub scale: f64,
}

/// The equations at a point, and what they are to be compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Value of each equation.
    pub value: Vec<f64>,
    /// Size of each equation: a unit plus the magnitudes of its terms. An equation is satisfied
    /// where its value is small against its size.
    pub size: Vec<f64>,
}

impl Residual {
    /// All zero, with sizes 1.
    pub fn new(size: usize) -> Self {
        Self { value: vec![0.0; size], size: vec![1.0; size] }
    }

    /// Sets every value to zero and the sizes to `units`.
    pub fn clear(&mut self, units: &[f64]) {
        self.value.fill(0.0);
        self.size.copy_from_slice(units);
    }

    /// Adds a term to an equation.
    pub fn add(&mut self, row: usize, term: f64) {
        self.value[row] += term;
        self.size[row] += term.abs();
    }
}

/// A state: the unknowns and which constraints are active.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The unknowns.
    pub z: Vec<f64>,
    /// A flag for each constraint.
    pub active: Vec<bool>,
}

impl State {
    /// Every unknown zero, no constraint active.
    pub fn at_rest(system: &impl System) -> Self {
        Self { z: vec![0.0; system.size()], active: vec![false; system.constraints().len()] }
    }
}

#[cfg(test)]
mod tests {
    use super::{BandMatrix, Control, Residual, State, System};
    use approx::assert_relative_eq;

    /// A constraint whose equation is `u³`.
    #[derive(Clone)]
    struct Cube;

    impl System for Cube {
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

        fn residual(&self, z: &[f64], _active: &[bool], residual: &mut Residual) {
            residual.clear(&[1.0; 3]);
            residual.add(1, z[0].powi(3));
        }

        fn tangent(&self, _z: &[f64], _active: &[bool], _matrix: &mut BandMatrix) {}
    }

    #[test]
    fn a_slope_by_differences_is_as_exact_along_any_length() {
        let state = State { z: vec![2.0, 0.0, 0.0], active: vec![false] };
        for length in [1e-6, 1.0, 1e6] {
            let slope = Cube.slope(&state, 0, &[-length, 0.0, 0.5 * length]);
            assert_relative_eq!(slope, -12.0 * length, max_relative = 1e-8);
        }
        assert_eq!(Cube.slope(&state, 0, &[0.0; 3]), 0.0);
    }
}
