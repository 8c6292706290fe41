//! Displacement of the surface of an elastic layer that is bonded to a rigid base, beside that of the half-space.
//!
//! A wave of traction of wave number `k` displaces the surface of a layer of thickness `h` by, with `x = k h`, `κ = 3 − 4ν` and
//! `D = κ cosh 2x + 2x² + 5 − 12ν + 8ν²`, and over `G k`,
//!
//! ```text
//! normal             N = (1 − ν) (κ sinh 2x − 2x)/D                          (Carbone & Mangialardi 2008)
//! shear, in plane    S = (1 − ν) (κ sinh 2x + 2x)/D,   out of plane  T = tanh x
//! normal and shear   C = [x² − (1 − 2ν) κ sinh² x]/D                                                      (S19)
//! ```
//!
//! What a deep layer has, the half-space has too: `1 − ν`, `1 − ν`, `1` and `−(1 − 2ν)/2`. The rest decays as `e^(−2x)`, so that in real
//! space it is a smooth function of `ρ = r/h`, which is added to the closed forms (S1) and (S2). With `ψ` the direction from the
//! load to the field point, from the row,
//!
//! ```text
//! u_y of P   ∫ ΔN J₀(xρ) dx                     u_x of Q   ∫ ½Δ(S + T) J₀ dx − cos 2ψ ∫ ½Δ(S − T) J₂ dx
//! u_x of P   −cos ψ ∫ ΔC J₁ dx                  u_y of Q   cos ψ ∫ ΔC J₁ dx               all over π (1 − ν) E* h   (S20)
//! ```
//!
//! (Carbone & Mangialardi, J. Mech. Phys. Solids 56, 684, doi 10.1016/j.jmps.2007.05.009.) As on the half-space, the coupling of a
//! deep layer, in proportion to `1 − 2ν`, is left out.

use std::f64::consts::PI;
use std::ops::{Add, Mul};
use std::sync::{Arc, Mutex, PoisonError};

/// The four integrals of (S20), in its order.
type Integrals = [f64; 4];

/// Values of `ρ` per unit at which the integrals are kept; cubics between them are right to 1e-8.
const PER_UNIT: usize = 48;

/// The largest `ρ` that is kept: beyond it a layer moves by less than 1e-6, and the rest takes away what the half-space does.
const FARTHEST: usize = 16;

/// The last intervals of the quadrature, where the integrands have decayed to 1e-12, and their width: an eighth of a unit
/// is a third of a wave of `J(xρ)` at the largest `ρ`.
const INTERVALS: u32 = 128;
const INTERVAL: f64 = 0.125;

/// Gauss points and weights on an interval from −1 to 1.
const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_9],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_9],
];

/// Returns `N`, `½(S + T)`, `½(S − T)` and `C` of (S19) at `x`, less those of the half-space.
pub fn beside_half_space(poisson_ratio: f64, x: f64) -> Integrals {
    let (left, kappa) = (1.0 - poisson_ratio, 3.0 - 4.0 * poisson_ratio);
    // Over e^(2x), in which differences with the half-space keep their digits.
    let decay = (-2.0 * x).exp();
    let rest = 5.0 - 12.0 * poisson_ratio + 8.0 * poisson_ratio * poisson_ratio;
    let constant = 2.0 * x * x + rest;
    let d = 0.5 * kappa * (1.0 + decay * decay) + constant * decay;
    // S and N less 1 − ν, T less 1.
    let common = -kappa * decay * decay - constant * decay;
    let [normal, shear] = [-2.0, 2.0].map(|sign| left * (common + sign * x * decay) / d);
    // tanh x − 1, without a difference of near numbers.
    let across = -2.0 * decay / (1.0 + decay);
    let incompressible = 1.0 - 2.0 * poisson_ratio;
    let coupled = x * x * decay + 0.5 * incompressible * decay * (kappa + constant);
    [normal, 0.5 * (shear + across), 0.5 * (shear - across), coupled / d]
}

/// The four compliances of (S19) of the half-space.
fn half_space(poisson_ratio: f64) -> Integrals {
    [1.0 - poisson_ratio, 1.0 - 0.5 * poisson_ratio, -0.5 * poisson_ratio, poisson_ratio - 0.5]
}

/// What a point load does on a layer beside what it does on the half-space (S20).
#[derive(Debug)]
pub struct Layer {
    poisson_ratio: f64,
    /// The integrals and their slopes, at steps of `ρ` from 0 on.
    nodes: Vec<[[f64; 2]; 4]>,
}

/// Displacements in two directions of a load in each, `E* = 1`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacements {
    /// Normal displacement of a normal load.
    pub normal: f64,
    /// Displacement along the row of a load along it.
    pub shear: f64,
    /// Displacement along the row of a normal load; the normal one of a load along the row is the same with the other sign.
    pub cross: f64,
}

impl Add for Displacements {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (normal, shear) = (self.normal + other.normal, self.shear + other.shear);
        Self { normal, shear, cross: self.cross + other.cross }
    }
}

impl Mul<f64> for Displacements {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        let (normal, shear) = (self.normal * factor, self.shear * factor);
        Self { normal, shear, cross: self.cross * factor }
    }
}

/// Layers that were made last, each for a Poisson's ratio: few are needed at a time.
static MADE: Mutex<Vec<Arc<Layer>>> = Mutex::new(Vec::new());

/// Layers that are kept: those of the differences by Poisson's ratio, for two threads and more.
const KEPT: usize = 16;

impl Layer {
    /// Returns the layer of a Poisson's ratio: its integrals depend on no thickness.
    pub fn with_poisson_ratio(poisson_ratio: f64) -> Arc<Self> {
        // The layer is made under the lock: a thread that needs the same one waits for it instead of making it again.
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        let known = made.iter().position(|layer| layer.poisson_ratio == poisson_ratio);
        let layer = known.map_or_else(|| Arc::new(Self::new(poisson_ratio)), |at| made.remove(at));
        // The one that was used last stands first, so that the longest unused falls off.
        made.insert(0, Arc::clone(&layer));
        made.truncate(KEPT);
        layer
    }

    fn new(poisson_ratio: f64) -> Self {
        let point = |k: u32, [place, weight]: [f64; 2]| {
            let x = INTERVAL * (f64::from(k) + 0.5 * (1.0 + place));
            let parts = beside_half_space(poisson_ratio, x);
            (x, parts.map(|part| 0.5 * INTERVAL * weight * part))
        };
        let points: Vec<_> =
            (0..INTERVALS).flat_map(|k| GAUSS.map(|gauss| point(k, gauss))).collect();
        let at = |k: usize| integrals(&points, k as f64 / PER_UNIT as f64);
        let last = FARTHEST * PER_UNIT;
        // Two more than are kept, for the slope of the last.
        let values: Vec<Integrals> = (0..=last + 2).map(at).collect();
        // Below 0 the integrals go on even, those of J₁ odd.
        let value = |k: usize, steps: isize, part: usize| {
            let place = k.cast_signed() + steps;
            let sign = if place < 0 && part == 3 { -1.0 } else { 1.0 };
            sign * values[place.unsigned_abs()][part]
        };
        let slope = |k: usize, part: usize| {
            let difference = |steps: isize| value(k, steps, part) - value(k, -steps, part);
            (8.0 * difference(1) - difference(2)) / 12.0
        };
        let node = |k: usize| std::array::from_fn(|part| [values[k][part], slope(k, part)]);
        Self { poisson_ratio, nodes: (0..=last).map(node).collect() }
    }

    /// Returns what unit loads do at the offset `(x, z)` beside what they do on the half-space, on a layer of a `thickness`.
    pub fn beside_half_space(&self, thickness: f64, x: f64, z: f64) -> Displacements {
        let square = x * x + z * z;
        let r = square.sqrt();
        let [normal, mean, difference, cross] = self.integrals(r / thickness);
        let unit = 1.0 / (PI * (1.0 - self.poisson_ratio) * thickness);
        // Where there is no direction, what depends on it vanishes.
        let (cos, cos_twice) = if r > 0.0 { (x / r, (x * x - z * z) / square) } else { (0.0, 0.0) };
        Displacements {
            normal: unit * normal,
            shear: unit * (mean - cos_twice * difference),
            cross: -unit * cos * cross,
        }
    }

    fn integrals(&self, rho: f64) -> Integrals {
        let steps = rho * PER_UNIT as f64;
        let k = steps as usize;
        let Some(next) = self.nodes.get(k + 1) else {
            // The layer does not move here: J₀, J₁ and J₂ alike have the integral 1/ρ.
            return half_space(self.poisson_ratio).map(|part| -part / rho);
        };
        let t = steps - k as f64;
        let (s, last) = (1.0 - t, &self.nodes[k]);
        let cubic = |part: usize| {
            let ([from, from_slope], [to, to_slope]) = (last[part], next[part]);
            s * s * ((1.0 + 2.0 * t) * from + t * from_slope)
                + t * t * ((1.0 + 2.0 * s) * to - s * to_slope)
        };
        std::array::from_fn(cubic)
    }
}

/// The integrals of (S20) at a `ρ`, from the points of the quadrature.
fn integrals(points: &[(f64, Integrals)], rho: f64) -> Integrals {
    let mut sums = [0.0; 4];
    for (x, [normal, mean, difference, cross]) in points {
        let z = x * rho;
        let (j0, j1) = (libm::j0(z), libm::j1(z));
        let j2 = if z > 0.0 { 2.0 * j1 / z - j0 } else { 0.0 };
        sums[0] += normal * j0;
        sums[1] += mean * j0;
        sums[2] += difference * j2;
        sums[3] += cross * j1;
    }
    sums
}
