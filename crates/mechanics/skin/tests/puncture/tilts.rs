//! Compares measures at several critical tilts of one path with paths that end at these tilts.

use approx::assert_relative_eq;
use skin::Status;
use skin::puncture::{NumberList, PunctureParameters};
use substrate::Calibrations;

use crate::samples::{forty, solve_with, spread};

/// Compares force, displacement and penetration at 3°, 5°, 10° and 15°.
#[test]
fn measures_at_intermediate_tilts_match_paths_that_end_at_these_tilts() {
    let known = Calibrations::default();
    let tilts = [3.0, 5.0, 10.0, 15.0];
    let parameters = PunctureParameters {
        critical_tilt_deg: 15.0,
        tilts_before_deg: NumberList::new(&tilts[..3]),
        ..PunctureParameters::default()
    };
    let mut compared = 0;
    for design in spread().into_iter().chain(forty()) {
        let all = solve_with(&known, &design, &parameters);
        assert_eq!(all.at_tilts.len(), tilts.len());
        for (critical_tilt_deg, ours) in tilts.into_iter().zip(&all.at_tilts) {
            let one = PunctureParameters { critical_tilt_deg, ..PunctureParameters::default() };
            let one = solve_with(&known, &design, &one);
            if one.status != Status::Complete {
                continue;
            }
            let (ours, measures) = (ours.unwrap(), one.measures);
            for (ours, theirs) in [
                (ours.force, measures.critical_force),
                (ours.displacement, measures.critical_displacement),
                (ours.penetration, measures.penetration),
            ] {
                assert_relative_eq!(ours, theirs.unwrap(), max_relative = 1e-9);
            }
            compared += 1;
        }
    }
    assert!(compared > 180, "{compared}");
}

/// The entry of the largest tilt has the final measures.
#[test]
fn intermediate_tilts_do_not_change_the_path() {
    let known = Calibrations::default();
    let tilts_before_deg = NumberList::new(&[2.5]);
    for design in spread() {
        let plain = solve_with(&known, &design, &PunctureParameters::default());
        let parameters = PunctureParameters { tilts_before_deg, ..PunctureParameters::default() };
        let with = solve_with(&known, &design, &parameters);
        assert_eq!((&plain.path, plain.measures), (&with.path, with.measures));
        assert_eq!(with.at_tilts[1].map(|at| at.force), with.measures.critical_force);
        assert_eq!(with.at_tilts[1].map(|at| at.penetration), with.measures.penetration);
    }
}
