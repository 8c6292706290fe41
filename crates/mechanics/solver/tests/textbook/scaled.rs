//! Problems in other units.

use std::borrow::Cow;

use solver::{BandMatrix, Change, Control, Residual, State, System, Tangent};

/// System in other units: `factors` multiply unknowns and control scales.
///
/// The path is the same.
#[derive(Clone)]
pub struct Scaled<S> {
    system: S,
    factors: Vec<f64>,
    controls: Vec<Control>,
}

impl<S: System> Scaled<S> {
    /// Factors of constraints must be positive.
    pub fn new(system: S, factors: Vec<f64>) -> Self {
        let mut controls = system.controls().to_vec();
        for control in &mut controls {
            control.scale *= factors[control.index];
        }
        Self { system, factors, controls }
    }

    fn unscaled_state(&self, state: &State<S::Mode>) -> State<S::Mode> {
        State { z: self.unscaled(&state.z), ..state.clone() }
    }

    /// Returns the unknowns in the units of the system.
    pub fn unscaled<'a>(&self, z: impl Into<Cow<'a, [f64]>>) -> Vec<f64> {
        z.into().iter().zip(&self.factors).map(|(z, factor)| z / factor).collect()
    }
}

impl<S: System> System for Scaled<S> {
    type Mode = S::Mode;

    fn size(&self) -> usize {
        self.system.size()
    }

    fn half_bandwidth(&self) -> usize {
        self.system.half_bandwidth()
    }

    fn load(&self) -> usize {
        self.system.load()
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        self.system.constraints()
    }

    fn mode_at_rest(&self) -> S::Mode {
        self.system.mode_at_rest()
    }

    fn residual(&self, state: &State<S::Mode>, residual: &mut Residual) {
        self.system.residual(&self.unscaled_state(state), residual);
    }

    fn tangent(&self, state: &State<S::Mode>, matrix: &mut impl Tangent) {
        let mut inner = BandMatrix::new(self.size(), self.half_bandwidth());
        self.system.tangent(&self.unscaled_state(state), &mut inner);
        for row in 0..self.size() {
            for column in inner.columns(row) {
                matrix.add(row, column, inner.get(row, column) / self.factors[column]);
            }
        }
    }

    fn slope(&self, state: &State<S::Mode>, constraint: usize, direction: &[f64]) -> f64 {
        let direction = self.unscaled(direction);
        self.system.slope(&self.unscaled_state(state), constraint, &direction)
    }

    fn transition(&self, state: &mut State<S::Mode>, change: Change) -> Option<usize> {
        self.system.transition(state, change)
    }
}
