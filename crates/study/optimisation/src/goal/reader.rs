//! Reads a goal from the keys and values of a file, and checks it.

use std::fmt::Write as _;
use std::path::Path;

use ranking::{FitnessGoal, Relation, Requirement};
use results::columns::{design_columns, measure_of};
use results::measurement_conditions;
use sweep::{
    Axis, InvalidDefinition, Problem, Role, Setting, Sweep, VariableValues, entries, key,
    read_entries, refuse,
};
use text::nearest;
use text::toml_source::{KeyValue, KeyValues, Location, Value};

use super::bounds::out_of_bounds;
use super::refusal::{no_effect, not_accepted};
use super::section::{GoalSection, Written};
use super::{DesignGoal, statistics};
use crate::column::NumberColumn;
use crate::space::{DesignSpace, Interval};
use crate::statistic::Statistic;

impl DesignGoal {
    /// Reads the goal in the file at `path` and applies `settings`.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or does not define a goal. The error lists all problems.
    pub fn read(path: &Path, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::read_with(path, settings, &[])
    }

    /// Reads a goal like [`Self::read`], and adds the requirements in `required`.
    ///
    /// # Errors
    ///
    /// See [`Self::read`].
    pub fn read_with(
        path: &Path,
        settings: &[Setting],
        required: &[Requirement],
    ) -> Result<Self, InvalidDefinition> {
        let mut entries = read_entries(path, settings)?;
        for requirement in required {
            require(&mut entries, requirement);
        }
        Self::of_section(&entries, &path.display().to_string(), required)
    }

    /// Reads the goal in `text` and applies `settings`; messages contain the file name `name`.
    ///
    /// # Errors
    ///
    /// If the text does not define a goal. The error lists all problems.
    pub fn parse(text: &str, name: &str, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&entries(text, name, settings)?, name)
    }

    /// Creates the goal from `entries`, the keys and values of the file `name`.
    ///
    /// # Errors
    ///
    /// If the entries do not define a goal. The error lists all problems.
    pub fn of_entries(entries: &KeyValues, name: &str) -> Result<Self, InvalidDefinition> {
        Self::of_section(entries, name, &[])
    }

    /// Creates the goal like [`Self::of_entries`].
    ///
    /// `required` are the requirements of the command line. `entries` already contain them.
    fn of_section(
        entries: &KeyValues,
        name: &str,
        required: &[Requirement],
    ) -> Result<Self, InvalidDefinition> {
        let file = Location::File { name: name.into(), line: None };
        let definition = entries.iter().filter(|entry| entry.key != "goal").cloned().collect();
        let mut refused = Vec::new();
        let mut section = goal_section(entries, &file, &mut refused);
        for (requirement, location) in &mut section.requirements {
            // Errors in requirements of the command line must not state a line of the file.
            if required.contains(requirement) {
                *location = argument(requirement);
            }
        }
        let sweep = match Sweep::of_entries(&definition, name) {
            Ok(sweep) => sweep,
            Err(error) => {
                refused.insert(0, error);
                return Err(InvalidDefinition::several(refused));
            }
        };
        refused.extend(unsearchable(entries, &sweep, &file));
        let is_named = section.columns().any(|named| named.column == NumberColumn::FITNESS);
        let fitness = section.fitness.goal(is_named).unwrap_or_else(|error| {
            refused.push(error);
            None
        });
        if refused.is_empty() {
            refused.extend(meaningless_keys(&section, fitness.as_ref(), &sweep));
        }
        let space = DesignSpace::new(sweep, section.round.as_ref().map(|(round, _)| *round));
        if refused.is_empty() {
            refused.extend(not_rounded(&section, &space));
            refused.extend(out_of_bounds(&section, &space));
        }
        if !refused.is_empty() {
            return Err(InvalidDefinition::several(refused));
        }
        Ok(Self {
            space,
            objectives: section.objectives.into_iter().map(|(objective, _)| objective).collect(),
            requirements: section.requirements.into_iter().map(|(required, _)| required).collect(),
            standards: section.standards,
            fitness,
            sound: section.sound,
            confirm: section.confirm,
            round: section.round.map(|(round, _)| round),
            samples: section.samples,
            points: section.points,
            samples_per_design: section.skins,
            seed: section.seed,
            text: to_toml(entries),
        })
    }
}

/// Returns the position that messages state for a requirement of the command line.
fn argument(requirement: &Requirement) -> Location {
    Location::Argument(format!("--require '{requirement}'").into())
}

/// Adds a requirement to the key `require` of the section `[goal]` in `entries`.
fn require(entries: &mut KeyValues, requirement: &Requirement) {
    let (name, text, location) = ("require", requirement.to_string(), argument(requirement));
    let goal = entries.iter_mut().find(|entry| entry.key == "goal");
    // A definition without a section `[goal]` is refused later.
    let Some(KeyValue { value: Value::Table(goal), .. }) = goal else { return };
    let required = goal.iter_mut().find(|entry| entry.key == name).map(|entry| &mut entry.value);
    match required {
        Some(Value::List(all)) => all.push(Value::Text(text)),
        Some(one) => *one = Value::List(vec![one.clone(), Value::Text(text)]),
        None => goal.push(KeyValue { key: name.into(), value: Value::Text(text), location }),
    }
}

/// Returns the entries of the section `name`; empty if there is no such section.
fn section<'e>(entries: &'e KeyValues, name: &str) -> &'e [KeyValue] {
    match entries.iter().find(|entry| entry.key == name).map(|entry| &entry.value) {
        Some(Value::Table(inner)) => inner,
        _ => &[],
    }
}

/// Reads the section `[goal]`. Errors are added to `refused`.
fn goal_section(
    entries: &KeyValues,
    file: &Location,
    refused: &mut Vec<InvalidDefinition>,
) -> GoalSection {
    let mut goal = GoalSection::default();
    for entry in section(entries, "goal") {
        refused.extend(goal.entry(entry).err());
    }
    if goal.objectives.is_empty() && refused.is_empty() {
        let expected = "at least one objective, e.g. maximize = [\"critical_force\"]";
        refused.push(refuse(file, "goal", Problem::Missing(expected)));
    }
    goal
}

/// Returns errors for variables and parameters that do not define a space to search.
///
/// These are missing variables, intervals of parameters that are not continuous, and parameters
/// that have several values but are not variables.
fn unsearchable(entries: &KeyValues, sweep: &Sweep, file: &Location) -> Vec<InvalidDefinition> {
    if sweep.variables().is_empty() {
        let expected =
            "a section of at least one variable, e.g. gap_over_t = { from = 0.1, to = 1 }";
        return vec![refuse(file, "variables", Problem::Missing(expected))];
    }
    let vague = sweep
        .variables()
        .iter()
        .filter(|variable| {
            let parameter = variable.parameter();
            let describes = parameter.has(Role::Continuous) || parameter.has(Role::Toleranced);
            matches!(variable.values(), VariableValues::Between(..)) && !describes
        })
        .map(|variable| {
            let key = variable.parameter().key;
            let expected =
                "a list of its values, because it is not a continuous parameter of the skin";
            let location = entry_location(entries, "variables", key).unwrap_or(file);
            not_accepted(location, &format!("variables.{key}"), variable.to_toml(), expected)
        });
    let open = sweep.grid().axes().iter().filter(|axis| axis.len() > 1).map(|axis: &Axis| {
        let key = axis.parameter().key;
        let expected = format!("one value, or {key} among [variables]");
        let location = entry_location(entries, "designs", key).unwrap_or(file);
        not_accepted(location, &format!("designs.{key}"), axis.to_toml(), expected)
    });
    vague.chain(open).collect()
}

/// Returns the position in the file of a key in the section `section_name`.
fn entry_location<'e>(
    entries: &'e KeyValues,
    section_name: &str,
    key: &str,
) -> Option<&'e Location> {
    let mut section = section(entries, section_name).iter();
    section.find(|entry| entry.key == key).map(|entry| &entry.location)
}

/// Returns errors for keys of a goal that have no meaning.
///
/// These are unknown columns, objectives that cannot be compared between designs, requirements that
/// no design can meet, and yields without meaning.
fn meaningless_keys(
    goal: &GoalSection,
    fitness: Option<&FitnessGoal>,
    sweep: &Sweep,
) -> Vec<InvalidDefinition> {
    let known = design_columns(sweep);
    let known: Vec<&str> = known.iter().map(|column| column.name.as_ref()).collect();
    let named = named(goal, fitness);
    let columns = named.iter().filter_map(|named| {
        let unavailable = statistics::unavailable(named, sweep);
        let is_nominal = Statistic::named(named.column).is_none() || known.contains(&named.column);
        unavailable.or_else(|| missing_column(named, &known, sweep).filter(|_| is_nominal))
    });
    // This check is for objectives only, because requirements do not compare designs. For example,
    // if the critical tilt is a variable, a force may be required but not maximised.
    let objectives = named.iter().filter(|named| named.key != "goal.require");
    let incomparable = objectives.flat_map(|Written { column, key, location }| {
        sweep
            .variables()
            .iter()
            .filter(|v| {
                measurement_conditions(Statistic::base(column)).contains(&v.parameter().key)
            })
            .map(|variable| {
                let found = format!("an objective with {} as a variable", variable.parameter().key);
                not_accepted(location, key, found, "values that can be compared between designs")
            })
    });
    let found = columns.chain(incomparable).chain(contradictions(goal));
    found.chain(out_of_reach(goal, sweep)).chain(statistics::meaningless_keys(goal)).collect()
}

/// Returns the columns of a goal. The fitness is replaced by the columns of its criteria.
fn named<'a>(goal: &'a GoalSection, fitness: Option<&'a FitnessGoal>) -> Vec<Written<'a>> {
    let (of_fitness, mut named): (Vec<_>, Vec<_>) =
        goal.columns().partition(|named| named.column == NumberColumn::FITNESS);
    let criteria = fitness.iter().flat_map(|fitness| &fitness.criteria);
    for (location, criterion) in of_fitness
        .first()
        .into_iter()
        .flat_map(|first| criteria.clone().map(move |criterion| (first.location, criterion)))
    {
        named.push(Written { column: &criterion.column, key: "goal.weights", location });
    }
    named
}

/// Returns the error for a column that does not exist or is not computed; otherwise `None`.
///
/// `known` are the names of the columns of `designs.csv`.
fn missing_column(named: &Written, known: &[&str], sweep: &Sweep) -> Option<InvalidDefinition> {
    let Written { column, key, location } = *named;
    if known.contains(&column) {
        let is_measured = measure_of(column).is_none_or(|m| sweep.measures().contains(&m));
        let expected = "a column of the requested `measures`";
        return (!is_measured).then(|| not_accepted(location, key, column, expected));
    }
    let expected = match (statistics::nearly(column, known), nearest(column, known)) {
        (Some(quantiles), _) => quantiles,
        (None, Some(near)) => format!("a column of designs.csv; did you mean {near}?"),
        (None, None) => {
            "a column of designs.csv, e.g. critical_force; columns in mm, N and kg need a section [material]"
                .to_owned()
        }
    };
    Some(not_accepted(location, key, column, expected))
}

/// Returns errors for pairs of requirements that exclude each other.
fn contradictions(goal: &GoalSection) -> Vec<InvalidDefinition> {
    let mut found = Vec::new();
    for (k, (upper, location)) in goal.requirements.iter().enumerate() {
        let mut earlier = goal.requirements[..k].iter().map(|(lower, _)| lower);
        if let Some(other) = earlier.find(|lower| exclude(lower, upper) || exclude(upper, lower)) {
            let expected = format!("a bound that is compatible with {other}");
            found.push(not_accepted(location, "goal.require", upper, expected));
        }
    }
    found
}

/// Returns true if `lower` is a lower bound that exceeds the upper bound `upper` of the same
/// column.
fn exclude(lower: &Requirement, upper: &Requirement) -> bool {
    let is_lower = matches!(lower.relation, Relation::AtLeast | Relation::Above);
    let is_upper = matches!(upper.relation, Relation::AtMost | Relation::Below);
    let strict = lower.relation == Relation::Above || upper.relation == Relation::Below;
    let same = lower.column == upper.column && is_lower && is_upper;
    same && (lower.limit > upper.limit || (strict && lower.limit >= upper.limit))
}

/// Returns errors for requirements on variables that no value in the variable's range can meet.
fn out_of_reach<'a>(
    goal: &'a GoalSection,
    sweep: &'a Sweep,
) -> impl Iterator<Item = InvalidDefinition> + 'a {
    goal.requirements.iter().filter_map(|(requirement, location)| {
        let VariableValues::Between(from, to) = *sweep
            .variables()
            .iter()
            .find(|variable| variable.parameter().key == requirement.column)?
            .values()
        else {
            return None;
        };
        let is_met = [from, to].iter().any(|end| requirement.is_met(*end));
        let expected = format!("a bound that values from {from} to {to} can meet");
        (!is_met).then(|| not_accepted(location, "goal.require", requirement, expected))
    })
}

/// Returns the error if the key `round` cannot be applied to the best design.
fn not_rounded(goal: &GoalSection, space: &DesignSpace) -> Option<InvalidDefinition> {
    let (round, location) = goal.round.as_ref()?;
    let name = "goal.round";
    if goal.objectives.len() > 1 {
        return Some(no_effect(
            location,
            name,
            "it rounds one best design, and a front has several",
        ));
    }
    let mut sizes = space.intervals().iter().filter(|interval| interval.step.is_some());
    if sizes.clone().next().is_none() {
        return Some(no_effect(location, name, "no variable is a length or an angle"));
    }
    let varies_thickness = space.parameters().any(|parameter| parameter.key == key::THICKNESS);
    let over_t = sizes.clone().find(|interval| interval.parameter.unit == "t");
    if let Some(interval) = over_t.filter(|_| varies_thickness) {
        let thickness = key::THICKNESS;
        let found = format!("{round} beside {} and {thickness}", interval.parameter.key);
        let expected = "variables in mm, e.g. gap_mm, because the thickness varies";
        return Some(not_accepted(location, name, found, expected));
    }
    let coarse = sizes.find(|interval| interval.multiples().is_none_or(|all| all.is_empty()))?;
    let Interval { parameter, from, to, .. } = *coarse;
    let expected = format!("a step with a multiple in {} from {from} to {to}", parameter.key);
    Some(not_accepted(location, name, round, expected))
}

/// Formats the keys and values of a goal as TOML.
fn to_toml(entries: &KeyValues) -> String {
    // Write values before tables, because in TOML a value after a table belongs to the table.
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
