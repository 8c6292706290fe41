//! Criteria that were measured under different conditions and cannot be compared.

use results::{InvalidResults, Results, measurement_conditions};
use sweep::{PARAMETERS, Parameter, Role};
use text::number;

use crate::filter::RequirementFilter;
use crate::preferences::Preferences;
use crate::requirement::{Relation, Requirement};

/// A criterion that was measured under different conditions in different designs.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{file}: {column} cannot be compared between designs of different {parameter} ({}), expected one of them, e.g. --require '{parameter} == {}', or other criteria{}",
    texts(values).join(", "), number::text(values[0]), remedy(parameter)
)]
pub struct Incomparable {
    /// File name of the table.
    pub file: String,
    /// Column of the criterion.
    pub column: String,
    /// Parameter that differs between designs and is a condition of the measurement.
    pub parameter: String,
    /// Values of the parameter, at least two.
    pub values: Vec<f64>,
}

fn texts(values: &[f64]) -> Vec<String> {
    values.iter().copied().map(number::text).collect()
}

fn remedy(parameter: &str) -> &'static str {
    // The rigidity in N mm² can be compared between membranes of different thickness.
    if Parameter::named(parameter).is_some_and(|parameter| parameter.has(Role::UnitOfBending)) {
        ", e.g. --minimize flexural_rigidity_N_mm2 with a [material]"
    } else {
        ""
    }
}

/// Returns the preferences for each group of comparable designs.
///
/// The preferences of a group have an additional requirement for each condition of the measurement
/// that differs between designs, e.g. `critical_tilt_deg == 5`. If all designs are comparable, the
/// only group has the given preferences.
///
/// # Errors
///
/// If a column is missing or not numeric.
///
/// ```
/// use ranking::{Preferences, comparable_groups};
/// use results::Results;
///
/// let folder = tempfile::tempdir()?;
/// let table = "design,critical_tilt_deg,critical_force\n0001,5,1\n0002,10,2\n";
/// std::fs::write(folder.path().join("designs.csv"), table)?;
/// let groups = comparable_groups(&Results::read(folder.path())?, &Preferences::paper())?;
/// let added: Vec<_> = groups.iter().map(|group| group.requirements[0].to_string()).collect();
/// assert_eq!(added, ["critical_tilt_deg == 5", "critical_tilt_deg == 10"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn comparable_groups(
    results: &Results,
    preferences: &Preferences,
) -> Result<Vec<Preferences>, InvalidResults> {
    let mut groups = vec![preferences.clone()];
    for Incomparable { parameter, values, .. } in differing(results, preferences)? {
        // Form all combinations of values, including combinations that no design has.
        for group in std::mem::take(&mut groups) {
            for &limit in &values {
                let (mut group, column) = (group.clone(), parameter.clone());
                group.requirements.push(Requirement { column, relation: Relation::Equal, limit });
                groups.push(group);
            }
        }
    }
    Ok(groups)
}

/// Returns the conditions of measurement that differ between designs that meet the requirements.
pub(crate) fn differing(
    results: &Results,
    preferences: &Preferences,
) -> Result<Vec<Incomparable>, InvalidResults> {
    let mut found = Vec::new();
    for Parameter { key, .. } in PARAMETERS {
        let mut columns = preferences.criteria.iter().map(|criterion| criterion.column.as_ref());
        let Some(column) = columns.find(|column| measurement_conditions(column).contains(key))
        else {
            continue;
        };
        let values = values(results, preferences, key)?;
        if values.len() > 1 {
            let (column, parameter) = (column.to_owned(), (*key).to_owned());
            found.push(Incomparable { file: results.file(), column, parameter, values });
        }
    }
    Ok(found)
}

/// Returns the distinct values of a parameter among the designs that meet the requirements.
///
/// The values are in the order of the table.
fn values(
    results: &Results,
    preferences: &Preferences,
    parameter: &str,
) -> Result<Vec<f64>, InvalidResults> {
    // If the parameter has no column, all designs have the same value.
    let Ok(column) = results.column(parameter) else { return Ok(Vec::new()) };
    let filter = RequirementFilter::new(results, &preferences.requirements)?;
    let mut values: Vec<f64> = Vec::new();
    for row in 0..results.len() {
        // Skip text such as `none` for a friction.
        let Ok(Some(value)) = results.number(row, column) else { continue };
        if !values.iter().any(|other| number::same(*other, value))
            && filter.first_unmet(row)?.is_none()
        {
            values.push(value);
        }
    }
    Ok(values)
}
