//! Tests of rows of given and of automatic length.

use approx::assert_relative_eq;
use contact::Law;
use skin::puncture::{self, PunctureParameters, RowLength};
use skin::{Base, Common, PathDetail};
use solver::Settings;
use substrate::{Calibrations, Coupling, RowStiffness};

use crate::samples::{
    LAWS, blocks, design, domino, on_row, settled, solve, solve_as, solve_with, springs, with_law,
};
use crate::{assert_same_measures, complete};

fn automatic() -> PunctureParameters {
    PunctureParameters { scales: RowLength::Auto, ..PunctureParameters::default() }
}

#[test]
fn automatic_rows_match_longer_rows() {
    let known = Calibrations::default();
    let designs = [blocks(), settled(), domino(), design(1.0, 0.025, 75.0, Base::TwoL)];
    for design in designs {
        for law in LAWS {
            let ours = solve_as(&known, &design, &with_law(law), &automatic());
            let longer = 2 * ours.measures.scales + 301;
            let theirs = solve_as(&known, &design, &with_law(law), &on_row(longer));
            assert_same_measures(&complete(&ours), &complete(&theirs), 1e-6);
        }
    }
}

#[test]
fn automatic_rows_grow_where_scales_touch() {
    let [apart, domino] = [design(1.0, 0.5, 0.0, Base::L), domino()].map(|design| {
        let puncture = solve(&design, &automatic());
        complete(&puncture);
        let [first, last] = [puncture.scales[0].scale, puncture.scales.last().unwrap().scale];
        assert_eq!(puncture.scales.len(), puncture.measures.scales);
        [-first, last]
    });
    // Without contact the row keeps its initial length and is symmetric.
    assert!(apart[0] == apart[1] && apart[0] < 30, "{apart:?}");
    // In the domino design contact spreads to the right.
    assert!(domino[1] >= 4 * domino[0], "{domino:?}");
}

/// In this design the last step exceeds the critical tilt by round-off, and a contact in this step
/// requires a longer row.
#[test]
fn a_row_extended_at_the_critical_tilt_is_solved_to_the_end() {
    let known = Calibrations::default();
    let design = design(
        0.501_236_456_022_181_6,
        0.450_867_931_000_371_87,
        65.229_831_378_204_57,
        Base::TwoL,
    );
    let parameters = PunctureParameters {
        contact_modulus_over_substrate: 138.209_603_399_707_1,
        load_position: 0.767_237_383_621_880_3,
        critical_tilt_deg: 16.012_588_191_662_68,
        ..automatic()
    };
    let footprint = design.footprint(parameters.poisson_ratio).unwrap();
    let stiffness = known.row(&footprint, Coupling::Full).unwrap().as_ref().clone();
    let common = Common { law: Law::EXCHANGED, detail: PathDetail::Critical, ..Common::default() };
    let [usual, finer] = [0.2, 0.05].map(|max_step| {
        let solver = Settings { max_step, ..Settings::default() };
        let common = Common { solver, ..common };
        let puncture = puncture::solve(&design, stiffness.clone(), &common, &parameters).unwrap();
        complete(&puncture).critical_force.unwrap()
    });
    assert_relative_eq!(usual, finer, max_relative = 1e-9);
}

/// Without contact the displacements near the ends decay as in an endless row.
#[test]
fn ends_of_automatic_rows_are_contact_free() {
    let known = Calibrations::default();
    for design in [blocks(), settled(), domino()] {
        let puncture = solve_with(&known, &design, &automatic());
        let stiffness = RowStiffness::from(&springs(&design, &automatic(), &known));
        let decay = stiffness.far_field(None).unwrap().displacement(|_| [1.0; 3], 1);
        let [first, second, .., before, last] = &puncture.scales[..] else { panic!("a short row") };
        for (inner, end) in [(before, last), (second, first)] {
            let [x, y] = end.displacement;
            let [inner_x, inner_y] = inner.displacement;
            assert_relative_eq!(x, decay[0] * inner_x, max_relative = 1e-8, epsilon = 1e-15);
            assert_relative_eq!(y, decay[1] * inner_y, max_relative = 1e-8, epsilon = 1e-15);
            let rotation = decay[2] * inner.rotation_deg;
            assert_relative_eq!(end.rotation_deg, rotation, max_relative = 1e-8, epsilon = 1e-13);
            assert!(end.reaction.abs() < 1e-12);
        }
        let [first, last] = [first.scale, last.scale - 1].map(Some);
        assert!(puncture.events.iter().all(|e| e.left_scale != last && e.left_scale != first));
    }
}

/// In this design dozens of scales lean on each other, so a row of 11 scales is too short.
#[test]
fn a_row_that_is_too_short_underestimates_the_force() {
    let [short, long, longer] = [11, 201, 401]
        .map(|scales| complete(&solve(&domino(), &on_row(scales))).critical_force.unwrap());
    assert!(short < 0.5 * long);
    assert_relative_eq!(long, longer, max_relative = 1e-9);
}

/// Only the substrate acts on scales without contact, so the forces of its springs must vanish.
#[test]
fn scales_out_of_reach_of_contact_are_in_equilibrium() {
    for scales in [12, 20, 41, 401] {
        let parameters = on_row(scales);
        let puncture = solve(&settled(), &parameters);
        let known = Calibrations::default();
        let stiffness = RowStiffness::from(&springs(&settled(), &parameters, &known));
        let row: Vec<[f64; 3]> = puncture
            .scales
            .iter()
            .map(|s| [s.displacement[0], s.displacement[1], s.rotation_deg.to_radians()])
            .collect();
        assert_eq!(row.len(), scales);
        assert_eq!(complete(&puncture).scales, scales);
        // No contact acts on scales to the left of the first pair that touched, or to the right of
        // the last pair that touched.
        let touched: Vec<i64> = puncture.events.iter().filter_map(|e| e.left_scale).collect();
        let (first, last) = (touched.iter().min().unwrap(), touched.iter().max().unwrap() + 1);
        for (i, state) in puncture.scales.iter().enumerate() {
            assert!(i == 0 || state.scale == puncture.scales[i - 1].scale + 1);
            if (*first..=last).contains(&state.scale) {
                continue;
            }
            for k in 0..3 {
                let (alpha, beta) = (stiffness.direct[k], -stiffness.neighbours[0].direct[k]);
                // Scales at the ends of the row have one neighbour.
                let beside = [i.checked_sub(1), Some(i + 1)].into_iter().flatten();
                let beside: f64 = beside.filter_map(|i| row.get(i)).map(|u| u[k]).sum();
                let force = alpha * row[i][k] - beta * beside;
                assert!(force.abs() < 1e-13, "{scales} {i} {k} {force:e}");
            }
        }
    }
}

#[test]
fn endless_rows_with_full_coupling_match_long_rows() {
    for design in [blocks(), settled(), design(0.1, 1.0, 45.0, Base::L)] {
        let footprint = design.footprint(0.5).unwrap();
        let full = RowStiffness::compute(&footprint, Coupling::Full).unwrap();
        let common = Common::default();
        let ours = skin::puncture::solve(&design, &full, &common, &automatic()).unwrap();
        let longer = on_row(2 * ours.measures.scales + 201);
        let theirs = skin::puncture::solve(&design, &full, &common, &longer).unwrap();
        assert_same_measures(&complete(&ours), &complete(&theirs), 1e-9);
    }
}

#[test]
fn an_even_number_of_scales_is_punctured_at_the_left_one_of_both_middle_scales() {
    for (scales, first, last) in [(1, 0, 0), (2, 0, 1), (3, -1, 1), (4, -1, 2), (5, -2, 2)] {
        let puncture = solve(&settled(), &on_row(scales));
        assert_eq!(complete(&puncture).scales, scales);
        let numbers: Vec<i64> = puncture.scales.iter().map(|state| state.scale).collect();
        assert_eq!(numbers, (first..=last).collect::<Vec<_>>());
        let tilt = puncture.scales.iter().find(|state| state.scale == 0).unwrap().rotation_deg;
        assert_relative_eq!(tilt, -10.0, max_relative = 1e-12);
    }
}
