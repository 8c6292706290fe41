//! Bratu's problem, which has a fold at a known critical load.

use solver::{Control, Residual, State, System, Tangent};

/// Bratu's problem `u″ + λ eᵘ = 0` on the unit interval, by central differences.
///
/// `u` is zero at both ends (Bratu 1914). The load is `λ`, the control parameter is `u` in the
/// middle. The maximum of `λ` is 3.513 830 719, at the solution of `cosh θ = θ sinh θ`.
#[derive(Clone)]
pub struct Bratu {
    intervals: usize,
    controls: [Control; 1],
}

impl Bratu {
    pub fn new(intervals: usize) -> Self {
        Self { intervals, controls: [Control { index: intervals / 2 - 1, scale: 3.0 }] }
    }

    /// Returns the length of an interval.
    fn h(&self) -> f64 {
        1.0 / self.intervals as f64
    }
}

impl System for Bratu {
    type Mode = ();

    fn size(&self) -> usize {
        self.intervals
    }

    fn half_bandwidth(&self) -> usize {
        self.intervals - 1
    }

    fn load(&self) -> usize {
        self.intervals - 1
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&vec![1.0; self.size()]);
        let (load, inside) = (self.load(), self.intervals - 1);
        for i in 0..inside {
            residual.add(i, -2.0 * z[i] + self.h().powi(2) * z[load] * z[i].exp());
            if i > 0 {
                residual.add(i, z[i - 1]);
            }
            if i + 1 < inside {
                residual.add(i, z[i + 1]);
            }
        }
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        let (load, inside) = (self.load(), self.intervals - 1);
        for i in 0..inside {
            let source = self.h().powi(2) * z[i].exp();
            matrix.add(i, i, -2.0 + z[load] * source);
            matrix.add(i, load, source);
            if i > 0 {
                matrix.add(i, i - 1, 1.0);
            }
            if i + 1 < inside {
                matrix.add(i, i + 1, 1.0);
            }
        }
    }
}
