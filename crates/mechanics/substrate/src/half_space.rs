//! Surface displacement of an elastic half-space under uniformly loaded rectangular cells.
//!
//! With `E* = E_s / (1 − ν²)` and the distance `r = √(x² + z²)` from a point load, a normal load
//! `P` displaces the surface normally by `u_y`, and a tangential load `Q` along `x` displaces it
//! along `x` by `u_x`:
//!
//! ```text
//! u_y = 1/(π E*) · P / r                            (S1, Boussinesq)
//! u_x = 1/(π E*) · Q [1/r + ν/(1 − ν) · x²/r³]      (S2, Cerruti)
//! ```
//!
//! (S1) and (S2) are Eqs. (3) and (2) of Shafiei et al. (doi 10.1016/j.jmps.2020.104176); both are
//! derived in Barber, *Elasticity* (2002). Their integrals over a rectangle are sums over its four
//! corners. The summands are two functions of the offset `(X, Z)` from the field point to a corner:
//!
//! ```text
//! A = X asinh(Z/|X|),   ∬ z²/r³ = A₊₊ − A₋₊ − A₊₋ + A₋₋
//! B = Z asinh(X/|Z|),   ∬ x²/r³ = B₊₊ − B₋₊ − B₊₋ + B₋₋     (S3)
//! ```
//!
//! Because `1/r = x²/r³ + z²/r³`, the two functions `A` and `B` give both `u_y` and `u_x`.

use std::f64::consts::PI;
use std::ops::{Add, Sub};

/// Integrals (S3) of a cell, which give the displacement due to a unit traction.
///
/// They contain no elastic constants. The same type holds `A` and `B` of a single corner.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Influence {
    /// `∬ z²/r³` over the cell, or `A` of a corner.
    pub z_part: f64,
    /// `∬ x²/r³` over the cell, or `B` of a corner.
    pub x_part: f64,
}

impl Influence {
    /// Returns `E* u_y` for a unit normal traction: `(A + B)/π` (S1).
    pub fn normal(self) -> f64 {
        (self.z_part + self.x_part) / PI
    }

    /// Returns `E* u_x` for a unit tangential traction along `x` (S2).
    ///
    /// It is `(A + B/(1 − ν))/π`.
    pub fn tangential(self, poisson_ratio: f64) -> f64 {
        (self.z_part + self.x_part / (1.0 - poisson_ratio)) / PI
    }
}

impl Add for Influence {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { z_part: self.z_part + other.z_part, x_part: self.x_part + other.x_part }
    }
}

impl Sub for Influence {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { z_part: self.z_part - other.z_part, x_part: self.x_part - other.x_part }
    }
}

/// Line of cell corners parallel to `z`, with their offsets from one field point.
///
/// The cells between two neighbouring lines share these corners. `ln|Z|` of a corner is stored,
/// because it is the same on every line of a mesh. With
/// `asinh(Z/|X|) = sgn Z · [ln(|Z| + r) − ln|X|]`, a corner costs two logarithms and one root.
#[derive(Clone, Debug)]
pub struct CornerLine {
    /// `Z` and `ln|Z|` of each corner; `Z` is measured from the field point.
    corners: Vec<[f64; 2]>,
}

impl CornerLine {
    /// Creates a line of corners at the coordinates `edges` along `z`, for a field point at
    /// `field`.
    pub fn new(edges: impl IntoIterator<Item = f64>, field: f64) -> Self {
        let offsets = edges.into_iter().map(|edge| edge - field);
        Self { corners: offsets.map(|z| [z, ln_or_zero(z)]).collect() }
    }

    /// Returns the number of corners.
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Returns true if the line has no corners.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Writes the corner functions `A` and `B` of a line at the offset `x` into `corners`.
    ///
    /// `x` is measured from the field point, which must not coincide with a corner. Collocation
    /// points lie inside cells, so they do not coincide with corners.
    pub fn evaluate(&self, x: f64, corners: &mut [Influence]) {
        let ln_x = ln_or_zero(x);
        for (corner, &[z, ln_z]) in corners.iter_mut().zip(&self.corners) {
            let r = (x * x + z * z).sqrt();
            corner.z_part = x * ((z.abs() + r).ln() - ln_x).copysign(z);
            corner.x_part = z * ((x.abs() + r).ln() - ln_z).copysign(x);
        }
    }
}

/// Returns `ln|s|`, or 0 at `s = 0`.
///
/// At `s = 0` the corner function is 0 because it is proportional to `s`.
fn ln_or_zero(s: f64) -> f64 {
    if s == 0.0 { 0.0 } else { s.abs().ln() }
}
