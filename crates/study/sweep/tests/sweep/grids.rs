//! Tests that a grid numbers its designs and finds designs by their parameters.

use proptest::prelude::*;

use crate::sweep;

#[test]
fn the_paper_sweep_is_numbered_as_in_its_tables() {
    let grid = sweep("name = 'x'").grid().clone();
    assert_eq!(grid.len(), 720);
    for (number, values) in [
        ("0001", [0.1, 0.025, 0.0]),
        ("2", [0.1, 0.025, 15.0]),
        ("0007", [0.1, 0.05, 0.0]),
        ("0073", [0.2, 0.025, 0.0]),
        ("0720", [1.0, 1.0, 75.0]),
    ] {
        let design = grid.case(grid.parse_number(number).expect("a number")).design;
        assert_eq!([design.gap, design.length, design.slant_deg], values);
    }
    assert_eq!(grid.number(0).to_string(), "0001");
    for wrong in ["0", "721", "-1", "x", ""] {
        assert!(grid.parse_number(wrong).is_err());
    }
}

#[test]
fn design_numbers_have_more_digits_on_large_grids() {
    let text = "name = 'x'\n[designs]\ngap_over_t = { from = 0.001, to = 1, step = 0.001 }";
    assert_eq!(sweep(text).grid().number(41).to_string(), "00042");
}

#[test]
fn a_design_that_is_not_on_the_grid_is_not_found() {
    let grid = sweep("name = 'x'").grid().clone();
    let mut case = grid.case(7);
    assert_eq!(grid.find(&case), Some(7));
    case.design.gap = 0.15;
    assert_eq!(grid.find(&case), None);
}

proptest! {
    #[test]
    fn every_design_is_found_by_its_parameters_and_by_its_number(
        gaps in 1_u32..30,
        moduli in 1_usize..4,
        rows in 1_usize..3,
        slants in 1_u32..20,
        choice in any::<prop::sample::Index>(),
    ) {
        let moduli = ["1", "1e2", "9677"][..moduli].join(", ");
        let rows = ["'auto'", "41"][..rows].join(", ");
        let text = format!(
            "name = 'x'\n[designs]\nslant_deg = {{ from = 0, to = {}, step = 3.5 }}\n\
             gap_over_t = {{ from = 0.07, to = {}e-2, step = 0.07 }}\n\
             contact_modulus_over_substrate = [{moduli}]\nlength_over_t = 1\nscales = [{rows}]",
            f64::from(slants - 1) * 3.5,
            7 * gaps,
        );
        let grid = sweep(&text).grid().clone();
        let index = choice.index(usize::try_from(grid.len()).expect("small")) as u64;
        prop_assert_eq!(grid.find(&grid.case(index)), Some(index));
        prop_assert_eq!(grid.parse_number(&grid.number(index).to_string()), Ok(index));
        prop_assert_eq!(grid.number(index).index(), index);
    }
}
