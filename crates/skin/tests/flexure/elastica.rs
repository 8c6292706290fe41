//! Bending against strips whose membrane is an extensible elastica, solved by collocation.
//!
//! `tests/reference/elastica.csv` holds the values and tells how they were made.

use approx::assert_relative_eq;
use rayon::prelude::*;
use skin::flexure::{Measures, Mesh, Parameters, solve};
use skin::{Base, Design, Status};

/// A design with the values of the reference.
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
    let number = |k: usize| cells[k].parse::<f64>().unwrap();
    let base = if cells[0] == "L" { Base::L } else { Base::TwoL };
    let design =
        Design { gap: number(1), length: number(2), slant_deg: number(3), base, width: 1.0 };
    Reference {
        design,
        gaps: number(4),
        compliance: number(5),
        end_moment: number(6),
        first_contact_curvature: number(7),
        max_strain: number(8),
    }
}

impl Reference {
    fn measures(&self, elements_per_gap: Mesh) -> Measures {
        let membrane_length = self.gaps * self.design.row().unwrap().pitch();
        let parameters = Parameters { membrane_length, elements_per_gap, ..Parameters::default() };
        let flexure = solve(&self.design, &parameters).unwrap();
        assert_eq!(flexure.status, Status::Complete, "{:?}", self.design);
        flexure.measures
    }
}

#[test]
fn sixty_designs_with_whole_gaps_and_ten_with_parts_of_one() {
    let references = references();
    assert_eq!(references.len(), 60 + 10);
    references.par_iter().for_each(|reference| {
        let ours = reference.measures(Mesh::Auto);
        let error = ours.error.unwrap();
        assert!(error <= 1e-4, "{:?}: {error:e}", reference.design);
        let close = |ours: Option<f64>, theirs: f64, tolerance: f64| {
            assert_relative_eq!(ours.unwrap(), theirs, max_relative = tolerance);
        };
        close(ours.compliance, reference.compliance, 1e-5);
        close(ours.max_moment, reference.end_moment, 1e-5);
        close(ours.first_contact_curvature, reference.first_contact_curvature, 1e-8);
        close(ours.membrane_strain_max, reference.max_strain, 1e-4);
    });
}

/// The error of the elements falls with the square of their length.
#[test]
fn elements_converge_to_it_with_the_square_of_their_length() {
    for reference in references().iter().step_by(7) {
        let error = |elements: usize| {
            let ours = reference.measures(Mesh::Elements(elements));
            ours.max_moment.unwrap() / reference.end_moment - 1.0
        };
        let [coarse, fine] = [error(32), error(64)];
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.1, "{:?}: order {order}", reference.design);
    }
}
