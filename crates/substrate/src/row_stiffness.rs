//! The stiffness of a whole row of bases on the substrate.

use std::ops::{Add, Mul};

use crate::boundary_element::{CrossTerms, RowReactions, Unresolved, row_reactions};
use crate::springs::{CELLS, estimated_error, extrapolation};
use crate::{Footprint, Springs, calibrate};

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
/// besides the `K_0` of each scale for itself. The form is that of mirror images and of Betti's
/// theorem: the matrix is symmetric, whatever the numbers are.
#[derive(Clone, Debug, PartialEq)]
pub struct RowStiffness {
    /// Stiffness `K_0` of a scale for itself: force along `x`, force along `y`, moment.
    pub direct: [f64; 3],
    /// Coupling with the neighbours on one side, the nearest first.
    pub neighbours: Vec<Neighbour>,
    /// Estimated relative error of the numbers, referred to the `K_0` of the same direction.
    pub error: f64,
    /// Size of the neglected coupling, referred to `K_0`: that of the last neighbour that is not
    /// neglected. It is 0 where the model has the nearest neighbours alone.
    pub truncation: f64,
}

/// Coupling of two scales (S9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// `K_x`, `K_y`, `K_φ`: force or moment on one scale from the displacement of the other in the same direction.
    pub direct: [f64; 3],
    /// `c`: vertical force on the right scale from a unit rotation of the left one.
    pub cross: f64,
}

impl RowStiffness {
    /// Solves the stiffness of an endless row from the middle one of `2 m + 1` rectangles, displaced with the
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
    /// If the gap is lost in rounding.
    pub fn solve(footprint: &Footprint, neighbours: usize) -> Result<Self, Unresolved> {
        let on = |n: usize| row_reactions(footprint, neighbours, n).map(|found| flat(&found));
        let [coarse, medium, fine] = CELLS;
        Ok(Self::from_meshes([on(coarse)?, on(medium)?, on(fine)?]))
    }

    /// Extrapolates the numbers of [`flat`] on three meshes.
    pub(crate) fn from_meshes([c4, c6, c8]: [Vec<f64>; 3]) -> Self {
        let [coarse, medium, fine] = CELLS;
        let checks = extrapolation([coarse, medium], [&c4, &c6]);
        let best = extrapolation([medium, fine], [&c6, &c8]);
        let sizes = sizes(&best);
        let error = (0..best.len())
            .map(|i| estimated_error([checks[i], c8[i], best[i]]) / sizes[i])
            .fold(0.0, f64::max);
        Self::from_numbers(&best, error)
    }

    /// Solves the stiffness of a row with a coupling.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn of(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        match coupling {
            Coupling::Nearest => Ok((&calibrate(footprint)?).into()),
            Coupling::Full => Self::solve(footprint, NEIGHBOURS),
        }
    }

    /// Returns the stiffness with lengths in a unit of which the half-width of a base is `half_base`: forces over `E* t²`, where
    /// they are over `E* a²` here.
    #[must_use]
    pub fn with_lengths_over(&self, half_base: f64) -> Self {
        let a = half_base;
        let scaled = |[x, y, turn]: [f64; 3]| [a * x, a * y, a.powi(3) * turn];
        let neighbours = self.neighbours.iter();
        let neighbours = neighbours
            .map(|n| Neighbour { direct: scaled(n.direct), cross: a * a * n.cross })
            .collect();
        Self { direct: scaled(self.direct), neighbours, ..*self }
    }

    /// Returns the estimated relative error, that of the neglected coupling included.
    pub fn estimated_error(&self) -> f64 {
        self.error + self.truncation
    }

    /// Creates the stiffness from the numbers of [`flat`].
    pub(crate) fn from_numbers(numbers: &[f64], error: f64) -> Self {
        let direct = [numbers[0], numbers[1], numbers[2]];
        let turn = (direct[1] * direct[2]).sqrt();
        let mut defect = 0.0_f64;
        let neighbours: Vec<_> = numbers[3..]
            .chunks(PER_NEIGHBOUR)
            .map(|n| {
                defect = defect.max((n[3] - n[4]).abs() / turn);
                Neighbour { direct: [n[0], n[1], n[2]], cross: f64::midpoint(n[3], n[4]) }
            })
            .collect();
        let last = neighbours.last().map_or([0.0; 3], |neighbour| neighbour.direct);
        let truncation = (0..3).map(|k| (last[k] / direct[k]).abs()).fold(0.0, f64::max);
        Self { direct, neighbours, error: error.max(defect), truncation }
    }
}

/// Numbers of each neighbour in [`flat`]: three reactions and the two cross terms.
const PER_NEIGHBOUR: usize = 5;

/// Returns all numbers of a row in a list, those of the middle rectangle first, for extrapolation.
pub(crate) fn flat(found: &RowReactions) -> Vec<f64> {
    let of_neighbour = |(direct, cross): (&[f64; 3], &CrossTerms)| {
        let [x, y, turn] = *direct;
        [x, y, turn, cross.force, cross.moment]
    };
    let neighbours = found.neighbours.iter().zip(&found.cross).flat_map(of_neighbour);
    found.direct.iter().copied().chain(neighbours).collect()
}

/// Returns the size to which the error of each number of [`flat`] is referred.
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
        let nearest = Neighbour { direct: springs.coupling.map(|beta| -beta), cross: 0.0 };
        let Springs { direct, error, .. } = *springs;
        Self { direct, neighbours: vec![nearest], error, truncation: 0.0 }
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
        self.direct.iter_mut().for_each(|direct| *direct *= factor);
        for neighbour in &mut self.neighbours {
            neighbour.direct.iter_mut().for_each(|direct| *direct *= factor);
            neighbour.cross *= factor;
        }
        self
    }
}

impl Add for RowStiffness {
    type Output = Self;

    /// Adds the stiffness of as many neighbours, number by number; the estimates of the errors stay those of the first.
    fn add(mut self, other: Self) -> Self {
        self.direct.iter_mut().zip(other.direct).for_each(|(direct, more)| *direct += more);
        for (neighbour, more) in self.neighbours.iter_mut().zip(other.neighbours) {
            neighbour.direct.iter_mut().zip(more.direct).for_each(|(direct, more)| *direct += more);
            neighbour.cross += more.cross;
        }
        self
    }
}
