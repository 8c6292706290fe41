//! Far field of free scales with several coupled neighbours, or with forces coupled to rotations.

use nalgebra::DMatrix;

use super::Relief;
use crate::RowStiffness;

/// Maximum number of iterations for `R`; if they do not converge, displacements do not decay.
const BLOCKS: usize = 400;

/// Convergence tolerance for the reduction `R`, relative to the largest stiffness of a scale.
const SETTLED: f64 = 1e-15;

/// Infinite row of free scales, each coupled with `m` neighbours on each side.
///
/// The row is divided into blocks of `m` scales. A block has the stiffness `D`, and `U` couples it
/// with the next block. If `n` more blocks follow it, its stiffness is `D − R_n`, with
///
/// ```text
/// R_0 = 0,   R_{n+1} = U (D − R_n)⁻¹ Uᵀ  →  R,      X_{j+1} = −(D − R)⁻¹ Uᵀ X_j         (S17)
/// ```
///
/// where `X_j` are the displacements of block `j`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CoupledRow {
    /// Number `m` of scales per block.
    scales: usize,
    /// `−(D − R)⁻¹ Uᵀ`, which maps the displacements of a block to the next; scales left to right.
    transfer: DMatrix<f64>,
}

impl CoupledRow {
    /// Computes the row, and the reductions of the stiffness of the last solved scales by the row.
    ///
    /// Returns `None` if displacements do not decay along the row.
    pub(super) fn endless(stiffness: &RowStiffness) -> Option<(Self, Vec<Relief>)> {
        let scales = stiffness.neighbours.len();
        let diagonal = block(stiffness, 0);
        let next = block(stiffness, scales);
        let least = SETTLED * stiffness.direct.iter().copied().fold(0.0, f64::max);
        let mut relief = DMatrix::zeros(3 * scales, 3 * scales);
        for _ in 0..BLOCKS {
            let follows = (&diagonal - &relief).lu().solve(&next.transpose())?;
            let before = std::mem::replace(&mut relief, &next * &follows);
            if relief.iter().any(|value| !value.is_finite()) {
                break;
            }
            if (&relief - &before).amax() <= least {
                let parts = parts(&relief, scales);
                return Some((Self { scales, transfer: -follows }, parts));
            }
        }
        None
    }

    /// Computes the displacements `(x, y, φ)` of the first `count` free scales.
    ///
    /// `end(i)` returns the displacements of the solved scale `i`, counted from the end inwards.
    pub(super) fn displacements(
        &self,
        end: impl Fn(usize) -> [f64; 3],
        count: usize,
    ) -> Vec<[f64; 3]> {
        // `end` counts scales from right to left; a block stores them from left to right.
        let mut block: Vec<f64> = (0..self.scales).rev().flat_map(end).collect();
        let mut displacements = Vec::with_capacity(count + self.scales);
        while displacements.len() < count {
            block = self.next(&block);
            displacements.extend_from_slice(block.as_chunks().0);
        }
        displacements.truncate(count);
        displacements
    }

    /// Computes the displacements of the block that follows `block`.
    fn next(&self, block: &[f64]) -> Vec<f64> {
        let mut next = vec![0.0; block.len()];
        for (column, u) in self.transfer.column_iter().zip(block) {
            for (next, factor) in next.iter_mut().zip(column.iter()) {
                *next += factor * u;
            }
        }
        next
    }
}

/// Returns the stiffness that couples a block with the block `farther` scales to its right.
///
/// For `farther = 0` it is `D`, for the number of scales of a block it is `U`.
fn block(stiffness: &RowStiffness, farther: usize) -> DMatrix<f64> {
    let size = 3 * stiffness.neighbours.len();
    DMatrix::from_fn(size, size, |row, column| {
        let (force, displaced) = (row / 3, column / 3 + farther);
        let (k, l) = (row % 3, column % 3);
        // `on_left` holds forces on the left scale; for forces on the right scale it is transposed.
        let (k, l) = if force <= displaced { (k, l) } else { (l, k) };
        match force.abs_diff(displaced) {
            0 if k == l => stiffness.direct[k],
            0 if k + l == 2 => stiffness.roll,
            0 => 0.0,
            distance => stiffness.neighbours.get(distance - 1).map_or(0.0, |n| n.on_left()[k][l]),
        }
    })
}

/// Splits the reduction of a block into symmetric parts for pairs of scales, counted from the end.
fn parts(relief: &DMatrix<f64>, scales: usize) -> Vec<Relief> {
    let pairs = (0..scales).flat_map(|force| (0..scales).map(move |displaced| (force, displaced)));
    let parts = pairs.map(|(force, displacement)| {
        let [row, column] = [force, displacement].map(|scale| 3 * (scales - 1 - scale));
        let by = std::array::from_fn(|k| {
            std::array::from_fn(|l| {
                let (i, j) = (row + k, column + l);
                f64::midpoint(relief[(i, j)], relief[(j, i)])
            })
        });
        Relief { force, displacement, by }
    });
    parts.collect()
}
