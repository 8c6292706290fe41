//! Cantilever of unit length for the tests: clamped on the left and loaded at its tip.

use geometry::OutOfRange;
use membrane::{GapMembrane, Section, Span};
use nalgebra::{DVector, Vector3};

const MAX_ITERATIONS: usize = 60;

/// Creates a cantilever of length 1, bending stiffness 1 and axial stiffness `12/thickness²`.
pub fn cantilever(elements: usize, thickness: f64) -> Result<GapMembrane, OutOfRange> {
    let section = Section::new(12.0 / thickness.powi(3), thickness)?;
    GapMembrane::new(section, Span { half_base: 0.0, gap: 1.0, axis_offset: 0.0 }, elements)
}

/// Returns the displacements of all nodes under the load `(X, Y, M)` on the right scale.
///
/// The left scale is clamped. The load is applied in `steps` equal steps. Newton's method starts
/// each step from a linear extrapolation of the last two solutions, because it only converges from
/// points near the equilibrium path: the strip is much stiffer in tension than in bending.
pub fn equilibrium(gap: &GapMembrane, load: Vector3<f64>, steps: u32) -> DVector<f64> {
    let mut last = DVector::zeros(gap.unknowns());
    let mut u = last.clone();
    for step in 1..=steps {
        let next = newton(gap, 2.0 * &u - &last, load * (f64::from(step) / f64::from(steps)));
        last = std::mem::replace(&mut u, next);
    }
    u
}

/// Returns the displacements under `load` on the right scale, by Newton's method from `u`.
fn newton(gap: &GapMembrane, mut u: DVector<f64>, load: Vector3<f64>) -> DVector<f64> {
    let free = gap.unknowns() - 3;
    for _ in 0..MAX_ITERATIONS {
        let response = gap.response(&u);
        let mut residual = -response.force.rows(3, free).into_owned();
        let mut tip = residual.fixed_rows_mut::<3>(free - 3);
        tip += load;
        let tangent = response.tangent.view((3, 3), (free, free)).into_owned();
        let change = tangent.lu().solve(&residual).expect("the tangent is regular");
        let mut moved = u.rows_mut(3, free);
        moved += &change;
        if change.amax() < 1e-11 {
            return u;
        }
    }
    panic!("no equilibrium at {load:?}");
}
