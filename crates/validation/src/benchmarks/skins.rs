//! Closed forms of the puncture and the flexure model.

use skin::puncture::RowLength;
use skin::{Base, Common, Design, flexure, puncture};

use super::Benchmark;
use crate::Error;

fn wrong(error: &impl ToString) -> Error {
    Error::Benchmark(error.to_string())
}

pub(super) fn benchmarks() -> Result<Vec<Benchmark>, Error> {
    let mut all = isolated_scale()?;
    all.extend(bending()?);
    Ok(all)
}

/// A scale alone: `a³ α_φ ψ = F (r_x cos ψ + sin ψ)`, `u = F/(a α_y) + r_x sin ψ + 1 − cos ψ`.
fn isolated_scale() -> Result<Vec<Benchmark>, Error> {
    let design = Design { gap: 1.0, length: 0.5, slant_deg: 45.0, base: Base::L, width: 1.0 };
    let parameters =
        puncture::Parameters { scales: RowLength::Scales(1), ..puncture::Parameters::default() };
    let footprint = design.footprint(parameters.poisson_ratio).map_err(|e| wrong(&e))?;
    let springs = substrate::calibrate(&footprint).map_err(|e| wrong(&e))?;
    let measures = puncture::solve(&design, &springs, &Common::default(), &parameters)
        .map_err(|e| wrong(&e))?
        .measures;
    let missing = || Error::Benchmark("an isolated scale does not tilt".to_owned());
    let (a, tilt) = (design.half_base(), parameters.critical_tilt_deg.to_radians());
    let arm = a + design.slant_deg.to_radians().tan();
    let force =
        a.powi(3) * springs.direct[2] * tilt / (arm * tilt.cos() + tilt.sin()) / design.length;
    let displacement =
        force * design.length / (a * springs.direct[1]) + arm * tilt.sin() + (1.0 - tilt.cos());
    let row = |name, exact, ours: Option<f64>| {
        let values = [exact, ours.ok_or_else(missing)?];
        Ok::<_, Error>(Benchmark::new(
            format!("isolated scale, slant 45°: {name}"),
            "closed form",
            values,
            1e-9,
        ))
    };
    Ok(vec![
        row("F_c*", force, measures.critical_force)?,
        row("u_c*", displacement, measures.critical_displacement)?,
    ])
}

/// `M*/κ* = p/d` before contact; upright blocks meet at `M* = 1`, `κ* = d/p`, or with one element in the gap
/// at `M* = 2 asin(d/2)/d`.
fn bending() -> Result<Vec<Benchmark>, Error> {
    let design = Design { gap: 0.1, length: 1.0, slant_deg: 0.0, base: Base::L, width: 1.0 };
    let (gap, pitch) = (design.gap, design.gap + design.length);
    let missing = || Error::Benchmark("upright blocks do not meet".to_owned());
    let bent = |elements_per_gap| {
        let parameters = flexure::Parameters {
            membrane_length: 10.0,
            elements_per_gap,
            ..flexure::Parameters::default()
        };
        flexure::solve(&design, &Common::default(), &parameters).map_err(|e| wrong(&e))
    };
    let (one, many) = (bent(1)?, bent(128)?);
    let free = one.path.get(1).ok_or_else(missing)?;
    let first = |flexure: &flexure::Flexure| {
        Ok::<_, Error>(flexure.events.first().ok_or_else(missing)?.point)
    };
    let (coarse, fine) = (first(&one)?, first(&many)?);
    let row = |name: &str, values, band| {
        Benchmark::new(format!("upright blocks, d/t = 0.1: {name}"), "closed form", values, band)
    };
    Ok(vec![
        row("M*/κ* before contact", [pitch / gap, free.moment / free.curvature], 1e-10),
        row("M* at first contact, 128 elements", [1.0, fine.moment], 1e-6),
        row("κ* at first contact, 128 elements", [gap / pitch, fine.curvature], 1e-6),
        row(
            "M* at first contact, 1 element",
            [2.0 * (gap / 2.0).asin() / gap, coarse.moment],
            1e-9,
        ),
    ])
}
