//! Reads the keys of the fitness in `[goal]`: weights, and worst and best values of its criteria.

use ranking::{CRITERIA, Criterion, CriterionEnds, FitnessGoal, Goal, Scale, Weights};
use serde_json::{Value as Json, json};
use sweep::InvalidDefinition;
use text::toml_source::{KeyValue, KeyValues, Location, Value};

use super::refusal::{no_effect, not_accepted};

const WEIGHTS: &str = "weights of at least 0, one of them positive, of columns for which large or small values are known to be better, e.g. { coverage = 1, critical_force = 2 }";
const RESCALE: &str = "the worst and the best value of each column, e.g. { coverage = [0, 0.9] }";

/// Values of the keys `weights` and `rescale` read so far.
#[derive(Default)]
pub(super) struct FitnessSection {
    weights: Option<(Vec<Criterion>, Weights, Location)>,
    ends: Vec<(CriterionEnds, Location)>,
}

impl FitnessSection {
    /// Returns the JSON schema of the key `weights`.
    pub fn weights_schema() -> Json {
        json!({
            "type": "object", "minProperties": 1,
            "additionalProperties": { "type": "number", "minimum": 0 },
            "description": "weights of the criteria of the fitness, by column",
        })
    }

    /// Returns the JSON schema of the key `rescale`.
    pub fn rescale_schema() -> Json {
        json!({
            "type": "object", "minProperties": 1,
            "additionalProperties": {
                "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
            },
            "description": "worst and best value of the criteria of the fitness, by column",
        })
    }

    /// Reads the key `weights`.
    pub fn weights(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let read = table(&entry.value).and_then(|inner| inner.iter().map(weight).collect());
        let read = read.and_then(|(criteria, weights): (Vec<_>, Vec<_>)| {
            Some((criteria, Weights::new(&weights).ok()?, entry.location.clone()))
        });
        let Some(weights) = read else {
            return Err(not_accepted(&entry.location, "goal.weights", &entry.value, WEIGHTS));
        };
        self.weights = Some(weights);
        Ok(())
    }

    /// Reads the key `rescale`.
    pub fn rescale(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let read = table(&entry.value).map(|inner| inner.iter().map(criterion_ends).collect());
        let read: Option<Vec<_>> = read.flatten();
        self.ends = read
            .ok_or_else(|| not_accepted(&entry.location, "goal.rescale", &entry.value, RESCALE))?;
        Ok(())
    }

    /// Returns the fitness if the goal refers to it.
    ///
    /// `is_named` is true if an objective or requirement is `fitness`. Otherwise the keys of the
    /// fitness have no effect, which is an error.
    pub fn goal(&self, is_named: bool) -> Result<Option<FitnessGoal>, InvalidDefinition> {
        if !is_named {
            return self.unused().map_or(Ok(None), Err);
        }
        let (criteria, weights) = match &self.weights {
            Some((criteria, weights, _)) => (criteria.clone(), *weights),
            None => (CRITERIA.to_vec(), Weights::BALANCED),
        };
        for (ends, location) in &self.ends {
            check(ends, &criteria, location)?;
        }
        let ends = self.ends.iter().map(|(ends, _)| ends.clone()).collect();
        Ok(Some(FitnessGoal { criteria, weights, ends }))
    }

    /// Returns the error for a key that has no effect because the goal has no fitness.
    ///
    /// `None` if the goal has neither key.
    fn unused(&self) -> Option<InvalidDefinition> {
        let of_weights = self.weights.iter().map(|(.., location)| ("goal.weights", location));
        let of_ends = self.ends.iter().map(|(_, location)| ("goal.rescale", location));
        let (key, location) = of_weights.chain(of_ends).next()?;
        Some(no_effect(location, key, "the goal does not maximize fitness"))
    }
}

/// Returns the keys of a non-empty table; `None` for other values.
fn table(value: &Value) -> Option<&KeyValues> {
    match value {
        Value::Table(inner) if !inner.is_empty() => Some(inner),
        _ => None,
    }
}

/// Reads the weight of a column.
///
/// `None` if the value is not a number, or if the column is not a criterion.
fn weight(entry: &KeyValue) -> Option<(Criterion, f64)> {
    match &entry.value {
        Value::Number(text) if !entry.key.contains(':') => {
            Some((entry.key.parse().ok()?, text.parse().ok()?))
        }
        _ => None,
    }
}

/// Reads the worst and the best value of a column.
///
/// `None` if they are not two finite numbers.
fn criterion_ends(entry: &KeyValue) -> Option<(CriterionEnds, Location)> {
    let Value::List(items) = &entry.value else { return None };
    let [Value::Number(worst), Value::Number(best)] = items.as_slice() else { return None };
    let [worst, best] = [worst.parse::<f64>().ok()?, best.parse().ok()?];
    let ends = CriterionEnds { column: entry.key.clone(), worst, best };
    (worst.is_finite() && best.is_finite()).then(|| (ends, entry.location.clone()))
}

/// Checks that `ends` belong to one of the `criteria`, and that their best value is the better one.
fn check(
    ends: &CriterionEnds,
    criteria: &[Criterion],
    location: &Location,
) -> Result<(), InvalidDefinition> {
    let Some(criterion) = criteria.iter().find(|criterion| criterion.column == ends.column) else {
        let names: Vec<&str> = criteria.iter().map(|c| c.column.as_ref()).collect();
        let expected = format!("one of {}", names.join(", "));
        return Err(not_accepted(location, "goal.rescale", ends.column.clone(), expected));
    };
    let [worst, best] =
        [ends.worst, ends.best].map(|value| Scale::Paper.criterion(criterion.goal, value));
    if worst.zip(best).is_some_and(|(worst, best)| worst < best) {
        return Ok(());
    }
    let found = format!("{} = [{}, {}]", ends.column, ends.worst, ends.best);
    let expected = match criterion.goal {
        Goal::Maximize => "the worst value, then a larger one",
        Goal::Minimize => "the worst value, then a smaller one above 0",
    };
    Err(not_accepted(location, "goal.rescale", found, expected))
}
