//! Problem that a gradient search or ridge search solves.
//!
//! The variables are fractions of the intervals. The cost is minimised. Cost and limits have values
//! of about 1.

use std::cell::RefCell;
use std::iter;

use ranking::Worth;
use results::DesignResult;
use sweep::{Measure, Parameter};

use super::{LocalSearch, bound_size};
use crate::candidate::{Merit, SearchStage};
use crate::contact_margin::{contact_margin, contact_margin_slopes};
use crate::coverage_piece::{CoveragePiece, continue_compliance};
use crate::evaluated_row::EvaluatedRow;
use crate::evaluations::Halt;
use crate::judgement::Judgement;
use crate::slopes::Slopes;

/// Length of a step at which a gradient search ends, as a fraction of the ranges of the variables.
///
/// Near a smooth optimum the next step would be far shorter. At a kink all further steps would be
/// as short.
const SHORTEST_STEP: f64 = 1e-7;

/// Length of a step, as a fraction of the ranges, below which a search may end as hopeless.
///
/// It ends if such steps cannot reach the best known merit, see [`HOPELESS`].
const SHORT_STEP: f64 = 1e-4;

/// Ratio of the distance from the best known merit to the gain of the last step.
///
/// A search with a larger ratio and short steps is hopeless.
const HOPELESS: f64 = 10.0;

/// Slack (O2) that a search among strips without contact keeps before first contact.
///
/// A gradient search may exceed its limits by about 1e-9, and the compliance jumps at contact.
pub(crate) const CLEAR: f64 = 1e-7;

/// Function that converts the objective to a cost of about 1.
#[derive(Clone, Copy)]
enum CostScale {
    /// Logarithm of a positive objective, which may vary by powers of ten.
    Logarithm,
    /// Objective divided by this size, for an objective that is not positive.
    Linear(f64),
}

impl CostScale {
    /// Returns the cost for an objective `value` to be minimised, and the derivative of the cost.
    fn cost(self, value: f64) -> (f64, f64) {
        match self {
            Self::Logarithm if value > 0.0 => (value.ln(), value.recip()),
            Self::Logarithm => (f64::NEG_INFINITY, f64::NAN),
            Self::Linear(size) => {
                let size = if size > 0.0 { size } else { 1.0 };
                (value / size, size.recip())
            }
        }
    }
}

/// Returns true if the scales have no contact at the end of bending.
fn is_open(result: &DesignResult) -> bool {
    result.flexure.is_some_and(|flexure| flexure.measures.contact == Some(false))
}

/// Problem of a gradient search or ridge search from the best design of a local search.
pub(super) struct LocalProblem<'a> {
    local: &'a LocalSearch<'a>,
    stage: SearchStage,
    scale: CostScale,
    /// True if the search is restricted to designs without contact in bending.
    ///
    /// The compliance jumps at contact, which derivatives do not show.
    stays_open: bool,
    /// Coverage branch to which the search is restricted.
    piece: Option<CoveragePiece>,
    /// True if the last variable is the largest shortfall, which is also the cost (O9).
    ///
    /// The last variable relaxes requirements and lower bounds of objectives.
    pub is_elastic: bool,
    /// Fractions and merit at the last evaluation; `None` before the first one.
    last: RefCell<Option<(Vec<f64>, Merit)>>,
    /// Lower bounds of the variables.
    pub lower: Vec<f64>,
    /// Upper bounds of the variables.
    pub upper: Vec<f64>,
}

/// An evaluated design with a valid judgement.
pub(super) struct EvaluatedPoint {
    pub worth: Worth,
    pub row: EvaluatedRow,
    /// True if the design is feasible.
    pub met: bool,
}

impl<'a> LocalProblem<'a> {
    /// Creates the problem for the best design of the local search `local`.
    ///
    /// `missed` is the largest shortfall of this design, if the shortfall is to be minimised (O9).
    /// `None` if the design has no valid judgement.
    pub fn new(
        local: &'a LocalSearch<'a>,
        stage: SearchStage,
        piece: Option<CoveragePiece>,
        missed: Option<f64>,
    ) -> Option<Self> {
        let best = local.best.borrow();
        let Judgement::Judged(worth) = &best.verdict else { return None };
        let value = worth.objectives[local.target.objective];
        let count = best.point.fractions.len();
        Some(Self {
            local,
            stage,
            // The scale stays the same during the search, because costs on different scales cannot
            // be compared.
            scale: if value > 0.0 { CostScale::Logarithm } else { CostScale::Linear(value.abs()) },
            stays_open: local.search.judge.depends_on(Measure::Flexure) && is_open(&best.result),
            piece,
            is_elastic: missed.is_some(),
            last: RefCell::default(),
            lower: vec![0.0; count + usize::from(missed.is_some())],
            // The shortfall may not exceed its initial value.
            upper: iter::repeat_n(1.0, count).chain(missed).collect(),
        })
    }

    /// Evaluates the design at the fractions `shares` of the intervals, with derivatives.
    ///
    /// `None` if the design has no valid judgement.
    pub fn evaluate(&self, shares: &[f64]) -> Result<Option<EvaluatedPoint>, Halt> {
        let shares = &shares[..self.local.search.space.intervals().len()];
        let (mut candidate, mut row) = self.local.at(self.stage, shares, true)?;
        // Judge feasibility before values are continued beyond a border: a continued value may meet
        // a limit that the design misses.
        let merit = self.local.search.merit(&candidate, self.local.target);
        let met = matches!(merit, Merit::Met(_));
        self.end_if_stalled(shares, merit)?;
        if let Some(piece) = self.piece {
            piece.continue_coverage(&mut row.nominal);
        }
        if self.stays_open {
            continue_compliance(&mut row.nominal);
        }
        // Judge the design again by the continued values. Samples have no continued values.
        if self.local.search.judge.samples().is_none() && (self.piece.is_some() || self.stays_open)
        {
            candidate.verdict = self.local.search.judge.verdict(&row.nominal);
        }
        let Judgement::Judged(worth) = candidate.verdict else { return Ok(None) };
        Ok(Some(EvaluatedPoint { worth, row, met }))
    }

    /// Returns `Halt::Stalled` if another step of a gradient search is useless.
    ///
    /// `merit` is the merit of the design at `shares`.
    fn end_if_stalled(&self, shares: &[f64], merit: Merit) -> Result<(), Halt> {
        // The ridge search ends when its radius is small enough, so its last steps are short.
        if self.stage != SearchStage::Gradient {
            return Ok(());
        }
        let last = self.last.replace(Some((shares.to_vec(), merit)));
        let Some((last, before)) = last else { return Ok(()) };
        // SLSQP requests cost, gradient and limits at one point in succession. A step is a change
        // of the point.
        if last == shares {
            return Ok(());
        }
        let step = last.iter().zip(shares).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let is_hopeless = step < SHORT_STEP && self.is_far_behind(before, merit);
        if step < SHORTEST_STEP || is_hopeless { Err(Halt::Stalled) } else { Ok(()) }
    }

    /// Returns true if steps such as the last one cannot reach the merit to beat.
    ///
    /// The last step has changed the merit from `before` to `after`.
    fn is_far_behind(&self, before: Merit, after: Merit) -> bool {
        match (before, after, self.local.to_beat) {
            (Merit::Met(before), Merit::Met(after), Merit::Met(best)) => {
                best - after > HOPELESS * (after - before).abs()
            }
            (Merit::Short(before), Merit::Short(after), Merit::Met(_)) => {
                after > HOPELESS * (after - before).abs()
            }
            _ => false,
        }
    }

    /// Returns the cost of a design; infinite if the cost is undefined.
    pub fn cost_of(&self, worth: &Worth) -> f64 {
        let objective = self.local.target.objective;
        let sign = self.local.search.judge.sign(objective);
        let cost = -sign * self.scale.cost(worth.objectives[objective]).0;
        // An undefined logarithm means an infinite cost, whether the objective is maximised or
        // minimised.
        if cost.is_finite() { cost } else { f64::INFINITY }
    }

    /// Returns the last variable if it is the largest shortfall (O9); otherwise `None`.
    pub fn missed(&self, shares: &[f64]) -> Option<f64> {
        shares.last().copied().filter(|_| self.is_elastic)
    }

    /// Returns the number of requirements and lower bounds of objectives.
    ///
    /// In the list of all limits, these limits are the first.
    pub fn asked_count(&self) -> usize {
        self.local.search.judge.requirements().count() + self.local.target.lower_bounds.len()
    }

    /// Returns the number of limits.
    ///
    /// Limits are requirements, lower bounds of objectives, borders of the coverage branch, and the
    /// slack before contact, in this order.
    pub fn limit_count(&self) -> usize {
        let borders = self.piece.map_or(0, |_| CoveragePiece::BORDERS);
        self.asked_count() + borders + usize::from(self.stays_open)
    }

    /// Returns the excess over each limit; at most 0 if the limit is met.
    pub fn limits(&self, evaluated: &EvaluatedPoint) -> Vec<f64> {
        let EvaluatedPoint { worth, row, .. } = evaluated;
        // The order must match `limit_gradient`.
        let contact = self.stays_open.then(|| CLEAR - contact_margin(&row.nominal.case));
        let borders = self.borders();
        let borders = borders.filter_map(|(piece, border)| piece.beyond(border, &row.nominal.case));
        let bounds = self.local.target.lower_bounds.iter().map(|&(k, bound)| {
            let signed = self.local.search.judge.sign(k) * worth.objectives[k];
            (bound - signed) / bound_size(bound)
        });
        worth
            .margins
            .iter()
            .map(|margin| -margin)
            .chain(bounds)
            .chain(borders)
            .chain(contact)
            .collect()
    }

    /// Returns the coverage branch with the index of each border; empty without a branch.
    fn borders(&self) -> impl Iterator<Item = (CoveragePiece, usize)> {
        self.piece
            .into_iter()
            .flat_map(|piece| (0..CoveragePiece::BORDERS).map(move |k| (piece, k)))
    }

    /// Computes the gradient of the cost with respect to the fractions of the intervals.
    ///
    /// `pick` selects one of the one-sided slopes at a kink. `None` if a slope is missing.
    pub fn cost_gradient(
        &self,
        shares: &[f64],
        evaluated: &EvaluatedPoint,
        pick: Pick,
    ) -> Option<Vec<f64>> {
        let (judge, objective) = (self.local.search.judge, self.local.target.objective);
        let rate = self.scale.cost(evaluated.worth.objectives[objective]).1;
        let slopes =
            |p: &Parameter| judge.objective_slopes(objective, &evaluated.row, p).scaled(rate);
        self.falling(shares, slopes, pick)
    }

    /// Computes the gradient of the excess over limit `k`.
    ///
    /// See [`Self::cost_gradient`] for `pick` and `None`.
    pub fn limit_gradient(
        &self,
        k: usize,
        shares: &[f64],
        evaluated: &EvaluatedPoint,
        pick: Pick,
    ) -> Option<Vec<f64>> {
        let (judge, row) = (self.local.search.judge, &evaluated.row);
        let required = judge.requirements().count();
        if k < required {
            return self.falling(shares, |p| judge.margin_slopes(k, row, p), pick);
        }
        let bounds = &self.local.target.lower_bounds;
        if let Some((piece, border)) =
            (k - required).checked_sub(bounds.len()).and_then(|k| self.borders().nth(k))
        {
            return self.falling(
                shares,
                |p| piece.border_slopes(border, &row.nominal.case, p),
                pick,
            );
        }
        match bounds.get(k - required) {
            Some(&(objective, bound)) => {
                let size = bound_size(bound).recip();
                self.falling(
                    shares,
                    |p| judge.objective_slopes(objective, row, p).scaled(size),
                    pick,
                )
            }
            None => self.falling(shares, |p| contact_margin_slopes(&row.nominal.case, p), pick),
        }
    }

    /// Computes the negative gradient of a quantity with respect to the fractions of the intervals.
    ///
    /// `slopes` returns the one-sided derivatives of the quantity. At an end of an interval the
    /// slope towards the inside is used; elsewhere `pick` selects the slope.
    pub fn falling(
        &self,
        shares: &[f64],
        slopes: impl Fn(&Parameter) -> Slopes,
        pick: Pick,
    ) -> Option<Vec<f64>> {
        let intervals = self.local.search.space.intervals().iter().zip(shares);
        let falling = intervals.map(|(interval, share)| {
            let Slopes { left, right } = slopes(interval.parameter);
            let slope = match *share {
                share if share <= 0.0 => right.or(left),
                share if share >= 1.0 => left.or(right),
                _ => pick(Slopes { left, right }),
            };
            slope.map(|slope| -slope * interval.length())
        });
        falling.collect()
    }
}

/// Function that selects a slope from the one-sided slopes of a quantity to be maximised.
pub(super) type Pick = fn(Slopes) -> Option<f64>;
