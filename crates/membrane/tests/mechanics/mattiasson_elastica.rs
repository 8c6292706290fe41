//! The inextensible cantilever with a transverse tip load.
//!
//! Closed form: K. E. Bisshopp, D. C. Drucker, *Quart. Appl. Math.* 3 (1945) 272,
//! doi 10.1090/qam/13360. Table: K. Mattiasson, *Int. J. Numer. Methods Eng.* 17 (1981) 145,
//! doi 10.1002/nme.1620170113.

use std::f64::consts::FRAC_1_SQRT_2;

use membrane::InvalidMembrane;
use nalgebra::Vector3;

use crate::cantilever::{cantilever, equilibrium};

/// Thin enough for a tip error of about 1e-8 from the stretch.
const INEXTENSIBLE: f64 = 1e-4;

/// `PL²/EI`, deflection `w/L`, shortening `u/L` and rotation of the tip, to the five decimals given
/// by Mattiasson.
const TABLE: [(f64, [f64; 3]); 4] = [
    (1.0, [0.30172, 0.05643, 0.46135]),
    (2.0, [0.49346, 0.16064, 0.78175]),
    (5.0, [0.71379, 0.38763, 1.21537]),
    (10.0, [0.81061, 0.55500, 1.43029]),
];

/// Carlson's symmetric integral of the first kind, by duplication.
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    loop {
        let mean = (x + y + z) / 3.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -dx - dy;
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let (e2, e3) = (dx * dy - dz * dz, dx * dy * dz);
            return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0)
                / mean.sqrt();
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
}

/// Legendre's integrals `F(φ, k)` and `E(φ, k)`; `E` from `F` by Carlson's integral of the second kind.
fn legendre(sin_phi: f64, k: f64) -> [f64; 2] {
    let (cos2, delta2) = (1.0 - sin_phi.powi(2), 1.0 - (k * sin_phi).powi(2));
    let f = sin_phi * carlson_rf(cos2, delta2, 1.0);
    [f, f - k.powi(2) * sin_phi.powi(3) / 3.0 * carlson_rd(cos2, delta2, 1.0)]
}

/// Carlson's symmetric integral of the second kind, by duplication.
fn carlson_rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut power) = (0.0, 1.0);
    loop {
        let mean = (x + y + 3.0 * z) / 5.0;
        let (dx, dy) = (1.0 - x / mean, 1.0 - y / mean);
        let dz = -(dx + dy) / 3.0;
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let e2 = dx * dy - 6.0 * dz * dz;
            let e3 = (3.0 * dx * dy - 8.0 * dz * dz) * dz;
            let e4 = 3.0 * (dx * dy - dz * dz) * dz * dz;
            let e5 = dx * dy * dz.powi(3);
            let series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0
                - 3.0 * e4 / 22.0
                - 9.0 * e2 * e3 / 52.0
                + 3.0 * e5 / 26.0;
            return 3.0 * sum + power * series / (mean * mean.sqrt());
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        sum += power / (z.sqrt() * (z + lambda));
        power /= 4.0;
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
}

/// `w/L`, `u/L` and the tip rotation from elliptic integrals of modulus `k`, for
/// `√(PL²/EI) = K(k) − F(φ₁, k)` with `sin φ₁ = 1/(k√2)`.
pub fn exact(load: f64) -> [f64; 3] {
    let between = |k: f64| {
        let (complete, lower) = (legendre(1.0, k), legendre(FRAC_1_SQRT_2 / k, k));
        [complete[0] - lower[0], complete[1] - lower[1]]
    };
    let (mut low, mut high) = (FRAC_1_SQRT_2 * (1.0 + 1e-12), 1.0 - 1e-12);
    for _ in 0..60 {
        let k = 0.5 * (low + high);
        *(if between(k)[0] < load.sqrt() { &mut low } else { &mut high }) = k;
    }
    let k = 0.5 * (low + high);
    let twice = 2.0 * k * k - 1.0;
    [1.0 - 2.0 * between(k)[1] / load.sqrt(), 1.0 - (2.0 * twice / load).sqrt(), twice.asin()]
}

/// The same from a mesh.
fn computed(load: f64, elements: usize, thickness: f64) -> Result<[f64; 3], InvalidMembrane> {
    let gap = cantilever(elements, thickness)?;
    let u = equilibrium(&gap, Vector3::new(0.0, load, 0.0), 20);
    let tip = u.fixed_rows::<3>(3 * elements);
    Ok([tip[1], -tip[0], tip[2]])
}

#[test]
fn elliptic_integrals_give_the_printed_table() {
    for (load, printed) in TABLE {
        for (exact, printed) in exact(load).into_iter().zip(printed) {
            assert!((exact - printed).abs() < 5.1e-6, "PL²/EI = {load}: {exact} against {printed}");
        }
    }
    // Fifteen digits by arbitrary-precision arithmetic, which tests the integrals themselves.
    let reference = [0.810_609_024_880_296, 0.554_995_597_753_751, 1.430_285_538_803_858];
    for (exact, reference) in exact(10.0).into_iter().zip(reference) {
        assert!((exact - reference).abs() < 1e-13, "{exact} against {reference}");
    }
}

/// The error falls by 4 when the elements are halved, and what is left after extrapolation by that
/// rule is far smaller, for all loads of the table.
#[test]
fn mattiasson_elastica() -> Result<(), InvalidMembrane> {
    for load in (1..=10).map(f64::from) {
        let exact = Vector3::from(exact(load));
        let coarse = Vector3::from(computed(load, 32, INEXTENSIBLE)?) - exact;
        let fine = Vector3::from(computed(load, 64, INEXTENSIBLE)?) - exact;
        let order = (coarse.norm() / fine.norm()).log2();
        let extrapolated = (fine - (coarse - fine) / 3.0).amax();
        assert!((order - 2.0).abs() < 0.003, "PL²/EI = {load}: order {order}");
        assert!(fine.amax() < 4e-5, "PL²/EI = {load}: {fine}");
        assert!(extrapolated < 1e-7, "PL²/EI = {load}: {extrapolated:e}");
    }
    Ok(())
}

/// The stretch leaves at the rate `1/EA`, that is with the square of the thickness.
#[test]
fn inextensible_limit() -> Result<(), InvalidMembrane> {
    let limit = computed(5.0, 8, INEXTENSIBLE)?;
    let [thick, thin] = [computed(5.0, 8, 0.02)?, computed(5.0, 8, 0.01)?];
    for i in 0..3 {
        let order = ((thick[i] - limit[i]) / (thin[i] - limit[i])).log2();
        assert!((order - 2.0).abs() < 0.01, "quantity {i}: order {order}");
    }
    Ok(())
}
