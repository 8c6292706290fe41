//! Bundle method with a trust region, for piecewise smooth problems.
//!
//! To minimise a piecewise smooth cost `f` under limits `c_k ≤ 0`: the minimum often lies on kinks,
//! such as the edge along a valley floor, where a gradient points across the kink instead of along
//! it. Tangents collected at points `x_i` near the best point define the direction along it. Each
//! step `d` is optimal for all of them:
//!
//! ```text
//! min s    subject to    f(x_i) + ∇f(x_i)·(x + d − x_i) ≤ s,                             (O5)
//!                        c_k(x_i) + ∇c_k(x_i)·(x + d − x_i) ≤ 0,    |d| ≤ r
//! ```
//!
//! A step is accepted if it achieves enough of the predicted gain; a rejected step adds a tangent.
//! If no step is left, points from a space-filling sequence complete a simplex in the ball of
//! radius `r` before it shrinks. This is the bundle method with a trust region (Schramm & Zowe
//! 1992, doi 10.1137/0802008) with the points of gradient sampling (Burke, Lewis & Overton 2005,
//! doi 10.1137/030601296) and linearised limits as in Curtis & Overton 2012 (doi
//! 10.1137/090780201): its limit points are Clarke-stationary. While no point is feasible, the
//! largest excess over a limit is the cost.

#[cfg(test)]
mod tests;

use std::iter;

use super::linear_model::{Cut, Model, Piece};
use crate::space_filling::Sequence;

/// Fraction of the predicted gain from which a step is accepted.
const ENOUGH: f64 = 0.1;

/// Fraction of the predicted gain from which the radius grows.
const PLENTY: f64 = 0.5;

/// Predicted gain that counts as zero, for a cost of about 1.
const NEGLIGIBLE: f64 = 1e-10;

/// Factor by which the radius shrinks if no step is left.
const SHRUNK: f64 = 0.1;

/// Maximum points of the bundle, per corner of a simplex.
const KEPT: usize = 4;

/// Values and gradients of cost and limits at a point.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    pub cost: Piece,
    pub limits: Vec<Piece>,
    /// True if the point counts as feasible.
    pub met: bool,
}

/// A piecewise smooth cost with limits over the unit cube, all scaled to about 1.
pub(super) trait PiecewiseSmooth {
    type Error;

    /// Evaluates cost and limits at a point; `None` if the cost is undefined.
    fn pieces(&self, point: &[f64]) -> Result<Option<Pieces>, Self::Error>;
}

/// Radii and evaluation budget of the bundle method.
#[derive(Clone, Copy, Debug)]
pub(super) struct BundleOptions {
    /// Initial radius, as a fraction of the intervals.
    pub reach: f64,
    /// Radius at which the search ends.
    pub smallest: f64,
    /// Maximum number of evaluated points.
    pub points: usize,
}

/// Minimises the cost of `problem` from `start`.
///
/// The problem logs the evaluations itself.
pub(super) fn descend<P: PiecewiseSmooth>(
    problem: &P,
    start: &[f64],
    options: BundleOptions,
) -> Result<(), P::Error> {
    let mut bundle = Bundle {
        problem,
        seen: Vec::new(),
        centre: 0,
        radius: options.reach,
        left: options.points,
        misses: 0,
        filled: false,
        sequence: Sequence::new(start.len(), 0),
        drawn: 0,
    };
    if bundle.evaluate(start.to_vec())?.is_none() {
        return Ok(());
    }
    while bundle.left > 0 && bundle.radius >= options.smallest {
        bundle.advance()?;
    }
    Ok(())
}

struct Seen {
    point: Vec<f64>,
    pieces: Pieces,
}

struct Bundle<'p, P> {
    problem: &'p P,
    seen: Vec<Seen>,
    /// Index of the best point.
    centre: usize,
    radius: f64,
    left: usize,
    /// Rejected steps since the last accepted step or change of radius.
    misses: usize,
    /// True if the ball was filled since the last accepted step or change of radius.
    filled: bool,
    sequence: Sequence,
    drawn: usize,
}

impl<P: PiecewiseSmooth> Bundle<'_, P> {
    /// Evaluates a point, and returns its index if the cost is defined.
    fn evaluate(&mut self, point: Vec<f64>) -> Result<Option<usize>, P::Error> {
        self.left = self.left.saturating_sub(1);
        let pieces = self.problem.pieces(&point)?;
        Ok(pieces.map(|pieces| {
            self.seen.push(Seen { point, pieces });
            self.seen.len() - 1
        }))
    }

    /// Makes one step, or fills the ball, or shrinks it.
    fn advance(&mut self) -> Result<(), P::Error> {
        if let Some((to, gain)) = self.step().filter(|(_, gain)| *gain > NEGLIGIBLE) {
            return self.attempt(to, gain);
        }
        // A simplex in n dimensions has n + 1 corners: fewer tangents leave a direction
        // undetermined.
        let lacking = (self.dimensions() + 1).saturating_sub(self.near(1.0).count());
        if lacking == 0 || self.filled {
            self.shrink(SHRUNK);
            return Ok(());
        }
        // Once for each ball: points at kinks have no tangents, so the ball would be filled
        // forever.
        self.filled = true;
        (0..lacking.min(self.left)).try_for_each(|_| self.fill())
    }

    /// Evaluates the next point of the sequence in the ball.
    fn fill(&mut self) -> Result<(), P::Error> {
        self.drawn += 1;
        let unit = self.sequence.point(self.drawn);
        let centre = &self.seen[self.centre].point;
        let shifted = centre.iter().zip(unit).map(|(x, u)| x + self.radius * (2.0 * u - 1.0));
        // Points beyond the cube move to its face instead of being skipped, so that the ball is
        // filled.
        let point: Vec<f64> = shifted.map(|x| x.clamp(0.0, 1.0)).collect();
        let merit = self.merit(self.centre);
        if let Some(index) = self.evaluate(point)?
            && better(self.merit(index), merit) > 0.0
        {
            self.centre = index;
        }
        Ok(())
    }

    /// Evaluates a step with this predicted gain, and accepts or rejects it.
    fn attempt(&mut self, to: Vec<f64>, predicted: f64) -> Result<(), P::Error> {
        // A step inside the ball was limited by tangents: a larger radius would not lengthen it.
        let far = distance(&to, &self.seen[self.centre].point) > 0.9 * self.radius;
        // Without a cost no tangent is added, so only a smaller radius avoids the same step.
        let Some(index) = self.evaluate(to)? else {
            self.shrink(0.5);
            return Ok(());
        };
        let gain = better(self.merit(index), self.merit(self.centre));
        if gain >= ENOUGH * predicted {
            self.centre = index;
            (self.misses, self.filled) = (0, false);
            self.radius *= if far && gain >= PLENTY * predicted { 2.0 } else { 1.0 };
            return Ok(());
        }
        self.misses += 1;
        // Each rejection added a tangent. If a full simplex of tangents does not help, the radius
        // is too large.
        if self.misses > self.dimensions() {
            self.shrink(0.5);
        }
        Ok(())
    }

    fn shrink(&mut self, factor: f64) {
        self.radius *= factor;
        (self.misses, self.filled) = (0, false);
    }

    fn dimensions(&self) -> usize {
        self.seen[self.centre].point.len()
    }

    /// Returns feasibility, and the cost (if feasible) or the excess to be minimised.
    fn merit(&self, index: usize) -> (bool, f64) {
        let pieces = &self.seen[index].pieces;
        (pieces.met, if pieces.met { pieces.cost.value } else { pieces.excess() })
    }

    /// Iterates over points with a tangent within `radii` of the centre, newest first.
    fn near(&self, radii: f64) -> impl Iterator<Item = &Seen> {
        let centre = &self.seen[self.centre].point;
        // Include points on the border of the ball despite round-off in their distance.
        let within = radii * self.radius * (1.0 + 1e-9);
        let near =
            self.seen.iter().rev().filter(move |seen| distance(&seen.point, centre) <= within);
        near.filter(|seen| seen.pieces.have_tangents())
    }

    /// Returns the end of the best step, and its predicted gain.
    fn step(&self) -> Option<(Vec<f64>, f64)> {
        let Seen { point, pieces } = &self.seen[self.centre];
        let (met, worst) = self.merit(self.centre);
        let mut model = Model::new(point, self.radius, worst);
        let kept = KEPT * (self.dimensions() + 1);
        // Twice the radius, so that a halved ball keeps its tangents. The centre may be older than
        // the kept points and is always included: without it, the model could predict a gain where
        // there is none.
        let near = self.near(2.0).take(kept).chain([&self.seen[self.centre]]);
        for seen in near {
            if met {
                model.add(Cut::Cost, &seen.pieces.cost, worst, &seen.point);
            }
            let cut = if met { Cut::Limit } else { Cut::Cost };
            for (piece, here) in seen.pieces.limits.iter().zip(&pieces.limits) {
                model.add(cut, piece, here.value, &seen.point);
            }
        }
        model.step()
    }
}

impl Pieces {
    /// Returns true if the cost or any limit has a gradient.
    fn have_tangents(&self) -> bool {
        iter::once(&self.cost).chain(&self.limits).any(|piece| piece.gradient.is_some())
    }

    /// Returns the largest excess over a limit.
    fn excess(&self) -> f64 {
        self.limits.iter().map(|limit| limit.value).fold(0.0, f64::max)
    }
}

/// Returns the gain of one merit over another.
///
/// Infinite if only the first is feasible.
fn better((met, value): (bool, f64), (other_met, other): (bool, f64)) -> f64 {
    match (met, other_met) {
        // Feasibility comes first: a step to the first feasible point is always accepted.
        (true, false) => f64::INFINITY,
        (false, true) => f64::NEG_INFINITY,
        _ => other - value,
    }
}

/// Returns the largest coordinate difference between two points.
pub(super) fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
