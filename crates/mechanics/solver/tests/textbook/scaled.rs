//! Wrapper for systems, with a change of the units of their unknowns.
//!
//! The wrapper contains the system as a trait object, so that the solver is compiled for a single
//! type instead of for each problem.

use std::borrow::Cow;
use std::rc::Rc;

use solver::{BandMatrix, Change, Control, Residual, State, System, Tangent};

/// Object-safe methods of a [`System`] without modes.
trait Problem {
    fn size(&self) -> usize;
    fn half_bandwidth(&self) -> usize;
    fn load(&self) -> usize;
    fn load_only_pushes(&self) -> bool;
    fn constraints(&self) -> &[usize];
    fn residual(&self, state: &State, residual: &mut Residual);
    fn tangent(&self, state: &State) -> BandMatrix;
    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64;
    fn transition(&self, state: &mut State, change: Change) -> Option<usize>;
}

impl<S: System<Mode = ()>> Problem for S {
    fn size(&self) -> usize {
        System::size(self)
    }

    fn half_bandwidth(&self) -> usize {
        System::half_bandwidth(self)
    }

    fn load(&self) -> usize {
        System::load(self)
    }

    fn load_only_pushes(&self) -> bool {
        System::load_only_pushes(self)
    }

    fn constraints(&self) -> &[usize] {
        System::constraints(self)
    }

    fn residual(&self, state: &State, residual: &mut Residual) {
        System::residual(self, state, residual);
    }

    fn tangent(&self, state: &State) -> BandMatrix {
        let mut matrix = BandMatrix::new(System::size(self), System::half_bandwidth(self));
        System::tangent(self, state, &mut matrix);
        matrix
    }

    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64 {
        System::slope(self, state, constraint, direction)
    }

    fn transition(&self, state: &mut State, change: Change) -> Option<usize> {
        System::transition(self, state, change)
    }
}

/// System in other units: its unknowns and control scales are multiplied by `factors`.
#[derive(Clone)]
pub struct Scaled {
    system: Rc<dyn Problem>,
    factors: Vec<f64>,
    controls: Vec<Control>,
}

impl Scaled {
    /// Wraps `system`; `factors` has one factor per unknown, positive for constraints.
    pub fn new(system: impl System<Mode = ()> + 'static, factors: Vec<f64>) -> Self {
        let mut controls = system.controls().to_vec();
        for control in &mut controls {
            control.scale *= factors[control.index];
        }
        Self { system: Rc::new(system), factors, controls }
    }

    /// Wraps `system` without a change of units.
    pub fn by_one(system: impl System<Mode = ()> + 'static) -> Self {
        let factors = vec![1.0; System::size(&system)];
        Self::new(system, factors)
    }

    /// Returns the state in the units of the wrapped system.
    fn unscaled_state(&self, state: &State) -> State {
        State { z: self.unscaled(&state.z), ..state.clone() }
    }

    /// Returns the unknowns in the units of the wrapped system.
    pub fn unscaled<'a>(&self, z: impl Into<Cow<'a, [f64]>>) -> Vec<f64> {
        z.into().iter().zip(&self.factors).map(|(z, factor)| z / factor).collect()
    }
}

impl System for Scaled {
    type Mode = ();

    fn size(&self) -> usize {
        self.system.size()
    }

    fn half_bandwidth(&self) -> usize {
        self.system.half_bandwidth()
    }

    fn load(&self) -> usize {
        self.system.load()
    }

    fn load_only_pushes(&self) -> bool {
        self.system.load_only_pushes()
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        self.system.constraints()
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, state: &State, residual: &mut Residual) {
        self.system.residual(&self.unscaled_state(state), residual);
    }

    fn tangent(&self, state: &State, matrix: &mut impl Tangent) {
        let inner = self.system.tangent(&self.unscaled_state(state));
        for row in 0..self.factors.len() {
            for column in inner.columns(row) {
                matrix.add(row, column, inner.get(row, column) / self.factors[column]);
            }
        }
    }

    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64 {
        self.system.slope(&self.unscaled_state(state), constraint, &self.unscaled(direction))
    }

    fn transition(&self, state: &mut State, change: Change) -> Option<usize> {
        self.system.transition(state, change)
    }
}
