//! The row beyond the last scale that anything but the substrate acts on.

use crate::RowStiffness;

/// The effect of an endless row of free scales on the scale at its beginning.
///
/// With the coupling of Eq. (1) a free scale `k` obeys `α u_k = β (u_{k−1} + u_{k+1})` in each direction. Of the two
/// solutions of such a chain the one that decays is
///
/// ```text
/// u_k = r^k u_0,     β (r + 1/r) = α,  |r| < 1                                       (S13)
/// ```
///
/// so the scale 0, with an endless row on one side of it, is held by `α − β r` in place of `α`, and the scales
/// beyond need not be solved for. `r` has the sign of `β`: rotations alternate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarField {
    /// `r` of `x`, `y`, `φ`.
    pub decay: [f64; 3],
    /// `β r`, by which the row takes the stiffness of the scale 0 down; in the units of [`RowStiffness`].
    pub relief: [f64; 3],
}

impl FarField {
    /// Displacements of the scale `distance` places from one that is displaced by `end`.
    pub fn displacement(&self, end: [f64; 3], distance: usize) -> [f64; 3] {
        // A row is never as long as an `i32` counts.
        std::array::from_fn(|k| self.decay[k].powi(distance as i32) * end[k])
    }
}

impl RowStiffness {
    /// The endless row beyond the end of one that is solved for. `None` with couplings that reach farther than the nearest
    /// neighbour, or turn rotation into force, and if nothing decays because the row is not stable (`α ≤ 2 |β|`).
    pub fn far_field(&self) -> Option<FarField> {
        let [nearest] = self.neighbours.as_slice() else { return None };
        let beta = nearest.direct.map(|stiffness| -stiffness);
        let stable = (0..3).all(|k| self.direct[k] > 2.0 * beta[k].abs());
        if nearest.cross != 0.0 || !stable {
            return None;
        }
        let decay = std::array::from_fn(|k| {
            let (alpha, twice) = (self.direct[k], 2.0 * beta[k]);
            // The smaller root of β r² − α r + β = 0, without cancellation.
            twice / (alpha + ((alpha - twice) * (alpha + twice)).sqrt())
        });
        Some(FarField { decay, relief: std::array::from_fn(|k| beta[k] * decay[k]) })
    }
}
