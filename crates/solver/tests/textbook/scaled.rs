//! Problems in other units.

use std::borrow::Cow;

use solver::{BandMatrix, Control, Residual, State, System};

/// A system whose unknowns are measured in other units: each is `factors` times the one of the `system`, and so
/// are the scales of its controls. Its path is the same.
#[derive(Clone)]
pub struct Scaled<S> {
    system: S,
    factors: Vec<f64>,
    controls: Vec<Control>,
}

impl<S: System> Scaled<S> {
    /// The factors of constraints must be positive.
    pub fn new(system: S, factors: Vec<f64>) -> Self {
        let scaled = |c: &Control| Control { scale: c.scale * factors[c.index], ..*c };
        let controls = system.controls().iter().map(scaled).collect();
        Self { system, factors, controls }
    }

    /// The unknowns in the units of the system.
    pub fn unscaled<'a>(&self, z: impl Into<Cow<'a, [f64]>>) -> Vec<f64> {
        z.into().iter().zip(&self.factors).map(|(z, factor)| z / factor).collect()
    }
}

impl<S: System> System for Scaled<S> {
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

    fn residual(&self, z: &[f64], active: &[bool], residual: &mut Residual) {
        self.system.residual(&self.unscaled(z), active, residual);
    }

    fn tangent(&self, z: &[f64], active: &[bool], matrix: &mut BandMatrix) {
        let mut inner = BandMatrix::new(self.size(), self.half_bandwidth());
        self.system.tangent(&self.unscaled(z), active, &mut inner);
        for row in 0..self.size() {
            for column in inner.columns(row) {
                matrix.add(row, column, inner.get(row, column) / self.factors[column]);
            }
        }
    }

    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64 {
        let state = State { z: self.unscaled(&state.z), active: state.active.clone() };
        self.system.slope(&state, constraint, &self.unscaled(direction))
    }

    fn exchange(&mut self, state: &mut State, constraint: usize) -> usize {
        self.system.exchange(state, constraint)
    }
}
