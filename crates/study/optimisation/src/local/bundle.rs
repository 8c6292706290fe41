//! Bundle method with a trust region, for piecewise smooth problems.
//!
//! The method minimises a piecewise smooth cost `f` under limits `c_k ≤ 0`. The minimum is often on
//! a kink, such as the sharp bottom of a valley, and gradients point across the kink instead of
//! along it. The tangents at several points `x_i` near the best point `x` together define the
//! direction along the kink. The step `d` is optimal for all these tangents:
//!
//! ```text
//! min s    subject to    f(x_i) + ∇f(x_i)·(x + d − x_i) ≤ s,                             (O5)
//!                        c_k(x_i) + ∇c_k(x_i)·(x + d − x_i) ≤ 0,    |d| ≤ r
//! ```
//!
//! A step is accepted if it achieves a sufficient part of the predicted gain. A rejected step adds
//! a tangent. If the tangents predict no gain, points of a space-filling sequence are evaluated in
//! the ball of radius `r` around `x`, until the ball contains as many points as a simplex has
//! corners. If the tangents at these points predict no gain either, the radius shrinks.
//!
//! This is the bundle method with a trust region (Schramm & Zowe 1992, doi 10.1137/0802008) with
//! points of gradient sampling (Burke, Lewis & Overton 2005, doi 10.1137/030601296) and linearised
//! limits as in Curtis & Overton 2012 (doi 10.1137/090780201). Its limit points are
//! Clarke-stationary. While no point is feasible, the cost is the largest excess over a limit.

#[cfg(test)]
mod tests;

use std::iter;

use super::linear_model::{Cut, Model, Piece};
use crate::space_filling::Sequence;

/// Minimum fraction of the predicted gain for which a step is accepted.
const ENOUGH: f64 = 0.1;

/// Minimum fraction of the predicted gain for which the radius grows.
const PLENTY: f64 = 0.5;

/// Predicted gain that counts as zero, for a cost of about 1.
const NEGLIGIBLE: f64 = 1e-10;

/// Factor by which the radius shrinks if no step predicts a gain.
const SHRUNK: f64 = 0.1;

/// Maximum number of tangents in the bundle, divided by the number of corners of a simplex.
const KEPT: usize = 4;

/// Values and gradients of cost and limits at a point.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    /// Cost to be minimised.
    pub cost: Piece,
    /// Excess over each limit; at most 0 if the limit is met.
    pub limits: Vec<Piece>,
    /// True if the point counts as feasible.
    pub met: bool,
}

/// Problem with a piecewise smooth cost and limits over the unit cube.
///
/// Cost and limits have values of about 1.
pub(super) trait PiecewiseSmooth {
    type Error;

    /// Evaluates cost and limits at `point`; `None` if the cost is undefined.
    fn pieces(&self, point: &[f64]) -> Result<Option<Pieces>, Self::Error>;
}

/// Radii and evaluation budget of the bundle method.
#[derive(Clone, Copy, Debug)]
pub(super) struct BundleOptions {
    /// Initial radius, as a fraction of the ranges of the variables.
    pub reach: f64,
    /// Radius at which the search ends.
    pub smallest: f64,
    /// Maximum number of evaluated points.
    pub points: usize,
}

/// Minimises the cost of `problem`, starting from `start`.
///
/// Returns no result: `problem` keeps the best point that it has evaluated.
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
        remaining: options.points,
        misses: 0,
        filled: false,
        sequence: Sequence::new(start.len(), 0),
        drawn: 0,
    };
    if bundle.evaluate(start.to_vec())?.is_none() {
        return Ok(());
    }
    while bundle.remaining > 0 && bundle.radius >= options.smallest {
        bundle.advance()?;
    }
    Ok(())
}

/// An evaluated point.
struct Seen {
    point: Vec<f64>,
    pieces: Pieces,
}

/// State of the bundle method.
struct Bundle<'p, P> {
    problem: &'p P,
    /// All evaluated points with a defined cost.
    seen: Vec<Seen>,
    /// Index of the best point, which is the centre of the ball.
    centre: usize,
    /// Radius of the ball.
    radius: f64,
    /// Number of evaluations that are still allowed.
    remaining: usize,
    /// Number of rejected steps since the last accepted step or change of radius.
    misses: usize,
    /// True if the ball was filled since the last accepted step or change of radius.
    filled: bool,
    /// Space-filling sequence of points in the ball.
    sequence: Sequence,
    /// Number of points of the sequence that have been used.
    drawn: usize,
}

impl<P: PiecewiseSmooth> Bundle<'_, P> {
    /// Evaluates a point, and returns its index if the cost is defined.
    fn evaluate(&mut self, point: Vec<f64>) -> Result<Option<usize>, P::Error> {
        self.remaining = self.remaining.saturating_sub(1);
        let pieces = self.problem.pieces(&point)?;
        Ok(pieces.map(|pieces| {
            self.seen.push(Seen { point, pieces });
            self.seen.len() - 1
        }))
    }

    /// Attempts one step. If no step predicts a gain, fills the ball with points, or shrinks it.
    fn advance(&mut self) -> Result<(), P::Error> {
        if let Some((to, gain)) = self.step().filter(|(_, gain)| *gain > NEGLIGIBLE) {
            return self.attempt(to, gain);
        }
        // A simplex in n dimensions has n + 1 corners. With fewer tangents a direction remains
        // undetermined.
        let lacking = (self.dimensions() + 1).saturating_sub(self.near(1.0).count());
        if lacking == 0 || self.filled {
            self.shrink(SHRUNK);
            return Ok(());
        }
        // Fill each ball only once. Points at kinks have no tangents, so tangents may still be
        // missing after filling the ball.
        self.filled = true;
        (0..lacking.min(self.remaining)).try_for_each(|_| self.fill())
    }

    /// Evaluates the next point of the space-filling sequence in the ball.
    fn fill(&mut self) -> Result<(), P::Error> {
        self.drawn += 1;
        let unit = self.sequence.point(self.drawn);
        let centre = &self.seen[self.centre].point;
        let shifted = centre.iter().zip(unit).map(|(x, u)| x + self.radius * (2.0 * u - 1.0));
        // Points outside the cube are moved to its surface, not skipped, because the simplex needs
        // enough points.
        let point: Vec<f64> = shifted.map(|x| x.clamp(0.0, 1.0)).collect();
        let merit = self.merit(self.centre);
        if let Some(index) = self.evaluate(point)?
            && better(self.merit(index), merit) > 0.0
        {
            self.centre = index;
        }
        Ok(())
    }

    /// Evaluates the step to the point `to`, and accepts or rejects it by the `predicted` gain.
    fn attempt(&mut self, to: Vec<f64>, predicted: f64) -> Result<(), P::Error> {
        // A step that ends inside the ball is limited by tangents, so a larger radius would not
        // lengthen this step.
        let far = distance(&to, &self.seen[self.centre].point) > 0.9 * self.radius;
        // A point without a cost adds no tangent. Only a smaller radius then avoids the same step.
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
        // Each rejected step has added a tangent. If the tangents of a whole simplex do not help,
        // the radius is too large.
        if self.misses > self.dimensions() {
            self.shrink(0.5);
        }
        Ok(())
    }

    /// Multiplies the radius by `factor`, and resets the counters of the ball.
    fn shrink(&mut self, factor: f64) {
        self.radius *= factor;
        (self.misses, self.filled) = (0, false);
    }

    /// Returns the number of variables.
    fn dimensions(&self) -> usize {
        self.seen[self.centre].point.len()
    }

    /// Returns whether a point is feasible, and the value to be minimised.
    ///
    /// The value is the cost of a feasible point, and the largest excess of an infeasible point.
    fn merit(&self, index: usize) -> (bool, f64) {
        let pieces = &self.seen[index].pieces;
        (pieces.met, if pieces.met { pieces.cost.value } else { pieces.excess() })
    }

    /// Iterates over the points with a tangent near the centre, newest first.
    ///
    /// Their distance from the centre is at most `radii` times the radius.
    fn near(&self, radii: f64) -> impl Iterator<Item = &Seen> {
        let centre = &self.seen[self.centre].point;
        // Include points on the border of the ball despite round-off in their distance.
        let within = radii * self.radius * (1.0 + 1e-9);
        let near =
            self.seen.iter().rev().filter(move |seen| distance(&seen.point, centre) <= within);
        near.filter(|seen| seen.pieces.have_tangents())
    }

    /// Returns the end point of the best step, and its predicted gain.
    fn step(&self) -> Option<(Vec<f64>, f64)> {
        let Seen { point, pieces } = &self.seen[self.centre];
        let (met, worst) = self.merit(self.centre);
        let mut model = Model::new(point, self.radius, worst);
        let kept = KEPT * (self.dimensions() + 1);
        // Use points within twice the radius, so that a halved ball keeps its tangents. Always
        // include the centre, which may be older than the newest points. Without the tangent of the
        // centre, the model could predict a gain where there is none.
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
    /// Returns true if the cost or at least one limit has a gradient.
    fn have_tangents(&self) -> bool {
        iter::once(&self.cost).chain(&self.limits).any(|piece| piece.gradient.is_some())
    }

    /// Returns the largest excess over a limit, at least 0.
    fn excess(&self) -> f64 {
        self.limits.iter().map(|limit| limit.value).fold(0.0, f64::max)
    }
}

/// Returns the improvement from the second merit to the first merit.
///
/// A merit states whether a point is feasible, and the value to be minimised. The improvement is
/// infinite if only the first point is feasible.
fn better((met, value): (bool, f64), (other_met, other): (bool, f64)) -> f64 {
    match (met, other_met) {
        // A step to the first feasible point is always accepted.
        (true, false) => f64::INFINITY,
        (false, true) => f64::NEG_INFINITY,
        _ => other - value,
    }
}

/// Returns the largest coordinate difference between two points.
pub(super) fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
