//! Tests of rows on a layer of soft tissue on a rigid base.

use approx::assert_relative_eq;
use skin::puncture::{self, Puncture, PunctureParameters, RowLength};
use skin::{Base, Common, Design};
use substrate::{Coupling, RowStiffness};

use crate::samples::{design, on_row};
use crate::{assert_same_measures, complete};

fn stiffness(design: &Design, thickness: f64, coupling: Coupling) -> RowStiffness {
    let footprint = design.footprint(0.5).unwrap();
    let layer = footprint.on_layer(thickness / design.half_base()).unwrap();
    RowStiffness::compute(&layer, coupling).unwrap()
}

fn solve(design: &Design, stiffness: &RowStiffness, parameters: &PunctureParameters) -> Puncture {
    puncture::solve(design, stiffness, &Common::default(), parameters).unwrap()
}

/// Compares forces and penetrations with an independent program.
///
/// The springs of the other program have an error of 1 to 2 %, and neglect the coupling between
/// normal and tangential tractions. The designs are chosen so that this coupling is small.
#[test]
fn layers_match_an_independent_program() {
    let slanted = design(0.1, 1.0, 45.0, Base::L);
    let steep = design(0.2, 0.3, 75.0, Base::L);
    let rows = [
        (slanted, 8.0, [0.413, 0.233]),
        (slanted, 4.0, [0.417, 0.216]),
        (slanted, 2.0, [0.424, 0.185]),
        (steep, 8.0, [7.09, 0.584]),
        (steep, 4.0, [7.25, 0.548]),
        (steep, 2.0, [7.65, 0.478]),
        (steep, 1.0, [8.74, 0.367]),
    ];
    for (design, thickness, [force, depth]) in rows {
        let row = stiffness(&design, thickness, Coupling::Nearest);
        let found = solve(&design, &row, &PunctureParameters::default()).measures;
        assert_relative_eq!(found.critical_force.unwrap(), force, max_relative = 0.02);
        assert_relative_eq!(found.penetration.unwrap(), depth, max_relative = 0.02);
    }
}

/// Checks the far field of a layer, which is mirrored between the left and the right end of a row.
#[test]
fn endless_rows_match_long_rows() {
    for (design, coupling) in [
        (design(0.1, 1.0, 45.0, Base::L), Coupling::Nearest),
        (design(0.1, 1.0, 0.0, Base::L), Coupling::Full),
        (design(0.2, 0.3, 60.0, Base::L), Coupling::Nearest),
    ] {
        let row = stiffness(&design, 1.5, coupling);
        let endless = PunctureParameters { scales: RowLength::Auto, ..on_row(1) };
        let ours = solve(&design, &row, &endless);
        let theirs = solve(&design, &row, &on_row(201));
        assert_same_measures(&complete(&ours), &complete(&theirs), 1e-9);
    }
}
