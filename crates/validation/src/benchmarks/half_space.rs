//! Rigid rectangles on an elastic half-space.

use substrate::{Footprint, Springs, calibrate, extrapolated};

use super::Benchmark;
use crate::Error;

/// So far apart that rectangles do not feel each other.
const ALONE: f64 = 1e5;

const NAMES: [&str; 6] = ["α_x", "α_y", "α_φ", "β_x", "β_y", "β_φ"];

fn footprint(gap: f64, width: f64) -> Result<Footprint, Error> {
    Footprint::new(gap, width, 0.5).map_err(|error| Error::Benchmark(error.to_string()))
}

fn springs(gap: f64, width: f64) -> Result<Springs, Error> {
    calibrate(&footprint(gap, width)?).map_err(|error| Error::Benchmark(error.to_string()))
}

fn six(springs: &Springs) -> [f64; 6] {
    let ([ax, ay, aphi], [bx, by, bphi]) = (springs.direct, springs.coupling);
    [ax, ay, aphi, bx, by, bphi]
}

pub(super) fn benchmarks() -> Result<Vec<Benchmark>, Error> {
    let mut all = square()?;
    all.extend(converged()?);
    for width in [1.0, 2.0, 8.0] {
        all.extend(formulas(width)?);
    }
    Ok(all)
}

fn square() -> Result<Vec<Benchmark>, Error> {
    let square = springs(ALONE, 2.0)?;
    let [x, y, phi] = square.direct;
    let square = |name, source, values| Benchmark::new(name, source, values, 1e-4);
    let known = "converged boundary elements";
    let mut all = vec![
        square("rigid square punch, normal: α_y", "Borodachev 1976", [2.3046, y]),
        square("square sheared, ν = 0.5: α_x", known, [1.5384, x]),
        square("square tilted: α_φ", known, [2.0807, phi]),
    ];
    // Known to three decimals.
    let row = six(&springs(0.2, 2.0)?);
    let printed = [2.699, 3.376, 2.473, 0.993, 1.082, -0.428];
    all.extend((0..6).map(|k| {
        let name = format!("three squares, d = 0.2 a: {}", NAMES[k]);
        Benchmark::new(name, known, [printed[k], row[k]], 1.1e-3 / printed[k].abs())
    }));
    Ok(all)
}

/// The coefficients that differ most from those of a much finer mesh.
fn converged() -> Result<Vec<Benchmark>, Error> {
    let corners = [(0.05, 0.25), (0.05, 80.0), (0.2, 2.0), (2.0, 20.0), (80.0, 0.25), (80.0, 80.0)];
    let worst = |(gap, width)| {
        let ours = six(&springs(gap, width)?);
        let fine = extrapolated(&footprint(gap, width)?, [16, 24])
            .map_err(|error| Error::Benchmark(error.to_string()))?;
        // A coupling that has died out has no digits to compare.
        let off = |k: &usize| ((ours[*k] - fine[*k]) / fine[k % 3]).abs();
        let k = (0..6).max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        let name = format!("d/a = {gap}, b/a = {width}: {} (the worst)", NAMES[k]);
        Ok(Benchmark::new(name, "16 and 24 cells a side, extrapolated", [fine[k], ours[k]], 3e-3))
    };
    corners.into_iter().map(worst).collect()
}

/// Formulas of soil dynamics for rigid rectangles, `G/(1 − ν) = E*/2`. With the half-sides `B ≤ L`.
fn formulas(width: f64) -> Result<Vec<Benchmark>, Error> {
    let [x, y, phi] = springs(ALONE, width)?.direct;
    let half = width / 2.0;
    // The scale tilts about the axis of its width.
    let (b, ratio) = (half.min(1.0), half.max(1.0) / half.min(1.0));
    let [normal, shear] = [0.5 * b, b / 6.0];
    let wide = half >= 1.0;
    let rocking = if wide { 3.2 * ratio + 0.8 } else { 3.73 * ratio.powf(2.4) + 0.27 };
    // Shear across the longer side.
    let across = if wide { 0.8 * (ratio - 1.0) } else { 0.0 };
    let pais = [
        ("α_x", x, shear * (6.8 * ratio.powf(0.65) + 2.4 + across)),
        ("α_y", y, normal * (3.1 * ratio.powf(0.75) + 1.6)),
        ("α_φ", phi, 0.5 * b.powi(3) * rocking),
    ];
    let chi = 1.0 / ratio;
    let l = b * ratio;
    let vertical = l * (0.73 + 1.54 * chi.powf(0.75));
    let pais = pais.map(|(name, ours, formula)| {
        let name = format!("rectangle b/a = {width}: {name}");
        Benchmark::new(name, "formula of Pais & Kausel 1988, ± 6 %", [formula, ours], 0.06)
    });
    let gazetas = Benchmark::new(
        format!("rectangle b/a = {width}: α_y"),
        "formula of Gazetas 1991, ± 6 %",
        [vertical, y],
        0.06,
    );
    Ok(pais.into_iter().chain([gazetas]).collect())
}
