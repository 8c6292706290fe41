//! How the path of a puncture ends where the row gives way.

use super::PuncturePoint;
use crate::Status;

/// The status of a path of which the solver says how it ended.
///
/// A needle that prescribes load, depth or tilt, or any of them in turn, loses a path that turns back in all three: the row snaps. It
/// lands on the path again where one of the three comes to its largest value again, however far the load has fallen by then
/// (drops by up to nine tenths recover). A path that ends numerically without any of that, say because sides come to
/// lie flush in the middle of the fold, has no place where the row could stand under the needle.
pub(super) fn classify(status: Status, path: &[PuncturePoint]) -> Status {
    match status {
        Status::Stopped(stop) if stop.is_numerical() && has_turned_back(path) => Status::LimitPoint,
        other => other,
    }
}

/// Whether load, depth and tilt are all below their largest values at the end of a path.
fn has_turned_back(path: &[PuncturePoint]) -> bool {
    let below = |value: fn(&PuncturePoint) -> f64| {
        let largest = path.iter().map(value).reduce(f64::max);
        // A quantity at its largest value has recovered, or has never turned back.
        path.last().map(value) < largest
    };
    below(|point| point.force) && below(|point| point.displacement) && below(|point| point.tilt_deg)
}

#[cfg(test)]
mod tests {
    use solver::Stop;

    use super::*;

    fn path(points: &[[f64; 3]]) -> Vec<PuncturePoint> {
        let point = |&[force, displacement, tilt_deg]: &[f64; 3]| PuncturePoint {
            displacement,
            force,
            lateral_force: 0.0,
            tilt_deg,
            contacts: 1,
            substrate_energy: 0.0,
            contact_energy: 0.0,
            friction_work: None,
            gap_stretch: None,
        };
        points.iter().map(point).collect()
    }

    #[test]
    fn a_path_that_stops_on_its_way_back_has_a_limit_point() {
        let stopped = Status::Stopped(Stop::Singular);
        let back = path(&[[0.0, 0.0, 0.0], [2.0, 1.0, 5.0], [1.0, 0.9, 4.0]]);
        assert_eq!(classify(stopped, &back), Status::LimitPoint);
        let many = Status::Stopped(Stop::TooManyPoints);
        assert_eq!(
            (classify(many, &back), classify(Status::Complete, &back)),
            (many, Status::Complete)
        );
        // The tilt goes on, the load has recovered, the path has not left its fold.
        for last in [[1.0, 0.9, 6.0], [2.5, 0.9, 4.0], [2.0, 1.0, 5.0]] {
            let path = path(&[[0.0, 0.0, 0.0], [2.0, 1.0, 5.0], last]);
            assert_eq!(classify(stopped, &path), stopped);
        }
    }
}
