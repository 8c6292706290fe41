//! Validates JSON against the part of JSON Schema (draft 7) that `squama schema` uses.
//!
//! A published validator would add dozens of dependencies to every build. `scripts/check-python`
//! runs the published validator taplo on all definitions under `sweeps/`.

use serde_json::{Map, Value};

/// Returns a message that states why `value` does not conform to `schema`; `None` if it conforms.
///
/// # Panics
/// If the schema has a keyword that this validator does not know.
pub fn mismatch(schema: &Value, value: &Value) -> Option<String> {
    let (keyword, expected) = violated(schema, value)?;
    Some(format!("{value} violates {keyword} {expected}"))
}

/// Returns the first keyword of `schema` that `value` violates, with the value of the keyword.
///
/// # Panics
/// If the schema has a keyword that this validator does not know.
pub fn violated<'s>(schema: &'s Value, value: &Value) -> Option<(&'s String, &'s Value)> {
    let Value::Object(keywords) = schema else { panic!("no schema: {schema}") };
    keywords.iter().find(|(keyword, expected)| !conforms(keywords, keyword, expected, value))
}

/// Returns true if `value` conforms to one keyword of a schema.
///
/// `expected` is the value of this keyword, `keywords` the whole schema.
fn conforms(keywords: &Map<String, Value>, keyword: &str, expected: &Value, value: &Value) -> bool {
    match keyword {
        "$schema" | "title" | "description" | "default" => true,
        "type" => has_type(expected, value),
        "enum" => list(expected).iter().any(|one| is_equal(one, value)),
        "anyOf" => list(expected).iter().any(|one| violated(one, value).is_none()),
        "not" => violated(expected, value).is_some(),
        "minimum" => value.as_f64().is_none_or(|number| number >= limit(expected)),
        "maximum" => value.as_f64().is_none_or(|number| number <= limit(expected)),
        "exclusiveMinimum" => value.as_f64().is_none_or(|number| number > limit(expected)),
        "exclusiveMaximum" => value.as_f64().is_none_or(|number| number < limit(expected)),
        "minItems" => value.as_array().is_none_or(|items| items.len() as f64 >= limit(expected)),
        "maxItems" => value.as_array().is_none_or(|items| items.len() as f64 <= limit(expected)),
        "minProperties" => {
            value.as_object().is_none_or(|fields| fields.len() as f64 >= limit(expected))
        }
        "minLength" => {
            value.as_str().is_none_or(|text| text.chars().count() as f64 >= limit(expected))
        }
        "maxLength" => {
            value.as_str().is_none_or(|text| text.chars().count() as f64 <= limit(expected))
        }
        "pattern" => value.as_str().is_none_or(|text| matches(expected, text)),
        "items" => value
            .as_array()
            .is_none_or(|items| items.iter().all(|item| violated(expected, item).is_none())),
        "uniqueItems" => value.as_array().is_none_or(|items| {
            (1..items.len()).all(|k| !items[..k].iter().any(|one| is_equal(one, &items[k])))
        }),
        "required" => value.as_object().is_none_or(|fields| {
            list(expected).iter().all(|key| fields.contains_key(key.as_str().expect("a key")))
        }),
        "properties" => value.as_object().is_none_or(|fields| {
            fields.iter().all(|(key, field)| {
                expected.get(key).is_none_or(|schema| violated(schema, field).is_none())
            })
        }),
        "additionalProperties" => {
            value.as_object().is_none_or(|fields| others_conform(keywords, expected, fields))
        }
        _ => panic!("unknown keyword {keyword} of a schema"),
    }
}

/// Returns true if all fields that `properties` does not name conform to `additionalProperties`.
fn others_conform(
    keywords: &Map<String, Value>,
    expected: &Value,
    fields: &Map<String, Value>,
) -> bool {
    let named = keywords.get("properties").and_then(Value::as_object);
    let mut others =
        fields.iter().filter(|(key, _)| named.is_none_or(|named| !named.contains_key(*key)));
    others.all(|(_, field)| match expected {
        Value::Bool(allowed) => *allowed,
        schema => violated(schema, field).is_none(),
    })
}

/// Returns true if `value` has the type that `expected` names.
fn has_type(expected: &Value, value: &Value) -> bool {
    match expected.as_str().expect("one type") {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        // In JSON Schema, 21.0 is an integer, too.
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        other => panic!("unknown type {other} of a schema"),
    }
}

/// Returns true if two JSON values are equal; 1 equals 1.0.
fn is_equal(one: &Value, other: &Value) -> bool {
    match (one, other) {
        (Value::Array(one), Value::Array(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(a, b)| is_equal(a, b))
        }
        (Value::Number(one), Value::Number(other)) => one.as_f64() == other.as_f64(),
        _ => one == other,
    }
}

/// Returns true if `text` is a word of `pattern`, in upper or lower case.
///
/// The pattern is a list of words such as `^([Pp][Ll][Aa]|[Tt][Pp][Uu])$`.
fn matches(pattern: &Value, text: &str) -> bool {
    let pattern = pattern.as_str().expect("a pattern");
    let words = pattern.strip_prefix("^(").and_then(|rest| rest.strip_suffix(")$"));
    words.expect("a list of words").split('|').any(|word| {
        // Each letter of a word is a bracket with its upper and lower case; a blank has no bracket.
        let letters: String =
            word.split(['[', ']']).filter_map(|class| class.chars().last()).collect();
        letters == text.to_lowercase()
    })
}

fn list(expected: &Value) -> &[Value] {
    expected.as_array().expect("a list")
}

fn limit(expected: &Value) -> f64 {
    expected.as_f64().expect("a number")
}
