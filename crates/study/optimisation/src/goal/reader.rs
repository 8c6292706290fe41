//! From keys and values to a goal.

use std::fmt::Write as _;
use std::path::Path;

use ranking::{FitnessGoal, Relation, Requirement};
use results::columns::{design_columns, measure_of};
use results::measurement_conditions;
use sweep::{
    Axis, InvalidDefinition, Problem, Role, Setting, Sweep, Variable, VariableValues, entries,
    read_entries, refuse,
};
use text::nearest;
use text::toml_source::{KeyValue, KeyValues, Place, Value};

use super::bounds::out_of_bounds;
use super::refusal::not_accepted;
use super::section::{GoalSection, Written};
use super::{DesignGoal, statistics};
use crate::column::NumberColumn;
use crate::space::DesignSpace;
use crate::statistic::Statistic;

impl DesignGoal {
    /// The goal in the file at `path` once `settings` are put in its place.
    ///
    /// # Errors
    /// If the file cannot be read or holds no goal; all that is wrong with it is told at once.
    pub fn read(path: &Path, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::read_with(path, settings, &[])
    }

    /// As [`Self::read`], with further requirements.
    ///
    /// # Errors
    /// As [`Self::read`].
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

    /// The goal that `text`, from the file `name`, holds once `settings` are put in its place.
    ///
    /// # Errors
    /// If the text holds no goal.
    pub fn parse(text: &str, name: &str, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&entries(text, name, settings)?, name)
    }

    /// The goal that `entries` of the file `name` hold.
    ///
    /// # Errors
    /// If they hold no goal.
    pub fn of_entries(entries: &KeyValues, name: &str) -> Result<Self, InvalidDefinition> {
        Self::of_section(entries, name, &[])
    }

    /// As [`Self::of_entries`], of which the command, and not the file, has said what is `required`.
    fn of_section(
        entries: &KeyValues,
        name: &str,
        required: &[Requirement],
    ) -> Result<Self, InvalidDefinition> {
        let file = Place::File { name: name.into(), line: None };
        let definition = entries.iter().filter(|entry| entry.key != "goal").cloned().collect();
        let mut refused = Vec::new();
        let mut section = goal_section(entries, &file, &mut refused);
        for (requirement, place) in &mut section.requirements {
            // Its key may stand in the file: a bound of the command would be blamed on that line.
            if required.contains(requirement) {
                *place = argument(requirement);
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
            refused.extend(senseless(&section, fitness.as_ref(), &sweep));
        }
        let space = DesignSpace::new(sweep);
        if refused.is_empty() {
            refused.extend(out_of_bounds(&section, &space));
        }
        if !refused.is_empty() {
            return Err(InvalidDefinition::several(refused));
        }
        let GoalSection {
            objectives,
            requirements,
            standards,
            sound,
            samples,
            points,
            skins,
            seed,
            ..
        } = section;
        Ok(Self {
            space,
            objectives: objectives.into_iter().map(|(objective, _)| objective).collect(),
            requirements: requirements.into_iter().map(|(requirement, _)| requirement).collect(),
            standards,
            fitness,
            sound,
            samples,
            points,
            realisations: skins,
            seed,
            text: to_toml(entries),
        })
    }
}

/// The place of a requirement that a command names.
fn argument(requirement: &Requirement) -> Place {
    Place::Argument(format!("--require '{requirement}'").into())
}

/// Adds a requirement to those that a goal has.
fn require(entries: &mut KeyValues, requirement: &Requirement) {
    let (name, text, place) = ("require", requirement.to_string(), argument(requirement));
    let goal = entries.iter_mut().find(|entry| entry.key == "goal");
    // A definition without a goal is refused later, by what it lacks.
    let Some(KeyValue { value: Value::Table(goal), .. }) = goal else { return };
    let own = goal.iter_mut().find(|entry| entry.key == name).map(|entry| &mut entry.value);
    match own {
        Some(Value::List(all)) => all.push(Value::Text(text)),
        Some(one) => *one = Value::List(vec![one.clone(), Value::Text(text)]),
        None => goal.push(KeyValue { key: name.into(), value: Value::Text(text), place }),
    }
}

/// The keys and values of a section.
fn section<'e>(entries: &'e KeyValues, name: &str) -> &'e [KeyValue] {
    match entries.iter().find(|entry| entry.key == name).map(|entry| &entry.value) {
        Some(Value::Table(inner)) => inner,
        _ => &[],
    }
}

fn goal_section(
    entries: &KeyValues,
    file: &Place,
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

/// Reasons why a space cannot be searched: no variables, a range of a number that does not describe the skin, parameters that
/// are neither variables nor have one value.
fn unsearchable(entries: &KeyValues, sweep: &Sweep, file: &Place) -> Vec<InvalidDefinition> {
    if sweep.variables().is_empty() {
        let expected =
            "a section of at least one variable, e.g. gap_over_t = { from = 0.1, to = 1 }";
        return vec![refuse(file, "variables", Problem::Missing(expected))];
    }
    let place = |section_name: &str, key: &str| {
        let entry = section(entries, section_name).iter().find(|entry| entry.key == key);
        entry.map_or(file, |entry| &entry.place)
    };
    let is_vague = |variable: &&Variable| {
        let parameter = variable.parameter();
        let describes = parameter.has(Role::Continuous) || parameter.has(Role::Made);
        matches!(variable.values(), VariableValues::Between(..)) && !describes
    };
    let vague = sweep.variables().iter().filter(is_vague).map(|variable| {
        let key = variable.parameter().key;
        let expected = "a list of its values: it is no number that describes the skin";
        let place = place("variables", key);
        not_accepted(place, &format!("variables.{key}"), variable.to_toml(), expected)
    });
    let open = sweep.grid().axes().iter().filter(|axis| axis.len() > 1).map(|axis: &Axis| {
        let key = axis.parameter().key;
        let expected = format!("one value, or {key} among [variables]");
        let place = place("designs", key);
        not_accepted(place, &format!("designs.{key}"), axis.to_toml(), expected)
    });
    vague.chain(open).collect()
}

/// Lines of a goal that can have no meaning: columns that designs do not have, objectives that cannot be compared, requirements that
/// exclude each other.
fn senseless(
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
    // A requirement compares no designs: the least tilt under a given force is a goal.
    let objectives = named.iter().filter(|named| named.key != "goal.require");
    let incomparable = objectives.flat_map(|Written { column, key, place }| {
        let fails = |v: &&Variable| {
            measurement_conditions(Statistic::base(column)).contains(&v.parameter().key)
        };
        sweep.variables().iter().filter(fails).map(|variable| {
            let found = format!("an objective with {} as a variable", variable.parameter().key);
            not_accepted(place, key, found, "values that can be compared between designs")
        })
    });
    let found = columns.chain(incomparable).chain(contradictions(goal));
    found.chain(out_of_reach(goal, sweep)).chain(statistics::senseless(goal)).collect()
}

/// The columns that a goal is about, in place of the fitness those of its criteria.
fn named<'a>(goal: &'a GoalSection, fitness: Option<&'a FitnessGoal>) -> Vec<Written<'a>> {
    let (of_fitness, mut named): (Vec<_>, Vec<_>) =
        goal.columns().partition(|named| named.column == NumberColumn::FITNESS);
    let criteria = fitness.iter().flat_map(|fitness| &fitness.criteria);
    for (place, criterion) in of_fitness
        .first()
        .into_iter()
        .flat_map(|first| criteria.clone().map(move |criterion| (first.place, criterion)))
    {
        named.push(Written { column: &criterion.column, key: "goal.weights", place });
    }
    named
}

fn missing_column(named: &Written, known: &[&str], sweep: &Sweep) -> Option<InvalidDefinition> {
    let Written { column, key, place } = *named;
    if known.contains(&column) {
        let is_measured = measure_of(column).is_none_or(|m| sweep.measures().contains(&m));
        let expected = "a column of what `measures` asks for";
        return (!is_measured).then(|| not_accepted(place, key, column, expected));
    }
    let expected = match (statistics::nearly(column, known), nearest(column, known)) {
        (Some(quantiles), _) => quantiles,
        (None, Some(near)) => format!("a column of designs.csv; did you mean {near}?"),
        (None, None) => {
            "a column of designs.csv, e.g. critical_force; those in mm, N and kg need a [material]"
                .to_owned()
        }
    };
    Some(not_accepted(place, key, column, expected))
}

/// Requirements of one column that no value meets.
fn contradictions(goal: &GoalSection) -> Vec<InvalidDefinition> {
    let mut found = Vec::new();
    for (k, (upper, place)) in goal.requirements.iter().enumerate() {
        let mut earlier = goal.requirements[..k].iter().map(|(lower, _)| lower);
        if let Some(other) = earlier.find(|lower| exclude(lower, upper) || exclude(upper, lower)) {
            let expected = format!("bounds that leave room beside {other}");
            found.push(not_accepted(place, "goal.require", upper, expected));
        }
    }
    found
}

/// Whether a lower bound stands above an upper one of the same column.
fn exclude(lower: &Requirement, upper: &Requirement) -> bool {
    let is_lower = matches!(lower.relation, Relation::AtLeast | Relation::Above);
    let is_upper = matches!(upper.relation, Relation::AtMost | Relation::Below);
    let strict = lower.relation == Relation::Above || upper.relation == Relation::Below;
    let same = lower.column == upper.column && is_lower && is_upper;
    same && (lower.limit > upper.limit || (strict && lower.limit >= upper.limit))
}

/// Requirements of a variable that no value between its bounds meets.
fn out_of_reach<'a>(
    goal: &'a GoalSection,
    sweep: &'a Sweep,
) -> impl Iterator<Item = InvalidDefinition> + 'a {
    goal.requirements.iter().filter_map(|(requirement, place)| {
        let of = |variable: &&Variable| variable.parameter().key == requirement.column;
        let VariableValues::Between(from, to) = *sweep.variables().iter().find(of)?.values() else {
            return None;
        };
        let is_met = [from, to].iter().any(|end| requirement.is_met(*end));
        let expected = format!("a bound that values from {from} to {to} can meet");
        (!is_met).then(|| not_accepted(place, "goal.require", requirement, expected))
    })
}

/// Keys and values as TOML again.
fn to_toml(entries: &KeyValues) -> String {
    // Values first: behind the header of a table TOML would count them as part of it.
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
