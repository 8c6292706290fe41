//! Surface displacement of a layer on a rigid base, minus the displacement of a half-space.
//!
//! A traction wave of unit amplitude and wave number `k` acts on a layer of thickness `h` and shear
//! modulus `G`. With `x = k h`, `κ = 3 − 4ν` and `D = κ cosh 2x + 2x² + 5 − 12ν + 8ν²`, the
//! displacement times `G k` is
//!
//! ```text
//! normal             N = (1 − ν) (κ sinh 2x − 2x)/D                          (Carbone & Mangialardi 2008)
//! shear, in plane    S = (1 − ν) (κ sinh 2x + 2x)/D,   out of plane  T = tanh x
//! normal and shear   C = [x² − (1 − 2ν) κ sinh² x]/D                                                      (S19)
//! ```
//!
//! In a deep layer these compliances are the values of the half-space: `1 − ν`, `1 − ν`, `1` and
//! `−(1 − 2ν)/2`. The differences `Δ` from these values decay as `e^(−2x)`. In real space they are
//! therefore smooth functions of `ρ = r/h`, which are added to the closed forms (S1) and (S2). Let
//! `ψ` be the angle between the row and the direction from the load to the field point. Then
//!
//! ```text
//! u_y of P   ∫ ΔN J₀(xρ) dx                     u_x of Q   ∫ ½Δ(S + T) J₀ dx − cos 2ψ ∫ ½Δ(S − T) J₂ dx
//! u_x of P   −cos ψ ∫ ΔC J₁ dx                  u_y of Q   cos ψ ∫ ΔC J₁ dx               all over π (1 − ν) E* h   (S20)
//! ```
//!
//! (Carbone & Mangialardi, J. Mech. Phys. Solids 56, 684, doi 10.1016/j.jmps.2007.05.009). The
//! coupling of normal and shear in a deep layer, `−(1 − 2ν)/2`, is neglected as on the half-space.

use std::f64::consts::PI;
use std::ops::{Add, Mul};
use std::sync::{Arc, Mutex, PoisonError};

/// The four integrals of (S20): of `ΔN`, `½Δ(S + T)`, `½Δ(S − T)` and `ΔC`, in this order.
type Integrals = [f64; 4];

/// Number of tabulated distances `ρ` per unit; cubic interpolation is then accurate to 1e-8.
const PER_UNIT: usize = 48;

/// Largest tabulated distance `ρ`.
///
/// At larger distances the surface of a layer moves by less than 1e-6. The differences are then the
/// negative displacements of the half-space.
const FARTHEST: usize = 16;

/// Number of intervals of the quadrature over `x`.
///
/// The integrands are about 1e-12 at the end of the last interval.
const INTERVALS: u32 = 128;
/// Width of an interval: a third of a wave of `J(xρ)` at the largest tabulated `ρ`.
const INTERVAL: f64 = 0.125;

/// Gauss points and weights on the interval from −1 to 1.
const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_9],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_9],
];

/// Returns the differences of `N`, `½(S + T)`, `½(S − T)` and `C` of (S19) from the half-space.
pub fn deviation_from_half_space(poisson_ratio: f64, x: f64) -> Integrals {
    let (deep, kappa) = (1.0 - poisson_ratio, 3.0 - 4.0 * poisson_ratio);
    // All terms are divided by e^(2x), so that differences from the half-space keep their digits.
    let decay = (-2.0 * x).exp();
    let rest = 5.0 - 12.0 * poisson_ratio + 8.0 * poisson_ratio * poisson_ratio;
    let constant = 2.0 * x * x + rest;
    let d = 0.5 * kappa * (1.0 + decay * decay) + constant * decay;
    // Differences of N and S from 1 − ν; `common` is the part that both differences share.
    let common = -kappa * decay * decay - constant * decay;
    let [normal, shear] = [-2.0, 2.0].map(|sign| deep * (common + sign * x * decay) / d);
    // tanh x − 1, without cancellation.
    let across = -2.0 * decay / (1.0 + decay);
    let incompressible = 1.0 - 2.0 * poisson_ratio;
    let coupled = x * x * decay + 0.5 * incompressible * decay * (kappa + constant);
    [normal, 0.5 * (shear + across), 0.5 * (shear - across), coupled / d]
}

/// Returns `N`, `½(S + T)`, `½(S − T)` and `C` of (S19) for the half-space.
fn half_space(poisson_ratio: f64) -> Integrals {
    [1.0 - poisson_ratio, 1.0 - 0.5 * poisson_ratio, -0.5 * poisson_ratio, poisson_ratio - 0.5]
}

/// Displacement due to a point load on a layer, minus the displacement of the half-space (S20).
#[derive(Debug)]
pub struct Layer {
    poisson_ratio: f64,
    /// Values of the four integrals of (S20) and their derivatives, at equidistant `ρ` from 0.
    ///
    /// Derivatives are per step of `ρ`.
    nodes: Vec<[[f64; 2]; 4]>,
}

/// Normal and tangential displacements due to normal and tangential unit loads, for `E* = 1`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacements {
    /// Normal displacement due to a normal load.
    pub normal: f64,
    /// Displacement along the row due to a load along the row.
    pub shear: f64,
    /// Displacement along the row due to a normal load.
    ///
    /// The normal displacement due to a load along the row has the opposite value.
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

/// Recently used layers, one for each Poisson's ratio, the most recently used first.
static RECENT: Mutex<Vec<Arc<Layer>>> = Mutex::new(Vec::new());

/// Maximum number of layers in `RECENT`.
///
/// Each thread that computes finite differences with respect to Poisson's ratio needs several.
const KEPT: usize = 16;

impl Layer {
    /// Returns the integrals of a layer with a Poisson's ratio, from the cache if possible.
    ///
    /// As functions of `ρ` the integrals do not depend on the thickness of the layer.
    pub fn with_poisson_ratio(poisson_ratio: f64) -> Arc<Self> {
        // A missing layer is computed under the lock, so that other threads wait for the result
        // instead of computing the same layer.
        let mut cache = RECENT.lock().unwrap_or_else(PoisonError::into_inner);
        let cached = cache.iter().position(|layer| layer.poisson_ratio == poisson_ratio);
        let layer =
            cached.map_or_else(|| Arc::new(Self::new(poisson_ratio)), |at| cache.remove(at));
        // The most recently used layer is first, so that `truncate` drops the least recently used.
        cache.insert(0, Arc::clone(&layer));
        cache.truncate(KEPT);
        layer
    }

    fn new(poisson_ratio: f64) -> Self {
        let mut points = Vec::with_capacity(INTERVALS as usize * GAUSS.len());
        for k in 0..INTERVALS {
            for [point, weight] in GAUSS {
                let x = INTERVAL * (f64::from(k) + 0.5 * (1.0 + point));
                let parts = deviation_from_half_space(poisson_ratio, x);
                points.push((x, parts.map(|part| 0.5 * INTERVAL * weight * part)));
            }
        }
        let last = FARTHEST * PER_UNIT;
        // Two values beyond the last node are needed for the central difference at the last node.
        let values: Vec<Integrals> =
            (0..=last + 2).map(|k| integrals(&points, k as f64 / PER_UNIT as f64)).collect();
        let nodes = (0..=last).map(|k| {
            std::array::from_fn(|part| {
                let [near, far] = [1, 2].map(|steps| {
                    // The integrals are even functions of ρ, but the one with J₁ (part 3) is odd.
                    let sign = if k < steps && part == 3 { -1.0 } else { 1.0 };
                    values[k + steps][part] - sign * values[k.abs_diff(steps)][part]
                });
                [values[k][part], (8.0 * near - far) / 12.0]
            })
        });
        Self { poisson_ratio, nodes: nodes.collect() }
    }

    /// Returns the displacements on a layer minus the displacements on a half-space.
    ///
    /// Unit loads act at a point; the displacements are taken at the offset `(x, z)` from it, with
    /// `x` along the row. The layer has the given `thickness`, in the unit of `x` and `z`.
    pub fn deviation_from_half_space(&self, thickness: f64, x: f64, z: f64) -> Displacements {
        let square = x * x + z * z;
        let r = square.sqrt();
        let [normal, mean, difference, cross] = self.integrals(r / thickness);
        let unit = 1.0 / (PI * (1.0 - self.poisson_ratio) * thickness);
        // At zero offset the angle ψ is undefined, but the terms with cos ψ and cos 2ψ vanish.
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
            // The layer does not move at this distance, so only the subtracted half-space remains.
            // The integrals of J₀(ξρ), J₁(ξρ) and J₂(ξρ) over ξ from 0 to ∞ are all 1/ρ.
            return half_space(self.poisson_ratio).map(|part| -part / rho);
        };
        let t = steps - k as f64;
        let (s, last) = (1.0 - t, &self.nodes[k]);
        std::array::from_fn(|part| {
            let ([from, from_slope], [to, to_slope]) = (last[part], next[part]);
            s * s * ((1.0 + 2.0 * t) * from + t * from_slope)
                + t * t * ((1.0 + 2.0 * s) * to - s * to_slope)
        })
    }
}

/// Computes the integrals of (S20) at `ρ` from the quadrature points `x` and weighted integrands.
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
