//! Closed-form solution for the free scales beyond the end of the solved part of a row.

mod coupled;

use coupled::CoupledRow;

use crate::RowStiffness;

/// Effect of the free scales of a row on the scales at the end of its solved part.
///
/// With nearest-neighbour coupling, a free scale `k` is in equilibrium if
/// `α u_k = β (u_{k−1} + u_{k+1})` in each direction. The decaying solution of this chain is
///
/// ```text
/// u_k = r^k u_0,     β (r + 1/r) = α,  |r| < 1                                       (S13)
/// ```
///
/// The last solved scale, 0, then has the stiffness `α − β r` instead of `α`, and the free scales
/// need not be solved. `r` has the sign of `β`, so rotations alternate in sign. If only `n` free
/// scales follow, both solutions `r^k` and `r^{−k}` are combined so that no force acts on the last
/// scale:
///
/// ```text
/// u_k = r^k (1 − r^{2(n+1−k)})/(1 − r^{2(n+1)}) u_0,     stiffness α − β u_1/u_0        (S16)
/// ```
///
/// If scales couple with `m > 1` neighbours, or forces with rotations, the last `m` solved scales
/// take the role of scale 0 (S17). Solved scales are counted from the end inwards, starting at 0;
/// the free scales lie to the right of the end.
#[derive(Clone, Debug, PartialEq)]
pub struct FarField {
    /// Reductions of the stiffness of the last solved scales.
    pub relief: Vec<Relief>,
    motion: FreeMotion,
}

/// Reduction of one 3 × 3 stiffness block by the free scales, in units of [`RowStiffness`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// Scale on which the force acts, counted from the end inwards.
    pub force: usize,
    /// Scale that is displaced, counted from the end inwards.
    pub displacement: usize,
    /// Reductions: rows are force along `x`, force along `y` and moment.
    ///
    /// Columns are the displacements `x`, `y`, `φ`.
    pub by: [[f64; 3]; 3],
}

/// Motion of the free scales as a function of the displacements of the last solved scales.
#[derive(Clone, Debug, PartialEq)]
enum FreeMotion {
    /// Decay `r` in each direction, and the number of free scales (`None`: infinite).
    Chain([f64; 3], Option<usize>),
    Coupled(CoupledRow),
}

impl FarField {
    /// Computes the displacements `(x, y, φ)` of the first `count` free scales.
    ///
    /// `end(i)` returns the displacements of the solved scale `i`, counted from the end inwards.
    pub fn displacements(&self, end: impl Fn(usize) -> [f64; 3], count: usize) -> Vec<[f64; 3]> {
        match &self.motion {
            FreeMotion::Chain(..) => (1..=count).map(|k| self.displacement(&end, k)).collect(),
            FreeMotion::Coupled(row) => row.displacements(end, count),
        }
    }

    /// Computes the displacements of the free scale `distance`, where 1 is next to the end.
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

/// Returns `u_k/u_0` by (S13), or by (S16) if the row ends after `scales` free scales.
fn decayed(r: f64, scales: Option<usize>, k: usize) -> f64 {
    // The cast is exact, because a row has far fewer scales than `i32::MAX`.
    let decay = r.powi(k as i32);
    let Some(n) = scales else { return decay };
    let [of_distance, of_length] = [n + 1 - k, n + 1].map(|n| 1.0 - r.powi(2 * n as i32));
    decay * (of_distance / of_length)
}

impl RowStiffness {
    /// Returns the far field of `scales` free scales, or of infinitely many for `None`.
    ///
    /// The result is `None` if displacements do not decay because the row is unstable
    /// (`α ≤ 2 |β|`). It is also `None` for a finite number of scales with a coupling other than
    /// nearest neighbours, because there is no closed form.
    pub fn far_field(&self, scales: Option<usize>) -> Option<FarField> {
        match self.neighbours.as_slice() {
            // The three directions are uncoupled, so each direction is a separate chain.
            [nearest] if nearest.is_diagonal() && self.roll == 0.0 => {
                self.chain(nearest.direct, scales)
            }
            _ => scales.is_none().then(|| self.coupled())?,
        }
    }

    /// Returns the far field for nearest-neighbour coupling without coupling of directions.
    fn chain(&self, coupling: [f64; 3], scales: Option<usize>) -> Option<FarField> {
        let beta = coupling.map(|stiffness| -stiffness);
        if !(0..3).all(|k| self.direct[k] > 2.0 * beta[k].abs()) {
            return None;
        }
        let decay: [f64; 3] = std::array::from_fn(|k| {
            let (alpha, twice) = (self.direct[k], 2.0 * beta[k]);
            // The smaller root of β r² − α r + β = 0, in a form without cancellation.
            twice / (alpha + ((alpha - twice) * (alpha + twice)).sqrt())
        });
        let mut by = [[0.0; 3]; 3];
        for k in 0..3 {
            by[k][k] = beta[k] * decayed(decay[k], scales, 1);
        }
        let relief = vec![Relief { force: 0, displacement: 0, by }];
        Some(FarField { relief, motion: FreeMotion::Chain(decay, scales) })
    }

    /// Returns the far field of infinitely many free scales with coupling to several neighbours.
    fn coupled(&self) -> Option<FarField> {
        let (row, relief) = CoupledRow::endless(self)?;
        Some(FarField { relief, motion: FreeMotion::Coupled(row) })
    }
}
