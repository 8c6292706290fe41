//! Reads the axes of a grid from numbers, lists and ranges, and orders them.

use std::collections::HashSet;

use super::invalid::Problem;
use crate::case::Case;
use crate::decimal::{self, Decimal};
use crate::grid::Axis;
use crate::parameter::{Parameter, WrongValue};
use crate::scalar::Scalar;
use text::number;
use text::toml_source::{self, KeyValues, Value};

/// The default axes of a grid, with the values of the paper.
///
/// The axes are written in TOML, so that their ranges give the same decimals as ranges in a file.
const PAPER: &str = "
gap_over_t = { from = 0.1, to = 1, step = 0.1 }
length_over_t = [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1]
slant_deg = { from = 0, to = 75, step = 15 }
";

/// The axis that always varies fastest.
///
/// The slant does not change the base, so neighbouring designs share their footprint and springs.
const FASTEST: &str = "slant_deg";

/// Reads the axis of `parameter` from `value`.
pub(crate) fn read(parameter: &'static Parameter, value: &Value) -> Result<Axis, Problem> {
    match value {
        Value::List(items) => Ok(Axis::list(parameter, read_list(parameter, items)?)),
        Value::Table(entries) => read_range(parameter, entries, value),
        single => Ok(Axis::list(parameter, vec![parameter.read(single)?])),
    }
}

/// Reads the values of a list, and refuses repeated values.
pub(crate) fn read_list(parameter: &Parameter, items: &[Value]) -> Result<Vec<Scalar>, Problem> {
    if items.is_empty() {
        let expected = format!("a list of at least one value, each {}", parameter.expected());
        return Err(WrongValue::not_accepted("[]", expected).into());
    }
    let mut values = Vec::with_capacity(items.len());
    for item in items {
        if let Value::List(_) = item {
            return Err(
                WrongValue::not_accepted(item, "a value for each design, not a list").into()
            );
        }
        values.push(parameter.read(item)?);
    }
    match repeated(&values) {
        Some(index) => Err(Problem::Twice(items[index].to_string())),
        None => Ok(values),
    }
}

/// Returns the index of the first value that equals an earlier one up to round-off.
fn repeated(values: &[Scalar]) -> Option<usize> {
    // Sort the numbers, because comparing each value with all earlier ones takes minutes for a long
    // list.
    let numbers = values.iter().enumerate();
    let mut numbers: Vec<(f64, usize)> =
        numbers.filter_map(|(index, value)| Some((value.number()?, index))).collect();
    numbers.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let pairs = numbers.windows(2).filter(|pair| number::same(pair[0].0, pair[1].0));
    let equal_number = pairs.map(|pair| pair[0].1.max(pair[1].1)).min();
    let mut seen = HashSet::with_capacity(values.len() - numbers.len());
    let equal_text = values.iter().enumerate().find(|(_, value)| {
        // Counts and words have no round-off.
        value.number().is_none() && !seen.insert(value.to_string())
    });
    equal_number.into_iter().chain(equal_text.map(|(index, _)| index)).min()
}

fn read_range(
    parameter: &'static Parameter,
    entries: &KeyValues,
    written: &Value,
) -> Result<Axis, Problem> {
    let wrong = |problem: String| Problem::Range { range: written.to_string(), problem };
    if !parameter.takes_numbers() {
        return Err(wrong(format!("words have no range, expected {}", parameter.expected())));
    }
    let [from, to, step] = range_values(entries).map_err(&wrong)?;
    // If both ends are within the bounds, so are all values between, because the bounds are an
    // interval.
    parameter.read(from)?;
    parameter.read(to)?;
    let [from, to, step] = [decimal(from), decimal(to), decimal(step)];
    let (from, to, step) = (from.map_err(&wrong)?, to.map_err(&wrong)?, step.map_err(&wrong)?);
    let [broken_from, broken_to, broken_step] =
        [from, to, step].map(|number| number.to_usize().is_none());
    // `decimal::range` refuses a step that is not positive, so do not report it as a fraction.
    let has_broken_step = step.to_f64() > 0.0 && broken_step;
    if parameter.takes_counts() && (broken_from || broken_to || has_broken_step) {
        return Err(wrong("has fractions, expected whole numbers".to_owned()));
    }
    let numbers = decimal::range(from, to, step).map_err(|problem| wrong(problem.to_string()))?;
    let values = numbers.into_iter().map(|number| parameter.scalar(number)).collect();
    // Keep the written range, so that the record of a run contains the range and not a million
    // numbers.
    let range = format!("{{ from = {from}, to = {to}, step = {step} }}");
    Ok(Axis::range(parameter, values, range))
}

/// Returns the values of the keys `from`, `to` and `step`, and refuses other keys.
fn range_values(entries: &KeyValues) -> Result<[&Value; 3], String> {
    const KEYS: [&str; 3] = ["from", "to", "step"];
    if let Some(entry) = entries.iter().find(|entry| !KEYS.contains(&entry.key.as_str())) {
        return Err(format!("unknown key {}, expected from, to and step", entry.key));
    }
    let [from, to, step] = KEYS.map(|key| {
        let entry = entries.iter().find(|entry| entry.key == key);
        entry
            .map(|entry| &entry.value)
            .ok_or_else(|| format!("no `{key}`, expected from, to and step"))
    });
    Ok([from?, to?, step?])
}

fn decimal(value: &Value) -> Result<Decimal, String> {
    match value {
        Value::Number(text) => text.parse::<Decimal>().map_err(|error| error.to_string()),
        other => Err(format!("{other} is not accepted, expected a number")),
    }
}

/// Returns `written` with the missing default axes, in the order of variation.
///
/// Default axes that are not written are first in the list and vary slowest. The written axes
/// follow in their order, except the slant, which is last. A default axis is omitted if a written
/// parameter determines its parameter; for example, a pitch determines the gap.
pub(crate) fn ordered(mut written: Vec<Axis>, base: &Case) -> Vec<Axis> {
    let mut axes = paper();
    axes.retain(|axis| {
        !written.iter().map(Axis::parameter).any(|other| {
            other == axis.parameter() || other.determines(base) == Some(axis.parameter())
        })
    });
    axes.append(&mut written);
    // Stable sort: all other axes keep their order.
    axes.sort_by_key(|axis| axis.parameter().key == FASTEST);
    axes
}

/// Returns the axes of [`PAPER`].
///
/// Invalid entries are skipped; a test checks that there are none.
fn paper() -> Vec<Axis> {
    let table = toml_source::parse(PAPER, "the paper sweep").unwrap_or_default();
    table
        .into_iter()
        .filter_map(|entry| read(Parameter::named(&entry.key)?, &entry.value).ok())
        .collect()
}
