//! Smooth systems without constraints.

use solver::{Control, Residual, State, System, Tangent};

use super::controls;

/// System of `N` unknowns without constraints, given by functions.
///
/// The load is the last unknown.
#[derive(Clone)]
pub struct Smooth<const N: usize> {
    pub controls: Vec<Control>,
    /// Values of the `N − 1` equations.
    pub equations: fn(&[f64]) -> Vec<f64>,
    /// Derivatives of each equation with respect to all unknowns.
    pub derivatives: fn(&[f64]) -> Vec<[f64; N]>,
    pub load_only_pushes: bool,
}

impl<const N: usize> System for Smooth<N> {
    type Mode = ();

    fn size(&self) -> usize {
        N
    }

    fn half_bandwidth(&self) -> usize {
        N - 1
    }

    fn load(&self) -> usize {
        N - 1
    }

    fn load_only_pushes(&self) -> bool {
        self.load_only_pushes
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&[1.0; N]);
        for (row, value) in (self.equations)(z).into_iter().enumerate() {
            residual.add(row, value);
        }
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        for (row, values) in (self.derivatives)(z).into_iter().enumerate() {
            for (column, value) in values.into_iter().enumerate() {
                matrix.add(row, column, value);
            }
        }
    }
}

/// Shallow arch with the displacement `u` and the load `p = u (1 − u)(2 − u)`.
///
/// The load has its extrema `± 2/(3√3)` at `u = 1 ∓ 1/√3`.
pub fn arch() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 2.5)]),
        equations: |z| vec![z[0] * (1.0 - z[0]) * (2.0 - z[0]) - z[1]],
        derivatives: |z| vec![[3.0 * z[0] * z[0] - 6.0 * z[0] + 2.0, -1.0]],
        load_only_pushes: false,
    }
}

/// [`arch`] under a load that can only push, which returns to zero at `u = 1`.
pub fn pushed_arch() -> Smooth<2> {
    Smooth { load_only_pushes: true, ..arch() }
}

/// Stiffness of the spring of [`arch_on_spring`].
pub const SPRING: f64 = 0.25;

/// Arch that is loaded by a soft spring: `p = w (1 − w)(2 − w) = k (d − w)`.
///
/// The unknowns are the displacement `w` of the arch, the displacement `d` of the end of the
/// spring, and `p`. The control parameter `d` reverses at `w = 1/2`, `d = 2`, and again at
/// `w = 3/2`, `d = 0`.
pub fn arch_on_spring() -> Smooth<3> {
    Smooth {
        controls: controls(&[(1, 3.0), (0, 1.0)]),
        equations: |z| {
            vec![z[0] * (1.0 - z[0]) * (2.0 - z[0]) - z[2], SPRING * (z[1] - z[0]) - z[2]]
        },
        derivatives: |z| {
            vec![[3.0 * z[0] * z[0] - 6.0 * z[0] + 2.0, 0.0, -1.0], [-SPRING, SPRING, -1.0]]
        },
        load_only_pushes: false,
    }
}

/// Circle `x² + y² = 1` with the load `y` and the control parameter `x`.
///
/// The control parameter never reaches its target 2.
pub fn circle() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 2.0), (1, 2.0)]),
        equations: |z| vec![z[0] * z[0] + z[1] * z[1] - 1.0],
        derivatives: |z| vec![[2.0 * z[0], 2.0 * z[1]]],
        load_only_pushes: false,
    }
}

/// Column under the load `F` that may buckle at `F = 1`.
///
/// The shortening is `x = F`, and the deflection `y` satisfies `y (1 − F + y²) = 0`.
pub fn column() -> Smooth<3> {
    Smooth {
        controls: controls(&[(0, 2.0)]),
        equations: |z| vec![z[0] - z[2], z[1] * (1.0 - z[2] + z[1] * z[1])],
        derivatives: |z| vec![[1.0, 0.0, -1.0], [0.0, 1.0 - z[2] + 3.0 * z[1] * z[1], -z[1]]],
        load_only_pushes: false,
    }
}

/// Smooth step `p = tanh 4 (u − 0.6)`, with the maximum slope 4 at `u = 0.6`.
pub fn step() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0)]),
        equations: |z| vec![(4.0 * (z[0] - 0.6)).tanh() - z[1]],
        derivatives: |z| vec![[4.0 / (4.0 * (z[0] - 0.6)).cosh().powi(2), -1.0]],
        load_only_pushes: false,
    }
}

/// Parabola `y² = u`; the control parameter `u` has its minimum at the start of the path.
pub fn parabola() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0)]),
        equations: |z| vec![z[1] * z[1] - z[0]],
        derivatives: |z| vec![[-1.0, 2.0 * z[1]]],
        load_only_pushes: false,
    }
}

/// Square root `p = √(1/2 − u)`, which ends at `u = 1/2`.
pub fn root() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0)]),
        equations: |z| vec![(0.5 - z[0]).sqrt() - z[1]],
        derivatives: |z| vec![[-0.5 / (0.5 - z[0]).sqrt(), -1.0]],
        load_only_pushes: false,
    }
}

/// Discontinuous path: `p = u` up to `u = 1/2`, and `p = u − 1` beyond.
pub fn jump() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0), (1, 1.0)]),
        equations: |z| vec![z[0] - f64::from(z[0] > 0.5) - z[1]],
        derivatives: |_| vec![[1.0, -1.0]],
        load_only_pushes: false,
    }
}

/// System `10¹⁵ (sin u − p) = 0`, with the control parameter `u` and its target 1.
///
/// The difference of the two large terms has a round-off error of about 0.1.
#[derive(Clone)]
pub struct Stiff;

impl System for Stiff {
    type Mode = ();

    fn size(&self) -> usize {
        2
    }

    fn half_bandwidth(&self) -> usize {
        1
    }

    fn load(&self) -> usize {
        1
    }

    fn controls(&self) -> &[Control] {
        &[Control { index: 0, scale: 1.0 }]
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&[1.0; 2]);
        residual.add(0, 1e15 * z[0].sin());
        residual.add(0, -1e15 * z[1]);
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        matrix.add(0, 0, 1e15 * z[0].cos());
        matrix.add(0, 1, -1e15);
    }
}
