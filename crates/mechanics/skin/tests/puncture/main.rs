//! Behaviour of the puncture model.
//!
//! | File | Against |
//! |---|---|
//! | `isolated_scale` | the closed form of one scale without neighbours |
//! | `first_contact` | the linear chain before contact, in closed form |
//! | `two_blocks` | the kink of Fig. 3 of Shafiei et al. (2021) |
//! | `steps` | ten times smaller steps |
//! | `rows` | rows of any length, and the lengths chosen by `Auto` |
//! | `scaling` | changes of units, which must not change results |
//! | `snapshots` | chosen points of the path, between recorded points and beyond its end |
//! | `folds` | folding of the substrate surface |
//! | `failure` | the first failure, and stresses of scales, bonds and tissue |
//! | `elastic_scales` | scales that bend, against finite elements |
//! | `neo_hookean` | a substrate with a surface that cannot fold over |
//! | `layers` | tissue of finite thickness, against another program |
//! | `outputs` | the meaning of measures, events and scales |
//! | `curved_body` | rows on convex and concave bodies, against independent programs |
//! | `path_ends` | ends found from similar designs, against paths from rest |
//! | `ends` | paths beyond the largest force: unloading to zero, and snap-through |
//! | `tilts` | measures at several critical tilts, against paths that end there |
//! | `load_positions` | the weakest of several load positions, against single punctures |
//! | `friction` | friction between scales: independent programs, steps, work |
//! | `enumerated` | friction of two scales, against enumerated contact patterns |
//! | `round_tip` | a needle with a radius: against a sharp one, a closed form, its mirror image |
//! | `robustness` | the 720 designs of the reference study and random ones |
//! | `widest` | random designs in the widest ranges of a definition |

mod curved_body;
mod elastic_scales;
mod ends;
mod enumerated;
mod failure;
mod first_contact;
mod folds;
mod friction;
mod isolated_scale;
mod layers;
mod load_positions;
mod neo_hookean;
mod outputs;
mod path_ends;
mod robustness;
mod round_tip;
mod rows;
#[path = "../samples/mod.rs"]
mod samples;
mod scaling;
mod snapshots;
mod steps;
mod tilts;
mod two_blocks;
mod widest;

use approx::assert_relative_eq;
use skin::Status;
use skin::puncture::{Puncture, PunctureMeasures, PuncturePoint};

/// Returns the measures of a completed puncture.
fn complete(puncture: &Puncture) -> PunctureMeasures {
    assert_eq!(puncture.status, Status::Complete);
    puncture.measures
}

/// Returns the last point of a path.
fn end(puncture: &Puncture) -> PuncturePoint {
    *puncture.path.last().unwrap()
}

/// Compares all measures except the length of the row.
fn assert_same_measures(ours: &PunctureMeasures, theirs: &PunctureMeasures, max_relative: f64) {
    let [our_numbers, their_numbers] = [ours, theirs].map(|m| {
        [
            m.critical_force,
            m.peak_force,
            m.peak_displacement,
            m.peak_tilt_deg,
            m.critical_displacement,
            m.penetration,
            m.sink,
            m.initial_stiffness,
            m.max_stiffness,
            m.secant_stiffness,
            m.first_contact_displacement,
        ]
    });
    for (ours, theirs) in our_numbers.into_iter().zip(their_numbers) {
        assert_eq!(ours.is_some(), theirs.is_some());
        if let (Some(ours), Some(theirs)) = (ours, theirs) {
            assert_relative_eq!(ours, theirs, max_relative = max_relative);
        }
    }
    assert_eq!(ours.contacts, theirs.contacts);
    assert_eq!(ours.engaged_scales, theirs.engaged_scales);
}
