//! How fast the stiffness of a row changes with its footprint.

use std::iter;

use crate::boundary_element::{
    FootprintChange, RowReactions, Unresolved, row_reactions, row_reactions_and_rates,
};
use crate::mesh::MeshChange;
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
        let by_ratio = FootprintChange { poisson_ratio: 1.0, ..FootprintChange::default() };
        let by_length = |mesh| FootprintChange { mesh, poisson_ratio: 0.0 };
        let lengths = LengthChanges::of(footprint);
        let changes: Vec<_> = iter::once(by_ratio).chain(lengths.used().map(by_length)).collect();
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
        let slopes: Vec<_> = (1..changes.len()).map(slope).collect();
        let [by_gap, by_width, by_size] = lengths.wanted.map(|sides| {
            let [left, right] = sides.map(|parts| lengths.slope(parts, &slopes));
            OneSided { left: left * -1.0, right }
        });
        Ok(Self { stiffness, by_gap, by_width, by_size, by_poisson_ratio: slope(0) })
    }
}

/// Changes of the lengths of a footprint, and the few directions that they are made of: gap, width, and, where equal lengths grade the
/// mesh, the layers that do.
struct LengthChanges {
    directions: [MeshChange; 4],
    /// The parts of the directions in the changes of gap, of width, and of both as a base shrinks: backwards and forwards.
    wanted: [[[f64; 4]; 2]; 3],
}

impl LengthChanges {
    fn of(footprint: &Footprint) -> Self {
        let change = |[gap, width]: [f64; 2]| footprint.mesh_change(gap, width);
        let [by_gap, by_width] = [change([1.0, 0.0]), change([0.0, 1.0])];
        let parts = |[gap, width]: [f64; 2]| {
            let there = change([gap, width]);
            let free = there.free - gap * by_gap.free - width * by_width.free;
            let facing = there.facing - gap * by_gap.facing - width * by_width.facing;
            [gap, width, free, facing]
        };
        let sizes = [footprint.gap_over_a(), footprint.width_over_a()];
        let wanted = [[1.0, 0.0], [0.0, 1.0], sizes]
            .map(|change| [parts(change.map(|rate| -rate)), parts(change)]);
        let rest = MeshChange::default();
        let layers = [MeshChange { free: 1.0, ..rest }, MeshChange { facing: 1.0, ..rest }];
        Self { directions: [by_gap, by_width, layers[0], layers[1]], wanted }
    }

    /// Whether any of the changes takes a direction.
    fn takes(&self, direction: usize) -> bool {
        self.wanted.iter().flatten().any(|parts| parts[direction] != 0.0)
    }

    /// The directions that the changes take.
    fn used(&self) -> impl Iterator<Item = MeshChange> {
        let directions = self.directions.into_iter().enumerate();
        directions.filter(|(number, _)| self.takes(*number)).map(|(_, direction)| direction)
    }

    /// The derivative in a change of these parts, by those in the directions that are used.
    fn slope(&self, parts: [f64; 4], slopes: &[RowStiffness]) -> RowStiffness {
        let used = (0..parts.len()).filter(|&direction| self.takes(direction));
        let terms = used.zip(slopes).map(|(direction, slope)| slope.clone() * parts[direction]);
        terms.fold(slopes[0].clone() * 0.0, |sum, term| sum + term)
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
