//! Reads the section `[goal]`: objectives, requirements, and the size of the search.

use std::str::FromStr;

use ranking::{Criterion, Goal, Relation, Requirement, Standard};
use serde_json::{Map, Value as Json, json};
use sweep::{InvalidDefinition, Problem, refuse};
use text::nearest;
use text::toml_source::{KeyValue, Location, Value};

use super::fitness_section::FitnessSection;
use super::refusal::not_accepted;

/// Maximum number of objectives.
const MOST_OBJECTIVES: usize = 4;

/// Keys of the section.
const KEYS: [&str; 13] = [
    "maximize", "minimize", "require", "protects", "weights", "rescale", "sound", "confirm",
    "round", "samples", "points", "skins", "seed",
];

/// A column in the goal, with the key that names it and the position in the file.
pub(super) struct Written<'a> {
    pub column: &'a str,
    pub key: &'static str,
    pub location: &'a Location,
}

/// Values of the section read so far, with their positions in the file.
pub(super) struct GoalSection {
    pub objectives: Vec<(Criterion, Location)>,
    pub requirements: Vec<(Requirement, Location)>,
    pub standards: Vec<&'static Standard>,
    pub fitness: FitnessSection,
    pub sound: bool,
    pub confirm: bool,
    pub round: Option<(f64, Location)>,
    pub samples: usize,
    pub points: usize,
    pub skins: usize,
    pub skins_location: Option<Location>,
    pub seed: u64,
}

/// Largest accepted step for rounding lengths.
const COARSEST: f64 = 100.0;
/// Smallest and largest accepted number of space-filling points.
const SAMPLES: [usize; 2] = [2, 10_000_000];
/// Smallest and largest accepted number of points of a front.
const POINTS: [usize; 2] = [2, 1000];
/// Smallest and largest accepted number of samples of each design.
const SKINS: [usize; 2] = [20, 100_000];
/// Smallest and largest accepted seed.
const SEEDS: [usize; 2] = [0, 1_000_000_000];

/// Returns the JSON schema of the section `[goal]`.
pub fn goal_schema() -> Json {
    let default = GoalSection::default();
    let protects = format!("levels of standards: {}", Standard::levels());
    // Schemas in the order of `KEYS`. The array has the length of `KEYS`, so none can be missing.
    let about: [Json; KEYS.len()] = [
        texts_schema("columns of designs.csv to be maximised, e.g. \"critical_force\""),
        texts_schema("columns of designs.csv to be minimised"),
        texts_schema("requirements COLUMN OP NUMBER, e.g. \"coverage >= 0.5\""),
        texts_schema(&protects),
        FitnessSection::weights_schema(),
        FitnessSection::rescale_schema(),
        json!({
            "type": "boolean", "default": default.sound,
            "description": "exclude designs with a folded surface",
        }),
        json!({
            "type": "boolean", "default": default.confirm,
            "description": "the best design must also meet the requirements with full substrate coupling and at eleven load positions",
        }),
        json!({
            "type": "number", "exclusiveMinimum": 0, "maximum": COARSEST,
            "description": "round the lengths of the best design to multiples of this step, in mm or, without material.thickness_mm, in units of the thickness; round angles to whole degrees",
        }),
        count_schema(SAMPLES, default.samples, "number of space-filling points"),
        count_schema(POINTS, default.points, "number of points of a front"),
        count_schema(
            SKINS,
            default.skins,
            "number of samples of each design, for yields and quantiles",
        ),
        count_schema(SEEDS, default.seed as usize, "seed of the random numbers"),
    ];
    let keys = KEYS.into_iter().map(str::to_owned).zip(about);
    json!({
        "type": "object",
        "description": "Goal of a search by squama optimise",
        "properties": keys.collect::<Map<_, _>>(),
        "additionalProperties": false,
    })
}

/// Returns the JSON schema of a text or a list of texts.
fn texts_schema(about: &str) -> Json {
    let text = json!({ "type": "string" });
    let list = json!({ "type": "array", "items": text });
    json!({ "anyOf": [text, list], "description": about })
}

/// Returns the JSON schema of an integer in a range.
fn count_schema([low, high]: [usize; 2], default: usize, about: &str) -> Json {
    json!({
        "type": "integer", "minimum": low, "maximum": high,
        "default": default, "description": about,
    })
}

impl Default for GoalSection {
    fn default() -> Self {
        Self {
            objectives: Vec::new(),
            requirements: Vec::new(),
            standards: Vec::new(),
            fitness: FitnessSection::default(),
            sound: true,
            confirm: false,
            round: None,
            samples: 128,
            points: 30,
            skins: 200,
            skins_location: None,
            seed: 0,
        }
    }
}

impl GoalSection {
    /// Reads one key of the section. The error states the position in the file.
    pub fn entry(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        match entry.key.as_str() {
            "maximize" => self.objectives(entry, Goal::Maximize)?,
            "minimize" => self.objectives(entry, Goal::Minimize)?,
            "require" => self.requirements(entry)?,
            "protects" => self.levels(entry)?,
            "weights" => self.fitness.weights(entry)?,
            "rescale" => self.fitness.rescale(entry)?,
            "sound" => self.sound = switch(entry)?,
            "confirm" => self.confirm = switch(entry)?,
            "round" => self.round = Some((step(entry)?, entry.location.clone())),
            "samples" => self.samples = count(entry, SAMPLES)?,
            "points" => self.points = count(entry, POINTS)?,
            "skins" => {
                self.skins = count(entry, SKINS)?;
                self.skins_location = Some(entry.location.clone());
            }
            "seed" => self.seed = count(entry, SEEDS)? as u64,
            key => {
                let hint = match nearest(key, &KEYS) {
                    Some(near) => format!("did you mean goal.{near}?"),
                    None => format!("expected one of {}", KEYS.join(", ")),
                };
                let problem = Problem::Unknown { value: entry.value.to_string(), hint };
                return Err(refuse(&entry.location, &format!("goal.{key}"), problem));
            }
        }
        Ok(())
    }

    /// Returns the columns of objectives, then of requirements, with their positions in the file.
    pub fn columns(&self) -> impl Iterator<Item = Written<'_>> {
        let objectives = self.objectives.iter().map(|(criterion, location)| Written {
            column: &criterion.column,
            key: match criterion.goal {
                Goal::Maximize => "goal.maximize",
                Goal::Minimize => "goal.minimize",
            },
            location,
        });
        let required = self.requirements.iter().map(|(requirement, location)| Written {
            column: &requirement.column,
            key: "goal.require",
            location,
        });
        objectives.chain(required)
    }

    /// Reads the columns of `entry`, which are all maximised or all minimised.
    fn objectives(&mut self, entry: &KeyValue, goal: Goal) -> Result<(), InvalidDefinition> {
        for column in texts(entry, "a column, e.g. \"critical_force\"")? {
            let criterion = Criterion::new(column, goal);
            if self.objectives.iter().any(|(other, _)| other.column == criterion.column) {
                return Err(wrong(entry, column, "each column only once as an objective"));
            }
            self.objectives.push((criterion, entry.location.clone()));
        }
        if self.objectives.len() > MOST_OBJECTIVES {
            let expected = format!("at most {MOST_OBJECTIVES} objectives");
            let found = format!("{} objectives", self.objectives.len());
            return Err(wrong(entry, found, expected));
        }
        Ok(())
    }

    /// Reads levels of standards, e.g. `needle 2`, and adds them as requirements.
    fn levels(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let expected = format!("a level of a standard: {}", Standard::levels());
        for text in texts(entry, &expected)? {
            let level = Standard::requirement(text);
            let (standard, level) = level.ok_or_else(|| wrong(entry, text, expected.as_str()))?;
            self.requirements.push((level, entry.location.clone()));
            self.standards.push(standard);
        }
        Ok(())
    }

    /// Reads requirements such as `coverage >= 0.5`.
    fn requirements(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let expected = "COLUMN OP NUMBER, OP being >=, <=, > or <, e.g. \"coverage >= 0.5\"; to fix a parameter, state its value in its section";
        for text in texts(entry, "a requirement, e.g. \"coverage >= 0.5\"")? {
            match Requirement::from_str(text) {
                Ok(read) if read.relation != Relation::Equal => {
                    self.requirements.push((read, entry.location.clone()));
                }
                _ => return Err(wrong(entry, text, expected)),
            }
        }
        Ok(())
    }
}

/// Returns the error for the value `found` in `entry` where `expected` was expected.
fn wrong(
    entry: &KeyValue,
    found: impl std::fmt::Display,
    expected: impl Into<String>,
) -> InvalidDefinition {
    not_accepted(&entry.location, &format!("goal.{}", entry.key), found, expected)
}

/// Returns the texts in a value that is a list of texts or a single text.
///
/// `expected` describes an accepted text in the error for other values.
fn texts<'v>(entry: &'v KeyValue, expected: &str) -> Result<Vec<&'v str>, InvalidDefinition> {
    let items = match &entry.value {
        Value::List(items) => items.as_slice(),
        value => std::slice::from_ref(value),
    };
    items
        .iter()
        .map(|item| match item {
            Value::Text(text) => Ok(text.as_str()),
            other => Err(wrong(entry, other, expected)),
        })
        .collect()
}

/// Reads the value `true` or `false`.
fn switch(entry: &KeyValue) -> Result<bool, InvalidDefinition> {
    match &entry.value {
        Value::Other(text) if text == "true" => Ok(true),
        Value::Other(text) if text == "false" => Ok(false),
        value => Err(wrong(entry, value, "true or false")),
    }
}

/// Reads the step for rounding lengths.
fn step(entry: &KeyValue) -> Result<f64, InvalidDefinition> {
    let read = match &entry.value {
        Value::Number(text) => text.parse().ok().filter(|step| *step > 0.0 && *step <= COARSEST),
        _ => None,
    };
    read.ok_or_else(|| {
        wrong(entry, &entry.value, format!("a number above 0, at most {COARSEST}, e.g. 0.05"))
    })
}

/// Reads an integer from `low` to `high`.
fn count(entry: &KeyValue, [low, high]: [usize; 2]) -> Result<usize, InvalidDefinition> {
    let read = match &entry.value {
        Value::Number(text) => text.parse().ok().filter(|count| (low..=high).contains(count)),
        _ => None,
    };
    read.ok_or_else(|| wrong(entry, &entry.value, format!("a whole number from {low} to {high}")))
}
