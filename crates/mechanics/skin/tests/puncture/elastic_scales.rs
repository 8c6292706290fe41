//! Compares elastic scales with finite elements.
//!
//! `tests/reference/elastic-scales.csv` contains the reference values and describes their
//! computation.

use skin::puncture::{Bending, PunctureParameters, RowLength, Strengths, solve};
use skin::{Base, Common, Design};
use substrate::calibrate;

use super::complete;

/// Pairs of a depth `h/t` of the scales and the relative deviation accepted up to this depth.
///
/// The deviation is between squama and finite elements, in force and stress.
const BANDS: [(f64, f64); 3] = [(0.2, 0.031), (1.0 / 3.0, 0.056), (1.0, 0.13)];

fn assert_within(part: f64, ours: f64, reference: f64) {
    assert!((ours / reference - 1.0).abs() <= part, "{ours} {reference}");
}

#[test]
fn force_and_stress_agree_with_finite_elements() {
    let table = include_str!("../reference/elastic-scales.csv");
    let rows: Vec<_> = table.lines().filter(|line| !line.starts_with('#')).skip(1).collect();
    assert_eq!(rows.len(), 6);
    for row in rows {
        let cells: Vec<Option<f64>> = row.split(',').map(|cell| cell.parse().ok()).collect();
        let [gap, length, slant_deg, modulus] = [0, 1, 2, 3].map(|k| cells[k].unwrap());
        let [force, stress] = [cells[7].unwrap(), cells[9].unwrap_or(f64::NAN)];
        let design = Design { gap, length, slant_deg, base: Base::L, width: 1.0 };
        let parameters = PunctureParameters {
            scales: RowLength::Scales(3),
            bending: Bending::Elastic,
            contact_modulus_over_substrate: modulus,
            failure: Some(Strengths::default()),
            ..PunctureParameters::default()
        };
        let substrate = calibrate(&design.footprint(0.5).unwrap()).unwrap();
        let solved = solve(&design, &substrate, &Common::default(), &parameters).unwrap();
        let measures = complete(&solved);
        let depth = length * slant_deg.to_radians().cos();
        let (_, band) = BANDS.into_iter().find(|(most, _)| depth <= *most).unwrap();
        assert_within(band, measures.critical_force.unwrap(), force);
        if !stress.is_nan() {
            assert_within(band, measures.failure.scale_stress.unwrap(), stress);
        }
    }
}
