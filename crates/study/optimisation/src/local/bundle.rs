//! The search along ridges: a bundle of pieces, each of them smooth, that were seen near by.
//!
//! Where a piecewise smooth cost `f` is to be small and limits `c_k ≤ 0` hold, the best place often stands on kinks: on a valley floor
//! that is an edge. Derivatives there tell the way to its sides alone. What was seen at places `x_i` near the best one tells the way
//! along it: every place gives the tangents of the pieces that it stands on, and the next step `d` is the best for all of them,
//!
//! ```text
//! min s    subject to    f(x_i) + ∇f(x_i)·(x + d − x_i) ≤ s,    c_k(x_i) + ∇c_k(x_i)·(x + d − x_i) ≤ 0,    |d| ≤ r          (O5)
//! ```
//!
//! A step that is as good as it is told, or nearly, is taken; one that is not has found a piece that was not known. Where no step is
//! left, the ball of radius `r` gets as many places as a simplex has corners, from a sequence that fills it, before it shrinks. That is the
//! bundle method with a trust region (Schramm & Zowe 1992, doi 10.1137/0802008) with the places of gradient sampling (Burke, Lewis &
//! Overton 2005, doi 10.1137/030601296) and linear limits as in Curtis & Overton 2012 (doi 10.1137/090780201): its limits are
//! Clarke-stationary. As long as no place keeps to the limits, the largest of them is the cost.

mod model;
#[cfg(test)]
mod tests;

use std::iter;

use crate::space_filling::Sequence;
use model::{Cut, Model};

/// The part of the gain that is told which makes a step be taken.
const ENOUGH: f64 = 0.1;

/// The part of the gain that is told from which on the tangents are good for longer steps.
const PLENTY: f64 = 0.5;

/// A gain that is none, of a cost of about 1 in size.
const NEGLIGIBLE: f64 = 1e-10;

/// The part of the radius to which the ball shrinks where no step is left.
const SHRUNK: f64 = 0.1;

/// Places of the bundle for each corner of a simplex, at most.
const KEPT: usize = 4;

/// A value with its gradient, which is missing at a kink.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub value: f64,
    pub gradient: Option<Vec<f64>>,
}

/// The pieces at a place: of the cost, and of the limits.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    pub cost: Piece,
    pub limits: Vec<Piece>,
    /// Whether the place keeps to the limits, as far as that counts.
    pub met: bool,
}

/// A piecewise smooth cost with limits over a unit cube, all of about 1 in size.
pub(super) trait PiecewiseSmooth {
    type Error;

    /// The pieces at a place; none where there is no cost.
    fn pieces(&self, place: &[f64]) -> Result<Option<Pieces>, Self::Error>;
}

/// How far a bundle search may go.
#[derive(Clone, Copy, Debug)]
pub(super) struct BundleOptions {
    /// The first radius, a share of the intervals.
    pub reach: f64,
    /// The radius at which it ends.
    pub smallest: f64,
    /// Places that may be looked at.
    pub places: usize,
}

/// Makes the cost of `problem` small from `start` on; what is looked at is the problem's to note.
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
        left: options.places,
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
    place: Vec<f64>,
    pieces: Pieces,
}

struct Bundle<'p, P> {
    problem: &'p P,
    seen: Vec<Seen>,
    /// The index of the best place.
    centre: usize,
    radius: f64,
    left: usize,
    /// Steps since the last that was taken, or since the ball shrank.
    misses: usize,
    /// Whether the ball has got places that it lacked.
    filled: bool,
    sequence: Sequence,
    drawn: usize,
}

impl<P: PiecewiseSmooth> Bundle<'_, P> {
    /// Looks at a place, and returns its index if it has a cost.
    fn evaluate(&mut self, place: Vec<f64>) -> Result<Option<usize>, P::Error> {
        self.left = self.left.saturating_sub(1);
        let pieces = self.problem.pieces(&place)?;
        Ok(pieces.map(|pieces| {
            self.seen.push(Seen { place, pieces });
            self.seen.len() - 1
        }))
    }

    /// One step, or as many places as the ball lacks, or a smaller ball.
    fn advance(&mut self) -> Result<(), P::Error> {
        if let Some((to, gain)) = self.step().filter(|(_, gain)| *gain > NEGLIGIBLE) {
            return self.attempt(to, gain);
        }
        // A simplex has one corner more than dimensions: fewer tangents leave a direction in which nothing is told.
        let lacking = (self.dimensions() + 1).saturating_sub(self.near(1.0).count());
        if lacking == 0 || self.filled {
            self.shrink(SHRUNK);
            return Ok(());
        }
        // Once for each ball: places at kinks have no tangents, and would have it filled for ever.
        self.filled = true;
        (0..lacking.min(self.left)).try_for_each(|_| self.fill())
    }

    /// Looks at the next place of the sequence in the ball.
    fn fill(&mut self) -> Result<(), P::Error> {
        self.drawn += 1;
        let unit = self.sequence.point(self.drawn);
        let centre = &self.seen[self.centre].place;
        let shifted = centre.iter().zip(unit).map(|(x, u)| x + self.radius * (2.0 * u - 1.0));
        // A place beyond the cube moves to its face and is not left out, so that the ball gets as many as it lacks.
        let place: Vec<f64> = shifted.map(|x| x.clamp(0.0, 1.0)).collect();
        let merit = self.merit(self.centre);
        if let Some(index) = self.evaluate(place)?
            && better(self.merit(index), merit) > 0.0
        {
            self.centre = index;
        }
        Ok(())
    }

    /// Tries the step to a place that is told to gain so much.
    fn attempt(&mut self, to: Vec<f64>, told: f64) -> Result<(), P::Error> {
        // A step that ends well within the ball has its end from the tangents: a larger ball would not lengthen it.
        let far = distance(&to, &self.seen[self.centre].place) > 0.9 * self.radius;
        // Where there is no cost there is no tangent that would keep the next step from going there: the ball has to.
        let Some(index) = self.evaluate(to)? else {
            self.shrink(0.5);
            return Ok(());
        };
        let gain = better(self.merit(index), self.merit(self.centre));
        if gain >= ENOUGH * told {
            self.centre = index;
            (self.misses, self.filled) = (0, false);
            self.radius *= if far && gain >= PLENTY * told { 2.0 } else { 1.0 };
            return Ok(());
        }
        self.misses += 1;
        // Each miss has added a tangent. Where as many as make a corner do not help, it is the ball that is too large
        // for them.
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
        self.seen[self.centre].place.len()
    }

    /// Whether a place keeps to the limits, and what is to be small there.
    fn merit(&self, index: usize) -> (bool, f64) {
        let pieces = &self.seen[index].pieces;
        (pieces.met, if pieces.met { pieces.cost.value } else { pieces.excess() })
    }

    /// The places with a tangent within so many radii of the best, the newest first.
    fn near(&self, radii: f64) -> impl Iterator<Item = &Seen> {
        let centre = &self.seen[self.centre].place;
        // Places that were put on the border of the ball count, whatever rounding has made of their distance.
        let within = radii * self.radius * (1.0 + 1e-9);
        let near = move |seen: &&Seen| distance(&seen.place, centre) <= within;
        let smooth = |seen: &&Seen| seen.pieces.have_tangents();
        self.seen.iter().rev().filter(near).filter(smooth)
    }

    /// The place of the best step for the tangents, and how much it is told to gain.
    fn step(&self) -> Option<(Vec<f64>, f64)> {
        let Seen { place, pieces } = &self.seen[self.centre];
        let (met, worst) = self.merit(self.centre);
        let mut model = Model::new(place, self.radius, worst);
        let kept = KEPT * (self.dimensions() + 1);
        // From twice as far as the step may go, so that a ball that was halved keeps the tangents it had. The centre
        // may be older than those that are kept, and is never left out: without it a step could be promised a gain
        // where there is none.
        let near = self.near(2.0).take(kept).chain([&self.seen[self.centre]]);
        for seen in near {
            if met {
                model.add(Cut::Cost, &seen.pieces.cost, worst, &seen.place);
            }
            let cut = if met { Cut::Limit } else { Cut::Cost };
            for (piece, here) in seen.pieces.limits.iter().zip(&pieces.limits) {
                model.add(cut, piece, here.value, &seen.place);
            }
        }
        model.step()
    }
}

impl Pieces {
    /// Whether any piece has a tangent.
    fn have_tangents(&self) -> bool {
        iter::once(&self.cost).chain(&self.limits).any(|piece| piece.gradient.is_some())
    }

    /// The largest excess over a limit.
    fn excess(&self) -> f64 {
        self.limits.iter().map(|limit| limit.value).fold(0.0, f64::max)
    }
}

/// How much better one merit is than another; infinitely, if it alone keeps to the limits.
fn better((met, value): (bool, f64), (other_met, other): (bool, f64)) -> f64 {
    match (met, other_met) {
        // No cost is worth a limit: a step to a place that keeps to them is taken whatever was told.
        (true, false) => f64::INFINITY,
        (false, true) => f64::NEG_INFINITY,
        _ => other - value,
    }
}

/// The largest difference between two places in any coordinate.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
