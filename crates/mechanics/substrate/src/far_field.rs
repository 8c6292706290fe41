//! Closed form for the free scales beyond the end of the solved part of a row.

mod coupled;

use coupled::CoupledRow;

use crate::RowStiffness;

/// Effect of free scales on the scales at the end of the solved part.
///
/// With the coupling of Eq. (1), a free scale `k` obeys `α u_k = β (u_{k−1} + u_{k+1})` in each
/// direction. The decaying solution of this chain is
///
/// ```text
/// u_k = r^k u_0,     β (r + 1/r) = α,  |r| < 1                                       (S13)
/// ```
///
/// so a scale 0 with an infinite row on one side has the stiffness `α − β r` instead of `α`, and
/// the scales beyond need not be solved. `r` has the sign of `β`: rotations alternate. If the row
/// ends after `n` more scales, a combination of both solutions leaves the last one free,
///
/// ```text
/// u_k = r^k (1 − r^{2(n+1−k)})/(1 − r^{2(n+1)}) u_0,     held by α − β u_1/u_0          (S16)
/// ```
///
/// If scales couple with `m > 1` neighbours, or forces with rotations, the last `m` scales take the
/// role of scale 0 (S17).
///
/// Scales are counted from the end, starting at 0; the free scales lie to the right.
#[derive(Clone, Debug, PartialEq)]
pub struct FarField {
    /// Reductions of the stiffness of the scales at the end.
    pub relief: Vec<Relief>,
    motion: FreeMotion,
}

/// Reduction of a stiffness block by free scales, in [`RowStiffness`] units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// Scale with the force.
    pub force: usize,
    /// Scale with the displacement.
    pub displacement: usize,
    /// Reduction of force along `x`, force along `y` and moment.
    ///
    /// Each is for the three displacements.
    pub by: [[f64; 3]; 3],
}

/// Law by which the free scales follow the scales at the end.
#[derive(Clone, Debug, PartialEq)]
enum FreeMotion {
    /// Decay `r` of each direction, and the number of free scales if the row ends.
    Chain([f64; 3], Option<usize>),
    Coupled(CoupledRow),
}

impl FarField {
    /// Computes the displacements of the first `count` free scales.
    ///
    /// `end` returns the displacements of the scales at the end, counted from there.
    pub fn displacements(&self, end: impl Fn(usize) -> [f64; 3], count: usize) -> Vec<[f64; 3]> {
        match &self.motion {
            FreeMotion::Chain(..) => (1..=count).map(|k| self.displacement(&end, k)).collect(),
            FreeMotion::Coupled(row) => row.displacements(end, count),
        }
    }

    /// Computes the displacement of the scale `distance > 0` beyond the end.
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

/// Returns `u_k/u_0` of (S13), or of (S16) if the row ends after `scales` further scales.
fn decayed(r: f64, scales: Option<usize>, k: usize) -> f64 {
    // A row is always shorter than the range of `i32`.
    let decay = r.powi(k as i32);
    let Some(n) = scales else { return decay };
    let [of_distance, of_length] = [n + 1 - k, n + 1].map(|n| 1.0 - r.powi(2 * n as i32));
    decay * (of_distance / of_length)
}

impl RowStiffness {
    /// Returns the far field of an infinite row, or of a row with `scales` more scales.
    ///
    /// A finite number has a closed form only with the coupling of Eq. (1). `None` without a closed
    /// form, and if nothing decays because the row is unstable (`α ≤ 2 |β|`).
    pub fn far_field(&self, scales: Option<usize>) -> Option<FarField> {
        match self.neighbours.as_slice() {
            // Without coupling of directions, each of the three is a separate chain.
            [nearest] if nearest.is_diagonal() && self.roll == 0.0 => {
                self.chain(nearest.direct, scales)
            }
            _ => scales.is_none().then(|| self.coupled())?,
        }
    }

    /// Returns the far field with the coupling of Eq. (1).
    fn chain(&self, coupling: [f64; 3], scales: Option<usize>) -> Option<FarField> {
        let beta = coupling.map(|stiffness| -stiffness);
        if !(0..3).all(|k| self.direct[k] > 2.0 * beta[k].abs()) {
            return None;
        }
        let decay: [f64; 3] = std::array::from_fn(|k| {
            let (alpha, twice) = (self.direct[k], 2.0 * beta[k]);
            // Smaller root of β r² − α r + β = 0, without cancellation.
            twice / (alpha + ((alpha - twice) * (alpha + twice)).sqrt())
        });
        let mut by = [[0.0; 3]; 3];
        for k in 0..3 {
            by[k][k] = beta[k] * decayed(decay[k], scales, 1);
        }
        let relief = vec![Relief { force: 0, displacement: 0, by }];
        Some(FarField { relief, motion: FreeMotion::Chain(decay, scales) })
    }

    /// Returns the far field of an infinite row with coupling to several neighbours.
    fn coupled(&self) -> Option<FarField> {
        let (row, relief) = CoupledRow::endless(self)?;
        Some(FarField { relief, motion: FreeMotion::Coupled(row) })
    }
}
