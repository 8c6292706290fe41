//! Points of a local search with puncture paths that were followed from rest.

use crate::candidate::{Candidate, SearchStage};
use crate::space::SpacePoint;

/// Maximum distance at which a design is solved from the path end of another design.
///
/// The distance is a fraction of the ranges of the variables. Starts from the path ends of designs
/// at larger distances seldom succeed.
const NEAR: f64 = 0.05;

/// Points with punctures that were followed from rest.
///
/// A local search solves the designs near these points from the ends of the followed paths.
pub(super) struct FollowedPoints(Vec<FollowedPoint>);

/// A point with a puncture that was followed from rest.
#[derive(PartialEq)]
struct FollowedPoint {
    point: SpacePoint,
    /// True if the result has derivatives.
    is_differentiated: bool,
}

impl FollowedPoints {
    /// Creates the followed points of a local search from `start`.
    ///
    /// If `start` is an initial sample, its path was followed without derivatives. The search then
    /// computes the derivatives from the end of this path.
    pub fn from_start(start: &Candidate) -> Self {
        let is_sample = start.stage == SearchStage::Sample;
        let start = FollowedPoint { point: start.point.clone(), is_differentiated: false };
        Self(is_sample.then_some(start).into_iter().collect())
    }

    /// Returns the followed point nearest to `point`.
    ///
    /// `None` if it is far away, or if the requested result of `point` itself is known from rest.
    pub fn nearest(&self, point: &SpacePoint, is_differentiated: bool) -> Option<&SpacePoint> {
        let distances = self.0.iter().map(|other| (point.distance(&other.point), other));
        let (distance, nearest) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let is_known = distance == 0.0 && nearest.is_differentiated == is_differentiated;
        (!is_known && distance <= NEAR).then_some(&nearest.point)
    }

    /// Adds a point that is followed from rest.
    pub fn add(&mut self, point: &SpacePoint, is_differentiated: bool) {
        let followed = FollowedPoint { point: point.clone(), is_differentiated };
        if !self.0.contains(&followed) {
            self.0.push(followed);
        }
    }
}
