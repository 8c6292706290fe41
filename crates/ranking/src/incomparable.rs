//! Designs whose values cannot be compared, because they are not measured alike.

use results::{InvalidResults, Results};

use crate::filter::RequirementFilter;
use crate::preferences::Preferences;
use crate::ranking::InvalidRanking;

/// A parameter that says how something is measured, and the columns that can be compared only where it is the same.
struct Yardstick {
    parameter: &'static str,
    /// Beginnings of the names of the columns.
    columns: &'static [&'static str],
}

const PUNCTURE: &[&str] = &[
    "critical_force",
    "penetration",
    "critical_displacement",
    "sink",
    "secant_stiffness",
    "peak_force",
    "sound_force",
];
const BENDING: &[&str] = &["compliance", "max_moment", "flexural_rigidity", "axial_energy_share"];

/// The parameters that say how something is measured. The dimensionless compliances are those of one membrane: `C_f*`
/// counts in `1/(E_m I_m)`, which another thickness changes.
const YARDSTICKS: [Yardstick; 4] = [
    Yardstick { parameter: "critical_tilt_deg", columns: PUNCTURE },
    Yardstick {
        parameter: "membrane_thickness_over_t",
        columns: &["compliance", "initial_compliance", "max_moment"],
    },
    Yardstick { parameter: "max_end_rotation_deg", columns: BENDING },
    Yardstick { parameter: "membrane_length_over_t", columns: BENDING },
];

/// Columns in physical units end so. They can be compared whatever the membrane.
const PHYSICAL: [&str; 3] = ["_N", "_N_mm", "_N_mm2"];

/// Designs that are not measured alike, so that a criterion says nothing about which of them is better.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{file}: {column} cannot be compared between designs of different {parameter} ({}), expected one of them, e.g. --require '{parameter} == {}', or other criteria{}",
    values.join(", "), values[0], remedy(parameter)
)]
pub struct Incomparable {
    /// The table.
    pub file: String,
    /// The column of the criterion.
    pub column: String,
    /// The parameter in which designs differ.
    pub parameter: String,
    /// Its values, at least two.
    pub values: Vec<String>,
}

fn remedy(parameter: &str) -> &'static str {
    if parameter == "membrane_thickness_over_t" {
        ", e.g. --minimize flexural_rigidity_N_mm2 with a [material]"
    } else {
        ""
    }
}

/// Checks that every criterion can be compared between the designs that meet the requirements.
///
/// # Errors
/// If a column is missing or no column of numbers, or designs are not measured alike.
pub fn check_comparable(
    results: &Results,
    preferences: &Preferences,
) -> Result<(), InvalidRanking> {
    for yardstick in &YARDSTICKS {
        let measured = |column: &&str| yardstick.measures(column);
        let columns = preferences.criteria.iter().map(|criterion| criterion.column.as_ref());
        let Some(column) = columns.into_iter().find(measured) else { continue };
        let values = values(results, preferences, yardstick.parameter)?;
        if values.len() > 1 {
            let (column, parameter) = (column.to_owned(), yardstick.parameter.to_owned());
            let file = results.file();
            return Err(Incomparable { file, column, parameter, values }.into());
        }
    }
    Ok(())
}

/// The parameters that say how a column is measured: only designs of the same values can be compared by it.
pub fn yardsticks(column: &str) -> Vec<&'static str> {
    let measuring = YARDSTICKS.iter().filter(|yardstick| yardstick.measures(column));
    measuring.map(|yardstick| yardstick.parameter).collect()
}

impl Yardstick {
    /// Whether the values of a column depend on it in a way that leaves nothing to compare.
    fn measures(&self, column: &str) -> bool {
        let is_physical = PHYSICAL.iter().any(|unit| column.ends_with(unit));
        let is_free = is_physical && self.parameter == "membrane_thickness_over_t";
        !is_free && self.columns.iter().any(|beginning| column.starts_with(beginning))
    }
}

/// The different values of a parameter among the designs that meet the requirements.
fn values(
    results: &Results,
    preferences: &Preferences,
    parameter: &str,
) -> Result<Vec<String>, InvalidResults> {
    let Ok(column) = results.column(parameter) else { return Ok(Vec::new()) };
    let filter = RequirementFilter::new(results, &preferences.requirements)?;
    let mut values: Vec<String> = Vec::new();
    for row in 0..results.len() {
        let value = results.text(row, column);
        let is_new = !values.iter().any(|known| known == value);
        if is_new && filter.first_unmet(row)?.is_none() {
            values.push(value.to_owned());
        }
    }
    Ok(values)
}
