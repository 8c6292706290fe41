//! Compares bending up to first contact with the closed forms of [`analytical::upright_blocks`].

use analytical::upright_blocks::{
    CONTACT_MOMENT, contact_curvature, contact_moment_of_polygon, moment_over_curvature,
};
use approx::assert_relative_eq;
use skin::flexure::{Flexure, FlexureParameters, MembraneMesh, solve};
use skin::{Base, Common, ContactChange};

use crate::samples::{design, forty, in_small_steps};

#[test]
fn the_moment_before_contact_is_the_curvature_times_pitch_divided_by_gap() {
    let mut compared = 0;
    for design in forty() {
        let pitch = design.row().unwrap().pitch();
        let flexure = solve(&design, &in_small_steps(), &FlexureParameters::default()).unwrap();
        let free = flexure.path.iter().skip(1).take_while(|point| point.contacts == 0);
        for point in free {
            let expected = point.curvature * moment_over_curvature(design.gap, pitch);
            assert_relative_eq!(point.moment, expected, max_relative = 1e-10);
            compared += 1;
        }
        let stiffness = flexure.path[0].stiffness;
        assert_relative_eq!(stiffness, pitch / design.gap, max_relative = 1e-10);
        assert_eq!(flexure.measures.initial_compliance, Some(design.gap / pitch));
    }
    assert!(compared > 400, "{compared}");
}

/// Bends upright blocks on a strip of length 4, with the given membrane mesh in each gap.
///
/// On this short strip the blocks touch before the end of bending.
fn blocks(gap: f64, length: f64, elements_per_gap: MembraneMesh) -> Flexure {
    let parameters = FlexureParameters {
        membrane_length: 4.0,
        elements_per_gap,
        ..FlexureParameters::default()
    };
    solve(&design(gap, length, 0.0, Base::L), &Common::default(), &parameters).unwrap()
}

#[test]
fn upright_blocks_touch_at_unit_moment() {
    for (gap, length) in [(0.1, 1.0), (0.1, 0.2), (0.3, 0.5), (0.5, 1.0)] {
        let flexure = blocks(gap, length, MembraneMesh::Auto);
        let first = flexure.events[0];
        assert_eq!(first.change, ContactChange::Closed);
        assert_relative_eq!(first.point.moment, CONTACT_MOMENT, max_relative = 1e-9);
        let curvature = flexure.measures.first_contact_curvature.unwrap();
        let expected = contact_curvature(gap, gap + length);
        assert_relative_eq!(curvature, expected, max_relative = 1e-9);
    }
}

#[test]
fn with_few_elements_blocks_touch_at_the_polygon_moment() {
    for elements in [1, 2, 3, 8] {
        for gap in [0.1, 0.5, 1.0] {
            let first = blocks(gap, 1.0, MembraneMesh::Elements(elements)).events[0];
            let expected = contact_moment_of_polygon(gap, elements);
            assert_relative_eq!(first.point.moment, expected, max_relative = 1e-9);
        }
    }
}
