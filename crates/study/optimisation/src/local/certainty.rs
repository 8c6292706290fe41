//! Proves by derivatives that a design is a local optimum.
//!
//! At an optimum the gradients of the binding limits balance the gradient of the objective (O1). By
//! weak duality, the linearised objective can then increase at most by `Σ μ_k (g_k − l_k)`, the sum
//! of multipliers times remaining margins. If this sum is negligible and no value has a kink, ridge
//! search and derivative-free search cannot improve the design.

use super::LocalSearch;
use crate::candidate::{Candidate, Merit, SearchStage};
use crate::contact_margin::{contact_margin, contact_margin_slopes};
use crate::evaluations::Halt;
use crate::price::first_order_gain;
use crate::space::SpacePoint;

/// Largest first-order gain at which an optimum counts as proven, relative to the objective.
const GAIN: f64 = 1e-8;

/// Slack (O2), with changed sign, of the design that is evaluated just beyond first contact.
const BEHIND: f64 = 1e-4;

/// Relative shortfall up to which the design just beyond first contact counts as feasible.
const NEARLY: f64 = 1e-2;

impl LocalSearch<'_> {
    /// Returns true if derivatives prove that the best design is a local optimum.
    pub(super) fn is_certain(&self) -> Result<bool, Halt> {
        let (search, best) = (self.search, self.best.borrow().clone());
        // Statistics over samples are not smooth.
        if search.judge.samples().is_some() || !matches!(self.best_merit(), Merit::Met(_)) {
            return Ok(false);
        }
        // The result is already stored, because the gradient search has evaluated its last design.
        let (_, row) = self.evaluate(SearchStage::Gradient, &best.point, true)?;
        match first_order_gain(search, &best, &row, self.target) {
            Some((gain, is_beside_contact)) if gain <= GAIN => {
                Ok(!is_beside_contact || self.ends_at_contact(&best)?)
            }
            _ => Ok(false),
        }
    }

    /// Returns true if the design just beyond first contact in bending is not feasible.
    ///
    /// The compliance jumps at first contact. If the design beyond the jump is still feasible,
    /// designs with contact may be as good as `best`. Returns false if there is no such design.
    fn ends_at_contact(&self, best: &Candidate) -> Result<bool, Halt> {
        let Some(behind) = self.behind_contact(best) else { return Ok(false) };
        let candidate = self.evaluate(SearchStage::Polish, &behind, false)?.0;
        self.note(&candidate);
        let merit = self.search.merit_within(&candidate, self.target, NEARLY);
        Ok(!matches!(merit, Merit::Met(_)))
    }

    /// Returns the nearest point at which scales barely touch at the end of bending.
    ///
    /// `None` if there is no such point in the space.
    fn behind_contact(&self, best: &Candidate) -> Option<SpacePoint> {
        let case = self.search.space.case(&best.point);
        let intervals = self.search.space.intervals();
        let slopes = intervals.iter().map(|interval| {
            let slopes = contact_margin_slopes(&case, interval.parameter);
            Some(slopes.left.or(slopes.right)? * interval.length())
        });
        let slopes: Vec<f64> = slopes.collect::<Option<_>>()?;
        let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
        let fall = (contact_margin(&case) + BEHIND) / square;
        let moved = best.point.fractions.iter().zip(&slopes);
        let shares = moved.map(|(share, slope)| (share - fall * slope).clamp(0.0, 1.0)).collect();
        let behind = SpacePoint { fractions: shares, chosen: best.point.chosen.clone() };
        let is_behind = contact_margin(&self.search.space.case(&behind)) < 0.0;
        is_behind.then_some(behind)
    }
}
