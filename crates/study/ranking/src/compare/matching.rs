//! The matching of the designs of two runs.

use std::collections::HashMap;

use results::Results;
use sweep::{PARAMETERS, Parameter, Scalar};

use super::InvalidComparison;

/// A parameter with the value that each of two runs gives to all of its designs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterChange {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// The value in the first run.
    pub first: Scalar,
    /// The value in the second run.
    pub second: Scalar,
}

/// The designs of two runs, side by side.
#[derive(Clone, Debug)]
pub(super) struct Matching {
    /// Rows of the same design in the first run and in the second.
    pub pairs: Vec<[usize; 2]>,
    /// Rows that have no partner, in the first run and in the second.
    pub alone: [Vec<usize>; 2],
    /// Parameters that differ for all designs alike.
    pub changes: Vec<ParameterChange>,
}

impl Matching {
    pub fn new(first: &Results, second: &Results) -> Result<Self, InvalidComparison> {
        let common = common(first, second);
        let [first_keys, second_keys] = [keys(first, &common)?, keys(second, &common)?];
        let pair = |row| Some([row, *second_keys.get(&key(first, &common, row))?]);
        let pairs: Vec<[usize; 2]> = (0..first.len()).filter_map(pair).collect();
        let without = |run: &Results, partners: &HashMap<String, usize>| {
            let is_alone = |row: &usize| !partners.contains_key(&key(run, &common, *row));
            (0..run.len()).filter(is_alone).collect()
        };
        let alone = [without(first, &second_keys), without(second, &first_keys)];
        Ok(Self { pairs, alone, changes: changes(first, second) })
    }
}

/// The value that a run gives to all of its designs, if it says so.
fn shared(run: &Results, parameter: &Parameter) -> Option<Scalar> {
    let definition = run.definition()?;
    let is_shared = definition.grid().axis(parameter.key).is_none();
    is_shared.then(|| parameter.get(definition.grid().base()))
}

/// Parameters that vary in a run, and that the other one knows.
fn common(first: &Results, second: &Results) -> Vec<&'static Parameter> {
    let varies = |run: &Results, parameter: &&Parameter| run.parameters().any(|p| p == *parameter);
    let knows =
        |run, parameter: &&Parameter| varies(run, parameter) || shared(run, parameter).is_some();
    let parameters = PARAMETERS.iter();
    let vary = parameters.filter(|p| varies(first, p) || varies(second, p));
    vary.filter(|p| knows(first, p) && knows(second, p)).collect()
}

/// The key that tells the design of a row from others: its values of `parameters`.
fn key(run: &Results, parameters: &[&'static Parameter], row: usize) -> String {
    // Texts, not numbers: every run writes a number with the same digits.
    let mut key = String::new();
    for parameter in parameters {
        match run.parameter(row, parameter).as_ref() {
            // A table without that column: its run gives one value to all designs.
            "" => key.extend(shared(run, parameter).map(|value| value.to_string())),
            value => key.push_str(value),
        }
        // Without a mark between them, 1 and 12 would be 11 and 2.
        key.push(',');
    }
    key
}

/// The row of each key.
fn keys(
    run: &Results,
    parameters: &[&'static Parameter],
) -> Result<HashMap<String, usize>, InvalidComparison> {
    let mut keys = HashMap::with_capacity(run.len());
    for row in 0..run.len() {
        // Refused: of two designs with one key the second would hide the first.
        if let Some(other) = keys.insert(key(run, parameters, row), row) {
            let [first, second] = [other, row].map(|row| run.design(row).to_owned());
            return Err(InvalidComparison::Ambiguous { file: run.file(), first, second });
        }
    }
    Ok(keys)
}

fn changes(first: &Results, second: &Results) -> Vec<ParameterChange> {
    let change = |parameter: &'static Parameter| {
        let change = ParameterChange {
            parameter,
            first: shared(first, parameter)?,
            second: shared(second, parameter)?,
        };
        (change.first != change.second).then_some(change)
    };
    PARAMETERS.iter().filter_map(change).collect()
}
