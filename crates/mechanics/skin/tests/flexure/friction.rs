//! Compares strips with friction with two independent programs, and checks related special cases.
//!
//! The independent programs model contact by penalty springs, and friction by return mapping.

use approx::assert_relative_eq;
use skin::flexure::{FlexureInput, FlexureParameters, MembraneMesh, solve, unloading_curve};
use skin::{Base, Common};
use solver::Settings;

use crate::samples::design;

/// Compares moments at the end of bending, with one co-rotational element in each gap.
///
/// Contacts slip at the end in all cases with friction except the last one.
#[test]
fn end_moments_with_friction_match_two_programs() {
    let moments = [
        ((0.3, 1.0, 75.0), 0.0, 661.29262),
        ((0.3, 1.0, 75.0), 0.1, 702.49992),
        ((0.3, 1.0, 75.0), 0.2, 746.69598),
        ((0.2, 1.0, 60.0), 0.0, 160.58560),
        ((0.2, 1.0, 60.0), 0.1, 166.03629),
        ((0.1, 0.9, 45.0), 0.0, 185.77726),
        ((0.1, 0.9, 45.0), 0.2, 191.15784),
    ];
    let parameters =
        FlexureParameters { elements_per_gap: MembraneMesh::Elements(1), ..Default::default() };
    for ((gap, length, slant), friction, expected) in moments {
        let common = Common { friction, ..Common::default() };
        let strip = solve(&design(gap, length, slant, Base::L), &common, &parameters);
        let end = strip.expect("a valid design").path.last().expect("a nonempty path").moment;
        assert_relative_eq!(end, expected, max_relative = 1e-7);
    }
}

#[test]
fn unloading_curves_lie_on_the_unloading_path() {
    let design = design(0.2, 1.0, 60.0, Base::L);
    let common = Common { friction: 0.2, ..Common::default() };
    let parameters = FlexureParameters { unload: true, ..Default::default() };
    let to = FlexureParameters { max_end_rotation_deg: 60.0, ..parameters };
    let strip = solve(&design, &common, &to).expect("a valid design");
    let back = strip.unloading.as_ref().expect("an unloading path");
    let turn = strip.path.last().expect("a nonempty path").curvature;
    let points = &back.path[1..back.path.len() - 1];
    let curvatures: Vec<_> = points.iter().map(|point| point.curvature).collect();
    let input = FlexureInput { design, common, parameters };
    let curve = unloading_curve(&input, turn, &curvatures).expect("a valid design");
    for (point, on_curve) in points.iter().zip(&curve) {
        let value = on_curve.as_ref().expect("a curvature on the unloading path").value;
        assert_relative_eq!(value, point.moment, max_relative = 1e-6, epsilon = 1e-9);
    }
}

/// With friction, corners of upright scales that meet may stick without a closing event.
#[test]
fn corners_that_meet_with_friction_count_as_contact() {
    for (gap, length, friction) in [(0.0208, 0.165, 0.24), (0.2533, 3.391, 0.17)] {
        for max_step in [0.2, 0.1, 0.05, 0.04, 0.02] {
            let solver = Settings { max_step, ..Settings::default() };
            let common = Common { friction, solver, ..Common::default() };
            let upright = design(gap, length, 0.0, Base::TwoL);
            let strip = solve(&upright, &common, &FlexureParameters::default());
            let strip = strip.expect("a valid design");
            assert_eq!(strip.measures.contact, Some(true), "{upright:?} {max_step}");
            assert!(strip.measures.compliance.expect("a complete path") < 1e-3);
        }
    }
}
