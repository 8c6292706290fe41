//! What a goal may say of skins that are made: quantiles and yields, which need deviations.

use ranking::{Goal, Relation};
use results::columns::{Cell, design_columns, measure_of};
use results::{Column, DesignResult, DesignRow, FlexureResult, Outcome, PunctureResult, QUANTILES};
use sweep::toml_source::Place;
use sweep::{InvalidDefinition, Sweep};

use super::reader::not_accepted;
use super::section::GoalSection;
use crate::made::MadeQuantity;

const DEVIATIONS: &str = "it beside a [tolerance], e.g. gap_over_t = { batch_sd = 0.02 } there";
const ONE_SCATTER: &str =
    "scatter from scale to scale as scale_sd in [tolerance], without [imperfection]";

/// Why a quantity over skins cannot be had from a sweep; `None` if it can, or `column` is none.
pub(super) fn unavailable(
    column: &str,
    key: &str,
    place: &Place,
    sweep: &Sweep,
) -> Option<InvalidDefinition> {
    let refused = |expected: String| Some(not_accepted(place, key, column, expected));
    let quantity = MadeQuantity::named(column)?;
    let is_column = design_columns(sweep).iter().any(|known| known.name == column);
    match (sweep.deviations().is_empty(), sweep.is_imperfect()) {
        (true, _) | (false, true) if is_column => None,
        (true, _) => refused(DEVIATIONS.to_owned()),
        (false, true) => refused(ONE_SCATTER.to_owned()),
        (false, false) => match quantity {
            MadeQuantity::Yield => None,
            MadeQuantity::Quantile { column, .. } => refused(not_of_numbers(&column, sweep)?),
        },
    }
}

/// What is expected in place of a quantile of `column`; `None` if it is one of numbers.
fn not_of_numbers(column: &str, sweep: &Sweep) -> Option<String> {
    let columns = design_columns(sweep);
    let Some(known) = columns.iter().find(|known| known.name == column) else {
        let names: Vec<&str> = columns.iter().map(|known| known.name.as_ref()).collect();
        let is_asked =
            |name: &&&str| measure_of(name).is_some_and(|m| sweep.measures().contains(&m));
        let asked = names.iter().find(is_asked).copied();
        let near = sweep::nearest(column, &names).or(asked).unwrap_or("coverage");
        return Some(format!("a quantile of a column of designs.csv, e.g. {}", quantiles(near)));
    };
    let is_measured = measure_of(column).is_none_or(|m| sweep.measures().contains(&m));
    if !is_measured {
        return Some("a quantile of a column of what `measures` asks for".to_owned());
    }
    holds_text(known, sweep)
        .then(|| format!("a quantile of a column of numbers, e.g. {}", quantiles("critical_force")))
}

/// The quantiles of a column, by their names.
fn quantiles(column: &str) -> String {
    QUANTILES.map(|(ending, _)| format!("{column}_{ending}")).join(", ")
}

/// Whether a column is one of texts, by what it has to say of a design without a path.
fn holds_text(column: &Column<DesignRow>, sweep: &Sweep) -> bool {
    let (number, case) = (sweep.grid().number(0), sweep.grid().case(0));
    let result = DesignResult {
        puncture: Some(PunctureResult::without_path(Outcome::Internal)),
        flexure: Some(FlexureResult::without_path(Outcome::Internal)),
        ..DesignResult::default()
    };
    matches!(column.cell(&DesignRow { number, case, result }), Cell::Text(_))
}

/// What would be right in place of a name that is nearly that of a quantile, as `critical_force_p5`.
pub(super) fn nearly(column: &str, known: &[&str]) -> Option<String> {
    let (base, ending) = column.rsplit_once("_p")?;
    let is_nearly = known.contains(&base) && ending.starts_with(|c: char| c.is_ascii_digit());
    is_nearly.then(|| format!("one of the quantiles {}", quantiles(base)))
}

/// Lines about yields that can have no meaning, and a count of skins that none asks for.
pub(super) fn senseless(goal: &GoalSection) -> Vec<InvalidDefinition> {
    let is_yield = |column: &str| column == MadeQuantity::YIELD;
    let mut refused = Vec::new();
    for placed in &goal.requirements {
        let requirement = &placed.requirement;
        let is_bound = matches!(requirement.relation, Relation::AtLeast | Relation::Above);
        let is_share = requirement.limit > 0.0 && requirement.limit <= 1.0;
        let is_strict = requirement.relation == Relation::Above && requirement.limit >= 1.0;
        if is_yield(&requirement.column) && (!is_bound || !is_share || is_strict) {
            let expected = "the least share of skins, at most 1, e.g. yield >= 0.9".to_owned();
            let text = requirement.to_string();
            refused.push(not_accepted(&placed.place, "goal.require", &text, expected));
        }
    }
    for placed in &goal.objectives {
        if is_yield(&placed.criterion.column) && placed.criterion.goal == Goal::Minimize {
            let expected = "it in maximize".to_owned();
            refused.push(not_accepted(&placed.place, "goal.minimize", "yield", expected));
        }
    }
    let plain = |column: &str| MadeQuantity::named(column).is_none();
    let has_bounds = goal.requirements.iter().any(|placed| plain(&placed.requirement.column));
    let yields = goal.columns().find(|(column, ..)| is_yield(column));
    if let Some((column, key, place)) = yields.filter(|_| !has_bounds) {
        let expected =
            "a requirement that skins are to meet beside it, e.g. \"coverage >= 0.5\"".to_owned();
        refused.push(not_accepted(place, key, column, expected));
    }
    let is_made = goal.columns().any(|(column, ..)| !plain(column));
    if let Some(place) = goal.skins_place.as_ref().filter(|_| !is_made) {
        let expected = "it beside a yield or a quantile".to_owned();
        refused.push(not_accepted(place, "goal.skins", &goal.skins.to_string(), expected));
    }
    refused
}
