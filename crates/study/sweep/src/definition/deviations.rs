//! Reads the section `[tolerance]`: the manufacturing deviation of each parameter.

use super::invalid::Problem;
use crate::deviation::{BatchDeviation, Deviation};
use crate::parameter::{Parameter, Role, WrongValue};
use text::toml_source::{KeyValue, KeyValues, Value};

/// Keys in the table of a deviation.
const KEYS: [&str; 3] = ["batch_sd", "batch_within", "scale_sd"];

/// Examples of valid deviations, for messages.
const EXAMPLE: &str =
    "e.g. { batch_sd = 0.02 }, { batch_within = 0.05 } or { batch_sd = 0.02, scale_sd = 0.01 }";

/// Reads the deviation in `entry`, an entry of the section `[tolerance]`.
pub(crate) fn read(entry: &KeyValue) -> Result<Deviation, Problem> {
    let Some(parameter) = Parameter::named(&entry.key).filter(|p| p.has(Role::Toleranced)) else {
        return Err(unknown(entry));
    };
    let Value::Table(entries) = &entry.value else {
        return Err(WrongValue::not_accepted(&entry.value, format!("deviations, {EXAMPLE}")).into());
    };
    if let Some(other) = entries.iter().find(|entry| !KEYS.contains(&entry.key.as_str())) {
        return Err(wrong(entry, format!("unknown key {}, expected {EXAMPLE}", other.key)));
    }
    let [sd, within, scale_sd] = KEYS.map(|key| number(entries, key));
    let batch = match (sd?, within?) {
        (Some(_), Some(_)) => {
            return Err(wrong(
                entry,
                "has batch_sd and batch_within; keep one of the two".to_owned(),
            ));
        }
        (sd, within) => sd.map(BatchDeviation::Normal).or(within.map(BatchDeviation::Uniform)),
    };
    let scale_sd = scale_sd?;
    if scale_sd.is_some() && !parameter.has(Role::Scattered) {
        let problem = "scale_sd is for gap_over_t (or gap_mm) and slant_deg only, expected batch_sd or batch_within";
        return Err(wrong(entry, problem.to_owned()));
    }
    if batch.is_none() && scale_sd.is_none() {
        return Err(wrong(entry, format!("no deviation, expected {EXAMPLE}")));
    }
    Ok(Deviation { parameter, batch, scale_sd })
}

/// Returns the positive number of `key`; `None` if `entries` do not contain the key.
fn number(entries: &KeyValues, key: &str) -> Result<Option<f64>, Problem> {
    let Some(entry) = entries.iter().find(|entry| entry.key == key) else { return Ok(None) };
    let number = match &entry.value {
        Value::Number(text) => text.parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite()),
        _ => None,
    };
    let expected = format!("a number above 0 for {key}");
    number.map(Some).ok_or_else(|| WrongValue::not_accepted(&entry.value, expected).into())
}

fn wrong(entry: &KeyValue, problem: String) -> Problem {
    Problem::Range { range: entry.value.to_string(), problem }
}

fn unknown(entry: &KeyValue) -> Problem {
    let possible = Parameter::with(Role::Toleranced);
    let known: Vec<_> = possible.map(|parameter| parameter.key).collect();
    let hint = match text::nearest(&entry.key, &known) {
        Some(near) => format!("did you mean {near}?"),
        None => format!("expected one of {}", known.join(", ")),
    };
    Problem::Unknown { value: entry.value.to_string(), hint }
}
