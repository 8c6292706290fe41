//! Springs from a table of Chebyshev polynomials, which replace boundary-element solutions.
//!
//! The springs are smooth functions of `log(d/a)`, `log(b/a)` and `log(1 − ν)`. Let `u`, `v`, `w`
//! be these logarithms, mapped linearly from the ranges of `d/a`, `b/a` and `1 − ν` to −1 … 1. With
//! Chebyshev polynomials `T`,
//!
//! ```text
//! ln α_y, ln α_φ, β_y/α_y, β_φ/α_φ = Σ_ij c_ij T_i(u) T_j(v)
//! ln α_x, β_x/α_x = Σ_ijk c_ijk T_i(u) T_j(v) T_k(w)                                 (S18)
//! ```
//!
//! For a row with coupling to [`NEIGHBOURS`] neighbours the table also holds polynomials for the
//! changes of `K_0` and `K_1` and for `K_k` of farther neighbours, all divided by `α`, and for `c`
//! divided by `√(α_y α_φ)`. Values for normal tractions do not depend on `ν`.
//!
//! `table.bin` holds the coefficients as 4-byte floats in little-endian order, with the index `j`
//! varying fastest. `examples/table.rs` generates this file.

use std::f64::consts::LN_2;
use std::ops::{Add, Mul};

use crate::{Coupling, Footprint, NEIGHBOURS};

/// Range of `d/a`.
pub const GAPS: [f64; 2] = [0.0125, 100.0];

/// Range of `b/a`.
pub const WIDTHS: [f64; 2] = [0.25, 80.0];

/// Number of polynomials in each length for the springs of Eq. (1).
pub const NEAREST: usize = 24;

/// Number of polynomials in each length for the additional values of long rows.
///
/// Fewer polynomials suffice because these values are smaller.
pub const ROW: usize = 16;

/// Number of polynomials in `log(1 − ν)`; `α_x` is smoother in this variable than in `ν`.
pub const RATIOS: usize = 5;

/// Error bound of the springs of Eq. (1) relative to `α`; tests check it between the nodes.
const ERROR: f64 = 1e-5;

/// Error bound of long rows relative to `α`, larger because coarser meshes give their values.
///
/// Long rows neglect the coupling beyond [`NEIGHBOURS`] neighbours, which is sixty times as large
/// as this bound.
const ROW_ERROR: f64 = 1e-4;

/// Returns the error bound of a row, relative to `K_0` of the same direction.
pub(crate) fn error(coupling: Coupling) -> f64 {
    match coupling {
        Coupling::Nearest => ERROR,
        Coupling::Full => ROW_ERROR,
    }
}

/// Returns Poisson's ratio at `w` in −1 … 1: 0 at −1 and ½ at 1, linear in `log(1 − ν)`.
pub fn poisson_ratio(w: f64) -> f64 {
    1.0 - (-0.5 - 0.5 * w).exp2()
}

/// Coefficients of all polynomials, read in sequence by `row`.
static TABLE: &[u8] = include_bytes!("table.bin");

/// Value with its derivatives with respect to `d/a`, `b/a` and `ν`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Differentiated(pub(crate) [f64; 4]);

impl Differentiated {
    /// Applies a function; `value` and `slope` are its value and its derivative at this number.
    fn map(self, value: f64, slope: f64) -> Self {
        let [_, by_gap, by_width, by_ratio] = self.0;
        Self([value, by_gap * slope, by_width * slope, by_ratio * slope])
    }

    fn exp(self) -> Self {
        let exp = self.0[0].exp();
        self.map(exp, exp)
    }

    fn sqrt(self) -> Self {
        let root = self.0[0].sqrt();
        self.map(root, 0.5 / root)
    }
}

impl Add for Differentiated {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Mul for Differentiated {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self(std::array::from_fn(|i| if i == 0 { a[0] * b[0] } else { a[i] * b[0] + a[0] * b[i] }))
    }
}

/// Returns the values of a row with their derivatives, or `None` outside the range of the table.
///
/// The first three values are `K_0` in `x`, `y` and `φ`. For each neighbour follow `K_x`, `K_y`,
/// `K_φ` and `c` of (S9).
pub(crate) fn row(footprint: &Footprint, coupling: Coupling) -> Option<Vec<Differentiated>> {
    let mut reader = Reader::at(footprint)?;
    // Each call reads the next polynomial of the file, so these lines follow the file's order.
    let [ln_y, ln_turn, y_ratio, turn_ratio] = [(); 4].map(|()| reader.surface(NEAREST));
    let [ln_x, x_ratio] = [(); 2].map(|()| reader.solid(NEAREST));
    let alpha = [ln_x, ln_y, ln_turn].map(Differentiated::exp);
    // K_0 and K_1 divided by α, for a row of three rectangles. Long rows add corrections.
    let mut ratios = vec![[Differentiated([1.0, 0.0, 0.0, 0.0]); 3]];
    ratios.push([x_ratio, y_ratio, turn_ratio].map(|ratio| ratio.map(-ratio.0[0], -1.0)));
    let mut cross = vec![Differentiated::default()];
    if coupling == Coupling::Full {
        ratios.resize(NEIGHBOURS + 1, [Differentiated::default(); 3]);
        for direction in [1, 2] {
            for k in &mut ratios {
                k[direction] = k[direction] + reader.surface(ROW);
            }
        }
        let size = (alpha[1] * alpha[2]).sqrt();
        cross = (0..NEIGHBOURS).map(|_| reader.surface(ROW) * size).collect();
        for k in &mut ratios {
            k[0] = k[0] + reader.solid(ROW);
        }
    }
    let mut stiffness =
        ratios.into_iter().map(|k| [k[0] * alpha[0], k[1] * alpha[1], k[2] * alpha[2]]);
    let middle = stiffness.next()?;
    let neighbours = stiffness.zip(cross).flat_map(|([x, y, turn], cross)| [x, y, turn, cross]);
    Some(middle.into_iter().chain(neighbours).collect())
}

/// Reader that evaluates the polynomials of the table in sequence at one footprint.
struct Reader {
    /// Chebyshev polynomials of `u`, `v`, `w`, with their derivatives by `d/a`, `b/a`, `ν`.
    gap: Vec<[f64; 2]>,
    width: Vec<[f64; 2]>,
    ratio: Vec<[f64; 2]>,
    coefficients: std::slice::Iter<'static, [u8; 4]>,
}

impl Reader {
    fn at(footprint: &Footprint) -> Option<Self> {
        let lengths = [(footprint.gap_over_a(), GAPS), (footprint.width_over_a(), WIDTHS)];
        let [gap, width] = lengths.map(|(value, [low, high])| {
            let slope = 2.0 / (high / low).ln();
            // Rounding may put a position slightly beyond ±1, where polynomials are still accurate.
            let position = (value / low).ln() * slope - 1.0;
            (low..=high).contains(&value).then(|| chebyshev(position, slope / value, NEAREST))
        });
        // Poisson's ratio needs no range check: a footprint has a ratio from 0 to ½.
        let rest = 1.0 - footprint.poisson_ratio();
        Some(Self {
            gap: gap?,
            width: width?,
            ratio: chebyshev(-1.0 - 2.0 * rest.log2(), 2.0 / (LN_2 * rest), RATIOS),
            coefficients: TABLE.as_chunks().0.iter(),
        })
    }

    /// Evaluates the next polynomial in the two lengths `d/a` and `b/a`.
    fn surface(&mut self, orders: usize) -> Differentiated {
        let mut sum = [0.0; 4];
        for [t, t_slope] in &self.gap[..orders] {
            let (mut value, mut slope) = (0.0, 0.0);
            for ([t, t_slope], coefficient) in
                self.width[..orders].iter().zip(&mut self.coefficients)
            {
                let coefficient = f64::from(f32::from_le_bytes(*coefficient));
                value += coefficient * t;
                slope += coefficient * t_slope;
            }
            sum[0] += t * value;
            sum[1] += t_slope * value;
            sum[2] += t * slope;
        }
        Differentiated(sum)
    }

    /// Evaluates the next polynomial in the two lengths and Poisson's ratio.
    fn solid(&mut self, orders: usize) -> Differentiated {
        let parts: Vec<_> = (0..RATIOS).map(|_| self.surface(orders)).collect();
        let terms = self.ratio.iter().zip(parts);
        let terms =
            terms.map(|([t, t_slope], part)| part * Differentiated([*t, 0.0, 0.0, *t_slope]));
        terms.fold(Differentiated::default(), Add::add)
    }
}

/// Returns the first `count` Chebyshev polynomials at `x` with their slopes.
///
/// `slope` is the derivative of `x` with respect to the variable of the returned slopes.
fn chebyshev(x: f64, slope: f64, count: usize) -> Vec<[f64; 2]> {
    let mut polynomials = vec![[1.0, 0.0], [x, slope]];
    for k in 2..count {
        let ([t, t_slope], [before, before_slope]) = (polynomials[k - 1], polynomials[k - 2]);
        let next_slope = 2.0 * (slope * t + x * t_slope) - before_slope;
        polynomials.push([2.0 * x * t - before, next_slope]);
    }
    polynomials
}
