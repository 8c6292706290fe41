//! Composes the sentence that states why a best design is best.

use std::fmt::Write as _;

use ranking::{Goal, Requirement};
use text::number;

use crate::best::BestDesign;
use crate::binding_text::BindingText;
use crate::goal::DesignGoal;
use crate::judgement::Judgement;
use crate::price::{Binding, Limit};

/// Relative change of a limit, for which the sentence states the gain.
const CHANGE: f64 = 0.01;

/// Effect of relaxing a limit on the objective.
struct Effect {
    /// Name of the limit.
    name: String,
    is_requirement: bool,
    /// Description of the relaxed limit, e.g. `1 % less required coverage`.
    ///
    /// `None` if a percentage of the limit has no meaning.
    relaxed: Option<String>,
    /// Gain divided by the objective; `None` if the multiplier is unknown.
    gain: Option<f64>,
}

/// Returns a sentence that names the binding limits of the design `best`.
///
/// The sentence also states the gain if the most expensive limit is relaxed by 1 %. `goal` is the
/// goal of the search. If `is_rough` is true, the multipliers in `bindings` are approximate, and
/// `goal` is the goal for nominal designs. Returns `None` if the reason is unknown.
pub(crate) fn reason(
    goal: &DesignGoal,
    best: &BestDesign,
    bindings: &[Binding],
    is_rough: bool,
) -> Option<String> {
    let Judgement::Judged(worth) = &best.candidate.verdict else { return None };
    let objective = &goal.objectives[best.target.objective];
    let value = worth.objectives[best.target.objective].abs();
    if bindings.is_empty() {
        let extreme = if objective.goal == Goal::Maximize { "largest" } else { "smallest" };
        let column = &objective.column;
        let sentence = format!("No limit binds: {column} is {extreme} inside the ranges.");
        return (!is_rough).then_some(sentence);
    }
    let binding_text = BindingText::new(goal);
    let mut effects: Vec<Effect> =
        bindings.iter().map(|binding| effect(goal, &binding_text, binding, best, value)).collect();
    if effects.iter().any(|effect| effect.gain.is_some_and(|gain| gain > 0.0)) {
        // Omit limits with a multiplier of 0, which do not affect the objective.
        effects.retain(|effect| effect.gain != Some(0.0));
    }
    // Name requirements first, because a user may relax them. The sort is stable, so limits without
    // a multiplier keep the order of the goal.
    effects.sort_by(|a, b| {
        let by_gain = b.gain.unwrap_or(0.0).total_cmp(&a.gain.unwrap_or(0.0));
        b.is_requirement.cmp(&a.is_requirement).then(by_gain)
    });
    let mut names: Vec<&str> = Vec::new();
    for effect in &effects {
        if !names.contains(&effect.name.as_str()) {
            names.push(&effect.name);
        }
    }
    let limit = if names.len() == 1 { "limits" } else { "limit" };
    let mut sentence = format!("{} {limit} this design", joined(&names));
    let known = effects.iter().find_map(|effect| Some((effect.relaxed.as_ref()?, effect.gain?)));
    if let Some((relaxed, gain)) = known.filter(|(_, gain)| *gain > 0.0) {
        let moves = if objective.goal == Goal::Maximize { "rises" } else { "falls" };
        let about = if is_rough { "about " } else { "" };
        let percent = number::rounded(100.0 * gain, 2);
        let column = &objective.column;
        // Writing to a string cannot fail.
        let _ = write!(sentence, ": with {relaxed}, {column} {moves} by {about}{percent} %");
    }
    Some(sentence + ".")
}

/// Returns the effect of relaxing the limit of `binding` by 1 %.
///
/// `objective` is the absolute value of the objective of the design `best`.
fn effect(
    goal: &DesignGoal,
    binding_text: &BindingText<'_>,
    binding: &Binding,
    best: &BestDesign,
    objective: f64,
) -> Effect {
    let percent = 100.0 * CHANGE;
    let (name, relaxed, size) = match binding.limit {
        Limit::Requirement(k) if k < goal.requirements.len() => {
            let Requirement { column, limit, .. } = &goal.requirements[k];
            let relaxed = if goal.requirements[k].direction() > 0.0 {
                format!("{percent} % less required {column}")
            } else {
                format!("{percent} % more allowed {column}")
            };
            (column.clone(), Some(relaxed), limit.abs())
        }
        Limit::Requirement(_) => ("folding of the surface".to_owned(), None, 1.0),
        Limit::Lower(j) => {
            let interval = &goal.space.intervals()[j];
            let relaxed = format!("{percent} % less {}", interval.parameter.key);
            (binding_text.limit(&binding.limit, &best.target), Some(relaxed), interval.from.abs())
        }
        Limit::Upper(j) => {
            let interval = &goal.space.intervals()[j];
            let relaxed = format!("{percent} % more {}", interval.parameter.key);
            (binding_text.limit(&binding.limit, &best.target), Some(relaxed), interval.to.abs())
        }
        Limit::FirstContact => ("contact in bending".to_owned(), None, 1.0),
        Limit::ObjectiveBound(_) => (binding_text.limit(&binding.limit, &best.target), None, 1.0),
    };
    let gain = binding.price.map(|price| price * CHANGE * size / objective);
    Effect {
        name,
        is_requirement: matches!(binding.limit, Limit::Requirement(_)),
        relaxed: relaxed.filter(|_| size > 0.0),
        gain: gain.filter(|gain| gain.is_finite()),
    }
}

/// Joins names as `a, b and c`.
fn joined(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
