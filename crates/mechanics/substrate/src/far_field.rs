//! The row beyond the last scale that anything but the substrate acts on.

mod coupled;

use coupled::CoupledRow;

use crate::RowStiffness;

/// The effect of free scales on those at whose end they stand.
///
/// With the coupling of Eq. (1) a free scale `k` obeys `α u_k = β (u_{k−1} + u_{k+1})` in each direction. Of the two
/// solutions of such a chain the one that decays is
///
/// ```text
/// u_k = r^k u_0,     β (r + 1/r) = α,  |r| < 1                                       (S13)
/// ```
///
/// so the scale 0, with an endless row on one side of it, is held by `α − β r` in place of `α`, and the scales
/// beyond need not be solved for. `r` has the sign of `β`: rotations alternate. Of a row that ends after `n` more scales both solutions
/// together leave the last one free,
///
/// ```text
/// u_k = r^k (1 − r^{2(n+1−k)})/(1 − r^{2(n+1)}) u_0,     held by α − β u_1/u_0          (S16)
/// ```
///
/// Where scales feel `m > 1` neighbours, or force from rotation, the last `m` scales take the place of the scale 0 (S17).
///
/// Scales are counted from the end, from 0 on; beyond it lies what is to the right.
#[derive(Clone, Debug, PartialEq)]
pub struct FarField {
    /// By how much the row takes the stiffness of the scales at the end down.
    pub relief: Vec<Relief>,
    motion: FreeMotion,
}

/// A part of the stiffness that free scales take from those at whose end they stand; in the units of [`RowStiffness`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// Scale on which the force acts.
    pub force: usize,
    /// Scale that is displaced.
    pub displacement: usize,
    /// By how much force along `x`, force along `y` and moment are smaller, each for the three displacements.
    pub by: [[f64; 3]; 3],
}

/// How the scales beyond follow those at the end.
#[derive(Clone, Debug, PartialEq)]
enum FreeMotion {
    /// With the decay `r` of each direction; of a row that ends, the number of scales beyond.
    Chain([f64; 3], Option<usize>),
    Coupled(CoupledRow),
}

impl FarField {
    /// Displacements of the first `count` scales beyond, by those of the scales at the end.
    pub fn displacements(&self, end: impl Fn(usize) -> [f64; 3], count: usize) -> Vec<[f64; 3]> {
        match &self.motion {
            FreeMotion::Chain(..) => (1..=count).map(|k| self.displacement(&end, k)).collect(),
            FreeMotion::Coupled(row) => row.displacements(end, count),
        }
    }

    /// Displacements of the scale `distance > 0` places beyond the end.
    pub fn displacement(&self, end: impl Fn(usize) -> [f64; 3], distance: usize) -> [f64; 3] {
        match &self.motion {
            FreeMotion::Chain(decay, scales) => {
                let end = end(0);
                std::array::from_fn(|k| decayed(decay[k], *scales, distance) * end[k])
            }
            FreeMotion::Coupled(row) => row.displacements(end, distance).pop().unwrap_or_default(),
        }
    }
}

/// `u_k/u_0` of (S13), or of (S16) where so many `scales` lie beyond.
fn decayed(r: f64, scales: Option<usize>, k: usize) -> f64 {
    // A row is never as long as an `i32` counts.
    let power = |n: usize| r.powi(n as i32);
    let free = |n: usize| (1.0 - power(2 * (n + 1 - k))) / (1.0 - power(2 * (n + 1)));
    power(k) * scales.map_or(1.0, free)
}

impl RowStiffness {
    /// The row beyond the end of one that is solved for: endless, or of so many `scales`, which has a closed form with the coupling
    /// of Eq. (1) alone. `None` where there is none, and if nothing decays because the row is not stable (`α ≤ 2 |β|`).
    pub fn far_field(&self, scales: Option<usize>) -> Option<FarField> {
        match self.neighbours.as_slice() {
            // Without any coupling of directions each of the three is a chain of its own.
            [nearest] if nearest.is_diagonal() && self.roll == 0.0 => {
                self.chain(nearest.direct, scales)
            }
            _ => scales.is_none().then(|| self.coupled())?,
        }
    }

    /// The far field with the coupling of Eq. (1).
    fn chain(&self, coupling: [f64; 3], scales: Option<usize>) -> Option<FarField> {
        let beta = coupling.map(|stiffness| -stiffness);
        if !(0..3).all(|k| self.direct[k] > 2.0 * beta[k].abs()) {
            return None;
        }
        let decay: [f64; 3] = std::array::from_fn(|k| {
            let (alpha, twice) = (self.direct[k], 2.0 * beta[k]);
            // The smaller root of β r² − α r + β = 0, without cancellation.
            twice / (alpha + ((alpha - twice) * (alpha + twice)).sqrt())
        });
        let mut by = [[0.0; 3]; 3];
        for k in 0..3 {
            by[k][k] = beta[k] * decayed(decay[k], scales, 1);
        }
        let relief = vec![Relief { force: 0, displacement: 0, by }];
        Some(FarField { relief, motion: FreeMotion::Chain(decay, scales) })
    }

    /// The far field of an endless row in which scales feel several neighbours.
    fn coupled(&self) -> Option<FarField> {
        let (row, relief) = CoupledRow::endless(self)?;
        Some(FarField { relief, motion: FreeMotion::Coupled(row) })
    }
}
