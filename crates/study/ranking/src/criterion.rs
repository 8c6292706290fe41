//! Criteria of a ranking: columns to be maximised or minimised.

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use results::columns::{Goal, ValueColumn, name, plain_goal};
use serde::{Serialize, Serializer};
use sweep::{Sweep, key};

/// Criterion of a ranking: a column to be maximised or minimised.
///
/// ```
/// use ranking::{Criterion, Goal};
///
/// let criterion: Criterion = "min:areal_mass_kg_m2".parse()?;
/// assert_eq!((criterion.column.as_ref(), criterion.goal), ("areal_mass_kg_m2", Goal::Minimize));
/// // For some columns it is known whether large or small values are better.
/// assert_eq!("penetration".parse::<Criterion>()?.goal, Goal::Minimize);
/// # Ok::<(), ranking::InvalidCriterion>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Criterion {
    /// Name of the criterion, for messages.
    pub name: Cow<'static, str>,
    /// Column name.
    pub column: Cow<'static, str>,
    /// Direction: maximise or minimise.
    pub goal: Goal,
}

/// Criteria of the paper, in the order of their weights `m, n, k, l`.
pub static CRITERIA: [Criterion; 4] = [
    Criterion::known("coverage", name::COVERAGE, Goal::Maximize),
    Criterion::known("critical force", name::CRITICAL_FORCE, Goal::Maximize),
    Criterion::known("penetration resistance", name::PENETRATION, Goal::Minimize),
    Criterion::known("flexural compliance", name::COMPLIANCE, Goal::Maximize),
];

/// Keys of the parameters that convert dimensionless values to physical units.
const UNITS: [&str; 3] = [key::THICKNESS, key::SUBSTRATE_MODULUS, key::MEMBRANE_MODULUS];

/// Error: a text is not a criterion.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:{}", column(found))]
pub struct InvalidCriterion {
    /// The invalid text.
    pub found: String,
}

/// Returns the part of an invalid criterion that may be a column, for the suggestion.
fn column(found: &str) -> &str {
    let column = found.rsplit(':').next().unwrap_or_default();
    if column.is_empty() { name::COVERAGE } else { column }
}

impl Criterion {
    const fn known(name: &'static str, column: &'static str, goal: Goal) -> Self {
        Self { name: Cow::Borrowed(name), column: Cow::Borrowed(column), goal }
    }

    /// Returns the default criteria: coverage, critical force, penetration and compliance.
    ///
    /// If designs differ in thickness or moduli, the criteria are in physical units.
    pub fn usual(sweep: Option<&Sweep>) -> Vec<Self> {
        let mut criteria = CRITERIA.to_vec();
        let Some(sweep) = sweep.filter(|sweep| {
            UNITS.iter().any(|key| sweep.grid().axis(key).is_some_and(|axis| axis.len() > 1))
        }) else {
            return criteria;
        };
        for criterion in &mut criteria {
            let column = ValueColumn::in_units_of(sweep, &criterion.column);
            let column = column.and_then(|column| Some((column.name(), column.good()?)));
            if let Some((name, goal)) = column {
                *criterion = Self::new(name, goal);
            }
        }
        criteria
    }

    /// Creates the criterion to maximise or minimise a column.
    pub fn new(column: &str, goal: Goal) -> Self {
        // A criterion of the paper must have its name in `CRITERIA`, because
        // `Preferences::has_paper_criteria` also compares names.
        let known = CRITERIA.iter().find(|known| known.column == column && known.goal == goal);
        known.cloned().unwrap_or_else(|| Self {
            name: format!("{} {column}", ["largest", "least"][usize::from(goal == Goal::Minimize)])
                .into(),
            column: column.to_owned().into(),
            goal,
        })
    }

    /// Returns the name of the criterion in headers of tables.
    ///
    /// The name is the column name, except for the resistance to penetration, which is the inverse
    /// of the column `penetration`.
    pub fn key(&self) -> &str {
        if *self == CRITERIA[2] { "penetration_resistance" } else { &self.column }
    }
}

impl FromStr for Criterion {
    type Err = InvalidCriterion;

    fn from_str(text: &str) -> Result<Self, InvalidCriterion> {
        let text = text.trim();
        let found = [Goal::Maximize, Goal::Minimize]
            .into_iter()
            .find_map(|goal| Some((text.strip_prefix(goal.key())?.strip_prefix(':')?, goal)))
            .or_else(|| Some((text, plain_goal(text)?)));
        let found = found.map(|(column, goal)| (column.trim(), goal));
        match found {
            Some((column, goal)) if !column.is_empty() && !column.contains(':') => {
                Ok(Self::new(column, goal))
            }
            _ => Err(InvalidCriterion { found: text.to_owned() }),
        }
    }
}

impl Serialize for Criterion {
    /// Serializes the criterion as text.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl fmt::Display for Criterion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.goal.key(), self.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn criteria_round_trip_through_text() {
        for criterion in &CRITERIA {
            assert_eq!(criterion.to_string().parse().as_ref(), Ok(criterion));
            assert_eq!(criterion.column.parse().as_ref(), Ok(criterion));
        }
        let gap: Criterion = "max: gap_over_t".parse().expect("a criterion");
        assert_eq!(
            (gap.to_string(), gap.name.as_ref()),
            ("max:gap_over_t".into(), "largest gap_over_t")
        );
        assert_eq!(Criterion::new("penetration", Goal::Maximize).key(), "penetration");
    }

    #[test]
    fn columns_without_a_known_direction_need_max_or_min() {
        let message = |text: &str| text.parse::<Criterion>().expect_err("invalid").to_string();
        insta::assert_snapshot!(message("gap_over_t"), @"gap_over_t is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:gap_over_t");
        insta::assert_snapshot!(message("best:sink"), @"best:sink is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:sink");
        insta::assert_snapshot!(message("max:"), @"max: is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:coverage");
    }
}
