//! JSON schemas of the sections of a definition, from the list of parameters.

use serde_json::{Map, Value, json};

use super::measure::Measure;
use super::suggestion;
use crate::named_values::{NAME_KEYS, NameKey, short_name_key};
use crate::parameter::{PARAMETERS, Parameter, Role};

/// Returns the schemas of the top-level keys of a definition.
pub fn definition_schema() -> Map<String, Value> {
    let mut keys = Map::new();
    keys.insert("name".to_owned(), name());
    keys.insert("measures".to_owned(), measures());
    for section in suggestion::sections() {
        keys.insert(section.to_owned(), section_schema(section));
    }
    let variables = PARAMETERS.iter().map(|p| (p.key, p.variable_schema()));
    let about = "Parameters that a search, a fit or a random draw varies";
    keys.insert(suggestion::VARIABLES.to_owned(), section_of(about, variables));
    let deviations = Parameter::with(Role::Toleranced).map(|p| (p.key, deviation(p)));
    let about = "Manufacturing deviations from the nominal design";
    keys.insert(suggestion::TOLERANCE.to_owned(), section_of(about, deviations));
    keys
}

fn name() -> Value {
    json!({
        "type": "string", "minLength": 1, "maxLength": 100,
        "description": "name of the sweep, and of the folder of its results",
    })
}

fn measures() -> Value {
    let measure = json!({ "enum": Measure::ALL.map(Measure::key) });
    let list = json!({ "type": "array", "items": measure, "minItems": 1, "uniqueItems": true });
    json!({
        "anyOf": [measure, list],
        "description": "measures that are solved",
        "default": Measure::USUAL.map(Measure::key),
    })
}

fn section_schema(section: &str) -> Value {
    if section == "designs" {
        let axes = PARAMETERS.iter().map(|p| (p.key, p.axis_schema()));
        return section_of("Axes of the grid; any parameter may be an axis", axes);
    }
    let own = PARAMETERS.iter().filter(|p| p.section == section).map(|p| (p.key, p.schema()));
    let names = NAME_KEYS.iter().filter(|name| name.section == section);
    let names = names.map(|name| (name.key, names_schema(name)));
    let keys = section_of(&format!("Section {section}"), own.chain(names));
    match short_name_key(section) {
        Some(name) => json!({ "anyOf": [keys, names_schema(name)] }),
        None => keys,
    }
}

/// Returns the schema of a section with these keys and no others.
fn section_of<'k>(about: &str, keys: impl Iterator<Item = (&'k str, Value)>) -> Value {
    let properties: Map<_, _> = keys.map(|(key, schema)| (key.to_owned(), schema)).collect();
    json!({
        "type": "object",
        "description": about,
        "properties": properties,
        "additionalProperties": false,
    })
}

/// Returns the schema of the names of materials or bodies.
fn names_schema(NameKey { section, key, known }: &NameKey) -> Value {
    let names: Vec<&str> = known.iter().map(|known| known.name).collect();
    // Editors complete the names of the enumeration; the pattern accepts upper and lower case.
    json!({
        "anyOf": [{ "enum": names }, { "type": "string", "pattern": in_any_case(&names) }],
        "description": format!("supplies values that the definition does not give ({section}.{key})"),
    })
}

/// Returns a regular expression that matches any of `words` in upper or lower case.
fn in_any_case(words: &[&str]) -> String {
    let letters = words.join("|").chars().fold(String::new(), |letters, c| {
        if c.is_ascii_alphabetic() {
            format!("{letters}[{}{}]", c.to_ascii_uppercase(), c.to_ascii_lowercase())
        } else {
            format!("{letters}{c}")
        }
    });
    format!("^({letters})$")
}

fn deviation(parameter: &Parameter) -> Value {
    let size = json!({ "type": "number", "exclusiveMinimum": 0 });
    let mut keys = json!({ "batch_sd": size, "batch_within": size });
    if parameter.has(Role::Scattered) {
        keys["scale_sd"] = size;
    }
    json!({
        "type": "object",
        "description": format!("deviation of: {}", parameter.meaning),
        "properties": keys,
        "minProperties": 1,
        "additionalProperties": false,
        "not": { "required": ["batch_sd", "batch_within"] },
    })
}
