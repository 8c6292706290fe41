//! Bending of all designs of the reference study, and strips that stop early.

use rayon::prelude::*;
use skin::flexure::{FlexureParameters, MembraneMesh, solve};
use skin::{Base, Common, Status};

use crate::samples::{BASES, LAWS, design, in_small_steps, reference_study, with_law};

#[test]
fn every_design_of_the_reference_study_completes_with_both_contact_laws() {
    for base in BASES {
        for law in LAWS {
            let touching: usize = reference_study(base)
                .par_iter()
                .map(|design| {
                    let flexure =
                        solve(design, &with_law(law), &FlexureParameters::default()).unwrap();
                    assert_eq!(flexure.status, Status::Complete, "{design:?} {law:?}");
                    usize::from(flexure.measures.contact == Some(true))
                })
                .sum();
            assert!((100..720).contains(&touching), "{touching}");
        }
    }
}

/// The gaps of this strip rotate until a corner slides beyond the upper end of a side.
#[test]
fn a_contact_beyond_its_edge_fails_the_audit() {
    let parameters = FlexureParameters { gaps: Some(3), ..FlexureParameters::default() };
    let flexure =
        solve(&design(0.05, 2.05, 30.0, Base::L), &Common::default(), &parameters).unwrap();
    assert_eq!(flexure.status, Status::OffEdge);
    assert_eq!(flexure.measures.max_moment, None);
}

/// Steep scales on a membrane far below their bases rotate until a side lies flush with a base.
///
/// When the side is flush, the moment grows without rotation, so the compliance is undefined. The
/// last recorded point lies shortly before the `moment` at which the side becomes flush.
#[test]
fn a_strip_locked_by_flush_sides_has_no_compliance() {
    for (design, gaps, moment) in [
        (design(0.97, 0.4, 80.0, Base::L), 4, 356.83),
        (design(0.18, 3.0, 80.0, Base::L), 9, 20275.2),
    ] {
        let parameters = FlexureParameters {
            gaps: Some(gaps),
            // The result depends on the resolution. With four elements or the elastica, the first
            // strip bends to the end without flush sides, and the second strip becomes flush at
            // another moment.
            elements_per_gap: MembraneMesh::Elements(1),
            membrane_axis_offset: 1.0,
            ..FlexureParameters::default()
        };
        let flexure = solve(&design, &in_small_steps(), &parameters).unwrap();
        assert_eq!(flexure.status, Status::Locked);
        assert_eq!(flexure.measures.compliance, None);
        let last = flexure.path.last().unwrap().moment;
        assert!((0.9 * moment..moment).contains(&last), "{last}");
    }
}
