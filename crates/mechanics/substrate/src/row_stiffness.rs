//! Stiffness of a whole row of bases on the substrate.

use std::ops::{Add, Mul};

use crate::boundary_element::{Unresolved, row_reactions};
use crate::springs::extrapolation;
use crate::table::{self, Differentiated};
use crate::{Footprint, Springs, layered};

/// Range of the coupling of scales through the substrate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Coupling {
    /// Nearest neighbours, force with displacement and moment with rotation.
    ///
    /// This is Eq. (1) of the paper.
    #[default]
    Nearest,
    /// [`NEIGHBOURS`] neighbours on each side, including force with rotation.
    Full,
}

/// Neighbours on each side with which [`Coupling::Full`] couples a scale.
///
/// With eight, the neglected coupling is below 2 % of the stiffness of a scale for all footprints
/// of the paper. Twice as many would double the unknowns and make the dense solution up to eight
/// times slower.
pub const NEIGHBOURS: usize = 8;

/// Stiffness of a row: forces and moments for unit displacements, `E* = a = 1`.
///
/// Let scale `j = i + k` lie to the right of scale `i`, `k = 1 … m`. With `K_k` and `c_k` for their
/// distance,
///
/// ```text
/// F_x⁽ʲ⁾ = K_x u_x⁽ⁱ⁾      F_y⁽ʲ⁾ = K_y u_y⁽ⁱ⁾ + c φ⁽ⁱ⁾      M⁽ʲ⁾ = −c u_y⁽ⁱ⁾ + K_φ φ⁽ⁱ⁾
/// F_x⁽ⁱ⁾ = K_x u_x⁽ʲ⁾      F_y⁽ⁱ⁾ = K_y u_y⁽ʲ⁾ − c φ⁽ʲ⁾      M⁽ⁱ⁾ =  c u_y⁽ʲ⁾ + K_φ φ⁽ʲ⁾      (S9)
/// ```
///
/// plus the own `K_0` of each scale. On a layer, forces along the row are coupled too, with the
/// `roll` `r_k` and the `lift` `l` of a neighbour, and the roll `r_0` of the scale itself,
///
/// ```text
/// F_x⁽ʲ⁾ = … − l u_y⁽ⁱ⁾ + r φ⁽ⁱ⁾     F_y⁽ʲ⁾ = … + l u_x⁽ⁱ⁾     M⁽ʲ⁾ = … + r u_x⁽ⁱ⁾     and for F⁽ⁱ⁾ with −l     (S21)
/// ```
///
/// This form follows from mirror symmetry and Betti's theorem: the matrix is symmetric for any
/// values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowStiffness {
    /// Own stiffness `K_0` of a scale: force along `x`, force along `y`, moment.
    pub direct: [f64; 3],
    /// `r_0`: force along the row from a unit rotation.
    ///
    /// It is also the moment from a unit displacement.
    ///
    /// 0 on the half-space.
    pub roll: f64,
    /// Coupling with the neighbours on one side, the nearest first.
    pub neighbours: Vec<Neighbour>,
    /// Estimated relative error of the values, relative to `K_0` of the same direction.
    pub error: f64,
    /// Size of the neglected coupling relative to `K_0`.
    ///
    /// Estimated by the coupling with the last included neighbour. 0 if the model has only nearest
    /// neighbours.
    pub truncation: f64,
}

/// Coupling of two scales (S9), (S21).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Neighbour {
    /// `K_x`, `K_y`, `K_φ`: force or moment on one scale from the other scale.
    ///
    /// The other scale is displaced in the same direction.
    pub direct: [f64; 3],
    /// `c`: vertical force on the right scale from a unit rotation of the left one.
    pub cross: f64,
    /// `l`: vertical force on the right scale from the left one's unit displacement.
    ///
    /// The displacement is along the row.
    ///
    /// 0 on the half-space.
    pub lift: f64,
    /// `r`: force along the row on one scale from a unit rotation of the other.
    ///
    /// 0 on the half-space.
    pub roll: f64,
}

impl Neighbour {
    /// Returns true if each force depends only on displacement in its own direction.
    pub fn is_diagonal(&self) -> bool {
        [self.cross, self.lift, self.roll] == [0.0; 3]
    }

    /// Returns forces on the left scale for unit displacements of the right.
    ///
    /// See (S9) and (S21). The forces on the right scale are the transpose.
    pub fn on_left(&self) -> [[f64; 3]; 3] {
        let ([x, y, rotation], Self { cross, lift, roll, .. }) = (self.direct, *self);
        [[x, lift, roll], [-lift, y, -cross], [roll, cross, rotation]]
    }
}

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

    /// Converts to a length unit in which the half-width of a base is `half_base`.
    ///
    /// Forces are then in `E* t²` instead of `E* a²`.
    #[must_use]
    pub fn with_lengths_over(&self, half_base: f64) -> Self {
        let (mut scaled, a) = (self.clone(), half_base);
        let square = a * a;
        scaled.roll *= square;
        for n in &mut scaled.neighbours {
            (n.cross, n.lift, n.roll) = (square * n.cross, a * n.lift, square * n.roll);
        }
        let direct = scaled.neighbours.iter_mut().map(|n| &mut n.direct);
        for [x, y, turn] in direct.chain([&mut scaled.direct]) {
            (*x, *y, *turn) = (a * *x, a * *y, a.powi(3) * *turn);
        }
        scaled
    }

    /// Returns all values of the stiffness.
    fn numbers_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let neighbours = self
            .neighbours
            .iter_mut()
            .flat_map(|n| n.direct.iter_mut().chain([&mut n.cross, &mut n.lift, &mut n.roll]));
        self.direct.iter_mut().chain([&mut self.roll]).chain(neighbours)
    }

    /// Returns the estimated relative error, including the neglected coupling.
    pub fn estimated_error(&self) -> f64 {
        self.error + self.truncation
    }
}

/// Cells per side of the meshes.
///
/// The coarsest meshes with an error below 0.03 % in the range of the table and around it.
const CELLS: [usize; 3] = [4, 6, 8];

/// Fraction of the extrapolation step in the estimated error (S8).
///
/// The smallest one that bounds the actual error for all reference values of the tests.
pub(crate) const CAUTION: f64 = 0.3;

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

impl From<&Springs> for RowStiffness {
    /// Converts the springs of Eq. (1).
    ///
    /// They couple nearest neighbours, without force from rotation.
    fn from(springs: &Springs) -> Self {
        let direct = springs.coupling.map(|beta| -beta);
        let nearest = Neighbour { direct, ..Neighbour::default() };
        let Springs { direct, error, .. } = *springs;
        Self { direct, neighbours: vec![nearest], error, ..Self::default() }
    }
}

impl From<&Self> for RowStiffness {
    fn from(stiffness: &Self) -> Self {
        stiffness.clone()
    }
}

impl Mul<f64> for RowStiffness {
    type Output = Self;

    fn mul(mut self, factor: f64) -> Self {
        self.numbers_mut().for_each(|number| *number *= factor);
        self
    }
}

impl Add for RowStiffness {
    type Output = Self;

    /// Adds the stiffness of equally many neighbours; keeps error estimates of `self`.
    fn add(mut self, mut other: Self) -> Self {
        self.numbers_mut().zip(other.numbers_mut()).for_each(|(number, more)| *number += *more);
        self
    }
}
