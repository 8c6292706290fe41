//! Stiffness of a whole row of bases on the substrate.

use std::ops::{Add, Mul};

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
