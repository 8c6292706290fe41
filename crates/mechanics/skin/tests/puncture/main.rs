//! Behaviour of the puncture model.
//!
//! | File | Against |
//! |---|---|
//! | `isolated_scale` | the closed form of one scale without neighbours |
//! | `first_contact` | the linear chain before contact, in closed form |
//! | `two_blocks` | the kink of Fig. 3 of Shafiei et al. (2021) |
//! | `steps` | the same path with steps a tenth as long |
//! | `rows` | rows of any length, and those that `Auto` chooses |
//! | `scaling` | changes of units that must change nothing |
//! | `snapshots` | chosen places of the path, between its points and beyond its end |
//! | `folds` | where the surface of the substrate folds over |
//! | `neo_hookean` | a substrate whose surface cannot fold over |
//! | `layers` | tissue of a finite thickness, against another program |
//! | `outputs` | what the measures, events and scales mean |
//! | `ends` | paths beyond the largest force: where the load is back at zero, and where all turns back |
//! | `tilts` | measures at tilts on the way, against paths that end there |
//! | `places` | the weakest of several places of the load, against punctures with the load there |
//! | `rubbing` | friction between scales: independent programs, steps, work |
//! | `round_tip` | a needle with a radius: against a sharp one, a closed form, its mirror image |
//! | `robustness` | the 720 designs of the reference study and random ones |
//! | `widest` | random ones in the widest ranges of a definition |

mod ends;
mod enumerated;
mod first_contact;
mod folds;
mod friction;
mod isolated_scale;
mod layers;
mod load_positions;
mod neo_hookean;
mod outputs;
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

/// The measures of a puncture that went all the way.
fn complete(puncture: &Puncture) -> PunctureMeasures {
    assert_eq!(puncture.status, Status::Complete);
    puncture.measures
}

/// The end of a path.
fn end(puncture: &Puncture) -> PuncturePoint {
    *puncture.path.last().unwrap()
}

/// Compares all measures but the length of the row.
fn assert_same_measures(ours: &PunctureMeasures, theirs: &PunctureMeasures, max_relative: f64) {
    let numbers = |m: &PunctureMeasures| {
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
    };
    for (ours, theirs) in numbers(ours).into_iter().zip(numbers(theirs)) {
        assert_eq!(ours.is_some(), theirs.is_some());
        if let (Some(ours), Some(theirs)) = (ours, theirs) {
            assert_relative_eq!(ours, theirs, max_relative = max_relative);
        }
    }
    assert_eq!(ours.contacts, theirs.contacts);
    assert_eq!(ours.engaged_scales, theirs.engaged_scales);
}
