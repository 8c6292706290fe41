//! Preferences of a ranking: requirements, criteria, weights and scale.

use std::fmt::Write as _;

use results::{InvalidFolder, ResultsFolder, VerifiedFolder};
use text::number;
use text::toml_source::{self, KeyValue, Location, SyntaxError, Value, quoted};

use crate::criterion::{CRITERIA, Criterion};
use crate::requirement::Requirement;
use crate::scale::Scale;
use crate::weights::{InvalidWeights, MOST_CRITERIA, Weights};

/// Preferences of a ranking, stored in the file `ranking.toml` beside its tables.
///
/// ```
/// use ranking::Preferences;
///
/// let mut preferences = Preferences::paper();
/// preferences.requirements.push("coverage >= 0.6".parse()?);
/// let text = preferences.to_toml();
/// assert_eq!(Preferences::parse(&text, "ranking.toml")?, preferences);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Preferences {
    /// Requirements that a design must meet to be ranked.
    pub requirements: Vec<Requirement>,
    /// Criteria, at least one.
    pub criteria: Vec<Criterion>,
    /// Weights, one for each criterion.
    pub weights: Weights,
    /// Scale on which criteria are rescaled and combined.
    pub scale: Scale,
}

/// Error: preferences are not valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InvalidPreferences {
    /// The numbers of weights and of criteria differ.
    #[error(transparent)]
    Weights(#[from] InvalidWeights),
    /// There are no criteria, or too many.
    #[error("{0} criteria, expected 1 to {MOST_CRITERIA}")]
    Count(usize),
    /// Two criteria have the same column.
    #[error("{0} is a criterion twice")]
    Twice(String),
    /// The file cannot be read, or was edited after `squama rank` wrote it.
    #[error(transparent)]
    File(#[from] InvalidFolder),
    /// The file is not valid TOML.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// A key of the file is unknown, or has an invalid value.
    #[error("{location}: {key}: {problem}")]
    Key {
        /// Position of the key.
        location: Location,
        /// Name of the key.
        key: String,
        /// Problem and expected value.
        problem: String,
    },
}

impl Preferences {
    /// Returns the four criteria of the paper with equal weights and no requirements.
    pub fn paper() -> Self {
        Self {
            requirements: Vec::new(),
            criteria: CRITERIA.to_vec(),
            weights: Weights::BALANCED,
            scale: Scale::Paper,
        }
    }

    /// Creates preferences. Without `weights`, all criteria have the same weight.
    ///
    /// # Errors
    ///
    /// If there are no criteria or more than [`MOST_CRITERIA`], if two criteria have the same
    /// column, or if the numbers of weights and criteria differ.
    pub fn new(
        requirements: Vec<Requirement>,
        criteria: Vec<Criterion>,
        weights: Option<Weights>,
        scale: Scale,
    ) -> Result<Self, InvalidPreferences> {
        let found = criteria.len();
        if !(1..=MOST_CRITERIA).contains(&found) {
            return Err(InvalidPreferences::Count(found));
        }
        if let Some((_, twice)) = criteria.iter().enumerate().find(|(c, criterion)| {
            // Compare columns only: maximising and minimising the same column is contradictory.
            criteria[..*c].iter().any(|other| other.column == criterion.column)
        }) {
            return Err(InvalidPreferences::Twice(twice.column.clone().into_owned()));
        }
        let weights = weights.unwrap_or(Weights::equal(found));
        let found = weights.values().len();
        if found != criteria.len() {
            let names: Vec<_> = criteria.iter().map(|criterion| criterion.name.as_ref()).collect();
            return Err(InvalidWeights::Count { found, criteria: names.join(", ") }.into());
        }
        Ok(Self { requirements, criteria, weights, scale })
    }

    /// Returns true if the criteria are the four criteria of the paper.
    pub fn has_paper_criteria(&self) -> bool {
        self.criteria == CRITERIA
    }

    /// Lists the criteria with their weights, for messages.
    pub fn criteria_text(&self) -> String {
        let parts = self.criteria.iter().zip(self.weights.values());
        let parts = parts.map(|(c, weight)| format!("{} {}", c.name, number::text(*weight)));
        parts.collect::<Vec<_>>().join(", ")
    }

    /// Reads `ranking.toml` in `folder`; `None` if the folder contains no ranking.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, was edited after `squama rank` wrote it, or is missing although
    /// the folder contains tables of a ranking.
    pub fn read(folder: &VerifiedFolder) -> Result<Option<Self>, InvalidPreferences> {
        if !folder.holds(ResultsFolder::PREFERENCES) {
            // The fitness in a table has no meaning without its criteria and weights.
            if ResultsFolder::RANKING.iter().any(|table| folder.holds(table)) {
                return Err(folder.missing(ResultsFolder::PREFERENCES).into());
            }
            return Ok(None);
        }
        let text = folder.text(ResultsFolder::PREFERENCES)?;
        let name = folder.path().join(ResultsFolder::PREFERENCES);
        Self::parse(&text, &name.display().to_string()).map(Some)
    }

    /// Reads preferences from `text`, the content of the file `name`.
    ///
    /// Missing keys have the values of the paper.
    ///
    /// # Errors
    ///
    /// If the text is not valid TOML, or a key is unknown or has an invalid value.
    pub fn parse(text: &str, name: &str) -> Result<Self, InvalidPreferences> {
        let mut found = Self::paper();
        let (mut weights, mut location) = (None, Location::File { name: name.into(), line: None });
        for entry in toml_source::parse(text, name)? {
            let wrong = |problem: String| InvalidPreferences::Key {
                location: entry.location.clone(),
                key: entry.key.clone(),
                problem,
            };
            match entry.key.as_str() {
                "scale" => found.scale = one(&entry.value).map_err(wrong)?,
                "requirements" => found.requirements = list(&entry.value).map_err(wrong)?,
                "criteria" => found.criteria = list(&entry.value).map_err(wrong)?,
                "weights" => {
                    let numbers: Vec<f64> = list(&entry.value).map_err(wrong)?;
                    let read = Weights::new(&numbers).map_err(|error| wrong(error.to_string()))?;
                    // The number of weights is checked below, because the key `criteria` may follow
                    // the key `weights`.
                    (weights, location) = (Some(read), entry.location);
                }
                _ => return Err(unknown(&entry)),
            }
        }
        // Ignore the four weights in `found`: if the file gives no weights, all of its criteria,
        // which need not be four, have equal weights.
        let Self { requirements, criteria, scale, .. } = found;
        Self::new(requirements, criteria, weights, scale).map_err(|error| InvalidPreferences::Key {
            location,
            key: "criteria".to_owned(),
            problem: error.to_string(),
        })
    }

    /// Returns the preferences in TOML, which [`Self::parse`] reads back.
    pub fn to_toml(&self) -> String {
        let requirements = self.requirements.iter().map(|one| quoted(&one.to_string()));
        let criteria = self.criteria.iter().map(|one| quoted(&one.to_string()));
        let [requirements, criteria]: [Vec<_>; 2] = [requirements.collect(), criteria.collect()];
        let mut text = "# Preferences of the ranking, written by squama rank.\n".to_owned();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "requirements = [{}]", requirements.join(", "));
        let _ = writeln!(text, "criteria = [{}]", criteria.join(", "));
        let _ = writeln!(text, "weights = [{}]", self.weights);
        let _ = writeln!(text, "scale = {}", quoted(self.scale.name()));
        text
    }
}

fn unknown(entry: &KeyValue) -> InvalidPreferences {
    InvalidPreferences::Key {
        location: entry.location.clone(),
        key: entry.key.clone(),
        problem: "is not a key, expected requirements, criteria, weights or scale".to_owned(),
    }
}

/// Parses a value as `T`.
fn one<T: std::str::FromStr<Err: std::fmt::Display>>(value: &Value) -> Result<T, String> {
    match value {
        Value::Text(text) | Value::Number(text) => {
            text.parse().map_err(|error: T::Err| error.to_string())
        }
        value => Err(format!("{value} is not accepted, expected a text or a number")),
    }
}

/// Parses a value as a list of `T`.
fn list<T: std::str::FromStr<Err: std::fmt::Display>>(value: &Value) -> Result<Vec<T>, String> {
    match value {
        Value::List(items) => items.iter().map(one).collect(),
        value => Err(format!("{value} is not accepted, expected a list")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preferences_read_back_as_they_are_written() {
        let preferences = Preferences::new(
            vec!["coverage >= 0.6".parse().expect("valid"), "a < -1e-7".parse().expect("valid")],
            vec!["coverage".parse().expect("valid"), "min:gap_over_t".parse().expect("valid")],
            Some("1,2".parse().expect("valid")),
            Scale::Log,
        );
        let preferences = preferences.expect("preferences");
        let text = preferences.to_toml();
        insta::assert_snapshot!(text);
        assert_eq!(Preferences::parse(&text, "x").expect("valid"), preferences);
        assert_eq!(Preferences::parse("", "x").expect("valid"), Preferences::paper());
    }

    #[test]
    fn invalid_preferences_are_refused_with_line_and_key() {
        let message =
            |text: &str| Preferences::parse(text, "x.toml").expect_err("invalid").to_string();
        insta::assert_snapshot!(message("weights = [1, 1]"), @"x.toml:1: criteria: 2 weights, expected 4: coverage, critical force, penetration resistance, flexural compliance");
        insta::assert_snapshot!(message("\nscale = 'cubic'"), @"x.toml:2: scale: cubic is not accepted, expected paper, linear or log");
        insta::assert_snapshot!(message("requirements = ['a']"), @"x.toml:1: requirements: a is not accepted, expected COLUMN OP NUMBER, OP being >=, <=, >, < or ==, e.g. coverage >= 0.6, or a level of a standard: 'needle 1' to 'needle 5', 'probe 1' to 'probe 4', or a limit of a body part: 'pain finger', 'pain palm', 'pain forearm', 'pain torso', 'pain chest', 'pain back', 'pain thigh', 'pain shin'");
        insta::assert_snapshot!(message("criteria = []"), @"x.toml: criteria: 0 criteria, expected 1 to 8");
        insta::assert_snapshot!(message("criteria = ['coverage', 'min:coverage']"), @"x.toml: criteria: coverage is a criterion twice");
        insta::assert_snapshot!(message("weight = [1]"), @"x.toml:1: weight: is not a key, expected requirements, criteria, weights or scale");
    }
}
