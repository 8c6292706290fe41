//! Springs: the coefficients of Eq. (1).

use crate::boundary_element::{Unresolved, row_reactions};
use crate::{Coupling, Footprint, RowStiffness};

/// Direct (`α`) and coupling (`β`) stiffness of a row of bases on a half-space.
///
/// Dimensionless (Eq. 1 of Shafiei et al., doi 10.1016/j.jmps.2020.104176).
///
/// With `E* = E_s / (1 − ν²)` and the half-width `a` of a base, including neighbour terms,
/// `F_x = E* a (α_x u_x − β_x Σ u_x)`, likewise in `y`, and `M = E* a³ (α_φ φ − β_φ Σ φ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Springs {
    /// `α_x`, `α_y`, `α_φ`.
    pub direct: [f64; 3],
    /// `β_x`, `β_y` (positive) and `β_φ` (negative).
    pub coupling: [f64; 3],
    /// Largest estimated error of the six, relative to `α` of the same direction.
    pub error: f64,
}

/// Returns the springs of a footprint.
///
/// From a table, accurate to 1e-5 of `α`, for `b/a` from 0.25 to 80 and `d/a` from 0.0125 to 100.
/// Otherwise from three meshes of `4`, `6` and `8` cells per side, extrapolated in the number of
/// cells:
///
/// ```text
/// c = c_n + (c_n − c_m) / ((n/m)³ − 1)                                (S7)
/// error = max over c of ( |c₆₈ − c₄₆| + 0.3 |c₆₈ − c₈| ) / α          (S8)
/// ```
///
/// where `c_mn` results from `m` and `n` cells per side. The error decreases as `n⁻³`. The second
/// term of (S8) covers extrapolations that agree by accident.
///
/// # Errors
/// If the gap vanishes by rounding (`d/a` below about 1e-15). Larger small gaps have a growing
/// `error`.
pub fn calibrate(footprint: &Footprint) -> Result<Springs, Unresolved> {
    RowStiffness::compute(footprint, Coupling::Nearest).map(|row| (&row).into())
}

impl From<&RowStiffness> for Springs {
    /// Extracts the scale itself and its nearest neighbours from a row.
    fn from(row: &RowStiffness) -> Self {
        let coupling = row.neighbours.first().map_or([0.0; 3], |nearest| nearest.direct);
        Self { direct: row.direct, coupling: coupling.map(|force| -force), error: row.error }
    }
}

/// Returns `α_x, α_y, α_φ, β_x, β_y, β_φ` extrapolated (S7) from two meshes.
///
/// `cells` holds the cells per side of the meshes, the coarser first.
///
/// # Errors
/// As [`calibrate`].
pub fn extrapolated(footprint: &Footprint, cells: [usize; 2]) -> Result<[f64; 6], Unresolved> {
    let [coarse, fine] = cells.map(|n| row_reactions(footprint, 1, n));
    let numbers = extrapolation(cells, [&coarse?.numbers(), &fine?.numbers()]);
    // `β` is the negative reaction on the neighbour (S6).
    Ok(std::array::from_fn(|i| if i < 3 { numbers[i] } else { -numbers[i] }))
}

/// Observed order of convergence of the reactions.
///
/// It is the order of piecewise constant tractions, since the grading resolves the edges.
const ORDER: i32 = 3;

/// Extrapolates a list of values by (S7) from two meshes, the coarser first.
pub(crate) fn extrapolation(cells: [usize; 2], [coarse, fine]: [&[f64]; 2]) -> Vec<f64> {
    let share = 1.0 / ((cells[1] as f64 / cells[0] as f64).powi(ORDER) - 1.0);
    coarse.iter().zip(fine).map(|(coarse, fine)| fine + (fine - coarse) * share).collect()
}
