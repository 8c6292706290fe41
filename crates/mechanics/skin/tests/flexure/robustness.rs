//! Every design of the reference study completes bending.

use rayon::prelude::*;
use skin::flexure::{FlexureParameters, MembraneMesh, solve};
use skin::{Base, Common, Status};

use crate::samples::{BASES, LAWS, design, in_small_steps, reference_study, with_law};

#[test]
fn the_reference_study_completes_with_either_law() {
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

/// The three gaps rotate until a corner slides beyond the upper end of a side.
#[test]
fn a_contact_beyond_its_edge_fails_the_audit() {
    let parameters = FlexureParameters { gaps: Some(3), ..FlexureParameters::default() };
    let flexure =
        solve(&design(0.05, 2.05, 30.0, Base::L), &Common::default(), &parameters).unwrap();
    assert_eq!(flexure.status, Status::OffEdge);
    assert_eq!(flexure.measures.max_moment, None);
}

/// A strip locked by flush sides has no compliance.
///
/// On a membrane far below their bases steep scales rotate until a side is flush with a base. There
/// the moment grows without rotation, so the compliance is undefined and the path stops before the
/// moment of contact.
#[test]
fn a_strip_locked_by_flush_sides_has_no_compliance() {
    for (design, gaps, moment) in [
        (design(0.97, 0.4, 80.0, Base::L), 4, 356.83),
        (design(0.18, 3.0, 80.0, Base::L), 9, 20275.2),
    ] {
        let parameters = FlexureParameters {
            gaps: Some(gaps),
            // Resolution matters here: with four elements or the elastica the tip of the first
            // strip never reaches the neighbour's corner, so the strip bends to the end; the second
            // becomes flush at another moment.
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
