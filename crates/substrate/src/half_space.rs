//! Displacement of the surface of an elastic half-space under uniformly loaded rectangular cells.
//!
//! With `E* = E_s / (1 − ν²)` and `r = √(x² + z²)` the distance to a point load, a normal load
//! displaces the surface normally, and a tangential load along `x` displaces it along `x`, by
//!
//! ```text
//! u_y = 1/(π E*) · P / r                            (S1, Boussinesq)
//! u_x = 1/(π E*) · Q [1/r + ν/(1 − ν) · x²/r³]      (S2, Cerruti)
//! ```
//!
//! which are Eqs. (3) and (2) of Shafiei et al. (doi 10.1016/j.jmps.2020.104176); see Barber,
//! *Elasticity* (2002), for both. Integrated over a rectangle, each is a sum over its four corners of
//! two functions of the offset `(X, Z)` from the field point to the corner,
//!
//! ```text
//! A = X asinh(Z/|X|),   ∬ z²/r³ = A₊₊ − A₋₊ − A₊₋ + A₋₋
//! B = Z asinh(X/|Z|),   ∬ x²/r³ = B₊₊ − B₋₊ − B₊₋ + B₋₋     (S3)
//! ```
//!
//! and `1/r = x²/r³ + z²/r³`, so that the pair `(A, B)` serves both loads.

use std::f64::consts::PI;
use std::ops::{Add, Sub};

use pulp::{Arch, NullaryFnOnce};

/// The integrals of (S3): what a unit traction on a cell does at a field point, before the elastic
/// constants enter. At a corner, the corner functions themselves.
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

    /// Returns `E* u_x` for a unit tangential traction along `x`: `(A + B/(1 − ν))/π` (S2).
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

/// Returns the corner functions (S3) at the offset `(x, z)`; both vanish with their factor.
pub fn corner(x: f64, z: f64) -> Influence {
    let half = |s: f64, t: f64| {
        if s == 0.0 { 0.0 } else { s * (t / s.abs()).asinh() }
    };
    Influence { across: half(x, z), along: half(z, x) }
}

/// Returns the influence of the cell `x[0] < x < x[1]`, `z[0] < z < z[1]` at the field point `(0, 0)` (S3).
pub fn cell(x: [f64; 2], z: [f64; 2]) -> Influence {
    corner(x[1], z[1]) - corner(x[0], z[1]) - corner(x[1], z[0]) + corner(x[0], z[0])
}

/// A line of corners parallel to `z`, seen from one field point: the cells between two such lines
/// share their corners, and the logarithm of `|Z|` serves every line.
///
/// With `asinh(Z/|X|) = sgn Z · [ln(|Z| + r) − ln|X|]` a corner costs two logarithms and a root.
#[derive(Clone, Debug)]
pub struct CornerLine {
    /// `Z` of each corner, and `ln|Z|`.
    z: Vec<f64>,
    ln: Vec<f64>,
    /// `|Z| + r` of each corner, `|X| + r` of each, and ones that fill the last vector; their logarithms.
    logarithms: Vec<f64>,
    /// The widest vectors that the processor has.
    arch: Arch,
}

/// Numbers in a vector: as many as most processors take at a time.
pub(crate) const LANES: usize = 4;

impl CornerLine {
    /// Creates a line of corners at the depths `edges`, seen from the depth `field`.
    pub fn new(edges: impl IntoIterator<Item = f64>, field: f64) -> Self {
        let z: Vec<f64> = edges.into_iter().map(|edge| edge - field).collect();
        let ln = z.iter().map(|&z| ln_or_zero(z)).collect();
        let logarithms = vec![1.0; (2 * z.len()).next_multiple_of(LANES)];
        Self { logarithms, z, ln, arch: Arch::new() }
    }

    /// Returns the number of corners.
    pub fn len(&self) -> usize {
        self.z.len()
    }

    /// Returns whether there are no corners.
    pub fn is_empty(&self) -> bool {
        self.z.is_empty()
    }

    /// Returns the corner functions along the line at the offset `x`, into `corners`.
    ///
    /// The field point must not be a corner (a collocation point never is).
    pub fn evaluate(&mut self, x: f64, corners: &mut [Influence]) {
        self.arch.dispatch(Logarithms { x, z: &self.z, of: &mut self.logarithms });
        let (across, along) = self.logarithms.split_at(self.z.len());
        let ln_x = ln_or_zero(x);
        let numbers = across.iter().zip(along).zip(self.z.iter().zip(&self.ln));
        for (corner, ((across, along), (&z, ln_z))) in corners.iter_mut().zip(numbers) {
            corner.across = x * (across - ln_x).copysign(z);
            corner.along = z * (along - ln_z).copysign(x);
        }
    }

    /// Returns the line as it was evaluated last: `ln(|Z| + r)` of each corner, and `ln(|X| + r)` of each behind them.
    pub(crate) fn logarithms(&self) -> &[f64] {
        &self.logarithms[..2 * self.len()]
    }

    /// Returns `Z` of each corner, and `ln|Z|` of each.
    pub(crate) fn depths(&self) -> [&[f64]; 2] {
        [&self.z, &self.ln]
    }
}

/// The logarithms of a line, evaluated in vectors as wide as the processor has them.
struct Logarithms<'a> {
    x: f64,
    z: &'a [f64],
    of: &'a mut [f64],
}

impl NullaryFnOnce for Logarithms<'_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
    #[inline(always)]
    fn call(self) {
        let (across, along) = self.of.split_at_mut(self.z.len());
        for ((across, along), z) in across.iter_mut().zip(along).zip(self.z) {
            let r = (self.x * self.x + z * z).sqrt();
            *across = z.abs() + r;
            *along = self.x.abs() + r;
        }
        take_logarithms(self.of);
    }
}

/// Returns `ln|s|`, or 0 where the corner function vanishes with its factor `s`.
pub(crate) fn ln_or_zero(s: f64) -> f64 {
    if s == 0.0 { 0.0 } else { s.abs().ln() }
}

/// `ln 2`, the first 33 bits and the rest.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// Replaces positive normal numbers by their logarithms, to within one unit of the last digit.
///
/// As in Sun's `fdlibm`: with `x = 2^k (1 + f)`, `1 + f` between `√½` and `√2`, and `s = f/(2 + f)`, a polynomial in `s²`
/// stands for `ln (1 + f) = 2 artanh s`. Without branches and tables the compiler takes several at a time.
#[inline(always)]
fn take_logarithms(numbers: &mut [f64]) {
    const SQRT_HALF: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    const ONE: u64 = 1.0_f64.to_bits();
    const FRACTION: u64 = (1 << 52) - 1;
    /// `2^52`, to the last digits of which a whole number is added.
    const SHIFT: f64 = 4_503_599_627_370_496.0;
    for x in numbers {
        let bits = x.to_bits().wrapping_add(ONE - SQRT_HALF);
        let k = f64::from_bits((bits >> 52) | SHIFT.to_bits()) - (SHIFT + 1023.0);
        let f = f64::from_bits((bits & FRACTION).wrapping_add(SQRT_HALF)) - 1.0;
        let s = f / (2.0 + f);
        let z = s * s;
        let w = z * z;
        let even = 0.222_221_984_321_497_84 + w * 0.153_138_376_992_093_73;
        let even = w * (0.399_999_999_994_094_2 + w * even);
        let odd = 0.181_835_721_616_180_5 + w * 0.147_981_986_051_165_86;
        let odd = z * (0.666_666_666_666_673_5 + w * (0.285_714_287_436_623_9 + w * odd));
        let half = 0.5 * f * f;
        *x = s * (half + (even + odd)) + k * LN_2[1] - half + f + k * LN_2[0];
    }
}

#[cfg(test)]
mod tests {
    use super::take_logarithms;

    #[test]
    fn logarithms_are_those_of_the_standard_library() {
        for i in 0..200_000 {
            let x = (1.0 + 1e-5 * f64::from(i)) * 10_f64.powi(i % 600 - 300);
            let mut ours = [x];
            take_logarithms(&mut ours);
            assert!((ours[0] - x.ln()).abs() <= 3e-16 * x.ln().abs().max(1e-3), "{x} {ours:?}");
        }
        let mut one = [1.0];
        take_logarithms(&mut one);
        assert_eq!(one, [0.0]);
    }
}
