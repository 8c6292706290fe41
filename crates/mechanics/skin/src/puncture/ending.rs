//! Classification of the end of a puncture path.
//!
//! The path has already ended: a free needle at the critical tilt, which is the target of the solver
//! in `system.rs`; a guided needle at a constraint (`GuidedNeedle::ends` in `needle/touches.rs`). A
//! critical tilt that follows from friction is set by `Case::punctured` in `study/sweep`.

use super::PuncturePoint;
use crate::Status;

/// Refines the stop status reported by the solver.
///
/// A needle that prescribes load, depth or tilt, or any of them in turn, cannot follow a path that
/// turns back in all three: the row snaps. It lands on the path again where one of the three
/// reaches its previous maximum, however far the load has dropped by then (drops by up to nine
/// tenths recover). A path that stops numerically before that, for example because sides become
/// flush in the middle of the fold, has no state to land on and ends at a limit point.
pub(super) fn classify(status: Status, path: &[PuncturePoint]) -> Status {
    match status {
        Status::Stopped(stop) if stop.is_numerical() && has_turned_back(path) => Status::LimitPoint,
        other => other,
    }
}

/// Returns true if load, depth and tilt all end below their maxima.
fn has_turned_back(path: &[PuncturePoint]) -> bool {
    let values: [fn(&PuncturePoint) -> f64; 3] =
        [|point| point.force, |point| point.displacement, |point| point.tilt_deg.abs()];
    // A quantity at its maximum has recovered, or never turned back.
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
    fn a_path_stopped_after_turning_back_has_a_limit_point() {
        let stopped = Status::Stopped(Termination::Singular);
        let back = path(&[[0.0, 0.0, 0.0], [2.0, 1.0, 5.0], [1.0, 0.9, 4.0]]);
        assert_eq!(classify(stopped, &back), Status::LimitPoint);
        let many = Status::Stopped(Termination::TooManyPoints);
        assert_eq!(
            (classify(many, &back), classify(Status::Complete, &back)),
            (many, Status::Complete)
        );
        // The tilt increases, the load has recovered, or the path has not yet turned.
        for last in [[1.0, 0.9, 6.0], [2.5, 0.9, 4.0], [2.0, 1.0, 5.0]] {
            let path = path(&[[0.0, 0.0, 0.0], [2.0, 1.0, 5.0], last]);
            assert_eq!(classify(stopped, &path), stopped);
        }
    }
}
