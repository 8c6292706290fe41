//! The stiffness of a whole row of bases on the substrate.

use std::ops::{Add, Mul};

use crate::boundary_element::{Unresolved, row_reactions};
use crate::springs::extrapolation;
use crate::table::{self, Differentiated};
use crate::{Footprint, Springs, layered};

/// The neighbours with which the substrate couples a scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Coupling {
    /// The nearest neighbours, force with displacement and moment with rotation: Eq. (1) of the paper.
    #[default]
    Nearest,
    /// [`NEIGHBOURS`] neighbours on each side, force with rotation too.
    Full,
}

/// Neighbours on each side with which [`Coupling::Full`] couples a scale.
///
/// With eight, the coupling that is neglected is below 2 % of the stiffness of a scale for all footprints of the
/// paper. Twice as many would double the unknowns, and make the dense solution up to eight times as long.
pub const NEIGHBOURS: usize = 8;

/// The stiffness of a row: forces and moments that hold the scales, `E* = a = 1`, when one of them is displaced.
///
/// With the scale `j = i + k` to the right of the scale `i`, `k = 1 … m`, and `K_k`, `c_k` for their distance,
///
/// ```text
/// F_x⁽ʲ⁾ = K_x u_x⁽ⁱ⁾      F_y⁽ʲ⁾ = K_y u_y⁽ⁱ⁾ + c φ⁽ⁱ⁾      M⁽ʲ⁾ = −c u_y⁽ⁱ⁾ + K_φ φ⁽ⁱ⁾
/// F_x⁽ⁱ⁾ = K_x u_x⁽ʲ⁾      F_y⁽ⁱ⁾ = K_y u_y⁽ʲ⁾ − c φ⁽ʲ⁾      M⁽ⁱ⁾ =  c u_y⁽ʲ⁾ + K_φ φ⁽ʲ⁾      (S9)
/// ```
///
/// besides the `K_0` of each scale for itself. On a layer force along the row goes with the rest, too, with `r_k` the `roll` and `l` the
/// `lift` of a neighbour, and `r_0` the roll of the scale itself,
///
/// ```text
/// F_x⁽ʲ⁾ = … − l u_y⁽ⁱ⁾ + r φ⁽ⁱ⁾     F_y⁽ʲ⁾ = … + l u_x⁽ⁱ⁾     M⁽ʲ⁾ = … + r u_x⁽ⁱ⁾     and for F⁽ⁱ⁾ with −l     (S21)
/// ```
///
/// The form is that of mirror images and of Betti's
/// theorem: the matrix is symmetric, whatever the numbers are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowStiffness {
    /// Stiffness `K_0` of a scale for itself: force along `x`, force along `y`, moment.
    pub direct: [f64; 3],
    /// `r_0`: force along the row from a unit rotation, and moment from a unit displacement along it; 0 on the half-space.
    pub roll: f64,
    /// Coupling with the neighbours on one side, the nearest first.
    pub neighbours: Vec<Neighbour>,
    /// Estimated relative error of the numbers, referred to the `K_0` of the same direction.
    pub error: f64,
    /// Size of the neglected coupling, referred to `K_0`: that of the last neighbour that is not
    /// neglected. It is 0 where the model has the nearest neighbours alone.
    pub truncation: f64,
}

/// Coupling of two scales (S9), (S21).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Neighbour {
    /// `K_x`, `K_y`, `K_φ`: force or moment on one scale from the displacement of the other in the same direction.
    pub direct: [f64; 3],
    /// `c`: vertical force on the right scale from a unit rotation of the left one.
    pub cross: f64,
    /// `l`: vertical force on the right scale from a unit displacement of the left one along the row; 0 on the half-space.
    pub lift: f64,
    /// `r`: force along the row on one scale from a unit rotation of the other; 0 on the half-space.
    pub roll: f64,
}

impl Neighbour {
    /// Whether each force comes from the displacement in its own direction alone.
    pub fn is_diagonal(&self) -> bool {
        [self.cross, self.lift, self.roll] == [0.0; 3]
    }

    /// Forces on the left scale for unit displacements of the right one (S9), (S21). Those on the right scale are its transpose.
    pub fn on_left(&self) -> [[f64; 3]; 3] {
        let ([x, y, rotation], Self { cross, lift, roll, .. }) = (self.direct, *self);
        [[x, lift, roll], [-lift, y, -cross], [roll, cross, rotation]]
    }
}

/// Whether boundary elements are compiled: without them there is the table alone.
pub(crate) const SOLVES: bool = cfg!(feature = "boundary-elements");

impl RowStiffness {
    /// Returns the stiffness of a row with a coupling: from the table, or solved for a footprint that lies beyond it.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn compute(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        let mut row = match table::row(footprint, coupling) {
            // The table bounds its error as a whole: it has no meshes to tell by.
            Some(row) => Self { error: table::error(coupling), ..Self::from_table(&row, 0) },
            None => Self::solved(footprint, coupling)?,
        };
        // A layer adds to the half-space, so that the table serves both.
        if footprint.is_on_layer() {
            if !SOLVES {
                return Err(Unresolved { footprint: *footprint, cells: 0 });
            }
            let stiffer = layered::addition(footprint, footprint, coupling)?;
            // Neither error knows the sign of the other: they add at worst.
            let error = row.error + stiffer.error;
            row = Self { error, ..row + stiffer };
        }
        if coupling == Coupling::Full {
            row.truncation = row.last_coupling();
        }
        Ok(row)
    }

    /// Solves the stiffness of a row with a coupling on the half-space.
    pub(crate) fn solved(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        match coupling {
            Coupling::Nearest => Ok((&Springs::from(&Self::solve(footprint, 1)?)).into()),
            Coupling::Full => Self::solve(footprint, NEIGHBOURS),
        }
    }

    /// Solves the stiffness of an endless row on the half-space from the middle one of `2 m + 1` rectangles, displaced with the
    /// others held, on three meshes, extrapolated as in (S7):
    ///
    /// ```text
    /// K_x, K_y = ∬ q, ∬ p,   K_φ = ∬ p (x − x_k)     on the k-th neighbour
    /// c = ½ (∬ p on the k-th neighbour, u_y = x − x_m  +  ∬ p (x − x_m) on the middle one, u_y = 1 under the k-th)   (S10)
    /// ```
    ///
    /// The two parts of `c` are equal by Betti's theorem; their difference counts as an error.
    ///
    /// # Errors
    /// If the gap is lost in rounding, and always without the feature `boundary-elements`.
    pub fn solve(footprint: &Footprint, neighbours: usize) -> Result<Self, Unresolved> {
        if !SOLVES {
            return Err(Unresolved { footprint: *footprint, cells: 0 });
        }
        let on = |n: usize| row_reactions(footprint, neighbours, n).map(|found| found.numbers());
        let [coarse, medium, fine] = [on(CELLS[0])?, on(CELLS[1])?, on(CELLS[2])?];
        // Two extrapolations, of which the difference tells how far the better one may be off.
        let check = extrapolation([CELLS[0], CELLS[1]], [&coarse, &medium]);
        let best = extrapolation([CELLS[1], CELLS[2]], [&medium, &fine]);
        let sizes = sizes(&best);
        let estimate = |i: usize| (best[i] - check[i]).abs() + CAUTION * (best[i] - fine[i]).abs();
        // The worst of all numbers counts for each: a row tells one error.
        let mut error = (0..best.len()).map(|i| estimate(i) / sizes[i]).fold(0.0, f64::max);
        let mut row = Self { direct: [best[0], best[1], best[2]], ..Self::default() };
        for n in best[3..].chunks(PER_NEIGHBOUR) {
            error = error.max((n[3] - n[4]).abs() / sizes[6]);
            // The mean of the two, which a mesh keeps apart by its error: the matrix is symmetric whatever that is.
            let cross = f64::midpoint(n[3], n[4]);
            let direct = [n[0], n[1], n[2]];
            row.neighbours.push(Neighbour { direct, cross, ..Neighbour::default() });
        }
        let truncation = row.last_coupling();
        Ok(Self { error, truncation, ..row })
    }

    /// Size of the coupling with the last neighbour, over `K_0`.
    fn last_coupling(&self) -> f64 {
        let last = self.neighbours.last().map_or([0.0; 3], |neighbour| neighbour.direct);
        (0..3).map(|k| (last[k] / self.direct[k]).abs()).fold(0.0, f64::max)
    }

    /// Takes the numbers of a row of the table, or one of their three derivatives.
    pub(crate) fn from_table(row: &[Differentiated], part: usize) -> Self {
        let numbers: Vec<f64> = row.iter().map(|number| number.0[part]).collect();
        let (direct, neighbours) = numbers.split_at(3);
        let neighbour = |&[x, y, turn, cross]: &[f64; 4]| Neighbour {
            direct: [x, y, turn],
            cross,
            ..Neighbour::default()
        };
        Self {
            direct: [direct[0], direct[1], direct[2]],
            neighbours: neighbours.as_chunks().0.iter().map(neighbour).collect(),
            ..Self::default()
        }
    }

    /// Returns the stiffness with lengths in a unit of which the half-width of a base is `half_base`: forces over `E* t²`, where
    /// they are over `E* a²` here.
    #[must_use]
    pub fn with_lengths_over(&self, half_base: f64) -> Self {
        let a = half_base;
        let scaled = |[x, y, turn]: [f64; 3]| [a * x, a * y, a.powi(3) * turn];
        let neighbour = |n: &Neighbour| Neighbour {
            direct: scaled(n.direct),
            cross: a * a * n.cross,
            lift: a * n.lift,
            roll: a * a * n.roll,
        };
        Self {
            direct: scaled(self.direct),
            roll: a * a * self.roll,
            neighbours: self.neighbours.iter().map(neighbour).collect(),
            ..*self
        }
    }

    /// All numbers of the stiffness.
    fn numbers_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let neighbours = self
            .neighbours
            .iter_mut()
            .flat_map(|n| n.direct.iter_mut().chain([&mut n.cross, &mut n.lift, &mut n.roll]));
        self.direct.iter_mut().chain([&mut self.roll]).chain(neighbours)
    }

    /// Returns the estimated relative error, that of the neglected coupling included.
    pub fn estimated_error(&self) -> f64 {
        self.error + self.truncation
    }
}

/// Cells a side of the meshes: the coarsest of which the error stays below 0.03 % in the range of the table and around it.
const CELLS: [usize; 3] = [4, 6, 8];

/// Share of the extrapolated step in the estimated error (S8): the least that bounds the actual error for all reference
/// values of the tests.
pub(crate) const CAUTION: f64 = 0.3;

/// Numbers of each neighbour in [`RowReactions::numbers`]: three reactions and the two cross terms.
const PER_NEIGHBOUR: usize = 5;

/// Returns the size to which the error of each number of [`RowReactions::numbers`] is referred.
fn sizes(numbers: &[f64]) -> Vec<f64> {
    let [x, y, turn] = [numbers[0], numbers[1], numbers[2]];
    let cross = (y * turn).sqrt();
    let neighbours = numbers[3..].iter().enumerate();
    let of_neighbour = neighbours.map(|(i, _)| [x, y, turn, cross, cross][i % PER_NEIGHBOUR]);
    [x, y, turn].into_iter().chain(of_neighbour).collect()
}

impl From<&Springs> for RowStiffness {
    /// Converts the springs of Eq. (1): the nearest neighbours, without force from rotation.
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

    /// Adds the stiffness of as many neighbours, number by number; the estimates of the errors stay those of the first.
    fn add(mut self, mut other: Self) -> Self {
        self.numbers_mut().zip(other.numbers_mut()).for_each(|(number, more)| *number += *more);
        self
    }
}
