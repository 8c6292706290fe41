//! JSON schemas of the values of a parameter.

use serde_json::{Map, Value, json};
use skin::puncture::MOST_NUMBERS;

use super::{Bound, CountRange, Parameter, ParameterKind, Range};
use crate::scalar::Scalar;

impl Parameter {
    /// Returns the schema of the parameter in its own section: a value or, if allowed, a list.
    pub fn schema(&self) -> Value {
        let single = self.item_schema();
        let ParameterKind::Numbers { range, .. } = &self.kind else {
            return self.described(single);
        };
        let list = json!({
            "type": "array", "items": number(*range), "minItems": 1, "maxItems": MOST_NUMBERS,
        });
        self.described(json!({ "anyOf": [single, list] }))
    }

    /// Returns the schema of an axis in `[designs]`: a value, a list or a range.
    pub fn axis_schema(&self) -> Value {
        let item = self.item_schema();
        let mut forms = vec![item.clone(), list(&item, 1)];
        forms.extend(self.end_schema().map(|end| {
            let step = json!({ "type": "number", "exclusiveMinimum": 0 });
            table(&[("from", end.clone()), ("to", end), ("step", step)])
        }));
        self.described(json!({ "anyOf": forms }))
    }

    /// Returns the schema of a variable in `[variables]`: two bounds, or a list of values.
    pub fn variable_schema(&self) -> Value {
        let mut forms = vec![list(&self.item_schema(), 2)];
        let end = self.end_schema().filter(|_| !self.takes_counts());
        forms.extend(end.map(|end| table(&[("from", end.clone()), ("to", end)])));
        self.described(json!({ "anyOf": forms }))
    }

    /// Returns the schema of one number or word.
    fn item_schema(&self) -> Value {
        match &self.kind {
            ParameterKind::Word { words: names, .. } => word_list(names),
            ParameterKind::CountOrWord { word, .. }
            | ParameterKind::Numbers { word: Some(word), .. } => {
                let numbers = self.end_schema().unwrap_or_default();
                json!({ "anyOf": [numbers, word_list(&[word])] })
            }
            _ => self.end_schema().unwrap_or_default(),
        }
    }

    /// Returns the schema of one number; `None` if the parameter accepts only words.
    fn end_schema(&self) -> Option<Value> {
        Some(match &self.kind {
            ParameterKind::Number { range, .. }
            | ParameterKind::OptionalNumber { range, .. }
            | ParameterKind::Numbers { range, .. } => number(*range),
            ParameterKind::SignedNumber { size, .. } => {
                json!({ "anyOf": [number(*size), number(size.negative())] })
            }
            ParameterKind::Count { range, .. } | ParameterKind::CountOrWord { range, .. } => {
                let CountRange { low, high } = range;
                json!({ "type": "integer", "minimum": low, "maximum": high })
            }
            ParameterKind::Word { .. } => return None,
        })
    }

    /// Adds meaning, unit and default to a schema.
    fn described(&self, mut schema: Value) -> Value {
        let unit = if self.unit == "-" { String::new() } else { format!(" ({})", self.unit) };
        schema["description"] = format!("{}{unit}", self.meaning).into();
        let default = self.default();
        // An optional number that is not given by default has no default value.
        if default != Scalar::Word(super::NOT_GIVEN) {
            schema["default"] = match default {
                Scalar::Word(word) => word_value(word),
                value => json!(value),
            };
        }
        schema
    }
}

impl Range {
    /// Returns the range of the negatives of the numbers in this range.
    fn negative(self) -> Self {
        let [low, high] = [self.high, self.low].map(|bound| match bound {
            Bound::Included(number) => Bound::Included(-number),
            Bound::Excluded(number) => Bound::Excluded(-number),
        });
        Self { low, high }
    }
}

/// Returns the schema of a number within bounds.
fn number(range: Range) -> Value {
    let mut schema = json!({ "type": "number" });
    let bounds = [
        (range.low, ["minimum", "exclusiveMinimum"]),
        (range.high, ["maximum", "exclusiveMaximum"]),
    ];
    for (bound, [included, excluded]) in bounds {
        match bound {
            Bound::Included(number) => schema[included] = json!(number),
            Bound::Excluded(number) => schema[excluded] = json!(number),
        }
    }
    schema
}

/// Returns the schema of a list of accepted words; `true` and `false` may also be booleans.
fn word_list(words: &[&str]) -> Value {
    let mut all: Vec<Value> = words.iter().map(|word| word_value(word)).collect();
    let booleans = words.iter().filter(|word| word.parse::<bool>().is_ok());
    all.extend(booleans.map(|word| json!(word)));
    json!({ "enum": all })
}

/// Returns a word as JSON, `true` and `false` as booleans.
fn word_value(word: &str) -> Value {
    word.parse::<bool>().map_or_else(|_| word.into(), Value::Bool)
}

/// Returns the schema of a list of at least `least` items without repetition.
fn list(item: &Value, least: usize) -> Value {
    json!({ "type": "array", "items": item, "minItems": least, "uniqueItems": true })
}

/// Returns the schema of a table with exactly these keys.
fn table(keys: &[(&str, Value)]) -> Value {
    let required: Vec<&str> = keys.iter().map(|(key, _)| *key).collect();
    let properties = keys.iter().map(|(key, schema)| ((*key).to_owned(), schema.clone()));
    json!({
        "type": "object",
        "properties": properties.collect::<Map<_, _>>(),
        "required": required,
        "additionalProperties": false,
    })
}
