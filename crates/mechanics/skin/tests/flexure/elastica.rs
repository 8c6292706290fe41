//! Compares bending with reference strips with a membrane that is an extensible elastica.
//!
//! A separate program solved the reference strips by collocation. `tests/reference/elastica.csv`
//! contains the values and describes their computation.

use approx::assert_relative_eq;
use rayon::prelude::*;
use skin::flexure::{FlexureMeasures, FlexureParameters, MembraneMesh, solve};
use skin::{Base, Common, Design, Status};

/// A design with reference values.
struct Reference {
    design: Design,
    gaps: f64,
    compliance: f64,
    end_moment: f64,
    first_contact_curvature: f64,
    max_strain: f64,
}

fn references() -> Vec<Reference> {
    let table = include_str!("../reference/elastica.csv");
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(reference).collect()
}

fn reference(line: &str) -> Reference {
    let cells: Vec<&str> = line.split(',').collect();
    let base = if cells[0] == "L" { Base::L } else { Base::TwoL };
    let numbers: Vec<f64> = cells[1..9].iter().map(|cell| cell.parse().unwrap()).collect();
    let [gap, length, slant_deg, gaps, compliance, end_moment, first_contact_curvature, max_strain] =
        numbers[..]
    else {
        panic!("{line}")
    };
    let design = Design { gap, length, slant_deg, base, width: 1.0 };
    Reference { design, gaps, compliance, end_moment, first_contact_curvature, max_strain }
}

impl Reference {
    fn measures(&self, elements_per_gap: MembraneMesh) -> FlexureMeasures {
        let membrane_length = self.gaps * self.design.row().unwrap().pitch();
        let parameters =
            FlexureParameters { membrane_length, elements_per_gap, ..FlexureParameters::default() };
        let flexure = solve(&self.design, &Common::default(), &parameters).unwrap();
        assert_eq!(flexure.status, Status::Complete, "{:?}", self.design);
        flexure.measures
    }
}

#[test]
fn seventy_designs_match_the_elastica() {
    let references = references();
    assert_eq!(references.len(), 60 + 10);
    references.par_iter().for_each(|reference| {
        let ours = reference.measures(MembraneMesh::Auto);
        let error = ours.error.unwrap();
        assert!(error <= 1e-4, "{:?}: {error:e}", reference.design);
        for (ours, theirs, tolerance) in [
            (ours.compliance, reference.compliance, 1e-5),
            (ours.max_moment, reference.end_moment, 1e-5),
            (ours.first_contact_curvature, reference.first_contact_curvature, 1e-8),
            (ours.membrane_strain_max, reference.max_strain, 1e-4),
        ] {
            assert_relative_eq!(ours.unwrap(), theirs, max_relative = tolerance);
        }
    });
}

/// Checks that the error of co-rotational elements is proportional to the square of their length.
#[test]
fn elements_converge_quadratically() {
    for reference in references().iter().step_by(7) {
        let [coarse, fine] = [32, 64].map(|elements| {
            let ours = reference.measures(MembraneMesh::Elements(elements));
            ours.max_moment.unwrap() / reference.end_moment - 1.0
        });
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.1, "{:?}: order {order}", reference.design);
    }
}

/// Tuples `(d, L, gaps, C_f*, M* at the end)` for designs with a slant of 75°.
///
/// The values were computed with one co-rotational element in each gap.
const ONE_ELEMENT: [(f64, f64, usize, f64, f64); 6] = [
    (0.2, 0.6, 125, 0.000_043_226_402_372_231_1, 896.124_183_604_776_7),
    (0.4, 0.2, 167, 0.000_567_246_544_534_441_5, 26.581_881_174_697_386),
    (0.5, 1.0, 67, 0.000_210_895_191_527_959_16, 113.739_556_933_393_17),
    (0.7, 0.6, 77, 0.001_305_626_566_627_645_5, 15.851_157_264_131_654),
    (0.9, 0.2, 91, 0.004_274_812_920_842_926, 0.308_281_634_480_729_1),
    (1.0, 1.0, 50, 0.002_491_288_740_449_56, 8.490_746_709_756_941),
];

#[test]
fn results_with_one_element_match_stored_values() {
    for (gap, length, gaps, compliance, end_moment) in ONE_ELEMENT {
        let design = Design { gap, length, slant_deg: 75.0, base: Base::L, width: 1.0 };
        let parameters = FlexureParameters {
            gaps: Some(gaps),
            elements_per_gap: MembraneMesh::Elements(1),
            ..FlexureParameters::default()
        };
        let measures = solve(&design, &Common::default(), &parameters).unwrap().measures;
        assert_relative_eq!(measures.compliance.unwrap(), compliance, max_relative = 1e-9);
        assert_relative_eq!(measures.max_moment.unwrap(), end_moment, max_relative = 1e-9);
        assert_eq!(measures.error, None);
    }
}
