//! Matches the designs of two runs by their parameters.

use std::borrow::Cow;
use std::collections::HashMap;

use results::Results;
use sweep::{PARAMETERS, Parameter, Scalar};
use text::number::DistinctNumbers;

use super::InvalidComparison;

/// A parameter that is constant within each of two runs, but differs between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterChange {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// Value in the first run.
    pub first: Scalar,
    /// Value in the second run.
    pub second: Scalar,
}

/// Matched designs of two runs.
#[derive(Clone, Debug)]
pub(super) struct Matching {
    /// Rows of each matched design in the first and in the second run.
    pub pairs: Vec<[usize; 2]>,
    /// Rows of designs that are only in the first run, and only in the second run.
    pub alone: [Vec<usize>; 2],
    /// Parameters that are constant within each run, but differ between the runs.
    pub changes: Vec<ParameterChange>,
}

impl Matching {
    pub fn new(first: &Results, second: &Results) -> Result<Self, InvalidComparison> {
        let common: Vec<_> = common(first, second)
            .into_iter()
            .map(|parameter| CommonParameter::new(parameter, [first, second]))
            .collect();
        let [first_keys, second_keys] = [keys(first, &common)?, keys(second, &common)?];
        let pairs: Vec<[usize; 2]> = (0..first.len())
            .filter_map(|row| Some([row, *second_keys.get(&key(first, &common, row))?]))
            .collect();
        let alone = [(first, &second_keys), (second, &first_keys)].map(|(run, partners)| {
            (0..run.len()).filter(|row| !partners.contains_key(&key(run, &common, *row))).collect()
        });
        Ok(Self { pairs, alone, changes: changes(first, second) })
    }
}

/// Returns the value of a parameter if the definition of the run shows that it is constant.
fn shared(run: &Results, parameter: &Parameter) -> Option<Scalar> {
    let definition = run.definition()?;
    let is_shared = definition.grid().axis(parameter.key).is_none();
    is_shared.then(|| parameter.get(definition.grid().base()))
}

/// Returns the parameters that have a column in one run, and a column or known value in the other.
fn common(first: &Results, second: &Results) -> Vec<&'static Parameter> {
    let common = PARAMETERS.iter().filter(|parameter| {
        let runs = [first, second].map(|run| (run, run.parameters().any(|p| p == *parameter)));
        runs.iter().any(|(_, varies)| *varies)
            && runs.iter().all(|(run, varies)| *varies || shared(run, parameter).is_some())
    });
    common.collect()
}

/// A parameter by which designs are matched, with its distinct numbers in both runs.
struct CommonParameter {
    parameter: &'static Parameter,
    numbers: DistinctNumbers,
}

impl CommonParameter {
    fn new(parameter: &'static Parameter, runs: [&Results; 2]) -> Self {
        let numbers = runs.into_iter().flat_map(|run| {
            (0..run.len()).filter_map(move |row| value(run, parameter, row).parse().ok())
        });
        Self { parameter, numbers: numbers.filter(|number: &f64| number.is_finite()).collect() }
    }

    /// Appends the value of a row to `key`. Values that are equal up to round-off have equal bytes.
    fn write(&self, run: &Results, row: usize, key: &mut Vec<u8>) {
        let value = value(run, self.parameter, row);
        let number = value.parse().ok().and_then(|number| self.numbers.position(number));
        match number {
            Some(index) => key.extend(index.to_le_bytes()),
            None => key.extend(value.as_bytes()),
        }
        // Without a separator, the texts 1 and 12 would give the same key as 11 and 2.
        key.push(b',');
    }
}

/// Returns the value of a parameter in a row, as text.
fn value<'r>(run: &'r Results, parameter: &Parameter, row: usize) -> Cow<'r, str> {
    let value = run.parameter(row, parameter);
    if !value.is_empty() {
        return value;
    }
    // If the parameter has no column, all designs of the run have the same value.
    shared(run, parameter).map_or_else(Cow::default, |value| value.to_string().into())
}

/// Returns the key of a row: the values of `parameters`, which identify its design.
fn key(run: &Results, parameters: &[CommonParameter], row: usize) -> Vec<u8> {
    let mut key = Vec::new();
    for parameter in parameters {
        parameter.write(run, row, &mut key);
    }
    key
}

/// Returns the row of each key, for all designs of a run.
fn keys(
    run: &Results,
    parameters: &[CommonParameter],
) -> Result<HashMap<Vec<u8>, usize>, InvalidComparison> {
    let mut keys = HashMap::with_capacity(run.len());
    for row in 0..run.len() {
        // Refuse repeated keys, because the second design would replace the first.
        if let Some(other) = keys.insert(key(run, parameters, row), row) {
            let [first, second] = [other, row].map(|row| run.design(row).to_owned());
            return Err(InvalidComparison::Ambiguous { file: run.file(), first, second });
        }
    }
    Ok(keys)
}

fn changes(first: &Results, second: &Results) -> Vec<ParameterChange> {
    PARAMETERS
        .iter()
        .filter_map(|parameter| {
            let change = ParameterChange {
                parameter,
                first: shared(first, parameter)?,
                second: shared(second, parameter)?,
            };
            (!change.first.same(change.second)).then_some(change)
        })
        .collect()
}
