//! Status of a puncture path that ended at a limit point.
//!
//! The criteria that end a path are elsewhere. The path of a free needle ends at the critical tilt,
//! the target of the solver in `system.rs`. The path of a guided needle ends at a constraint
//! (`GuidedNeedle::ends` in `needle/tip_contacts.rs`). If the critical tilt follows from friction,
//! `Case::punctured` in `study/sweep` computes it.

use super::PuncturePoint;
use crate::Status;

/// Changes a numerical stop to [`Status::LimitPoint`] if the path reversed before it stopped.
///
/// If load, depth and tilt all decrease along a path, the row snaps, whichever of these quantities
/// the needle prescribes. It snaps to the point where one of the three quantities exceeds its
/// previous maximum; load drops of up to nine tenths recover in this way. If the path stops
/// numerically before such a point, for example because sides become flush, the row has no known
/// state to snap to, and the path ends at a limit point.
pub(super) fn classify(status: Status, path: &[PuncturePoint]) -> Status {
    match status {
        Status::Stopped(stop) if stop.is_numerical() && has_reversed(path) => Status::LimitPoint,
        other => other,
    }
}

/// Returns true if load, depth and tilt at the end are all below their maxima on the path.
fn has_reversed(path: &[PuncturePoint]) -> bool {
    let values: [fn(&PuncturePoint) -> f64; 3] =
        [|point| point.force, |point| point.displacement, |point| point.tilt_deg.abs()];
    // A quantity that ends at its maximum has recovered, or never decreased.
    values.into_iter().all(|value| path.last().map(value) < path.iter().map(value).reduce(f64::max))
}

#[cfg(test)]
mod tests {
    use solver::Termination;

    use super::*;

    fn path(points: &[[f64; 3]]) -> Vec<PuncturePoint> {
        points
            .iter()
            .map(|&[force, displacement, tilt_deg]| PuncturePoint {
                displacement,
                force,
                lateral_force: 0.0,
                tilt_deg,
                contacts: 1,
                substrate_energy: 0.0,
                contact_energy: 0.0,
                friction_work: None,
                gap_stretch: None,
            })
            .collect()
    }

    #[test]
    fn a_path_that_reverses_and_stops_numerically_ends_at_a_limit_point() {
        let stopped = Status::Stopped(Termination::Singular);
        let back = path(&[[0.0, 0.0, 0.0], [2.0, 1.0, 5.0], [1.0, 0.9, 4.0]]);
        assert_eq!(classify(stopped, &back), Status::LimitPoint);
        let many = Status::Stopped(Termination::TooManyPoints);
        assert_eq!(
            (classify(many, &back), classify(Status::Complete, &back)),
            (many, Status::Complete)
        );
        // The tilt has increased, the load has recovered, or no value has decreased.
        for last in [[1.0, 0.9, 6.0], [2.5, 0.9, 4.0], [2.0, 1.0, 5.0]] {
            let path = path(&[[0.0, 0.0, 0.0], [2.0, 1.0, 5.0], last]);
            assert_eq!(classify(stopped, &path), stopped);
        }
    }
}
