//! The JSON output of `squama rank`.

use ranking::{RankedDesign, Ranking, Unmet, Weights};
use results::Results;
use results::columns::mode_column;
use run::GapChange;
use serde_json::{Map, Value, json};

use super::columns::preferred_columns;
use super::report::{RankReport, judged_modes};
use crate::json;

/// Returns the ranking, the checks of the best designs and the answer as JSON.
///
/// `change` contains the measures of the answer (the best design) with smaller and larger gaps.
pub fn report_record(report: &RankReport<'_>, change: Option<&GapChange>) -> Value {
    let RankReport { results, ranking, top, changes, couplings, checks, answer } = *report;
    let mut record = ranking_record(results, ranking, top);
    if let Some(modes) = judged_modes(results, ranking) {
        record["failure_modes"] = json::failure_modes(&modes);
    }
    record["gap_changes"] = json!(changes);
    record["full_coupling"] = json!(couplings);
    record["answer"] = answer.record(change);
    record["fail_checks"] = json!(checks.failed);
    record["best_that_passes_checks"] = json!(checks.best.map(|best| best.design().to_owned()));
    record
}

/// Returns the ranking as JSON, with the `top` designs by fitness.
fn ranking_record(results: &Results, ranking: &Ranking<'_>, top: usize) -> Value {
    let preferences = ranking.preferences();
    let criteria = &preferences.criteria;
    let exclusions = ranking.exclusions().iter();
    let exclusions = exclusions.map(|(why, count)| json!({ "why": why, "designs": count }));
    let best: Vec<_> = ranking.by_fitness(preferences.weights).take(top).collect();
    let alone = criteria.iter().zip(Weights::alone_among(criteria.len()));
    let alone = alone.map(|(criterion, weights)| {
        let mut winner = design(results, ranking, &ranking.winner(weights));
        winner["criterion"] = criterion.column.as_ref().into();
        winner["equally_good"] = ranking.equals(weights).into();
        winner
    });
    json!({
        "folder": results.folder().to_string_lossy(),
        "designs": results.len(),
        "ranked": ranking.len(),
        "left_out": exclusions.collect::<Vec<_>>(),
        "requirements": preferences.requirements,
        "criteria": criteria,
        "weights": preferences.weights.values(),
        "scale": preferences.scale.to_string(),
        "best": designs(results, ranking, &best),
        "as_good_as_the_best": ranking.equals(preferences.weights),
        "best_by_one_criterion": alone.collect::<Vec<_>>(),
        "best_for_some_weights": designs(results, ranking, &ranking.winners()),
        "front": designs(results, ranking, &ranking.front()),
        "knee": ranking.knee().map(|knee| knee.design().to_owned()),
    })
}

fn designs(results: &Results, ranking: &Ranking<'_>, all: &[RankedDesign<'_>]) -> Vec<Value> {
    all.iter().map(|ranked| design(results, ranking, ranked)).collect()
}

/// Returns a design as JSON: fitness, fraction of weights for which the design is best, and values.
fn design(results: &Results, ranking: &Ranking<'_>, ranked: &RankedDesign<'_>) -> Value {
    let criteria = ranking.preferences().criteria.iter().enumerate();
    let values =
        criteria.map(|(c, criterion)| (criterion.column.to_string(), ranked.value(c).into()));
    let mut values: Map<String, Value> = values.collect();
    for mode in preferred_columns(ranking.preferences()).filter_map(mode_column) {
        if let Ok(column) = results.column(mode) {
            values.insert(mode.to_owned(), results.text(ranked.row(), column).into());
        }
    }
    json!({
        "design": ranked.design(),
        "fitness": ranked.fitness,
        "share_of_weights": ranked.share(),
        "values": values,
    })
}

/// Returns the requirements and the nearest design as JSON, if no design meets the requirements.
pub fn unmet_record(results: &Results, unmet: &Unmet) -> Value {
    json!({
        "folder": results.folder().to_string_lossy(),
        "designs": results.len(),
        "ranked": 0,
        "requirements": unmet.requirements.iter().map(|unmet| {
        json!({
            "requirement": unmet.requirement.to_string(),
            "met_by": unmet.met,
            "met_without": unmet.met_without,
            "nearest_has": unmet.nearest,
            "short_by": unmet.shortfall,
            "binds": unmet.binds(),
        })
    }).collect::<Vec<_>>(),
        "nearest": unmet.nearest.map(|row| results.design(row).to_owned()),
    })
}
