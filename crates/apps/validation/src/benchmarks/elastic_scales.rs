//! Benchmarks of rows with elastic scales: finite elements.

use serde::Deserialize;
use skin::puncture::{Bending, PunctureParameters, RowLength, Strengths};
use skin::{Base, Common, Design, puncture};

use anyhow::Context as _;

use super::Benchmark;

/// Results of `scripts/reference-calculix`.
const ROWS: &str = include_str!("../../elastic-scales.csv");

/// Largest depth of a beam, over `t`, that counts as slender.
const SLENDER: f64 = 1.0 / 3.0;

/// Largest known difference of slender scales, and of stout ones.
const BANDS: [f64; 2] = [0.05, 0.15];

/// Row of three elastic scales with its finite-element solution.
#[derive(Deserialize)]
struct Row {
    gap_over_t: f64,
    length_over_t: f64,
    slant_deg: f64,
    contact_modulus_over_substrate: f64,
    fe_force: f64,
    /// `None` where no section is far enough from base and loads.
    fe_stress: Option<f64>,
}

/// Compares critical force and bending stress of rows of three elastic scales.
pub(super) fn benchmarks() -> anyhow::Result<Vec<Benchmark>> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(ROWS.as_bytes());
    let rows = reader.deserialize().map(|row| compared(&row?));
    Ok(rows.collect::<anyhow::Result<Vec<_>>>()?.concat())
}

fn compared(row: &Row) -> anyhow::Result<Vec<Benchmark>> {
    let Row { gap_over_t: gap, length_over_t: length, slant_deg, .. } = *row;
    let design = Design { gap, length, slant_deg, base: Base::L, width: 1.0 };
    let parameters = PunctureParameters {
        scales: RowLength::Scales(3),
        bending: Bending::Elastic,
        contact_modulus_over_substrate: row.contact_modulus_over_substrate,
        failure: Some(Strengths::default()),
        ..PunctureParameters::default()
    };
    let springs = substrate::calibrate(&design.footprint(parameters.poisson_ratio)?)?;
    let measures = puncture::solve(&design, &springs, &Common::default(), &parameters)?.measures;
    let missing = "a row of elastic scales does not tilt";
    let depth = length * slant_deg.to_radians().cos();
    let band = BANDS[usize::from(depth > SLENDER)];
    let name = format!("elastic scales ({gap}, {length}, {slant_deg}°), 1/h = {:.1}", 1.0 / depth);
    let source = "finite elements, CalculiX";
    let force = measures.critical_force.context(missing)?;
    let mut all =
        vec![Benchmark::new(format!("{name}: F_c*"), source, [row.fe_force, force], band)];
    if let Some(reference) = row.fe_stress {
        let stress = measures.failure.scale_stress.context(missing)?;
        all.push(Benchmark::new(format!("{name}: σ/E_s"), source, [reference, stress], band));
    }
    Ok(all)
}
