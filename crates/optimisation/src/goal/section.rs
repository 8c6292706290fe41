//! The section `[goal]`: objectives, requirements, and how much is searched.

use ranking::{Criterion, Goal, Requirement};
use sweep::toml_source::{KeyValue, Place, Value};
use sweep::{InvalidDefinition, nearest};

use super::MOST_OBJECTIVES;
use super::fitness_section::FitnessSection;
use super::reader::{not_accepted, unknown};

/// Keys of the section.
const KEYS: [&str; 10] = [
    "maximize", "minimize", "require", "weights", "rescale", "sound", "samples", "points", "skins",
    "seed",
];

/// A requirement, and where it is written.
pub(super) struct PlacedRequirement {
    pub requirement: Requirement,
    pub place: Place,
}

/// An objective, and where it is written.
pub(super) struct PlacedObjective {
    pub criterion: Criterion,
    pub place: Place,
}

/// The section as it is understood so far.
pub(super) struct GoalSection {
    pub objectives: Vec<PlacedObjective>,
    pub requirements: Vec<PlacedRequirement>,
    pub fitness: FitnessSection,
    pub sound: bool,
    pub samples: usize,
    pub points: usize,
    pub skins: usize,
    pub skins_place: Option<Place>,
    pub seed: u64,
}

impl Default for GoalSection {
    fn default() -> Self {
        Self {
            objectives: Vec::new(),
            requirements: Vec::new(),
            fitness: FitnessSection::default(),
            sound: true,
            samples: 1024,
            points: 30,
            skins: 200,
            skins_place: None,
            seed: 0,
        }
    }
}

impl GoalSection {
    /// Understands one key.
    pub fn entry(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        match entry.key.as_str() {
            "maximize" => self.objectives(entry, Goal::Maximize)?,
            "minimize" => self.objectives(entry, Goal::Minimize)?,
            "require" => self.requirements(entry)?,
            "weights" => self.fitness.weights(entry)?,
            "rescale" => self.fitness.rescale(entry)?,
            "sound" => self.sound = switch(entry)?,
            "samples" => self.samples = count(entry, 2, 10_000_000)?,
            "points" => self.points = count(entry, 2, 1000)?,
            "skins" => {
                self.skins = count(entry, 20, 100_000)?;
                self.skins_place = Some(entry.place.clone());
            }
            "seed" => self.seed = count(entry, 0, 1_000_000_000)? as u64,
            key => {
                let hint = match nearest(key, &KEYS) {
                    Some(near) => format!("did you mean goal.{near}?"),
                    None => format!("expected one of {}", KEYS.join(", ")),
                };
                return Err(unknown(&entry.place, &format!("goal.{key}"), &entry.value, hint));
            }
        }
        Ok(())
    }

    /// The columns of objectives and requirements, with the keys and the places where they are named.
    pub fn columns(&self) -> impl Iterator<Item = (&str, &'static str, &Place)> {
        let objectives = self.objectives.iter().map(|objective| {
            (objective.criterion.column.as_ref(), "goal.maximize", &objective.place)
        });
        let required = self
            .requirements
            .iter()
            .map(|placed| (placed.requirement.column.as_str(), "goal.require", &placed.place));
        objectives.chain(required)
    }

    fn objectives(&mut self, entry: &KeyValue, goal: Goal) -> Result<(), InvalidDefinition> {
        for column in texts(entry, "a column, e.g. \"critical_force\"")? {
            let criterion = Criterion::new(column, goal);
            let key = format!("goal.{}", entry.key);
            if self.objectives.iter().any(|other| other.criterion.column == criterion.column) {
                let expected = "each column as one objective".to_owned();
                return Err(not_accepted(&entry.place, &key, column, expected));
            }
            self.objectives.push(PlacedObjective { criterion, place: entry.place.clone() });
        }
        if self.objectives.len() > MOST_OBJECTIVES {
            let expected = format!("at most {MOST_OBJECTIVES} objectives");
            let found = format!("{} objectives", self.objectives.len());
            return Err(not_accepted(&entry.place, "goal.maximize", &found, expected));
        }
        Ok(())
    }

    fn requirements(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        for text in texts(entry, "a requirement, e.g. \"coverage >= 0.5\"")? {
            let expected = "COLUMN OP NUMBER, OP being >=, <=, > or <, e.g. \"coverage >= 0.5\"; a parameter that is to have one value is fixed in its section";
            let requirement: Requirement = text
                .parse()
                .ok()
                .filter(|read: &Requirement| read.relation != ranking::Relation::Equal)
                .ok_or_else(|| {
                    not_accepted(&entry.place, "goal.require", text, expected.to_owned())
                })?;
            self.requirements.push(PlacedRequirement { requirement, place: entry.place.clone() });
        }
        Ok(())
    }
}

/// The texts of a list, or the one text.
fn texts<'v>(entry: &'v KeyValue, what: &str) -> Result<Vec<&'v str>, InvalidDefinition> {
    let key = format!("goal.{}", entry.key);
    let items = match &entry.value {
        Value::List(items) => items.as_slice(),
        value => std::slice::from_ref(value),
    };
    let text = |item: &'v Value| match item {
        Value::Text(text) => Ok(text.as_str()),
        other => Err(not_accepted(&entry.place, &key, &other.to_string(), what.to_owned())),
    };
    items.iter().map(text).collect()
}

fn switch(entry: &KeyValue) -> Result<bool, InvalidDefinition> {
    match &entry.value {
        Value::Other(text) if text == "true" => Ok(true),
        Value::Other(text) if text == "false" => Ok(false),
        value => {
            let key = format!("goal.{}", entry.key);
            Err(not_accepted(&entry.place, &key, &value.to_string(), "true or false".to_owned()))
        }
    }
}

fn count(entry: &KeyValue, low: usize, high: usize) -> Result<usize, InvalidDefinition> {
    let read = match &entry.value {
        Value::Number(text) => text.parse().ok().filter(|count| (low..=high).contains(count)),
        _ => None,
    };
    read.ok_or_else(|| {
        let expected = format!("a whole number from {low} to {high}");
        let key = format!("goal.{}", entry.key);
        not_accepted(&entry.place, &key, &entry.value.to_string(), expected)
    })
}
