//! Elastica: large deflections of inextensible beams.
//!
//! The tip of a cantilever of length `L` under a transverse dead load `P` rotates by `φ₁`. With
//! `sin φ₁ = 2k² − 1`, the modulus `k` of the elliptic integrals solves
//!
//! ```text
//! √(PL²/EI) = K(k) − F(φ, k),     sin φ = 1/(k √2)
//! w/L = 1 − 2 [E(k) − E(φ, k)] / √(PL²/EI),     u/L = 1 − √(2 (2k² − 1) / (PL²/EI))
//! ```
//!
//! Closed form: K. E. Bisshopp, D. C. Drucker, *Quart. Appl. Math.* 3 (1945) 272, doi
//! 10.1090/qam/13360. Table: K. Mattiasson, *Int. J. Numer. Methods Eng.* 17 (1981) 145, doi
//! 10.1002/nme.1620170113. Elliptic integrals by duplication: B. C. Carlson, *Numer. Math.* 33
//! (1979) 1, doi 10.1007/BF01396491.

use std::f64::consts::FRAC_1_SQRT_2;

use crate::bisected;

/// Tip displacement of a cantilever, over its length, and tip rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Deflection `w/L` along the load.
    pub deflection: f64,
    /// Shortening `u/L` of the distance to the clamp along the undeformed axis.
    pub shortening: f64,
    /// Rotation `φ₁`, radians.
    pub rotation: f64,
}

impl Tip {
    /// Returns deflection, shortening and rotation in a list.
    pub fn values(&self) -> [f64; 3] {
        [self.deflection, self.shortening, self.rotation]
    }
}

/// Loads `PL²/EI` and tip displacements, to five decimals (Mattiasson, 1981).
pub const MATTIASSON: [(f64, Tip); 4] = [
    (1.0, Tip { deflection: 0.30172, shortening: 0.05643, rotation: 0.46135 }),
    (2.0, Tip { deflection: 0.49346, shortening: 0.16064, rotation: 0.78175 }),
    (5.0, Tip { deflection: 0.71379, shortening: 0.38763, rotation: 1.21537 }),
    (10.0, Tip { deflection: 0.81061, shortening: 0.55500, rotation: 1.43029 }),
];

/// Returns the tip displacement of an inextensible cantilever.
///
/// `load` is `PL²/EI > 0`.
pub fn tip(load: f64) -> Tip {
    // Just inside the interval: at its ends the load is zero and infinite.
    let ends = [FRAC_1_SQRT_2 * (1.0 + 1e-12), 1.0 - 1e-12];
    let k = bisected(ends, |k| between(k)[0] < load.sqrt());
    let twice = 2.0 * k * k - 1.0;
    Tip {
        deflection: 1.0 - 2.0 * between(k)[1] / load.sqrt(),
        shortening: 1.0 - (2.0 * twice / load).sqrt(),
        rotation: twice.asin(),
    }
}

/// Returns the nodes of a strip rolled up by an end moment.
///
/// The strip has unit length along `x` and is clamped at its left end. The moment rotates its tip
/// by `angle`. It is a polygon of `elements` straight links, each as long as its arc. Returns
/// `(x, y, rotation)` of every node except the clamped one.
///
/// Co-rotational elements in pure bending are such links: their rotations and moments are exact for
/// any number of elements.
pub fn rolled_up(elements: usize, angle: f64) -> Vec<[f64; 3]> {
    let count = elements as f64;
    let mut node = [0.0; 2];
    let nodes = (1..=elements).map(|k| {
        // The chord of an arc has the mean direction of its ends.
        let chord = angle * (k as f64 - 0.5) / count;
        node = [node[0] + chord.cos() / count, node[1] + chord.sin() / count];
        [node[0], node[1], angle * k as f64 / count]
    });
    nodes.collect()
}

/// Returns `K(k) − F(φ, k)` and `E(k) − E(φ, k)` with `sin φ = 1/(k √2)`.
fn between(k: f64) -> [f64; 2] {
    let (complete, lower) = (legendre(1.0, k), legendre(FRAC_1_SQRT_2 / k, k));
    [complete[0] - lower[0], complete[1] - lower[1]]
}

/// Returns Legendre's integrals `F(φ, k)` and `E(φ, k)`, by Carlson's integrals.
fn legendre(sin_phi: f64, k: f64) -> [f64; 2] {
    let (cos2, delta2) = (1.0 - sin_phi.powi(2), 1.0 - (k * sin_phi).powi(2));
    let f = sin_phi * carlson_rf(cos2, delta2, 1.0);
    [f, f - k.powi(2) * sin_phi.powi(3) / 3.0 * carlson_rd(cos2, delta2, 1.0)]
}

/// Deviation of the arguments from their mean below which the series is used.
///
/// It is relative to the mean. The series of Carlson's integrals have errors of sixth order in it,
/// below round-off.
const NEAR: f64 = 1e-3;

/// Returns Carlson's symmetric integral of the first kind, by duplication.
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

/// Returns Carlson's symmetric integral of the second kind, by duplication.
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

/// Returns the series of [`carlson_rd`] near equal arguments.
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
    fn elliptic_integrals_give_the_printed_table() {
        for (load, printed) in MATTIASSON {
            for (exact, printed) in tip(load).values().into_iter().zip(printed.values()) {
                assert!((exact - printed).abs() < 5.1e-6, "{load}: {exact} against {printed}");
            }
        }
        // Fifteen digits by arbitrary-precision arithmetic, which test the integrals themselves.
        let reference = [0.810_609_024_880_296, 0.554_995_597_753_751, 1.430_285_538_803_858];
        for (exact, reference) in tip(10.0).values().into_iter().zip(reference) {
            assert!((exact - reference).abs() < 1e-13, "{exact} against {reference}");
        }
    }

    #[test]
    fn a_full_circle_closes() {
        let [x, y, turn] = rolled_up(12, std::f64::consts::TAU)[11];
        assert!(x.abs() < 1e-14 && y.abs() < 1e-14 && turn == std::f64::consts::TAU);
    }
}
