//! Points of a local search with punctures that were followed from rest.

use crate::space::SpacePoint;

/// Largest distance over which a puncture starts from the end of another one.
///
/// It is a fraction of the intervals. Starts from farther ends seldom succeed.
const NEAR: f64 = 0.05;

/// Points with punctures that a local search has followed from rest.
///
/// The search solves designs beside them from their ends.
#[derive(Default)]
pub(super) struct FollowedPoints(Vec<SpacePoint>);

impl FollowedPoints {
    /// Returns the nearest followed point; `None` if it is far away, or if `point` was followed.
    pub fn nearest(&self, point: &SpacePoint) -> Option<&SpacePoint> {
        let distances = self.0.iter().map(|other| (point.distance(other), other));
        let (distance, nearest) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (distance > 0.0 && distance <= NEAR).then_some(nearest)
    }

    /// Adds a followed point.
    pub fn add(&mut self, point: &SpacePoint) {
        if !self.0.contains(point) {
            self.0.push(point.clone());
        }
    }
}
