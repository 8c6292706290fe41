//! Follows one parameter in the direction that improves a measure, up to the first limit.

use ranking::Requirement;
use results::columns::{Goal, name, plain_goal};
use run::Evaluator;
use sweep::{Case, Sweep};

use crate::answer::{Followed, Required, Value};
use crate::request::{Follow, Setting, put};

/// Number of steps over the whole range. Limits within one step may be missed.
const STEPS: u32 = 24;
/// Number of bisections of the last step, down to less than the resolution of a slider.
const HALVINGS: u32 = 10;

/// An evaluated design.
struct Look {
    /// Value of the measure, negated if it is to be minimised; `None` if it has no value.
    worth: Option<f64>,
    /// True if the surface folds.
    folds: bool,
    /// The requirements with their margins.
    required: Vec<Required>,
}

/// Changes a parameter of `case` towards `walk.to`, up to the first limit.
///
/// At a limit the measure stops improving or loses its value, a requirement is no longer met, or
/// the surface begins to fold.
///
/// # Errors
/// If there is no such parameter, or one of its values is rejected.
pub(crate) fn follow(
    sweep: &Sweep,
    case: &Case,
    walk: &Follow,
    requirements: &[Requirement],
    evaluator: &Evaluator,
) -> Result<Followed, String> {
    let from =
        sweep::Parameter::named(&walk.key).and_then(|parameter| parameter.get(case).number());
    let from = from.ok_or_else(|| format!("{}: has no numeric value to follow", walk.key))?;
    let look = |value: f64| -> Result<Look, String> {
        let case = put(case, &walk.key, &Setting::Number(value))?;
        let sweep = sweep.at(&case);
        let values = Value::all(&sweep, &evaluator.row(sweep.grid().number(0), &case));
        let sign = if plain_goal(&walk.measure) == Some(Goal::Minimize) { -1.0 } else { 1.0 };
        Ok(Look {
            worth: Value::number(&values, &walk.measure).map(|value| sign * value),
            folds: Value::number(&values, name::FOLD_FORCE).is_some(),
            required: Required::all(requirements, &values),
        })
    };
    let value_at = |share: f64| from + share * (walk.to - from);
    let (mut good, mut share) = (look(from)?, 0.0);
    let mut reason = None;
    for _ in 0..STEPS {
        let next = share + 1.0 / f64::from(STEPS);
        let ahead = look(value_at(next))?;
        reason = limit(&good, &ahead, walk);
        if reason.is_some() {
            break;
        }
        (good, share) = (ahead, next);
    }
    if reason.is_some() {
        let mut beyond = share + 1.0 / f64::from(STEPS);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (share + beyond);
            let ahead = look(value_at(middle))?;
            match limit(&good, &ahead, walk) {
                None => (good, share) = (ahead, middle),
                // A finer step may reach a different limit first.
                limit => (reason, beyond) = (limit, middle),
            }
        }
    }
    let reason = reason.unwrap_or_else(|| "the end of the slider".to_owned());
    Ok(Followed { key: walk.key.clone(), value: value_at(share), reason })
}

/// Returns a description of the limit between the designs `here` and `ahead`, if there is one.
fn limit(here: &Look, ahead: &Look, walk: &Follow) -> Option<String> {
    let broken =
        here.required.iter().zip(&ahead.required).find(|(here, ahead)| here.met && !ahead.met);
    if let Some((broken, _)) = broken {
        return Some(format!("limited by {}", broken.text));
    }
    match (here.worth, ahead.worth) {
        (Some(_), None) => Some("beyond this value the path does not converge".to_owned()),
        _ if ahead.folds && !here.folds => Some("beyond this value the surface folds".to_owned()),
        (Some(here), Some(ahead)) if ahead < here => {
            Some(format!("{} is best here", walk.measure.replace('_', " ")))
        }
        // If neither design has a value, continue: a later design may have one.
        _ => None,
    }
}
