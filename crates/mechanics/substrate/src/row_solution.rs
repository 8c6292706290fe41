//! Computation of the stiffness of a row: from the table or solved, with the layer added.

use crate::boundary_element::{Unresolved, row_reactions};
use crate::extrapolation::{CAUTION, extrapolation};
use crate::table::{self, Differentiated};
use crate::{Coupling, Footprint, NEIGHBOURS, Neighbour, RowStiffness, Springs, layered};

impl RowStiffness {
    /// Returns the stiffness of a row, from the table or solved outside it.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn compute(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        let mut row = match table::row(footprint, coupling) {
            // The table has one error bound and no meshes to estimate from.
            Some(row) => Self { error: table::error(coupling), ..Self::from_table(&row, 0) },
            None => Self::solved(footprint, coupling)?,
        };
        // A layer adds to the half-space, so the table serves both.
        if footprint.is_on_layer() {
            let stiffer = layered::addition(footprint, footprint, coupling)?;
            // The signs of the errors are unknown, so add their magnitudes.
            let error = row.error + stiffer.error;
            row = Self { error, ..row + stiffer };
        }
        if coupling == Coupling::Full {
            row.truncation = row.last_coupling();
        }
        Ok(row)
    }

    /// Solves for the stiffness of a row on the half-space with the given coupling.
    pub(crate) fn solved(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        match coupling {
            Coupling::Nearest => Ok((&Springs::from(&Self::solve(footprint, 1)?)).into()),
            Coupling::Full => Self::solve(footprint, NEIGHBOURS),
        }
    }

    /// Solves for the stiffness of an infinite row on the half-space.
    ///
    /// The middle one of `2 m + 1` rectangles is displaced while the others are fixed, on three
    /// meshes, extrapolated as in (S7):
    ///
    /// ```text
    /// K_x, K_y = ∬ q, ∬ p,   K_φ = ∬ p (x − x_k)     on the k-th neighbour
    /// c = ½ (∬ p on the k-th neighbour, u_y = x − x_m  +  ∬ p (x − x_m) on the middle one, u_y = 1 under the k-th)   (S10)
    /// ```
    ///
    /// The two parts of `c` are equal by Betti's theorem; their difference counts as an error.
    ///
    /// # Errors
    /// If the gap vanishes by rounding.
    pub fn solve(footprint: &Footprint, neighbours: usize) -> Result<Self, Unresolved> {
        let [coarse, medium, fine] = CELLS.map(|n| row_reactions(footprint, neighbours, n));
        let [coarse, medium, fine] = [coarse?.numbers(), medium?.numbers(), fine?.numbers()];
        // The difference of two extrapolations estimates the error of the better one.
        let check = extrapolation([CELLS[0], CELLS[1]], [&coarse, &medium]);
        let best = extrapolation([CELLS[1], CELLS[2]], [&medium, &fine]);
        let sizes = sizes(&best);
        // A row has one error: the largest of all values.
        let mut error = 0.0_f64;
        for (i, size) in sizes.iter().enumerate() {
            let estimate = (best[i] - check[i]).abs() + CAUTION * (best[i] - fine[i]).abs();
            error = error.max(estimate / size);
        }
        let mut row = Self { direct: [best[0], best[1], best[2]], ..Self::default() };
        for n in best[3..].chunks(PER_NEIGHBOUR) {
            error = error.max((n[3] - n[4]).abs() / sizes[6]);
            // The mean of the two parts, which differ by the mesh error, makes the matrix
            // symmetric.
            let cross = f64::midpoint(n[3], n[4]);
            let direct = [n[0], n[1], n[2]];
            row.neighbours.push(Neighbour { direct, cross, ..Neighbour::default() });
        }
        let truncation = row.last_coupling();
        Ok(Self { error, truncation, ..row })
    }

    /// Returns the size of the coupling with the last neighbour, over `K_0`.
    fn last_coupling(&self) -> f64 {
        let last = self.neighbours.last().map_or([0.0; 3], |neighbour| neighbour.direct);
        (0..3).map(|k| (last[k] / self.direct[k]).abs()).fold(0.0, f64::max)
    }

    /// Builds the stiffness from a row of the table, or one of its three derivatives.
    pub(crate) fn from_table(row: &[Differentiated], part: usize) -> Self {
        let numbers: Vec<f64> = row.iter().map(|number| number.0[part]).collect();
        let (direct, neighbours) = numbers.split_at(3);
        let mut row = Self { direct: [direct[0], direct[1], direct[2]], ..Self::default() };
        for &[x, y, turn, cross] in neighbours.as_chunks().0 {
            row.neighbours.push(Neighbour { direct: [x, y, turn], cross, ..Neighbour::default() });
        }
        row
    }
}

/// Cells per side of the meshes.
///
/// The coarsest meshes with an error below 0.03 % in the range of the table and around it.
const CELLS: [usize; 3] = [4, 6, 8];

/// Number of values per neighbour in `RowReactions::numbers`.
///
/// They are three reactions and two cross terms.
const PER_NEIGHBOUR: usize = 5;

/// Returns the reference size for the error of each value.
///
/// `RowReactions::numbers` lists the values.
fn sizes(numbers: &[f64]) -> Vec<f64> {
    let [x, y, turn] = [numbers[0], numbers[1], numbers[2]];
    let cross = (y * turn).sqrt();
    let neighbours = numbers[3..].iter().enumerate();
    let of_neighbour = neighbours.map(|(i, _)| [x, y, turn, cross, cross][i % PER_NEIGHBOUR]);
    [x, y, turn].into_iter().chain(of_neighbour).collect()
}
