//! Reads the section `[variables]`: for each parameter bounds or a list of values.

use super::axes;
use super::invalid::Problem;
use crate::parameter::{Parameter, WrongValue};
use crate::variable::{Variable, VariableValues};
use text::toml_source::{KeyValues, Value};

/// Reads the variable of `parameter` from `value`: bounds or a list of values.
pub(crate) fn read(parameter: &'static Parameter, value: &Value) -> Result<Variable, Problem> {
    let values = match value {
        Value::Table(entries) => between(parameter, entries, value)?,
        Value::List(items) => VariableValues::OneOf(axes::read_list(parameter, items)?),
        _ => VariableValues::OneOf(Vec::new()),
    };
    if matches!(&values, VariableValues::OneOf(values) if values.len() < 2) {
        let expected = "bounds or several values, e.g. { from = 0.1, to = 1 } or [0.5, 1]";
        return Err(WrongValue::not_accepted(value, expected).into());
    }
    Ok(Variable { parameter, values })
}

fn between(
    parameter: &Parameter,
    entries: &KeyValues,
    written: &Value,
) -> Result<VariableValues, Problem> {
    let wrong = |problem: String| Problem::Range { range: written.to_string(), problem };
    if parameter.takes_counts() || !parameter.takes_numbers() {
        return Err(wrong(
            "whole numbers and words cannot have bounds, expected a list of values".to_owned(),
        ));
    }
    if let Some(entry) = entries.iter().find(|entry| !["from", "to"].contains(&entry.key.as_str()))
    {
        return Err(wrong(format!("unknown key {}, expected from and to", entry.key)));
    }
    let [from, to] = ["from", "to"].map(|key| {
        let entry = entries.iter().find(|entry| entry.key == key);
        let entry =
            entry.ok_or_else(|| wrong(format!("`{key}` is missing, expected from and to")))?;
        let number = parameter.read(&entry.value)?.number();
        number.ok_or_else(|| wrong(format!("{} is not a number", entry.value)))
    });
    let (from, to) = (from?, to?);
    if from < to {
        Ok(VariableValues::Between(from, to))
    } else {
        Err(wrong("`from` must be below `to`".to_owned()))
    }
}
