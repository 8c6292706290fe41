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

/// Safety factor on a tightened limit.
///
/// The ratio of the values of both models will be different at the next best design.
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
        let Some(made) = &self.confirmation else { return all };
        // If the new samples cannot decide whether a requirement is met, only the text states so.
        let broken = made.broken.iter().filter(|requirement| !made.is_open(requirement));
        all.extend(broken.map(|requirement| {
            let estimate = made.estimate(&requirement.column);
            Contradiction {
                check: Check::Samples(made.fresh),
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

    /// Returns the check at the weakest load position, and the force there.
    ///
    /// `None` unless the requirement is a lower limit of a force that was computed at several load
    /// positions.
    fn elsewhere(&self, requirement: &Requirement) -> Option<(Check, Option<f64>)> {
        let weakest = self.checks.places.iter().find(|of| of.column == requirement.column)?;
        let is_lower_limit = requirement.direction() > 0.0;
        let check = if weakest.place == self.row.case.punctured().load_position {
            Check::Coupling
        } else {
            Check::Places(weakest.place, weakest.outcome)
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
            (None, Check::Places(_, outcome)) if *outcome != Outcome::Complete => {
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
    for (own, meant) in limits.requirements.iter_mut().zip(&goal.requirements) {
        let mut ratios = Vec::new();
        for Contradiction { check, requirement, searched, value } in &contradictions {
            // New samples are no finer model: the search judges its samples by the same limits.
            let is_finer = requirement == meant && !matches!(check, Check::Samples(_));
            if let (true, Some(searched), Some(value)) = (is_finer, searched, value) {
                ratios.extend(Some(searched / value).filter(|r| r.is_finite() && *r > 0.0));
            }
        }
        if ratios.is_empty() {
            continue;
        }
        let safety = if meant.direction() > 0.0 { SAFETY } else { SAFETY.recip() };
        let limit = meant.limit * ratios.iter().product::<f64>() * safety;
        if own.is_met(limit) && limit != own.limit {
            own.limit = limit;
            is_tighter = true;
        }
    }
    is_tighter
}
