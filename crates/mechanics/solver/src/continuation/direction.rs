//! Lengths of path directions, and angles that reveal a step to another branch.

use super::{Candidate, Continuation, Equilibrium};
use crate::newton::FLOOR;
use crate::system::{Control, System};

/// Cosine of the largest angle (45°) by which the path may turn within a step.
///
/// If the angle is larger, Newton's method converged to a part of the path beyond a fold, or the
/// step is too long.
const STRAIGHT: f64 = 0.7;

/// Cosine of the largest angle (37°) by which the path may turn in all coordinates.
///
/// Far from the load a row may buckle either way within a small part of a step, and the controls
/// hardly change.
const STRAIGHT_IN_ALL: f64 = 0.8;

/// Cosine of the largest angle (3°) between a chord and its ends' mean direction.
///
/// On an arc, chord and mean direction agree up to the third order of the length. A chord to a
/// neighbouring path makes angles of the same sign with both directions.
const SYMMETRIC: f64 = 0.9986;

/// Rate of all coordinates over the rate of the controls that makes a path hidden.
///
/// A hidden path moves far from the load, as in a local instability, and hardly moves the controls.
/// Its steps are measured by the arc length in all coordinates.
pub(super) const HIDDEN: f64 = 100.0;

/// Step length below which the angle of a step is round-off.
///
/// It is in scales of the controls. If the initial stiffness of a contact is a thousand times its
/// later stiffness, the path turns by a right angle within 1e-8 of contact closure and continues
/// from there.
pub(super) const SHORT: f64 = 1e-7;

impl<S: System> Continuation<S> {
    /// Scales a direction to unit length in the controls, or to less if it is hidden.
    pub(crate) fn normalised(&self, mut direction: Vec<f64>) -> Vec<f64> {
        let all = self.coordinates.iter().map(|&index| direction[index].powi(2)).sum::<f64>();
        let factor = 1.0 / self.in_controls(&direction).max(all.sqrt() / HIDDEN);
        for x in &mut direction {
            *x *= factor;
        }
        direction
    }

    /// Computes the length of a direction in the controls.
    fn in_controls(&self, direction: &[f64]) -> f64 {
        let controls = self.system.controls().iter();
        controls.map(|c| (direction[c.index] / c.scale).powi(2)).sum::<f64>().sqrt()
    }

    /// Returns true if a direction of the path is hidden from the controls.
    pub(super) fn is_hidden(&self, direction: &[f64]) -> bool {
        self.in_controls(direction) < 1.0 - FLOOR.sqrt()
    }

    /// Returns true if the chord to the candidate, or its direction, deviates sharply.
    ///
    /// Both are compared with the outgoing direction of `from`.
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

    /// Returns true if the candidate, the end of a step, lies on another branch.
    ///
    /// On another branch the orientation differs, or the step bends. Do not call this before events
    /// are located: beyond an event a valid step may end on a reversed part of the path.
    pub(super) fn strays(
        &self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
    ) -> bool {
        candidate.is_positive != self.is_positive || self.bends(from, candidate)
    }

    /// Returns true if outgoing, chord and incoming directions differ strongly.
    ///
    /// The angles are those in all coordinates. If one is large, the candidate lies on another
    /// branch or beyond a bend that the step cuts off.
    pub(super) fn bends(
        &self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
    ) -> bool {
        // One pass over all coordinates, because every step evaluates this.
        let mut products = [[0.0; 3]; 3];
        for &index in &self.coordinates {
            let chord = candidate.state.z[index] - from.state.z[index];
            let ways = [from.leaving[index], candidate.direction[index], chord];
            for (row, one) in products.iter_mut().zip(ways) {
                for (product, other) in row.iter_mut().zip(ways) {
                    *product += one * other;
                }
            }
        }
        let lengths = [0, 1, 2].map(|k| products[k][k].sqrt());
        let turn = products[0][1] / (lengths[0] * lengths[1]);
        let along =
            products[0][2] / (lengths[0] * lengths[2]) + products[1][2] / (lengths[1] * lengths[2]);
        let off_mean = along < SYMMETRIC * (2.0 + 2.0 * turn).sqrt();
        // A hidden path is longer than its length in the controls.
        lengths[2] > SHORT * lengths[0].max(1.0) && (turn < STRAIGHT_IN_ALL || off_mean)
    }

    /// Computes the cosine of the angle between two directions in all coordinates.
    ///
    /// For a system without [`System::coordinates`], the controls take their place.
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
