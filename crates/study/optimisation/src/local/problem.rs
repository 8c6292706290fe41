//! The problem of a local search along derivatives: a cost that is to be small and limits, both about 1 in size, over shares of the
//! intervals.

use std::cell::RefCell;
use std::iter;

use ranking::Worth;
use results::DesignResult;
use sweep::{Measure, Parameter};

use super::{LocalSearch, floor_size};
use crate::candidate::{Merit, SearchStage};
use crate::contact_margin::{contact_margin, contact_margin_slopes};
use crate::coverage_piece::{CoveragePiece, continue_compliance};
use crate::evaluated_row::EvaluatedRow;
use crate::evaluations::Halt;
use crate::judgement::Judgement;
use crate::slopes::Slopes;

/// A step that hardly moves, a share of the intervals.
const STILL: f64 = 1e-7;

/// Such steps in a row that end a climb.
const STALLED: usize = 3;

/// Room that is kept before scales touch in bending: a climb ends up to some 1e-9 beyond its limits, and beyond this one compliance is lost
/// at once.
const CLEAR: f64 = 1e-7;

/// How an objective becomes a cost of about 1 in size.
#[derive(Clone, Copy)]
enum CostScale {
    /// Its logarithm: objectives vary by powers of ten.
    Logarithm,
    /// Over a size, where it is not above 0.
    Linear(f64),
}

impl CostScale {
    /// The cost of a value, and its derivative, for one that is to be small.
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

/// Whether bending brings no scales into contact.
fn is_open(result: &DesignResult) -> bool {
    result.flexure.is_some_and(|flexure| flexure.measures.contact == Some(false))
}

/// The problem of a local search from its best design.
pub(super) struct LocalProblem<'a> {
    walk: &'a LocalSearch<'a>,
    stage: SearchStage,
    scale: CostScale,
    /// Whether the search stays where bending brings no scales into contact: compliances jump where it does, and no derivative tells.
    stays_open: bool,
    /// The piece of coverage in which the search stays.
    piece: Option<CoveragePiece>,
    /// Whether the shares end with one more variable, by which requirements and floors may be missed, and which is the cost (O9).
    pub is_elastic: bool,
    /// Where it looked last, and how often in a row it has hardly moved.
    still: RefCell<(Vec<f64>, usize)>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
}

/// A design that can be judged.
pub(super) struct EvaluatedPoint {
    pub worth: Worth,
    pub row: EvaluatedRow,
    /// Whether it meets everything.
    pub met: bool,
}

impl<'a> LocalProblem<'a> {
    /// The problem from the best design of `walk`, elastic if that misses something by `missed`; none if it cannot be judged.
    pub fn new(
        walk: &'a LocalSearch<'a>,
        stage: SearchStage,
        piece: Option<CoveragePiece>,
        missed: Option<f64>,
    ) -> Option<Self> {
        let best = walk.best.borrow();
        let Judgement::Judged(worth) = &best.verdict else { return None };
        let value = worth.objectives[walk.target.objective];
        let count = best.point.shares.len();
        Some(Self {
            walk,
            stage,
            // Chosen at the start for the whole search, or costs of two places had no order.
            scale: if value > 0.0 { CostScale::Logarithm } else { CostScale::Linear(value.abs()) },
            stays_open: walk.search.judge.is_about(Measure::Flexure) && is_open(&best.result),
            piece,
            is_elastic: missed.is_some(),
            still: RefCell::default(),
            lower: vec![0.0; count + usize::from(missed.is_some())],
            // Nobody goes where more is missed than at the start.
            upper: iter::repeat_n(1.0, count).chain(missed).collect(),
        })
    }

    /// The design at some shares, with its derivatives.
    pub fn evaluate(&self, shares: &[f64]) -> Result<Option<EvaluatedPoint>, Halt> {
        let shares = &shares[..self.walk.search.space.intervals().len()];
        let (mut candidate, mut row) = self.walk.at(self.stage, shares, true)?;
        // Of the design as it is: continued beyond a border it may keep limits that it breaks.
        let met = matches!(self.walk.search.merit(&candidate, self.walk.target), Merit::Met(_));
        self.end_if_stalled(shares)?;
        if let Some(piece) = self.piece {
            piece.continue_coverage(&mut row.nominal);
            if self.stays_open {
                continue_compliance(&mut row.nominal);
            }
            candidate.verdict = self.walk.search.judge.verdict(&row.nominal);
        }
        let Judgement::Judged(worth) = candidate.verdict else { return Ok(None) };
        Ok(Some(EvaluatedPoint { worth, row, met }))
    }

    /// Ends a climb that does not move any more: at a kink, steps along derivatives become ever smaller.
    fn end_if_stalled(&self, shares: &[f64]) -> Result<(), Halt> {
        let (last, count) = &mut *self.still.borrow_mut();
        // The cost, the gradient and the limits at one place are no steps.
        if last.as_slice() == shares {
            return Ok(());
        }
        // The largest of all intervals: a climb that still moves in one has not come to its end.
        let step = last.iter().zip(shares).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        *count = if !last.is_empty() && step < STILL { *count + 1 } else { 0 };
        shares.clone_into(last);
        // A search along ridges ends by its radius, and in its smallest ball every step is a small one.
        if *count >= STALLED && self.stage == SearchStage::Gradient {
            Err(Halt::Stalled)
        } else {
            Ok(())
        }
    }

    /// The cost, to be small; infinite where there is none.
    pub fn cost_of(&self, worth: &Worth) -> f64 {
        let objective = self.walk.target.objective;
        let sign = self.walk.search.judge.sign(objective);
        let cost = -sign * self.scale.cost(worth.objectives[objective]).0;
        // A logarithm that does not exist is no way to go, whichever sign is good.
        if cost.is_finite() { cost } else { f64::INFINITY }
    }

    /// By how much a requirement or a floor may be missed at some shares.
    pub fn missed(&self, shares: &[f64]) -> Option<f64> {
        shares.last().copied().filter(|_| self.is_elastic)
    }

    /// The number of requirements and floors, which come first among the limits.
    pub fn asked_count(&self) -> usize {
        self.walk.search.judge.requirements().count() + self.walk.target.floors.len()
    }

    /// The number of limits: requirements, floors, borders of the piece, and room in bending.
    pub fn limit_count(&self) -> usize {
        let borders = self.piece.map_or(0, |_| CoveragePiece::BORDERS);
        self.asked_count() + borders + usize::from(self.stays_open)
    }

    /// How far a design is beyond each limit; not above 0 where it keeps to it.
    pub fn limits(&self, evaluated: &EvaluatedPoint) -> Vec<f64> {
        let EvaluatedPoint { worth, row, .. } = evaluated;
        // In the order in which `limit_gradient` numbers them.
        let contact = self.stays_open.then(|| CLEAR - contact_margin(&row.nominal.case));
        let borders = self.borders();
        let borders = borders.filter_map(|(piece, border)| piece.beyond(border, &row.nominal.case));
        let turned = |k: usize| self.walk.search.judge.sign(k) * worth.objectives[k];
        let floors = self.walk.target.floors.iter();
        let floors = floors.map(|&(k, floor)| (floor - turned(k)) / floor_size(floor));
        worth
            .margins
            .iter()
            .map(|margin| -margin)
            .chain(floors)
            .chain(borders)
            .chain(contact)
            .collect()
    }

    /// The borders of the piece.
    fn borders(&self) -> impl Iterator<Item = (CoveragePiece, usize)> {
        self.piece
            .into_iter()
            .flat_map(|piece| (0..CoveragePiece::BORDERS).map(move |k| (piece, k)))
    }

    /// The gradient of the cost, made of the slopes that are picked.
    pub fn cost_gradient(
        &self,
        shares: &[f64],
        evaluated: &EvaluatedPoint,
        pick: Pick,
    ) -> Option<Vec<f64>> {
        let (judge, objective) = (self.walk.search.judge, self.walk.target.objective);
        let rate = self.scale.cost(evaluated.worth.objectives[objective]).1;
        let slopes =
            |p: &Parameter| judge.objective_slopes(objective, &evaluated.row, p).scaled(rate);
        self.falling(shares, slopes, pick)
    }

    /// The gradient of limit `k`, made of the slopes that are picked.
    pub fn limit_gradient(
        &self,
        k: usize,
        shares: &[f64],
        evaluated: &EvaluatedPoint,
        pick: Pick,
    ) -> Option<Vec<f64>> {
        let (judge, row) = (self.walk.search.judge, &evaluated.row);
        let required = judge.requirements().count();
        if k < required {
            return self.falling(shares, |p| judge.margin_slopes(k, row, p), pick);
        }
        let floors = &self.walk.target.floors;
        if let Some((piece, border)) =
            (k - required).checked_sub(floors.len()).and_then(|k| self.borders().nth(k))
        {
            return self.falling(
                shares,
                |p| piece.border_slopes(border, &row.nominal.case, p),
                pick,
            );
        }
        match floors.get(k - required) {
            Some(&(objective, floor)) => {
                let slopes = |p: &Parameter| judge.objective_slopes(objective, row, p);
                let size = floor_size(floor).recip();
                self.falling(shares, |p| slopes(p).scaled(size), pick)
            }
            None => self.falling(shares, |p| contact_margin_slopes(&row.nominal.case, p), pick),
        }
    }

    /// The gradient over shares of the negative of what has these slopes; at the ends of an interval the side within counts.
    fn falling(
        &self,
        shares: &[f64],
        slopes: impl Fn(&Parameter) -> Slopes,
        pick: Pick,
    ) -> Option<Vec<f64>> {
        let intervals = self.walk.search.space.intervals().iter().zip(shares);
        let slope = |(interval, share): (&crate::space::Interval, &f64)| {
            let Slopes { left, right } = slopes(interval.parameter);
            let slope = match *share {
                share if share <= 0.0 => right.or(left),
                share if share >= 1.0 => left.or(right),
                _ => pick(Slopes { left, right }),
            };
            slope.map(|slope| -slope * interval.length())
        };
        intervals.map(slope).collect()
    }
}

/// What is made of the two slopes of a value that is to be large.
pub(super) type Pick = fn(Slopes) -> Option<f64>;
