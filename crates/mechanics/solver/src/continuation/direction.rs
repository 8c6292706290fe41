//! Directions of the path: their lengths, and the angles between them that tell when a step has left it.

use super::{Candidate, Continuation, Equilibrium};
use crate::newton::FLOOR;
use crate::system::{Control, System};

/// Cosine of the largest angle (45°) by which the path may turn within a step. Where it seems to turn by more,
/// Newton's method has come to a part of the path further on, beyond a fold, or the step is too long.
const STRAIGHT: f64 = 0.7;

/// Cosine of the largest angle (37°) by which the path of all coordinates may turn within a step. Far from the load a row may
/// buckle either way within a small part of a step, of which the controls show next to nothing.
const STRAIGHT_IN_ALL: f64 = 0.8;

/// Cosine of the largest angle (3°) between a chord and the mean of the directions at its ends. They agree on an arc up to the
/// third order of its length; a chord that leads aside, to a path beside this one, has angles of one sign at both ends.
const SYMMETRIC: f64 = 0.9986;

/// The path is hidden from the controls where all coordinates together move this many times as fast: something gives way far from
/// the load. The arc length in all of them measures it there.
pub(super) const HIDDEN: f64 = 100.0;

/// Below this distance, in scales of the controls, the angle of a step is round-off. Where a contact is a thousand times as stiff at first
/// as soon after, the path turns by a right angle within 1e-8 of where it closes, and goes on from there.
pub(super) const SHORT: f64 = 1e-7;

impl<S: System> Continuation<S> {
    /// A direction of unit length in the controls; of less where they hide the path.
    pub(crate) fn normalised(&self, mut direction: Vec<f64>) -> Vec<f64> {
        let all = self.coordinates.iter().map(|&index| direction[index].powi(2)).sum::<f64>();
        let factor = 1.0 / self.in_controls(&direction).max(all.sqrt() / HIDDEN);
        for x in &mut direction {
            *x *= factor;
        }
        direction
    }

    /// The length of a direction in the controls.
    fn in_controls(&self, direction: &[f64]) -> f64 {
        let controls = self.system.controls().iter();
        controls.map(|c| (direction[c.index] / c.scale).powi(2)).sum::<f64>().sqrt()
    }

    /// Whether the controls hide a direction of the path.
    pub(super) fn is_hidden(&self, direction: &[f64]) -> bool {
        self.in_controls(direction) < 1.0 - FLOOR.sqrt()
    }

    /// Whether the way to the candidate, or the path there, makes a large angle with the direction
    /// in which the path left.
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

    /// Whether the candidate, the end of a step, is on another branch: the path has another orientation there, or gets there
    /// by a bend. Before events are looked for a step may well end on a continuation of the path that turns round.
    pub(super) fn strays(
        &self,
        from: &Equilibrium<S::Mode>,
        candidate: &Candidate<S::Mode>,
    ) -> bool {
        candidate.is_positive != self.is_positive || self.bends(from, candidate)
    }

    /// Whether the three directions in which the path leaves, goes and arrives make large angles with each other in all
    /// coordinates: then the candidate is on another branch, or beyond a bend that the step cuts off.
    fn bends(&self, from: &Equilibrium<S::Mode>, candidate: &Candidate<S::Mode>) -> bool {
        // In one pass: every step of every path asks for this, over all coordinates.
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
        let cosine = |a: usize, b: usize| products[a][b] / (lengths[a] * lengths[b]);
        let (turn, along) = (cosine(0, 1), cosine(0, 2) + cosine(1, 2));
        let off_mean = along < SYMMETRIC * (2.0 + 2.0 * turn).sqrt();
        // Where the controls hide the path it is longer than they show.
        lengths[2] > SHORT * lengths[0].max(1.0) && (turn < STRAIGHT_IN_ALL || off_mean)
    }

    /// Cosine of the angle between two directions in all coordinates, or in the controls of a system that tells of none.
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
