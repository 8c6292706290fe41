//! From keys and values to a goal.

use ranking::{Relation, Requirement};
use results::columns::{design_columns, measure_of};
use results::yardsticks;
use sweep::toml_source::{KeyValue, KeyValues, Place, Value};
use sweep::{
    Axis, InvalidDefinition, Problem, Role, Sweep, Variable, VariableValues, WrongValue, nearest,
};

use super::section::GoalSection;
use super::{DesignGoal, quantities};
use crate::fitness::{Fitness, FitnessGoal};
use crate::made::MadeQuantity;
use crate::space::DesignSpace;

pub(super) fn refuse(place: &Place, key: &str, problem: impl Into<Problem>) -> InvalidDefinition {
    InvalidDefinition::Refused {
        place: place.clone(),
        key: key.to_owned(),
        problem: Box::new(problem.into()),
    }
}

pub(super) fn not_accepted(
    place: &Place,
    key: &str,
    found: &str,
    expected: String,
) -> InvalidDefinition {
    refuse(place, key, WrongValue::NotAccepted { found: found.to_owned(), expected })
}

pub(super) fn unknown(place: &Place, key: &str, value: &Value, hint: String) -> InvalidDefinition {
    refuse(place, key, Problem::Unknown { value: value.to_string(), hint })
}

/// The goal that `entries` of the file `name` hold.
pub(super) fn read(
    entries: &KeyValues,
    name: &str,
    text: String,
) -> Result<DesignGoal, InvalidDefinition> {
    let file = Place::File { name: name.into(), line: None };
    let definition = entries.iter().filter(|entry| entry.key != "goal").cloned().collect();
    let sweep = Sweep::of_entries(&definition, name);
    let mut refused = Vec::new();
    let section = goal_section(entries, &file, &mut refused);
    let sweep = match sweep {
        Ok(sweep) => sweep,
        Err(error) => {
            refused.insert(0, error);
            return Err(several(refused));
        }
    };
    refused.extend(unsearchable(entries, &sweep, &file));
    let is_named = section.columns().any(|(column, ..)| column == Fitness::COLUMN);
    let fitness = section.fitness.goal(is_named).unwrap_or_else(|error| {
        refused.push(error);
        None
    });
    if refused.is_empty() {
        refused.extend(senseless(&section, fitness.as_ref(), &sweep));
    }
    if !refused.is_empty() {
        return Err(several(refused));
    }
    Ok(checked(section, sweep, fitness, text))
}

/// The goal of a section in which nothing is wrong.
fn checked(
    section: GoalSection,
    sweep: Sweep,
    fitness: Option<FitnessGoal>,
    text: String,
) -> DesignGoal {
    let GoalSection { objectives, requirements, sound, samples, points, skins, seed, .. } = section;
    DesignGoal {
        space: DesignSpace::new(sweep),
        objectives: objectives.into_iter().map(|objective| objective.criterion).collect(),
        requirements: requirements.into_iter().map(|placed| placed.requirement).collect(),
        fitness,
        sound,
        samples,
        points,
        skins,
        seed,
        text,
    }
}

/// Errors as one, of which there is at least one.
fn several(mut refused: Vec<InvalidDefinition>) -> InvalidDefinition {
    if refused.len() == 1 { refused.swap_remove(0) } else { InvalidDefinition::Several(refused) }
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
        refused.push(refuse(file, "goal", Problem::Missing { expected }));
    }
    goal
}

/// Reasons why a space cannot be searched: no variables, a range of a number that does not describe the skin, parameters that
/// are neither variables nor have one value.
fn unsearchable(entries: &KeyValues, sweep: &Sweep, file: &Place) -> Vec<InvalidDefinition> {
    if sweep.variables().is_empty() {
        let expected =
            "a section of at least one variable, e.g. gap_over_t = { from = 0.1, to = 1 }";
        return vec![refuse(file, "variables", Problem::Missing { expected })];
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
        let expected = "a list of its values: it is no number that describes the skin".to_owned();
        let place = place("variables", key);
        not_accepted(place, &format!("variables.{key}"), &variable.to_toml(), expected)
    });
    let open = sweep.grid().axes().iter().filter(|axis| axis.len() > 1).map(|axis: &Axis| {
        let key = axis.parameter().key;
        let expected = format!("one value, or {key} among [variables]");
        let place = place("designs", key);
        not_accepted(place, &format!("designs.{key}"), &axis.to_toml(), expected)
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
    let known: Vec<String> =
        design_columns(sweep).iter().map(|column| column.name.to_string()).collect();
    let named = named(goal, fitness);
    let columns = named.iter().filter_map(|(column, key, place)| {
        let is_drawn =
            MadeQuantity::named(column).is_none() || known.iter().any(|name| name == column);
        let missing = || missing_column(column, key, place, &known, sweep);
        let unavailable = quantities::unavailable(column, key, place, sweep);
        unavailable.or_else(|| is_drawn.then(missing).flatten())
    });
    let objectives = named.iter().filter(|(_, key, _)| *key != "goal.require");
    let incomparable = objectives.flat_map(|(column, key, place)| {
        let fails =
            |v: &&Variable| yardsticks(MadeQuantity::base(column)).contains(&v.parameter().key);
        sweep.variables().iter().filter(fails).map(|variable| {
            let expected = "values that can be compared between designs".to_owned();
            let found = format!("an objective with {} as a variable", variable.parameter().key);
            not_accepted(place, key, &found, expected)
        })
    });
    let found = columns.chain(incomparable).chain(contradictions(goal));
    found.chain(out_of_reach(goal, sweep)).chain(quantities::senseless(goal)).collect()
}

/// The columns that a goal is about, in place of the fitness those of its criteria.
fn named<'a>(
    goal: &'a GoalSection,
    fitness: Option<&'a FitnessGoal>,
) -> Vec<(&'a str, &'static str, &'a Place)> {
    let criteria = |place: &'a Place| {
        let criteria = fitness.iter().flat_map(|fitness| &fitness.criteria);
        criteria.map(move |criterion| (criterion.column.as_ref(), "goal.weights", place))
    };
    let (of_fitness, others): (Vec<_>, Vec<_>) =
        goal.columns().partition(|(column, ..)| *column == Fitness::COLUMN);
    let first = of_fitness.into_iter().take(1);
    others.into_iter().chain(first.flat_map(|(.., place)| criteria(place))).collect()
}

fn missing_column(
    column: &str,
    key: &str,
    place: &Place,
    known: &[String],
    sweep: &Sweep,
) -> Option<InvalidDefinition> {
    if known.iter().any(|name| name == column) {
        let is_measured = measure_of(column).is_none_or(|m| sweep.measures().contains(&m));
        return (!is_measured).then(|| {
            let expected = "a column of what `measures` asks for".to_owned();
            not_accepted(place, key, column, expected)
        });
    }
    let names: Vec<&str> = known.iter().map(String::as_str).collect();
    let nearly = quantities::nearly(column, &names);
    let expected = match nearest(column, &names) {
        _ if nearly.is_some() => nearly.unwrap_or_default(),
        Some(near) => format!("a column of designs.csv; did you mean {near}?"),
        None => {
            "a column of designs.csv, e.g. critical_force; those in mm, N and kg need a [material]"
                .to_owned()
        }
    };
    Some(not_accepted(place, key, column, expected))
}

/// Requirements of one column that no value meets.
fn contradictions(goal: &GoalSection) -> Vec<InvalidDefinition> {
    let mut found = Vec::new();
    for (k, upper) in goal.requirements.iter().enumerate() {
        let below = goal.requirements[..k].iter().find(|lower| {
            let pair = [&lower.requirement, &upper.requirement];
            exclude(pair[0], pair[1]) || exclude(pair[1], pair[0])
        });
        if let Some(other) = below {
            let expected = format!("bounds that leave room beside {}", other.requirement);
            let text = upper.requirement.to_string();
            found.push(not_accepted(&upper.place, "goal.require", &text, expected));
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
    goal.requirements.iter().filter_map(|placed| {
        let of = |variable: &&Variable| variable.parameter().key == placed.requirement.column;
        let VariableValues::Between(from, to) = *sweep.variables().iter().find(of)?.values() else {
            return None;
        };
        let is_met = [from, to].iter().any(|end| placed.requirement.is_met(*end));
        let expected = format!("a bound that values from {from} to {to} can meet");
        let text = placed.requirement.to_string();
        (!is_met).then(|| not_accepted(&placed.place, "goal.require", &text, expected))
    })
}
