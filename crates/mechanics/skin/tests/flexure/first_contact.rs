//! Compares the closed form of the curvature of first contact with solved strips.

use proptest::prelude::*;
use skin::flexure::{self, FlexureParameters, contact_curvature};
use skin::{Base, Common, Design};

fn design(gap: f64, length: f64, slant_deg: f64) -> Design {
    Design { gap, length, slant_deg, base: Base::L, width: 1.0 }
}

#[test]
fn upright_scales_touch_when_the_bend_radius_equals_their_height() {
    for (membrane_axis_offset, curvature) in [(0.0, 0.1 / 1.1), (0.25, 0.1 / 1.25 / 1.1)] {
        let parameters = FlexureParameters { membrane_axis_offset, ..Default::default() };
        let touching = contact_curvature(&design(0.1, 1.0, 0.0), &parameters);
        let touching = touching.expect("a valid design");
        assert_eq!(touching, Some(curvature));
    }
}

#[test]
fn a_slight_slant_hardly_changes_first_contact() {
    let [upright, slanted] = [0.0, 1e-6].map(|slant| {
        let touching = contact_curvature(&design(0.1, 1.0, slant), &FlexureParameters::default());
        touching.expect("a valid design").expect("gaps that close")
    });
    assert!((slanted / upright - 1.0).abs() < 1e-6, "{upright} {slanted}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// On short strips all scales touch, at the curvature of the closed form.
    ///
    /// On the long default strip they touch at this curvature, or bending ends before contact.
    #[test]
    fn closed_form_matches_the_first_contact_of_solved_strips(
        gap in 0.05_f64..0.8, length in 0.1_f64..1.5, slant in 0.0_f64..75.0, offset in 0.0_f64..0.3,
        short in any::<bool>(),
    ) {
        let design = design(gap, length, slant);
        let parameters = FlexureParameters {
            membrane_axis_offset: offset,
            membrane_length: if short { 100.0 } else { 6.0 },
            ..Default::default()
        };
        let closed_form = contact_curvature(&design, &parameters).expect("a valid design");
        let solved = flexure::solve(&design, &Common::default(), &parameters);
        let solved = solved.expect("a valid design");
        let end = solved.path.last().expect("a nonempty path").curvature;
        match (closed_form, solved.measures.first_contact_curvature) {
            (Some(expected), Some(found)) => {
                prop_assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
            }
            (Some(expected), None) => prop_assert!(expected > end * (1.0 - 1e-9), "{expected} {end}"),
            (None, found) => prop_assert_eq!(found, None),
        }
    }

    /// If the strip bends with its scales on the outside, gaps open and only the membrane bends.
    #[test]
    fn bending_with_scales_on_the_outside_opens_the_gaps(gap in 0.05_f64..0.8, length in 0.1_f64..1.5, slant in 0.0_f64..75.0) {
        let design = design(gap, length, slant);
        let parameters = FlexureParameters { max_end_rotation_deg: -180.0, ..Default::default() };
        let solved = flexure::solve(&design, &Common::default(), &parameters);
        let solved = solved.expect("a valid design");
        prop_assert_eq!(solved.status, skin::Status::Complete);
        prop_assert_eq!(solved.measures.contact, Some(false));
        let end = solved.path.last().expect("a nonempty path");
        prop_assert!((end.end_rotation_deg + 180.0).abs() < 1e-9);
        prop_assert!(end.curvature < 0.0 && end.moment < 0.0);
        let pitch = length + gap;
        prop_assert_eq!(solved.measures.compliance, Some(gap / pitch));
        prop_assert_eq!(solved.measures.max_moment, Some(end.moment));
    }
}
