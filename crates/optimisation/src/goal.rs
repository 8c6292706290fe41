//! The goal of an optimisation as it is written: variables, objectives, requirements.

mod fitness_section;
mod quantities;
mod reader;
mod section;

use std::fmt::Write as _;
use std::path::Path;

use ranking::{Criterion, Requirement};
use sweep::toml_source::{KeyValues, Value};
use sweep::{InvalidDefinition, Setting, entries, read_entries};

use crate::fitness::FitnessGoal;
use crate::space::DesignSpace;

/// Objectives of a goal, at most.
pub(crate) const MOST_OBJECTIVES: usize = 4;

/// The goal of an optimisation: the space in which designs are searched, and what is good there.
#[derive(Clone, Debug)]
pub struct DesignGoal {
    /// The variables, and what all designs share.
    pub space: DesignSpace,
    /// The columns that are to be large or small: one gives an optimum, two to four a front.
    pub objectives: Vec<Criterion>,
    /// The bounds that columns must keep.
    pub requirements: Vec<Requirement>,
    /// The criteria of the fitness, if the goal names it.
    pub fitness: Option<FitnessGoal>,
    /// Whether only designs count whose surface has not folded.
    pub sound: bool,
    /// The number of points that fill the space before any is improved.
    pub samples: usize,
    /// The number of points of a front.
    pub points: usize,
    /// The number of skins that are made of each design, if the goal is about them.
    pub skins: usize,
    /// The seed of the points that fill the space.
    pub seed: u64,
    text: String,
}

impl DesignGoal {
    /// The goal in the file at `path` once `settings` are put in its place.
    ///
    /// # Errors
    /// If the file cannot be read or holds no goal; all that is wrong with it is told at once.
    pub fn read(path: &Path, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&read_entries(path, settings)?, &path.display().to_string())
    }

    /// The goal that `text`, from the file `name`, holds once `settings` are put in its place.
    ///
    /// # Errors
    /// If the text holds no goal.
    pub fn parse(text: &str, name: &str, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&entries(text, name, settings)?, name)
    }

    fn of_entries(entries: &KeyValues, name: &str) -> Result<Self, InvalidDefinition> {
        reader::read(entries, name, to_toml(entries))
    }

    /// The name of the goal, which is also that of the folder of its results.
    pub fn name(&self) -> &str {
        self.space.sweep().name()
    }

    /// The goal in TOML, which reads back as the same.
    pub fn to_toml(&self) -> &str {
        &self.text
    }
}

/// Keys and values as TOML again.
fn to_toml(entries: &KeyValues) -> String {
    let (tables, values): (Vec<_>, Vec<_>) =
        entries.iter().partition(|entry| matches!(entry.value, Value::Table(_)));
    let mut text = String::new();
    // Writing to a string cannot fail.
    for entry in values {
        let _ = writeln!(text, "{} = {}", entry.key, entry.value);
    }
    for entry in tables {
        let Value::Table(inner) = &entry.value else { continue };
        let _ = writeln!(text, "\n[{}]", entry.key);
        for entry in inner {
            let _ = writeln!(text, "{} = {}", entry.key, entry.value);
        }
    }
    text
}
