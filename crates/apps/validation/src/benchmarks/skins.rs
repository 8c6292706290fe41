//! Benchmarks of the puncture and the flexure model.

use analytical::isolated_scale::IsolatedScale;
use analytical::upright_blocks::{
    CONTACT_MOMENT, contact_curvature, contact_moment_of_polygon, moment_over_curvature,
};
use skin::flexure::MembraneMesh;
use skin::puncture::RowLength;
use skin::{Base, Common, Design, flexure, puncture};

use anyhow::Context as _;

use super::Benchmark;

pub(super) fn benchmarks() -> anyhow::Result<Vec<Benchmark>> {
    let mut all = isolated_scale()?;
    all.extend(bending()?);
    Ok(all)
}

/// Compares critical force and displacement of a scale without neighbours with closed forms.
fn isolated_scale() -> anyhow::Result<Vec<Benchmark>> {
    let design = Design { gap: 1.0, length: 0.5, slant_deg: 45.0, base: Base::L, width: 1.0 };
    let parameters = puncture::PunctureParameters {
        scales: RowLength::Scales(1),
        ..puncture::PunctureParameters::default()
    };
    let springs = substrate::calibrate(&design.footprint(parameters.poisson_ratio)?)?;
    let solved = puncture::solve(&design, &springs, &Common::default(), &parameters)?;
    let measures = solved.measures;
    let (a, tilt) = (design.half_base(), parameters.critical_tilt_deg.to_radians());
    let exact = IsolatedScale {
        normal: a * springs.direct[1],
        rotation: a.powi(3) * springs.direct[2],
        arm: [a + design.slant_deg.to_radians().tan(), 1.0],
    };
    let rows = [
        ("F_c*", exact.force(tilt) / design.length, measures.critical_force),
        ("u_c*", exact.displacement(tilt), measures.critical_displacement),
    ];
    let rows = rows.into_iter().map(|(name, exact, ours)| {
        let values = [exact, ours.context("an isolated scale does not tilt")?];
        let name = format!("isolated scale, slant 45°: {name}");
        Ok(Benchmark::new(name, "closed form", values, 1e-9))
    });
    rows.collect()
}

/// Compares the bending of upright blocks before and at their first contact with closed forms.
fn bending() -> anyhow::Result<Vec<Benchmark>> {
    let design = Design { gap: 0.1, length: 1.0, slant_deg: 0.0, base: Base::L, width: 1.0 };
    let (gap, pitch) = (design.gap, design.gap + design.length);
    let missing = "upright blocks do not meet";
    let [one, many] = [MembraneMesh::Elements(1), MembraneMesh::Auto].map(|elements_per_gap| {
        let parameters = flexure::FlexureParameters {
            // On a strip of 100 t, as in the sweeps, upright blocks with this gap never touch.
            membrane_length: 10.0,
            elements_per_gap,
            ..flexure::FlexureParameters::default()
        };
        flexure::solve(&design, &Common::default(), &parameters)
    });
    let (one, many) = (one?, many?);
    let free = one.path.get(1).context(missing)?;
    let [coarse, fine] = [&one, &many].map(|of| of.events.first().context(missing));
    let (coarse, fine) = (coarse?.point, fine?.point);
    let stiffness = [moment_over_curvature(gap, pitch), free.moment / free.curvature];
    let curvature = [contact_curvature(gap, pitch), fine.curvature];
    let coarse_moment = [contact_moment_of_polygon(gap, 1), coarse.moment];
    let rows = [
        ("M*/κ* before contact", stiffness, 1e-10),
        ("M* at first contact, elastica", [CONTACT_MOMENT, fine.moment], 1e-9),
        ("κ* at first contact, elastica", curvature, 1e-9),
        ("M* at first contact, 1 element", coarse_moment, 1e-9),
    ];
    let rows = rows.map(|(name, values, band)| {
        Benchmark::new(format!("upright blocks, d/t = 0.1: {name}"), "closed form", values, band)
    });
    Ok(rows.into())
}
