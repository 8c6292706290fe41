//! Follows one parameter in the direction that improves a measure, up to the first limit.

use ranking::Requirement;
use results::columns::{Goal, name, plain_goal};
use run::Evaluator;
use sweep::{Case, Sweep};

use crate::answer::{Followed, Required, Value};
use crate::request::{Follow, Setting, put};

/// Number of steps over the whole range. Limits within one step may be missed.
const STEPS: u32 = 24;
/// Number of bisections of the last step; the result is more precise than a slider.
const HALVINGS: u32 = 10;

/// An evaluated design.
struct Evaluation {
    /// Value of the measure, negated for a measure to be minimised; `None` without a value.
    objective: Option<f64>,
    /// True if the surface folds.
    folds: bool,
    /// The requirements with their margins.
    required: Vec<Required>,
}

/// Changes the parameter of `request` in `case` towards `request.to`, up to the first limit.
///
/// At a limit the measure stops improving or loses its value, a requirement is no longer met, or
/// the surface begins to fold.
///
/// # Errors
/// If there is no such parameter, or one of its values is rejected.
pub(crate) fn follow(
    sweep: &Sweep,
    case: &Case,
    request: &Follow,
    requirements: &[Requirement],
    evaluator: &Evaluator,
) -> Result<Followed, String> {
    let from =
        sweep::Parameter::named(&request.key).and_then(|parameter| parameter.get(case).number());
    let from = from.ok_or_else(|| format!("{}: has no numeric value to follow", request.key))?;
    let evaluate = |value: f64| -> Result<Evaluation, String> {
        let case = put(case, &request.key, &Setting::Number(value))?;
        let sweep = sweep.at(&case);
        let values = Value::all(&sweep, &evaluator.row(sweep.grid().number(0), &case));
        let sign = if plain_goal(&request.measure) == Some(Goal::Minimize) { -1.0 } else { 1.0 };
        Ok(Evaluation {
            objective: Value::number(&values, &request.measure).map(|value| sign * value),
            folds: Value::number(&values, name::FOLD_FORCE).is_some(),
            required: Required::all(requirements, &values),
        })
    };
    let value_at = |fraction: f64| from + fraction * (request.to - from);
    let (mut good, mut fraction) = (evaluate(from)?, 0.0);
    let mut reason = None;
    for _ in 0..STEPS {
        let next = fraction + 1.0 / f64::from(STEPS);
        let ahead = evaluate(value_at(next))?;
        reason = limit(&good, &ahead, request);
        if reason.is_some() {
            break;
        }
        (good, fraction) = (ahead, next);
    }
    if reason.is_some() {
        let mut beyond = fraction + 1.0 / f64::from(STEPS);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (fraction + beyond);
            let ahead = evaluate(value_at(middle))?;
            match limit(&good, &ahead, request) {
                None => (good, fraction) = (ahead, middle),
                // A finer step may reach a different limit first.
                limit => (reason, beyond) = (limit, middle),
            }
        }
    }
    let reason = reason.unwrap_or_else(|| "the end of the slider".to_owned());
    Ok(Followed { key: request.key.clone(), value: value_at(fraction), reason })
}

/// Returns a description of the limit between the designs `here` and `ahead`, if there is one.
fn limit(here: &Evaluation, ahead: &Evaluation, request: &Follow) -> Option<String> {
    let violated =
        here.required.iter().zip(&ahead.required).find(|(here, ahead)| here.met && !ahead.met);
    if let Some((violated, _)) = violated {
        return Some(format!("limited by {}", violated.text));
    }
    match (here.objective, ahead.objective) {
        (Some(_), None) => Some("beyond this value the path does not converge".to_owned()),
        _ if ahead.folds && !here.folds => Some("beyond this value the surface folds".to_owned()),
        (Some(here), Some(ahead)) if ahead < here => {
            Some(format!("{} is best here", request.measure.replace('_', " ")))
        }
        // If neither design has a value, continue: a design farther on may have a value.
        _ => None,
    }
}
