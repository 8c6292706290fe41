//! Matches the designs of two runs.

use std::collections::HashMap;

use results::Results;
use sweep::{PARAMETERS, Parameter, Scalar};

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

/// Returns the value of a parameter that is known to be constant in a run.
fn shared(run: &Results, parameter: &Parameter) -> Option<Scalar> {
    let definition = run.definition()?;
    let is_shared = definition.grid().axis(parameter.key).is_none();
    is_shared.then(|| parameter.get(definition.grid().base()))
}

/// Returns the parameters that vary in a run and are known in the other.
fn common(first: &Results, second: &Results) -> Vec<&'static Parameter> {
    let varies = |run: &Results, parameter: &&Parameter| run.parameters().any(|p| p == *parameter);
    let knows =
        |run, parameter: &&Parameter| varies(run, parameter) || shared(run, parameter).is_some();
    let parameters = PARAMETERS.iter();
    let vary = parameters.filter(|p| varies(first, p) || varies(second, p));
    vary.filter(|p| knows(first, p) && knows(second, p)).collect()
}

/// Returns a key made of the values of `parameters`, which identifies a design.
fn key(run: &Results, parameters: &[&'static Parameter], row: usize) -> String {
    // Texts suffice, because all runs format numbers in the same way.
    let mut key = String::new();
    for parameter in parameters {
        match run.parameter(row, parameter).as_ref() {
            // Without a column, all designs of the run have the same value.
            "" => key.extend(shared(run, parameter).map(|value| value.to_string())),
            value => key.push_str(value),
        }
        // A separator, or 1 and 12 would equal 11 and 2.
        key.push(',');
    }
    key
}

/// Returns the row of each key.
fn keys(
    run: &Results,
    parameters: &[&'static Parameter],
) -> Result<HashMap<String, usize>, InvalidComparison> {
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
