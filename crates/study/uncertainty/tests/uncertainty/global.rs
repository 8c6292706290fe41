//! Compares the Sobol' indices of the coverage with their closed form.

use std::sync::atomic::AtomicBool;

use sweep::Sweep;
use uncertainty::{GlobalAnalysis, SampleStore};

use crate::PROGRAM;

/// Tests the indices of the coverage `λ = 1 − d cot α`.
///
/// This formula is valid (G2) if a vertical line crosses at most one neighbour. The term `d cot α`
/// is a product of two independent variables, so its indices have a closed form.
#[test]
fn indices_of_coverage_match_the_closed_form() {
    let text = "name = 'x'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 0.5 }\n\
                length_over_t = [1, 1.5, 2]\nslant_deg = { from = 30, to = 45 }";
    let sweep = Sweep::parse(text, "x.toml", &[]).expect("a valid sweep");
    let (place, stop) = (tempfile::tempdir().expect("a folder"), AtomicBool::new(false));
    let analysis = GlobalAnalysis { sweep: &sweep, samples: 4_000, stop: &stop, program: PROGRAM };
    let found = analysis.solve(&SampleStore::new(place.path())).expect("indices");
    assert_eq!(found.variables, ["gap_over_t", "length_over_t", "slant_deg"]);
    let [coverage] = found.measures.as_slice() else { panic!("one measure") };
    assert_eq!((coverage.name.as_str(), coverage.samples, coverage.failed), ("coverage", 4_000, 0));

    // Means of d, d², cot α and cot² α.
    let (from, to) = (30.0_f64.to_radians(), 45.0_f64.to_radians());
    let gap = [0.3, (0.5_f64.powi(3) - 0.1_f64.powi(3)) / 3.0 / 0.4];
    let [start, end] = [from, to].map(|a| [a.sin().ln(), -1.0 / a.tan() - a]);
    let cot = [0, 1].map(|k| (end[k] - start[k]) / (to - from));
    let all = gap[1] * cot[1] - (gap[0] * cot[0]).powi(2);
    let of_gap = (gap[1] - gap[0].powi(2)) * cot[0].powi(2) / all;
    let of_slant = gap[0].powi(2) * (cot[1] - cot[0].powi(2)) / all;
    let expected = [[of_gap, 1.0 - of_slant], [0.0, 0.0], [of_slant, 1.0 - of_gap]];
    assert!((coverage.spread / all.sqrt() - 1.0).abs() < 0.03);
    for (found, [first, total]) in coverage.indices.iter().zip(expected) {
        for (estimate, exact) in [(found.first, first), (found.total, total)] {
            let off = (estimate.value - exact).abs();
            assert!(off <= 4.0 * estimate.error + 1e-12, "{estimate:?} {exact}");
            assert!(estimate.error < 0.03, "{estimate:?}");
        }
    }
}
