//! Stiffness of a whole row of bases on the substrate, with any number of coupled neighbours.

use std::ops::{Add, Mul};

/// Range of the coupling of scales through the substrate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Coupling {
    /// Coupling with the nearest neighbours, Eq. (1) of Shafiei et al. (2021).
    ///
    /// Forces depend on displacements and moments on rotations only.
    #[default]
    Nearest,
    /// Coupling with [`NEIGHBOURS`] neighbours on each side, also of forces with rotations.
    Full,
}

/// Number of neighbours on each side with which [`Coupling::Full`] couples a scale.
///
/// With eight neighbours, the neglected coupling is below 2 % of the stiffness of a scale for all
/// footprints of Shafiei et al. (2021). Sixteen neighbours would double the number of unknowns of
/// the boundary elements and make their dense solution up to eight times slower.
pub const NEIGHBOURS: usize = 8;

/// Stiffness of a row: forces and moments due to unit displacements, for `E* = a = 1`.
///
/// Scale `j = i + k` lies `k = 1 … m` positions to the right of scale `i`. The coefficients `K_x`,
/// `K_y`, `K_φ` and `c` depend on `k`:
///
/// ```text
/// F_x⁽ʲ⁾ = K_x u_x⁽ⁱ⁾      F_y⁽ʲ⁾ = K_y u_y⁽ⁱ⁾ + c φ⁽ⁱ⁾      M⁽ʲ⁾ = −c u_y⁽ⁱ⁾ + K_φ φ⁽ⁱ⁾
/// F_x⁽ⁱ⁾ = K_x u_x⁽ʲ⁾      F_y⁽ⁱ⁾ = K_y u_y⁽ʲ⁾ − c φ⁽ʲ⁾      M⁽ⁱ⁾ =  c u_y⁽ʲ⁾ + K_φ φ⁽ʲ⁾      (S9)
/// ```
///
/// Each scale also has its own stiffness `K_0`. On a layer, forces along the row are coupled with
/// `u_y` and `φ` by the coefficients `l` ([`Neighbour::lift`]) and `r` ([`Neighbour::roll`]) of a
/// neighbour, and by `r_0` ([`RowStiffness::roll`]) of the scale itself:
///
/// ```text
/// F_x⁽ʲ⁾ = … − l u_y⁽ⁱ⁾ + r φ⁽ⁱ⁾     F_y⁽ʲ⁾ = … + l u_x⁽ⁱ⁾     M⁽ʲ⁾ = … + r u_x⁽ⁱ⁾     and for F⁽ⁱ⁾ with −l     (S21)
/// ```
///
/// This form follows from mirror symmetry and Betti's theorem. The matrix of the row is symmetric
/// for any values of the coefficients.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowStiffness {
    /// `K_0`: forces `x`, `y` and moment on a scale due to unit displacements of the same scale.
    pub direct: [f64; 3],
    /// `r_0`: force along the row from a unit rotation of the scale; 0 on the half-space.
    ///
    /// The moment from a unit displacement of the scale along the row has the same value.
    pub roll: f64,
    /// Coupling with the neighbours on one side, the nearest neighbour first.
    pub neighbours: Vec<Neighbour>,
    /// Largest estimated error of the values, relative to `K_0` of the same direction.
    pub error: f64,
    /// Estimated size of the neglected coupling with farther scales, relative to `K_0`.
    ///
    /// It is the coupling with the last included neighbour, and 0 for [`Coupling::Nearest`].
    pub truncation: f64,
}

/// Coupling coefficients of two scales, defined by (S9) and (S21) in [`RowStiffness`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Neighbour {
    /// `K_x`, `K_y`, `K_φ`: force or moment on a scale from a unit displacement of the other scale.
    ///
    /// Force and displacement have the same direction `x`, `y` or `φ`.
    pub direct: [f64; 3],
    /// `c`: vertical force on the right scale from a unit rotation of the left scale.
    pub cross: f64,
    /// `l`: vertical force on the right scale from a unit displacement of the left scale along `x`.
    ///
    /// 0 on the half-space.
    pub lift: f64,
    /// `r`: force along the row on one scale from a unit rotation of the other scale.
    ///
    /// 0 on the half-space.
    pub roll: f64,
}

impl Neighbour {
    /// Returns true if each force or moment depends only on displacements in its own direction.
    pub fn is_diagonal(&self) -> bool {
        [self.cross, self.lift, self.roll] == [0.0; 3]
    }

    /// Returns the forces on the left scale due to unit displacements of the right scale.
    ///
    /// Rows are the force components `x`, `y`, `φ`, columns the displacements, see (S9) and (S21).
    /// The transpose holds the forces on the right scale due to displacements of the left scale.
    pub fn on_left(&self) -> [[f64; 3]; 3] {
        let ([x, y, rotation], Self { cross, lift, roll, .. }) = (self.direct, *self);
        [[x, lift, roll], [-lift, y, -cross], [roll, cross, rotation]]
    }
}

impl RowStiffness {
    /// Converts to a length unit `t` in which the half-width of a base is `half_base`.
    ///
    /// Forces are then in units of `E* t²` instead of `E* a²`.
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

    /// Returns mutable references to all stiffness coefficients, without error and truncation.
    fn numbers_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let neighbours = self
            .neighbours
            .iter_mut()
            .flat_map(|n| n.direct.iter_mut().chain([&mut n.cross, &mut n.lift, &mut n.roll]));
        self.direct.iter_mut().chain([&mut self.roll]).chain(neighbours)
    }

    /// Returns the estimated relative error including the neglected coupling with farther scales.
    pub fn estimated_error(&self) -> f64 {
        self.error + self.truncation
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

    /// Adds the coefficients of `other`, which must have the same number of neighbours.
    ///
    /// Keeps the error estimates of `self`.
    fn add(mut self, mut other: Self) -> Self {
        self.numbers_mut().zip(other.numbers_mut()).for_each(|(number, more)| *number += *more);
        self
    }
}
