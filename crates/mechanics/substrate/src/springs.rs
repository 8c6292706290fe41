//! Springs that represent the substrate: coefficients of Eq. (1) of Shafiei et al. (2021).

use crate::boundary_element::{Unresolved, row_reactions};
use crate::extrapolation::extrapolation;
use crate::{Footprint, Neighbour, RowStiffness};

/// Dimensionless direct (`α`) and coupling (`β`) stiffness of a row of bases on a half-space.
///
/// Defined by Eq. (1) of Shafiei et al. (doi 10.1016/j.jmps.2020.104176). With
/// `E* = E_s / (1 − ν²)`, the half-width `a` of a base, and sums over both neighbours of a scale,
/// its forces and moment are `F_x = E* a (α_x u_x − β_x Σ u_x)`, likewise in `y`, and
/// `M = E* a³ (α_φ φ − β_φ Σ φ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Springs {
    /// Direct stiffness `α_x`, `α_y`, `α_φ` of a base.
    pub direct: [f64; 3],
    /// Coupling with each neighbour: `β_x`, `β_y` (positive) and `β_φ` (negative).
    pub coupling: [f64; 3],
    /// Largest estimated error of the six coefficients, relative to `α` of the same direction.
    pub error: f64,
}

impl From<&RowStiffness> for Springs {
    /// Keeps the stiffness of a scale and the coupling with its nearest neighbours in Eq. (1).
    fn from(row: &RowStiffness) -> Self {
        let coupling = row.neighbours.first().map_or([0.0; 3], |nearest| nearest.direct);
        Self { direct: row.direct, coupling: coupling.map(|force| -force), error: row.error }
    }
}

impl From<&Springs> for RowStiffness {
    /// Converts the springs of Eq. (1) to a row with one neighbour on each side.
    ///
    /// Forces do not depend on rotations, and moments do not depend on displacements.
    fn from(springs: &Springs) -> Self {
        let direct = springs.coupling.map(|beta| -beta);
        let nearest = Neighbour { direct, ..Neighbour::default() };
        let Springs { direct, error, .. } = *springs;
        Self { direct, neighbours: vec![nearest], error, ..Self::default() }
    }
}

/// Returns `α_x, α_y, α_φ, β_x, β_y, β_φ` on a half-space, extrapolated (S7) from two meshes.
///
/// `cells` holds the number of cells per side of the coarse mesh and of the fine mesh.
///
/// # Errors
/// If the gap or a cell vanishes by rounding.
pub fn extrapolated(footprint: &Footprint, cells: [usize; 2]) -> Result<[f64; 6], Unresolved> {
    let [coarse, fine] = cells.map(|n| row_reactions(footprint, 1, n));
    let numbers = extrapolation(cells, [&coarse?.numbers(), &fine?.numbers()]);
    // `β` is the negative reaction on the neighbour (S6).
    Ok(std::array::from_fn(|i| if i < 3 { numbers[i] } else { -numbers[i] }))
}
