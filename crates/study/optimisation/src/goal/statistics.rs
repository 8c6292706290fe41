//! Checks the statistics over samples in a goal: quantiles and yields.
//!
//! A statistic needs deviations, i.e. a section `[tolerance]`.

use ranking::{Goal, Relation};
use results::columns::{Cell, design_columns, measure_of, name};
use results::{Column, DesignResult, DesignRow, FlexureResult, Outcome, PunctureResult, QUANTILES};
use sweep::{InvalidDefinition, Sweep};

use super::refusal::{no_effect, not_accepted};
use super::section::{GoalSection, Written};
use crate::statistic::Statistic;

/// End of the error for a statistic in a goal without deviations: the text after "expected".
const DEVIATIONS: &str = "a section [tolerance], e.g. gap_over_t = { batch_sd = 0.02 }";
/// End of the error for a statistic in a goal with deviations and a section `[imperfection]`.
const ONE_SCATTER: &str =
    "scatter from scale to scale as scale_sd in [tolerance], without [imperfection]";

/// Returns the error for a statistic that cannot be computed for the designs of `sweep`.
///
/// `None` if the statistic can be computed, or if the column is not a statistic.
pub(super) fn unavailable(named: &Written, sweep: &Sweep) -> Option<InvalidDefinition> {
    let Written { column, key, location } = *named;
    let statistic = Statistic::named(column)?;
    let is_column = design_columns(sweep).iter().any(|known| known.name == column);
    let expected = match (sweep.deviations().is_empty(), sweep.is_imperfect(), statistic) {
        (true, ..) | (false, true, _) if is_column => return None,
        (true, ..) => DEVIATIONS.to_owned(),
        (false, true, _) => ONE_SCATTER.to_owned(),
        (false, false, Statistic::Yield) => return None,
        (false, false, Statistic::Quantile { column, .. }) => not_of_numbers(&column, sweep)?,
    };
    Some(not_accepted(location, key, column, expected))
}

/// Returns the text that describes accepted names, if a quantile of `column` is not accepted.
///
/// `None` if the column has numbers, so that its quantiles exist.
fn not_of_numbers(column: &str, sweep: &Sweep) -> Option<String> {
    let columns = design_columns(sweep);
    let Some(known) = columns.iter().find(|known| known.name == column) else {
        let names: Vec<&str> = columns.iter().map(|known| known.name.as_ref()).collect();
        let is_asked =
            |name: &&&str| measure_of(name).is_some_and(|m| sweep.measures().contains(&m));
        let asked = names.iter().find(is_asked).copied();
        let near = text::nearest(column, &names).or(asked).unwrap_or(name::COVERAGE);
        return Some(format!("a quantile of a column of designs.csv, e.g. {}", quantiles(near)));
    };
    let is_measured = measure_of(column).is_none_or(|m| sweep.measures().contains(&m));
    if !is_measured {
        return Some("a quantile of a column of the requested `measures`".to_owned());
    }
    holds_text(known, sweep).then(|| {
        format!("a quantile of a column of numbers, e.g. {}", quantiles(name::CRITICAL_FORCE))
    })
}

/// Lists the names of the quantiles of a column, separated by commas.
fn quantiles(column: &str) -> String {
    QUANTILES.map(|(ending, _)| format!("{column}_{ending}")).join(", ")
}

/// Returns true if a column contains text.
///
/// The column is evaluated for a design without paths.
fn holds_text(column: &Column<DesignRow>, sweep: &Sweep) -> bool {
    let (number, case) = (sweep.grid().number(0), sweep.grid().case(0));
    let result = DesignResult {
        puncture: Some(PunctureResult::without_path(Outcome::Internal)),
        flexure: Some(FlexureResult::without_path(Outcome::Internal)),
        ..DesignResult::default()
    };
    matches!(column.cell(&DesignRow { number, case, result }), Cell::Text(_))
}

/// Suggests the quantiles of a column for a wrong name such as `critical_force_p5`.
///
/// `None` if `column` does not look like a quantile of one of the `known` columns.
pub(super) fn nearly(column: &str, known: &[&str]) -> Option<String> {
    let (base, ending) = column.rsplit_once("_p")?;
    let is_nearly = known.contains(&base) && ending.starts_with(|c: char| c.is_ascii_digit());
    is_nearly.then(|| format!("one of the quantiles {}", quantiles(base)))
}

/// Returns errors for invalid keys of statistics.
///
/// These are bounds on the yield that are not minimum fractions, a yield to be minimised, a yield
/// without requirements on columns, and a number of samples without a statistic.
pub(super) fn meaningless_keys(goal: &GoalSection) -> Vec<InvalidDefinition> {
    let mut refused = Vec::new();
    for (requirement, location) in &goal.requirements {
        let is_bound = matches!(requirement.relation, Relation::AtLeast | Relation::Above);
        let is_share = requirement.limit > 0.0 && requirement.limit <= 1.0;
        let is_strict = requirement.relation == Relation::Above && requirement.limit >= 1.0;
        if requirement.column == Statistic::YIELD && (!is_bound || !is_share || is_strict) {
            let expected = "the minimum fraction of samples, at most 1, e.g. yield >= 0.9";
            refused.push(not_accepted(location, "goal.require", requirement, expected));
        }
    }
    for (criterion, location) in &goal.objectives {
        if criterion.column == Statistic::YIELD && criterion.goal == Goal::Minimize {
            refused.push(not_accepted(location, "goal.minimize", "yield", "yield in maximize"));
        }
    }
    let has_bounds = goal.requirements.iter().any(|(r, _)| Statistic::named(&r.column).is_none());
    let mut yields = goal.columns().filter(|named| named.column == Statistic::YIELD && !has_bounds);
    refused.extend(yields.next().map(|Written { column, key, location }| {
        let expected = "also a requirement on the samples, e.g. \"coverage >= 0.5\"";
        not_accepted(location, key, column, expected)
    }));
    let is_sampled = goal.columns().any(|named| Statistic::named(named.column).is_some());
    if let Some(location) = goal.skins_location.as_ref().filter(|_| !is_sampled) {
        let reason = "the goal names no yield or quantile";
        refused.push(no_effect(location, "goal.skins", reason));
    }
    refused
}
