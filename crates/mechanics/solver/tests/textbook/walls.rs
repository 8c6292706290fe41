//! System with one displacement that is limited by compliant walls.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use solver::{Control, Residual, State, System, Tangent};

/// Displacement `u` under a load `p`, with compliant walls.
///
/// `c_k` is the force of wall `k`. The equations are `p = u + Σ c_k` and
/// `0 ≤ c_k ⟂ r_k(u) + c_k + s_k ≥ 0`. The term `s_k` is twice the force of the wall that shields
/// wall `k`, or zero without such a wall. The unknowns are `u, c_1, c_2 … p`, and the control
/// parameter is `u` with the target 1.
#[derive(Clone)]
pub struct Walls {
    /// Function `r_k` of each wall, with its derivative.
    gaps: Vec<fn(f64) -> [f64; 2]>,
    /// Number of the shielded wall and of the wall that shields it.
    shielded: Option<(usize, usize)>,
    constraints: Vec<usize>,
    controls: Vec<Control>,
    /// Number of evaluations of the tangent.
    pub tangents: Arc<AtomicUsize>,
}

impl Walls {
    pub fn new(gaps: Vec<fn(f64) -> [f64; 2]>) -> Self {
        let constraints = (1..=gaps.len()).collect();
        let controls = vec![Control { index: 0, scale: 1.0 }];
        Self { gaps, shielded: None, constraints, controls, tangents: Arc::default() }
    }

    /// Creates walls in which twice the force of the wall `by` is added to the gap of the wall
    /// `wall`.
    pub fn shielded(gaps: Vec<fn(f64) -> [f64; 2]>, wall: usize, by: usize) -> Self {
        Self { shielded: Some((wall, by)), ..Self::new(gaps) }
    }

    /// Creates walls with the load as a second control.
    pub fn measured_by_the_load(gaps: Vec<fn(f64) -> [f64; 2]>) -> Self {
        let mut walls = Self::new(gaps);
        walls.controls.push(Control { index: walls.load(), scale: 1.0 });
        walls
    }
}

impl System for Walls {
    type Mode = ();

    fn size(&self) -> usize {
        self.gaps.len() + 2
    }

    fn half_bandwidth(&self) -> usize {
        self.size() - 1
    }

    fn load(&self) -> usize {
        self.size() - 1
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        &self.constraints
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&vec![1.0; self.size()]);
        residual.add(0, z[0]);
        residual.add(0, -z[self.load()]);
        for (k, gap) in self.gaps.iter().enumerate() {
            residual.add(0, z[k + 1]);
            residual.add(k + 1, gap(z[0])[0]);
            residual.add(k + 1, z[k + 1]);
        }
        if let Some((wall, by)) = self.shielded {
            residual.add(wall + 1, 2.0 * z[by + 1]);
        }
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        self.tangents.fetch_add(1, Ordering::Relaxed);
        matrix.add(0, 0, 1.0);
        matrix.add(0, self.load(), -1.0);
        for (k, gap) in self.gaps.iter().enumerate() {
            matrix.add(0, k + 1, 1.0);
            matrix.add(k + 1, 0, gap(z[0])[1]);
            matrix.add(k + 1, k + 1, 1.0);
        }
        if let Some((wall, by)) = self.shielded {
            matrix.add(wall + 1, by + 1, 2.0);
        }
    }
}
