//! A criterion: a column of the tables, and which of its values are good.

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use results::columns::{Goal, name, plain_goal};
use serde::{Serialize, Serializer};

/// A criterion: a column of the tables, and which of its values are good.
///
/// ```
/// use ranking::{Criterion, Goal};
///
/// let criterion: Criterion = "min:areal_mass_kg_m2".parse()?;
/// assert_eq!((criterion.column.as_ref(), criterion.goal), ("areal_mass_kg_m2", Goal::Minimize));
/// // What is good needs no word where it is plain.
/// assert_eq!("penetration".parse::<Criterion>()?.goal, Goal::Minimize);
/// # Ok::<(), ranking::InvalidCriterion>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Criterion {
    /// The name of the criterion in words.
    pub name: Cow<'static, str>,
    /// The column that it is made from.
    pub column: Cow<'static, str>,
    /// Which of its values are good.
    pub goal: Goal,
}

/// The criteria of the paper in the order of their weights `m, n, k, l`.
pub static CRITERIA: [Criterion; 4] = [
    Criterion::known("coverage", name::COVERAGE, Goal::Maximize),
    Criterion::known("critical force", name::CRITICAL_FORCE, Goal::Maximize),
    Criterion::known("penetration resistance", name::PENETRATION, Goal::Minimize),
    Criterion::known("flexural compliance", name::COMPLIANCE, Goal::Maximize),
];

/// A text that is no criterion.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:{}", column(found))]
pub struct InvalidCriterion {
    /// The text.
    pub found: String,
}

/// The part of a text that may be a column.
fn column(found: &str) -> &str {
    let column = found.rsplit(':').next().unwrap_or_default();
    if column.is_empty() { name::COVERAGE } else { column }
}

impl Criterion {
    const fn known(name: &'static str, column: &'static str, goal: Goal) -> Self {
        Self { name: Cow::Borrowed(name), column: Cow::Borrowed(column), goal }
    }

    /// The criterion that a column is to be as large, or as small, as can be.
    pub fn new(column: &str, goal: Goal) -> Self {
        // One of the paper's has its name, too: `are_the_papers` compares whole criteria.
        let known = CRITERIA.iter().find(|known| known.column == column && known.goal == goal);
        let own = || Self {
            name: format!("{} {column}", ["largest", "least"][usize::from(goal == Goal::Minimize)])
                .into(),
            column: column.to_owned().into(),
            goal,
        };
        known.cloned().unwrap_or_else(own)
    }

    /// The name of the criterion in the headers of tables. Resistance to penetration is another thing than penetration.
    pub fn key(&self) -> &str {
        if *self == CRITERIA[2] { "penetration_resistance" } else { &self.column }
    }
}

impl FromStr for Criterion {
    type Err = InvalidCriterion;

    fn from_str(text: &str) -> Result<Self, InvalidCriterion> {
        let text = text.trim();
        let plain = || Some((text, plain_goal(text)?));
        let read = |goal: Goal| Some((text.strip_prefix(goal.key())?.strip_prefix(':')?, goal));
        let found = read(Goal::Maximize).or_else(|| read(Goal::Minimize)).or_else(plain);
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
    /// As it is written.
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
    fn criteria_are_written_as_they_are_read() {
        for criterion in &CRITERIA {
            assert_eq!(criterion.to_string().parse().as_ref(), Ok(criterion));
            assert_eq!(criterion.column.parse().as_ref(), Ok(criterion));
        }
        let own: Criterion = "max: gap_over_t".parse().expect("a criterion");
        assert_eq!(
            (own.to_string(), own.name.as_ref()),
            ("max:gap_over_t".into(), "largest gap_over_t")
        );
        assert_eq!(Criterion::new("penetration", Goal::Maximize).key(), "penetration");
    }

    #[test]
    fn what_is_good_must_be_said_where_it_is_not_plain() {
        let message = |text: &str| text.parse::<Criterion>().expect_err("invalid").to_string();
        insta::assert_snapshot!(message("gap_over_t"), @"gap_over_t is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:gap_over_t");
        insta::assert_snapshot!(message("best:sink"), @"best:sink is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:sink");
        insta::assert_snapshot!(message("max:"), @"max: is not accepted, expected max:COLUMN or min:COLUMN, e.g. max:coverage");
    }
}
