//! Benchmarks of the substrate: rigid rectangles on an elastic half-space.

use analytical::half_space;
use substrate::{Footprint, Springs, calibrate, extrapolated};

use super::Benchmark;

/// Gap, divided by the half-width `a`, of rectangles with negligible coupling.
///
/// The coupling is below the precision of the reference values.
const ALONE: f64 = 1e5;

/// Names of the six spring coefficients: direct (α) and coupling (β), each for `x`, `y` and `φ`.
const NAMES: [&str; 6] = ["α_x", "α_y", "α_φ", "β_x", "β_y", "β_φ"];

fn footprint(gap: f64, width: f64) -> anyhow::Result<Footprint> {
    Ok(Footprint::new(gap, width, 0.5)?)
}

fn springs(gap: f64, width: f64) -> anyhow::Result<Springs> {
    Ok(calibrate(&footprint(gap, width)?)?)
}

/// Returns the six coefficients in the order of [`NAMES`].
fn six(springs: &Springs) -> [f64; 6] {
    let ([ax, ay, aphi], [bx, by, bphi]) = (springs.direct, springs.coupling);
    [ax, ay, aphi, bx, by, bphi]
}

pub(super) fn benchmarks() -> anyhow::Result<Vec<Benchmark>> {
    let mut all = square()?;
    all.extend(converged()?);
    for width in [1.0, 2.0, 8.0] {
        all.extend(formulas(width)?);
    }
    Ok(all)
}

fn square() -> anyhow::Result<Vec<Benchmark>> {
    // A width of `2a` equals the length of the base.
    let [x, y, phi] = springs(ALONE, 2.0)?.direct;
    let known = "converged boundary elements";
    let exact = half_space::SQUARE;
    let square = [
        ("rigid square punch, normal: α_y", "Borodachev 1976", [exact.normal, y]),
        ("square sheared, ν = 0.5: α_x", known, [exact.shear, x]),
        ("square tilted: α_φ", known, [exact.rocking, phi]),
    ];
    let square = square.map(|(name, source, values)| Benchmark::new(name, source, values, 1e-4));
    let mut all = Vec::from(square);
    // The band is the round-off of the reference, which has three decimals.
    let row = six(&springs(0.2, 2.0)?);
    let printed = [half_space::THREE_SQUARES_DIRECT, half_space::THREE_SQUARES_COUPLING];
    let printed = printed.iter().flat_map(half_space::Stiffnesses::values);
    all.extend(printed.zip(row).zip(NAMES).map(|((printed, ours), name)| {
        let name = format!("three squares, d = 0.2 a: {name}");
        Benchmark::new(name, known, [printed, ours], 1.1e-3 / printed.abs())
    }));
    Ok(all)
}

/// Compares the springs of rectangles with a much finer mesh.
///
/// Each rectangle has one benchmark: the coefficient with the largest difference.
fn converged() -> anyhow::Result<Vec<Benchmark>> {
    let corners = [(0.05, 0.25), (0.05, 80.0), (0.2, 2.0), (2.0, 20.0), (80.0, 0.25), (80.0, 80.0)];
    let mut all = Vec::new();
    for (gap, width) in corners {
        let ours = six(&springs(gap, width)?);
        let fine = extrapolated(&footprint(gap, width)?, [16, 24])?;
        // Differences are relative to the direct coefficient, because a vanishing coupling has no
        // significant digits.
        let off: [f64; 6] = std::array::from_fn(|k| ((ours[k] - fine[k]) / fine[k % 3]).abs());
        let k = (0..6).max_by(|a, b| off[*a].total_cmp(&off[*b])).unwrap_or(0);
        let name = format!("d/a = {gap}, b/a = {width}: {} (the worst)", NAMES[k]);
        let source = "16 and 24 cells a side, extrapolated";
        all.push(Benchmark::new(name, source, [fine[k], ours[k]], 3e-3));
    }
    Ok(all)
}

/// Compares isolated rectangles with formulas of soil dynamics.
fn formulas(width: f64) -> anyhow::Result<Vec<Benchmark>> {
    let ours = springs(ALONE, width)?.direct;
    let pais_kausel = half_space::pais_kausel(width).values();
    let pais = (0..3)
        .map(|k| (NAMES[k], "formula of Pais & Kausel 1988, ± 6 %", [pais_kausel[k], ours[k]]));
    let vertical = [half_space::gazetas_normal(width), ours[1]];
    let all = pais.chain([("α_y", "formula of Gazetas 1991, ± 6 %", vertical)]);
    let all = all.map(|(name, source, values)| {
        Benchmark::new(format!("rectangle b/a = {width}: {name}"), source, values, 0.06)
    });
    Ok(all.collect())
}
