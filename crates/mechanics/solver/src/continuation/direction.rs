//! Lengths of path directions, and angles between them that reveal a step to another branch.

use super::{Candidate, Continuation, Equilibrium};
use crate::newton::FLOOR;
use crate::system::{Control, System};

/// Cosine of the largest angle (45°) in the controls by which the path may turn within a step.
///
/// If the angle is larger, Newton's method converged to a part of the path beyond a fold, or the
/// step is too long.
const STRAIGHT: f64 = 0.7;

/// Cosine of the largest angle (37°) in all coordinates by which the path may turn within a step.
///
/// Far from the load a row may buckle in one of two directions within a small part of a step, while
/// the controls hardly change.
const STRAIGHT_IN_ALL: f64 = 0.8;

/// Cosine of the largest angle (3°) between a chord and the mean of the directions at its ends.
///
/// On a smooth path the angle is of third order in the length of the chord. A chord to a
/// neighbouring path deviates to the same side from the directions at both ends, and so from their
/// mean.
const SYMMETRIC: f64 = 0.9986;

/// Ratio of the rate of all coordinates to the rate of the controls above which a path is hidden.
///
/// On a hidden path the system deforms far from the load, as in a local instability, while the
/// controls hardly change. Steps of a hidden path are measured by the arc length in all
/// coordinates.
pub(super) const HIDDEN: f64 = 100.0;

/// Step length below which the angles of a step are not checked.
///
/// The length is in units of the scales of the controls. If the initial stiffness of a contact is a
/// thousand times its later stiffness, the path may turn by a right angle within 1e-8 after the
/// contact closes.
pub(super) const SHORT: f64 = 1e-7;

impl<S: System> Continuation<S> {
    /// Returns a direction scaled to unit length in the controls.
    ///
    /// A hidden direction is scaled to the length [`HIDDEN`] in all coordinates; its length in the
    /// controls is then less than 1.
    pub(crate) fn normalised(&self, mut direction: Vec<f64>) -> Vec<f64> {
        let all = self.coordinates.iter().map(|&index| direction[index].powi(2)).sum::<f64>();
        let factor = 1.0 / self.in_controls(&direction).max(all.sqrt() / HIDDEN);
        for x in &mut direction {
            *x *= factor;
        }
        direction
    }

    /// Returns the length of a direction in the controls, each divided by its scale.
    fn in_controls(&self, direction: &[f64]) -> f64 {
        let controls = self.system.controls().iter();
        controls.map(|c| (direction[c.index] / c.scale).powi(2)).sum::<f64>().sqrt()
    }

    /// Returns true if a normalised direction is hidden, see [`HIDDEN`].
    pub(super) fn is_hidden(&self, direction: &[f64]) -> bool {
        self.in_controls(direction) < 1.0 - FLOOR.sqrt()
    }

    /// Returns true if the path from `from` to the candidate turns by too large an angle.
    ///
    /// Compares the chord and the direction at the candidate with the outgoing direction of `from`,
    /// in the controls, or in all coordinates if the path is hidden.
    pub(crate) fn turns_sharply(
        &self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
    ) -> bool {
        if self.is_hidden(&from.leaving) || self.is_hidden(&candidate.direction) {
            return self.bends(from, candidate);
        }
        let mut products = [0.0; 3];
        for Control { index, scale } in self.system.controls() {
            let leaving = from.leaving[*index] / scale;
            let arriving = candidate.direction[*index] / scale;
            let chord = (candidate.state.z[*index] - from.state.z[*index]) / scale;
            let terms = [leaving * arriving, leaving * chord, chord * chord];
            products = std::array::from_fn(|k| products[k] + terms[k]);
        }
        let [turn, along, chord] = [products[0], products[1], products[2].sqrt()];
        chord > SHORT && (turn < STRAIGHT || along < STRAIGHT * chord)
    }

    /// Returns true if the candidate, the end of a step, seems to lie on another branch.
    ///
    /// The criteria are another orientation (N7) or large angles in all coordinates. Call this only
    /// after the events within the step have been located: beyond an event the path may have
    /// reversed.
    pub(super) fn strays(
        &self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
    ) -> bool {
        candidate.is_positive != self.is_positive || self.bends(from, candidate)
    }

    /// Returns true if angles between the directions of a step are too large in all coordinates.
    ///
    /// The directions are the outgoing direction of `from`, the chord, and the incoming direction
    /// of the candidate. If an angle is large, the candidate lies on another branch, or the step
    /// has skipped a bend of the path.
    pub(super) fn bends(
        &self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
    ) -> bool {
        // One pass over the coordinates computes all products, because every step needs them.
        let mut products = [[0.0; 3]; 3];
        for &index in &self.coordinates {
            let chord = candidate.state.z[index] - from.state.z[index];
            let vectors = [from.leaving[index], candidate.direction[index], chord];
            for (row, one) in products.iter_mut().zip(vectors) {
                for (product, other) in row.iter_mut().zip(vectors) {
                    *product += one * other;
                }
            }
        }
        let lengths = [0, 1, 2].map(|k| products[k][k].sqrt());
        let turn = products[0][1] / (lengths[0] * lengths[1]);
        let along =
            products[0][2] / (lengths[0] * lengths[2]) + products[1][2] / (lengths[1] * lengths[2]);
        let off_mean = along < SYMMETRIC * (2.0 + 2.0 * turn).sqrt();
        // `SHORT` is a length in the controls. A hidden direction is longer in all coordinates.
        lengths[2] > SHORT * lengths[0].max(1.0) && (turn < STRAIGHT_IN_ALL || off_mean)
    }

    /// Returns the cosine of the angle between two directions in all coordinates.
    ///
    /// If [`System::coordinates`] is empty, the controls are used instead.
    pub(crate) fn cosine(&self, one: &[f64], other: &[f64]) -> f64 {
        let all = self.coordinates.iter().map(|&index| (index, 1.0));
        let controls = self.system.controls().iter().map(|c| (c.index, c.scale.powi(-2)));
        let controls = controls.filter(|_| self.coordinates.is_empty());
        let [mut product, mut of_one, mut of_other] = [0.0; 3];
        for (index, weight) in all.chain(controls) {
            product += weight * one[index] * other[index];
            of_one += weight * one[index].powi(2);
            of_other += weight * other[index].powi(2);
        }
        product / (of_one * of_other).sqrt()
    }
}
