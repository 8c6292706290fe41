//! The JSON output of `squama optimise`.

use optimisation::{
    Answer, BestDesign, BindingText, Candidate, DesignGoal, Found, Judgement, Rounding,
};
use ranking::Requirement;
use results::columns::design_columns;
use serde_json::{Map, Value, json};

use super::report::{SearchReport, constant_objectives, judged_modes, unmet};
use crate::json;

/// Returns the result of a search as JSON.
pub fn record(report: &SearchReport<'_>) -> Value {
    let SearchReport { goal, found } = *report;
    let texts = BindingText::new(goal);
    let unjudged = &found.unjudged;
    let failed = unjudged.failed.iter().map(|(why, count)| (why.to_string(), json!(count)));
    let mut record = json!({
        "goal": goal.name(),
        "designs": found.history.len(),
        "failed": failed.collect::<Map<_, _>>(),
        "folded": unjudged.folded,
        "starts": found.starts,
        "regions": found.regions,
    });
    let (key, answer) = match &found.answer {
        Answer::Optimum(best) => {
            let mut optimum = design(goal, &texts, best);
            optimum["answer"] = report.answer(best).record(best.checks.gaps.as_ref());
            optimum["reason"] = json!(best.reason);
            if let Some(Rounding { step, unit, exact, rounded }) = &found.rounding {
                optimum["rounding"] =
                    json!({ "step": step, "unit": unit, "exact": exact, "rounded": rounded });
            }
            ("optimum", optimum)
        }
        Answer::Front(front) => {
            ("front", front.designs.iter().map(|best| design(goal, &texts, best)).collect())
        }
        Answer::Infeasible(nearest) => ("infeasible", infeasible(goal, &texts, found, *nearest)),
    };
    record[key] = answer;
    let constant = constant_objectives(goal, found).into_iter();
    record["constant"] = constant.map(|(column, _)| column).collect();
    if goal.fitness.is_some() {
        let bounds = found.rescaled.iter();
        let bounds = bounds.map(|of| (of.column.clone(), json!([of.worst, of.best])));
        record["rescaled"] = Value::Object(bounds.collect());
    }
    record
}

fn variables(goal: &DesignGoal, candidate: &Candidate) -> Map<String, Value> {
    let case = goal.space.case(&candidate.point);
    let variables = goal.space.parameters();
    variables.map(|p| (p.key.to_owned(), json!(p.get(&case)))).collect()
}

fn design(goal: &DesignGoal, texts: &BindingText<'_>, best: &BestDesign) -> Value {
    let columns = design_columns(goal.space.sweep());
    let measures = columns.iter().filter(|column| column.name != "design");
    let measures = measures.map(|c| (c.name.to_string(), json!(c.cell(&best.row))));
    let mut measures: Map<String, Value> = measures.collect();
    measures.extend(objectives(goal, best));
    let mut design = json!({
        "variables": variables(goal, &best.candidate),
        "values": measures,
        "binding": best.bindings.iter().map(|binding| {
        json!({
            "limit": texts.limit(&binding.limit, &best.target),
            "multiplier": binding.price,
            "price": texts.price(binding, &best.target),
        })
    }).collect::<Vec<_>>(),
    });
    if let Some(modes) = judged_modes(goal, &best.candidate) {
        design["failure_modes"] = json::failure_modes(&modes);
    }
    if let Some(of) = best.agreement {
        design["agreement"] =
            json!({ "searches": of.searches, "agreeing": of.agreeing, "spread": of.spread });
    }
    let failed = best.contradictions(goal);
    design["failed_checks"] = failed.iter().map(ToString::to_string).collect();
    design["full_coupling"] = json!(best.checks.coupling);
    design["weakest_place"] = json!(best.checks.places);
    if let Some(confirmation) = &best.confirmation {
        design["made"] = json!(confirmation);
    }
    design
}

/// Returns the objectives that are not statistics over samples, with their values.
fn objectives(goal: &DesignGoal, best: &BestDesign) -> Map<String, Value> {
    let Judgement::Judged(worth) = &best.candidate.verdict else { return Map::new() };
    let values = goal.objectives.iter().zip(&worth.objectives);
    let nominal = values.filter(|(objective, _)| goal.statistic(&objective.column).is_none());
    nominal.map(|(objective, value)| (objective.column.to_string(), json!(value))).collect()
}

/// Returns the requirements and the nearest design, if no design meets the requirements.
fn infeasible(
    goal: &DesignGoal,
    texts: &BindingText<'_>,
    found: &Found,
    nearest: Option<usize>,
) -> Value {
    let requirements: Vec<Requirement> = texts.requirements().into_iter().cloned().collect();
    let unmet = unmet(goal, found, &requirements, nearest);
    let nearest = nearest.map(|index| &found.history[index]);
    let is_judged =
        |c: &&Candidate| matches!(c.verdict, Judgement::Judged(_) | Judgement::Nominal(_));
    json!({
        "requirements": unmet.requirements.iter().map(|r| {
        json!({
            "requirement": r.requirement.to_string(),
            "met": r.met,
            "met_without": r.met_without,
            "nearest": r.nearest,
        })
    }).collect::<Vec<_>>(),
        "missed": found.missed,
        "nearest": nearest.filter(is_judged).map(|candidate| variables(goal, candidate)),
    })
}
