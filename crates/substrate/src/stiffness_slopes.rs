//! How fast the stiffness of a row changes with its footprint.

use crate::boundary_element::{
    FootprintChange, RowReactions, Unresolved, row_reactions, row_reactions_and_rates,
};
use crate::row_stiffness::flat;
use crate::springs::{CELLS, extrapolation};
use crate::{Coupling, Footprint, NEIGHBOURS, RowStiffness, Springs};

/// The stiffness of a row and its derivatives with respect to the numbers of the footprint.
///
/// The derivatives are those of the numbers that [`RowStiffness::of`] returns, extrapolated alike. Where lengths that grade
/// the mesh are equal these have a kink, as small as the error of the discretisation, and the derivatives on the two sides differ.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessSlopes {
    /// The stiffness itself, bit by bit that of [`RowStiffness::of`].
    pub stiffness: RowStiffness,
    /// Derivative with respect to `d/a`.
    pub by_gap: OneSided,
    /// Derivative with respect to `b/a`.
    pub by_width: OneSided,
    /// Derivative with respect to the logarithm of `d/a` and `b/a` together: that of a base that shrinks.
    pub by_size: OneSided,
    /// Derivative with respect to `ν`.
    pub by_poisson_ratio: RowStiffness,
}

/// Derivatives of a stiffness on both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct OneSided {
    /// The derivative where the number decreases.
    pub left: RowStiffness,
    /// The derivative where the number increases.
    pub right: RowStiffness,
}

impl StiffnessSlopes {
    /// Solves the stiffness of a row with a coupling, and its derivatives on the same factors.
    ///
    /// # Errors
    /// As [`RowStiffness::of`].
    pub fn of(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        let neighbours = if coupling == Coupling::Nearest { 1 } else { NEIGHBOURS };
        let (gap, width) = (footprint.gap_over_a(), footprint.width_over_a());
        let unit = |gap_over_a, width_over_a, poisson_ratio| FootprintChange {
            gap_over_a,
            width_over_a,
            poisson_ratio,
        };
        let mut changes = vec![unit(0.0, 0.0, 1.0), unit(1.0, 0.0, 0.0), unit(0.0, 1.0, 0.0)];
        if footprint.is_tied() {
            changes.extend([unit(gap, width, 0.0), unit(-1.0, 0.0, 0.0), unit(0.0, -1.0, 0.0)]);
            changes.push(unit(-gap, -width, 0.0));
        }
        let [coarse, medium, fine] = CELLS;
        let coarse = row_reactions(footprint, neighbours, coarse)?;
        // Eq. (1) has no force from rotation.
        let of = (neighbours, coupling == Coupling::Full);
        let on_mesh = |cells| row_reactions_and_rates(footprint, of, cells, &changes);
        let [(medium, medium_rates), (fine, fine_rates)] = [on_mesh(medium)?, on_mesh(fine)?];
        let stiffness = stiffness(coupling, [&coarse, &medium, &fine]);
        let slope = |change: usize| {
            let rates = [&medium_rates, &fine_rates].map(|rates| flat(&rates[change]));
            let [medium, fine] = rates.each_ref();
            slope(coupling, &extrapolation([CELLS[1], CELLS[2]], [medium, fine]))
        };
        let [by_poisson_ratio, by_gap, by_width] = [0, 1, 2].map(slope);
        let sides = |right: RowStiffness, left: usize| OneSided { left: slope(left) * -1.0, right };
        let [by_gap, by_width, by_size] = if footprint.is_tied() {
            [sides(by_gap, 4), sides(by_width, 5), sides(slope(3), 6)]
        } else {
            let by_size = by_gap.clone() * gap + by_width.clone() * width;
            [by_gap, by_width, by_size].map(|slope| OneSided { left: slope.clone(), right: slope })
        };
        Ok(Self { stiffness, by_gap, by_width, by_size, by_poisson_ratio })
    }
}

/// The stiffness by the reactions on the three meshes.
fn stiffness(coupling: Coupling, on_meshes: [&RowReactions; 3]) -> RowStiffness {
    match coupling {
        Coupling::Nearest => {
            (&Springs::from_meshes(on_meshes.map(RowReactions::coefficients))).into()
        }
        Coupling::Full => RowStiffness::from_meshes(on_meshes.map(flat)),
    }
}

/// The derivative of a stiffness by those of the numbers of [`flat`].
fn slope(coupling: Coupling, numbers: &[f64]) -> RowStiffness {
    let mut slope = RowStiffness::from_numbers(numbers, 0.0);
    (slope.error, slope.truncation) = (0.0, 0.0);
    if coupling == Coupling::Nearest {
        slope.neighbours.iter_mut().for_each(|neighbour| neighbour.cross = 0.0);
    }
    slope
}
