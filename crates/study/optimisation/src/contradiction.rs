//! Requirements that the checks of a best design contradict.
//!
//! A best design may meet a requirement in the fast model of the search, but miss the requirement
//! in a check with a finer model. With `confirm = true` the search then tightens the limit `l` of
//! the requirement by the ratio of the value of the search to the value of the check, and
//! continues:
//!
//! ```text
//! l ← l · v_search/v_check                                                               (O10)
//! ```

use std::fmt;

use ranking::Requirement;
use results::Outcome;
use results::columns::is_invalid_after_fold;
use text::number;

use crate::best::BestDesign;
use crate::checks::Check;
use crate::column::NumberColumn;
use crate::goal::DesignGoal;

/// Safety factor by which a limit is tightened further.
///
/// The ratio of the values of both models is slightly different at the next best design.
const SAFETY: f64 = 1.005;

/// A requirement that a check contradicts.
#[derive(Clone, Debug, PartialEq)]
pub struct Contradiction {
    /// Check that contradicts the requirement.
    pub check: Check,
    /// Contradicted requirement.
    pub requirement: Requirement,
    /// Value of the required column in the model of the search.
    pub searched: Option<f64>,
    /// Value of the required column in the check; `None` without a valid value.
    pub value: Option<f64>,
}

impl BestDesign {
    /// Returns the requirements of `goal` that a check contradicts.
    pub fn contradictions(&self, goal: &DesignGoal) -> Vec<Contradiction> {
        let mut all = Vec::new();
        for requirement in &goal.requirements {
            let column = NumberColumn::named(goal.space.sweep(), &requirement.column);
            let searched = column.and_then(|column| column.value(&self.row));
            // Prefer the check at other load positions: it includes full substrate coupling.
            let checked = self.elsewhere(requirement).or_else(|| self.coupled(requirement));
            if let Some((check, value)) = checked
                && !value.is_some_and(|value| requirement.is_met(value))
            {
                let requirement = requirement.clone();
                all.push(Contradiction { check, requirement, searched, value });
            }
        }
        let Some(confirmation) = &self.confirmation else { return all };
        // If the confidence interval from the new samples contains values that meet a requirement,
        // the new samples do not contradict this requirement.
        let broken =
            confirmation.broken.iter().filter(|requirement| !confirmation.is_open(requirement));
        all.extend(broken.map(|requirement| {
            let estimate = confirmation.estimate(&requirement.column);
            Contradiction {
                check: Check::Samples(confirmation.fresh),
                requirement: requirement.clone(),
                searched: estimate.and_then(|of| of.seen),
                value: estimate.and_then(|of| of.value),
            }
        }));
        all
    }

    /// Returns the check with full substrate coupling, and its value of the required column.
    ///
    /// `None` if this check did not compute the column. The value is `None` if it is not valid.
    fn coupled(&self, requirement: &Requirement) -> Option<(Check, Option<f64>)> {
        let change = self.checks.coupling.as_ref()?;
        let measure = change.measures.iter().find(|m| m.column == requirement.column)?;
        // Some columns are not valid after the surface has folded.
        let is_valid = !(change.folds && is_invalid_after_fold(&requirement.column));
        Some((Check::Coupling, measure.full.filter(|_| is_valid)))
    }

    /// Returns the check at several load positions, and the force at the weakest position.
    ///
    /// `None` unless the requirement is a lower limit of a force that was computed at several load
    /// positions.
    fn elsewhere(&self, requirement: &Requirement) -> Option<(Check, Option<f64>)> {
        let weakest = self.checks.places.iter().find(|of| of.column == requirement.column)?;
        let is_lower_limit = requirement.direction() > 0.0;
        let check = if weakest.load_position == self.row.case.punctured().load_position {
            Check::Coupling
        } else {
            Check::LoadPositions(weakest.load_position, weakest.outcome)
        };
        is_lower_limit.then_some((check, weakest.weakest))
    }
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { check, requirement, value, .. } = self;
        let column = &requirement.column;
        match (value, check) {
            (Some(value), _) => write!(f, "{check}, {column} is {}", number::rounded(*value, 5))?,
            (None, Check::LoadPositions(_, outcome)) if *outcome != Outcome::Complete => {
                write!(f, "{check}, {column} has no valid value ({outcome})")?;
            }
            (None, _) => write!(f, "{check}, {column} has no valid value")?,
        }
        write!(f, ", which misses {requirement}")
    }
}

/// Tightens those requirements of `limits` that the checks of the design `best` contradict.
///
/// `limits` is the goal of the search, `goal` has the limits of the user. Returns true if a limit
/// changed.
pub(crate) fn tighten(limits: &mut DesignGoal, goal: &DesignGoal, best: &BestDesign) -> bool {
    let contradictions = best.contradictions(goal);
    let mut is_tighter = false;
    for (tightened, stated) in limits.requirements.iter_mut().zip(&goal.requirements) {
        let mut ratios = Vec::new();
        for Contradiction { check, requirement, searched, value } in &contradictions {
            // Ignore the check with new samples: the model is the same as in the search, so the
            // ratio of the values is not a ratio of two models.
            let is_finer = requirement == stated && !matches!(check, Check::Samples(_));
            if let (true, Some(searched), Some(value)) = (is_finer, searched, value) {
                ratios.extend(Some(searched / value).filter(|r| r.is_finite() && *r > 0.0));
            }
        }
        if ratios.is_empty() {
            continue;
        }
        let safety = if stated.direction() > 0.0 { SAFETY } else { SAFETY.recip() };
        let limit = stated.limit * ratios.iter().product::<f64>() * safety;
        if tightened.is_met(limit) && limit != tightened.limit {
            tightened.limit = limit;
            is_tighter = true;
        }
    }
    is_tighter
}
