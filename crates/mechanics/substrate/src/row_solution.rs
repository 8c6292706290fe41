//! Computes the stiffness of a row from the table or by boundary elements, and adds a layer.

use crate::boundary_element::{Unresolved, row_reactions};
use crate::extrapolation::{CAUTION, extrapolation};
use crate::table::{self, Differentiated};
use crate::{Coupling, Footprint, NEIGHBOURS, Neighbour, RowStiffness, Springs, layered};

impl RowStiffness {
    /// Returns the stiffness of a row, from the table or, outside its range, by boundary elements.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding.
    pub fn compute(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        let mut row = match table::row(footprint, coupling) {
            // The table has one error bound for its whole range.
            Some(row) => Self { error: table::error(coupling), ..Self::from_table(&row, 0) },
            None => Self::solved(footprint, coupling)?,
        };
        // The table holds the half-space; the effect of the rigid base below a layer is added.
        if footprint.is_on_layer() {
            let stiffer = layered::addition(footprint, footprint, coupling)?;
            // The signs of both errors are unknown, so their magnitudes add.
            let error = row.error + stiffer.error;
            row = Self { error, ..row + stiffer };
        }
        if coupling == Coupling::Full {
            row.truncation = row.last_coupling();
        }
        Ok(row)
    }

    /// Solves for the stiffness of a row on the half-space; `coupling` sets the number of
    /// neighbours.
    pub(crate) fn solved(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        match coupling {
            Coupling::Nearest => Ok((&Springs::from(&Self::solve(footprint, 1)?)).into()),
            Coupling::Full => Self::solve(footprint, NEIGHBOURS),
        }
    }

    /// Solves for the stiffness of a row on the half-space by boundary elements on three meshes.
    ///
    /// The middle one of `2 m + 1` rectangles is displaced and the others are fixed, with
    /// `m = neighbours`. The results of three meshes are extrapolated by (S7):
    ///
    /// ```text
    /// K_x, K_y = ∬ q, ∬ p,   K_φ = ∬ p (x − x_k)     on the k-th neighbour
    /// c = ½ (∬ p on the k-th neighbour, u_y = x − x_m  +  ∬ p (x − x_m) on the middle one, u_y = 1 under the k-th)   (S10)
    /// ```
    ///
    /// Betti's theorem makes the two parts of `c` equal; their difference counts as an error.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding.
    pub fn solve(footprint: &Footprint, neighbours: usize) -> Result<Self, Unresolved> {
        let [coarse, medium, fine] = CELLS.map(|n| row_reactions(footprint, neighbours, n));
        let [coarse, medium, fine] = [coarse?.numbers(), medium?.numbers(), fine?.numbers()];
        // The difference of two extrapolations estimates the error of the better one, `best`.
        let check = extrapolation([CELLS[0], CELLS[1]], [&coarse, &medium]);
        let best = extrapolation([CELLS[1], CELLS[2]], [&medium, &fine]);
        let sizes = sizes(&best);
        // The row states one error: the largest relative error of all its values.
        let mut error = 0.0_f64;
        for (i, size) in sizes.iter().enumerate() {
            let estimate = (best[i] - check[i]).abs() + CAUTION * (best[i] - fine[i]).abs();
            error = error.max(estimate / size);
        }
        let mut row = Self { direct: [best[0], best[1], best[2]], ..Self::default() };
        for n in best[3..].chunks(PER_NEIGHBOUR) {
            error = error.max((n[3] - n[4]).abs() / sizes[6]);
            // Both parts of `c` differ by the mesh error. Their mean keeps the matrix symmetric.
            let cross = f64::midpoint(n[3], n[4]);
            let direct = [n[0], n[1], n[2]];
            row.neighbours.push(Neighbour { direct, cross, ..Neighbour::default() });
        }
        let truncation = row.last_coupling();
        Ok(Self { error, truncation, ..row })
    }

    /// Returns the largest ratio of the coupling with the last neighbour to `K_0`, over `x`, `y`,
    /// `φ`.
    fn last_coupling(&self) -> f64 {
        let last = self.neighbours.last().map_or([0.0; 3], |neighbour| neighbour.direct);
        (0..3).map(|k| (last[k] / self.direct[k]).abs()).fold(0.0, f64::max)
    }

    /// Converts values of the table (`part` 0) or their derivatives to coefficients of a row.
    ///
    /// `part` 1, 2 and 3 are the derivatives with respect to `d/a`, `b/a` and `ν`.
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

/// Number of cells per side of the three meshes.
///
/// These are the coarsest meshes with an error below 0.03 % in the range of the table and near it.
const CELLS: [usize; 3] = [4, 6, 8];

/// Number of values of each neighbour in `RowReactions::numbers`.
///
/// The values are three reactions and two cross terms.
const PER_NEIGHBOUR: usize = 5;

/// Returns the reference stiffness to which the error of each value is relative.
///
/// The argument is the list of values from `RowReactions::numbers`.
fn sizes(numbers: &[f64]) -> Vec<f64> {
    let [x, y, turn] = [numbers[0], numbers[1], numbers[2]];
    let cross = (y * turn).sqrt();
    let neighbours = numbers[3..].iter().enumerate();
    let of_neighbour = neighbours.map(|(i, _)| [x, y, turn, cross, cross][i % PER_NEIGHBOUR]);
    [x, y, turn].into_iter().chain(of_neighbour).collect()
}
