//! Surface displacement of a half-space under uniformly loaded cells.
//!
//! The cells are rectangles. With `E* = E_s / (1 − ν²)` and the distance `r = √(x² + z²)` to a
//! point load, a normal load displaces the surface normally, and a tangential load along `x`
//! displaces it along `x`, by
//!
//! ```text
//! u_y = 1/(π E*) · P / r                            (S1, Boussinesq)
//! u_x = 1/(π E*) · Q [1/r + ν/(1 − ν) · x²/r³]      (S2, Cerruti)
//! ```
//!
//! which are Eqs. (3) and (2) of Shafiei et al. (doi 10.1016/j.jmps.2020.104176); for both see
//! Barber, *Elasticity* (2002). Integrated over a rectangle, each is a sum over its four corners of
//! two functions of the offset `(X, Z)` from the field point to the corner,
//!
//! ```text
//! A = X asinh(Z/|X|),   ∬ z²/r³ = A₊₊ − A₋₊ − A₊₋ + A₋₋
//! B = Z asinh(X/|Z|),   ∬ x²/r³ = B₊₊ − B₋₊ − B₊₋ + B₋₋     (S3)
//! ```
//!
//! and `1/r = x²/r³ + z²/r³`, so the pair `(A, B)` serves both loads.

use std::f64::consts::PI;
use std::ops::{Add, Sub};

/// Integrals of (S3): the effect of a unit traction on a cell.
///
/// They contain no elastic constants. The corner functions of a single corner have the same type.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Influence {
    /// `A`, `∬ z²/r³`.
    pub across: f64,
    /// `B`, `∬ x²/r³`.
    pub along: f64,
}

impl Influence {
    /// Returns `E* u_y` for a unit normal traction: `(A + B)/π` (S1).
    pub fn normal(self) -> f64 {
        (self.across + self.along) / PI
    }

    /// Returns `E* u_x` for a unit tangential traction along `x` (S2).
    ///
    /// It is `(A + B/(1 − ν))/π`.
    pub fn tangential(self, poisson_ratio: f64) -> f64 {
        (self.across + self.along / (1.0 - poisson_ratio)) / PI
    }
}

impl Add for Influence {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { across: self.across + other.across, along: self.along + other.along }
    }
}

impl Sub for Influence {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { across: self.across - other.across, along: self.along - other.along }
    }
}

/// Line of corners parallel to `z`, seen from one field point.
///
/// Cells between two such lines share their corners, and the logarithm of `|Z|` serves every line.
///
/// With `asinh(Z/|X|) = sgn Z · [ln(|Z| + r) − ln|X|]`, a corner costs two logarithms and one root.
#[derive(Clone, Debug)]
pub struct CornerLine {
    /// `Z` and `ln|Z|` of each corner.
    corners: Vec<[f64; 2]>,
}

impl CornerLine {
    /// Creates a line of corners at the depths `edges`, seen from the depth `field`.
    pub fn new(edges: impl IntoIterator<Item = f64>, field: f64) -> Self {
        let offsets = edges.into_iter().map(|edge| edge - field);
        Self { corners: offsets.map(|z| [z, ln_or_zero(z)]).collect() }
    }

    /// Returns the number of corners.
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Returns true if the set has no corners.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Evaluates the corner functions along the line at the offset `x`, into `corners`.
    ///
    /// The field point must not be a corner, which is never the case for a collocation point.
    pub fn evaluate(&self, x: f64, corners: &mut [Influence]) {
        let ln_x = ln_or_zero(x);
        for (corner, &[z, ln_z]) in corners.iter_mut().zip(&self.corners) {
            let r = (x * x + z * z).sqrt();
            corner.across = x * ((z.abs() + r).ln() - ln_x).copysign(z);
            corner.along = z * ((x.abs() + r).ln() - ln_z).copysign(x);
        }
    }
}

/// Returns `ln|s|`, or 0 at `s = 0`.
///
/// There the corner function vanishes with its factor `s`.
fn ln_or_zero(s: f64) -> f64 {
    if s == 0.0 { 0.0 } else { s.abs().ln() }
}
