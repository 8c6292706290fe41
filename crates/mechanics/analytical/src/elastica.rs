//! Elastica: large deflections of inextensible beams.
//!
//! A cantilever of length `L` and bending stiffness `EI` carries a transverse dead load `P` at its
//! tip. The tip rotates by `φ₁`, deflects by `w` along the load, and moves by `u` towards the
//! clamp. `F` and `E` are the elliptic integrals of the first and second kind with modulus `k`, and
//! `K(k)` and `E(k)` the complete ones. `k` is the solution of the first equation:
//!
//! ```text
//! √(PL²/EI) = K(k) − F(φ, k),     sin φ = 1/(k √2),     sin φ₁ = 2k² − 1
//! w/L = 1 − 2 [E(k) − E(φ, k)] / √(PL²/EI),     u/L = 1 − √(2 (2k² − 1) / (PL²/EI))
//! ```
//!
//! Closed form: K. E. Bisshopp, D. C. Drucker, *Quart. Appl. Math.* 3 (1945) 272, doi
//! 10.1090/qam/13360. Table: K. Mattiasson, *Int. J. Numer. Methods Eng.* 17 (1981) 145, doi
//! 10.1002/nme.1620170113. Elliptic integrals by duplication: B. C. Carlson, *Numer. Math.* 33
//! (1979) 1, doi 10.1007/BF01396491.

use std::f64::consts::FRAC_1_SQRT_2;

use crate::bisected;

/// Displacement and rotation of the tip of a cantilever of length `L`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Displacement `w/L` along the load.
    pub deflection: f64,
    /// Displacement `u/L` along the undeformed axis, towards the clamp.
    pub shortening: f64,
    /// Rotation `φ₁` in radians.
    pub rotation: f64,
}

impl Tip {
    /// Returns the array `[deflection, shortening, rotation]`.
    pub fn values(&self) -> [f64; 3] {
        [self.deflection, self.shortening, self.rotation]
    }
}

/// Loads `PL²/EI` with the resulting tip displacements, to five decimals (Mattiasson, 1981).
pub const MATTIASSON: [(f64, Tip); 4] = [
    (1.0, Tip { deflection: 0.30172, shortening: 0.05643, rotation: 0.46135 }),
    (2.0, Tip { deflection: 0.49346, shortening: 0.16064, rotation: 0.78175 }),
    (5.0, Tip { deflection: 0.71379, shortening: 0.38763, rotation: 1.21537 }),
    (10.0, Tip { deflection: 0.81061, shortening: 0.55500, rotation: 1.43029 }),
];

/// Returns displacement and rotation of the tip of an inextensible cantilever.
///
/// `load` is the dimensionless load `PL²/EI > 0`.
pub fn tip(load: f64) -> Tip {
    // The load is zero at `k = 1/√2` and infinite at `k = 1`, so both ends are excluded.
    let ends = [FRAC_1_SQRT_2 * (1.0 + 1e-12), 1.0 - 1e-12];
    let k = bisected(ends, |k| between(k)[0] < load.sqrt());
    let twice = 2.0 * k * k - 1.0;
    Tip {
        deflection: 1.0 - 2.0 * between(k)[1] / load.sqrt(),
        shortening: 1.0 - (2.0 * twice / load).sqrt(),
        rotation: twice.asin(),
    }
}

/// Returns `[x, y, rotation]` of every free node of a strip that an end moment rolls up.
///
/// The nodes are ordered from the clamp to the tip. The strip lies along `x`, has unit length and
/// is clamped at its left end. The moment rotates the tip of the strip by `angle`. The strip is a
/// polygon of `elements` straight links of equal length.
///
/// In pure bending, co-rotational elements form this polygon: the length of an element does not
/// change, and rotations and moments are exact for any number of elements.
pub fn rolled_up(elements: usize, angle: f64) -> Vec<[f64; 3]> {
    let count = elements as f64;
    let mut node = [0.0; 2];
    let nodes = (1..=elements).map(|k| {
        // The direction of the chord of an arc is the mean of the directions at the two ends.
        let chord = angle * (k as f64 - 0.5) / count;
        node = [node[0] + chord.cos() / count, node[1] + chord.sin() / count];
        [node[0], node[1], angle * k as f64 / count]
    });
    nodes.collect()
}

/// Returns `K(k) − F(φ, k)` and `E(k) − E(φ, k)` for `sin φ = 1/(k √2)`.
fn between(k: f64) -> [f64; 2] {
    let (complete, lower) = (legendre(1.0, k), legendre(FRAC_1_SQRT_2 / k, k));
    [complete[0] - lower[0], complete[1] - lower[1]]
}

/// Returns Legendre's integrals `F(φ, k)` and `E(φ, k)`, computed from Carlson's integrals.
fn legendre(sin_phi: f64, k: f64) -> [f64; 2] {
    let (cos2, delta2) = (1.0 - sin_phi.powi(2), 1.0 - (k * sin_phi).powi(2));
    let f = sin_phi * carlson_rf(cos2, delta2, 1.0);
    [f, f - k.powi(2) * sin_phi.powi(3) / 3.0 * carlson_rd(cos2, delta2, 1.0)]
}

/// Largest relative deviation of the arguments from their mean for the series expansion.
///
/// The error of the series of Carlson's integrals is of sixth order in this deviation, so it is
/// below round-off.
const NEAR: f64 = 1e-3;

/// Returns Carlson's symmetric integral `R_F(x, y, z)` of the first kind.
///
/// Duplication steps bring the arguments closer together until the series converges.
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    loop {
        let mean = (x + y + z) / 3.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -dx - dy;
        if dx.abs().max(dy.abs()).max(dz.abs()) < NEAR {
            let (e2, e3) = (dx * dy - dz * dz, dx * dy * dz);
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
            return series / mean.sqrt();
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
}

/// Returns Carlson's symmetric integral `R_D(x, y, z)` of the second kind.
///
/// Duplication steps bring the arguments closer together until the series converges.
fn carlson_rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut power) = (0.0, 1.0);
    loop {
        let mean = (x + y + 3.0 * z) / 5.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -(dx + dy) / 3.0;
        if dx.abs().max(dy.abs()).max(dz.abs()) < NEAR {
            return 3.0 * sum + power * rd_series(dx, dy, dz) / (mean * mean.sqrt());
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        sum += power / (z.sqrt() * (z + lambda));
        power /= 4.0;
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
}

/// Returns the series expansion of [`carlson_rd`] about equal arguments.
///
/// `dx`, `dy` and `dz` are the relative deviations of the arguments from their weighted mean.
fn rd_series(dx: f64, dy: f64, dz: f64) -> f64 {
    let e2 = dx * dy - 6.0 * dz * dz;
    let e3 = (3.0 * dx * dy - 8.0 * dz * dz) * dz;
    let e4 = 3.0 * (dx * dy - dz * dz) * dz * dz;
    let e5 = dx * dy * dz.powi(3);
    1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0
        + 3.0 * e5 / 26.0
}

#[cfg(test)]
mod tests {
    use super::{MATTIASSON, rolled_up, tip};

    #[test]
    fn elliptic_integrals_reproduce_the_published_table() {
        for (load, printed) in MATTIASSON {
            for (exact, printed) in tip(load).values().into_iter().zip(printed.values()) {
                assert!((exact - printed).abs() < 5.1e-6, "{load}: {exact} against {printed}");
            }
        }
        // The published five decimals do not reveal small errors of the integrals. These 15 digits
        // were computed in arbitrary precision.
        let reference = [0.810_609_024_880_296, 0.554_995_597_753_751, 1.430_285_538_803_858];
        for (exact, reference) in tip(10.0).values().into_iter().zip(reference) {
            assert!((exact - reference).abs() < 1e-13, "{exact} against {reference}");
        }
    }

    #[test]
    fn a_strip_rolled_up_by_a_full_turn_is_a_closed_polygon() {
        let [x, y, turn] = rolled_up(12, std::f64::consts::TAU)[11];
        assert!(x.abs() < 1e-14 && y.abs() < 1e-14 && turn == std::f64::consts::TAU);
    }
}
