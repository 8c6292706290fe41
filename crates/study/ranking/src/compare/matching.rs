//! Matches the designs of two runs.

use std::borrow::Cow;
use std::collections::HashMap;

use results::Results;
use sweep::{PARAMETERS, Parameter, Scalar};
use text::number::DistinctNumbers;

use super::InvalidComparison;

/// A parameter with different values in two runs, constant within each of them.
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
    /// Rows of the same design in both runs.
    pub pairs: Vec<[usize; 2]>,
    /// Rows of designs in the first run only, and in the second only.
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

/// Returns the value of a parameter that is known to be constant in a run.
fn shared(run: &Results, parameter: &Parameter) -> Option<Scalar> {
    let definition = run.definition()?;
    let is_shared = definition.grid().axis(parameter.key).is_none();
    is_shared.then(|| parameter.get(definition.grid().base()))
}

/// Returns the parameters that vary in a run and are known in the other.
fn common(first: &Results, second: &Results) -> Vec<&'static Parameter> {
    let common = PARAMETERS.iter().filter(|parameter| {
        let runs = [first, second].map(|run| (run, run.parameters().any(|p| p == *parameter)));
        runs.iter().any(|(_, varies)| *varies)
            && runs.iter().all(|(run, varies)| *varies || shared(run, parameter).is_some())
    });
    common.collect()
}

/// A parameter that matches designs, and its different numbers in both runs.
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

    /// Appends the value of a row to a key. Equal values have equal bytes.
    fn write(&self, run: &Results, row: usize, key: &mut Vec<u8>) {
        let value = value(run, self.parameter, row);
        let number = value.parse().ok().and_then(|number| self.numbers.position(number));
        match number {
            Some(index) => key.extend(index.to_le_bytes()),
            None => key.extend(value.as_bytes()),
        }
        // A separator, or 1 and 12 would equal 11 and 2.
        key.push(b',');
    }
}

/// Returns the value of a parameter in a row, as text.
fn value<'r>(run: &'r Results, parameter: &Parameter, row: usize) -> Cow<'r, str> {
    let value = run.parameter(row, parameter);
    if !value.is_empty() {
        return value;
    }
    // Without a column, all designs of the run have the same value.
    shared(run, parameter).map_or_else(Cow::default, |value| value.to_string().into())
}

/// Returns the values of a row that distinguish its design from the others.
fn key(run: &Results, parameters: &[CommonParameter], row: usize) -> Vec<u8> {
    let mut key = Vec::new();
    for parameter in parameters {
        parameter.write(run, row, &mut key);
    }
    key
}

/// Returns the row of each key.
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
