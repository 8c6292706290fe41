//! Far field with coupling to several neighbours.

use nalgebra::DMatrix;

use super::Relief;
use crate::RowStiffness;

/// Number of blocks after which a row without convergence counts as non-decaying.
const BLOCKS: usize = 400;

/// Relative change of the reduction per block below which the row is infinite.
const SETTLED: f64 = 1e-15;

/// Infinite row of free scales coupled with `m` neighbours per side.
///
/// Its blocks have `m` scales. Each block has the stiffness `D` for itself and `U` for the next
/// block. A block followed by `n` more has the stiffness `D − R_n`,
///
/// ```text
/// R_0 = 0,   R_{n+1} = U (D − R_n)⁻¹ Uᵀ  →  R,      X_{j+1} = −(D − R)⁻¹ Uᵀ X_j         (S17)
/// ```
///
/// with the displacements `X_j` of block `j`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CoupledRow {
    /// Number `m` of scales per block.
    scales: usize,
    /// `−(D − R)⁻¹ Uᵀ`, with the scales ordered from left to right.
    transfer: DMatrix<f64>,
}

impl CoupledRow {
    /// Solves for the row and its reduction of the stiffness of the block before it.
    ///
    /// `None` if nothing decays.
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

    /// Computes the displacements of the first `count` free scales.
    ///
    /// `end` counts the scales at the end from there.
    pub(super) fn displacements(
        &self,
        end: impl Fn(usize) -> [f64; 3],
        count: usize,
    ) -> Vec<[f64; 3]> {
        // The end counts its scales inwards, a block from left to right.
        let mut block: Vec<f64> = (0..self.scales).rev().flat_map(end).collect();
        let mut displacements = Vec::with_capacity(count + self.scales);
        while displacements.len() < count {
            block = self.next(&block);
            displacements.extend_from_slice(block.as_chunks().0);
        }
        displacements.truncate(count);
        displacements
    }

    /// Computes the displacements of the next block.
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

/// Returns the stiffness of a block for the block `farther` scales to the right.
///
/// It is `D` for 0.
fn block(stiffness: &RowStiffness, farther: usize) -> DMatrix<f64> {
    let size = 3 * stiffness.neighbours.len();
    DMatrix::from_fn(size, size, |row, column| {
        let (force, displaced) = (row / 3, column / 3 + farther);
        let (k, l) = (row % 3, column % 3);
        // Seen from the right, force and displacement are exchanged.
        let (k, l) = if force <= displaced { (k, l) } else { (l, k) };
        match force.abs_diff(displaced) {
            0 if k == l => stiffness.direct[k],
            0 if k + l == 2 => stiffness.roll,
            0 => 0.0,
            distance => stiffness.neighbours.get(distance - 1).map_or(0.0, |n| n.on_left()[k][l]),
        }
    })
}

/// Splits a reduction by scales from the end, and symmetrises it.
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
