//! The measures of a sweep.

use serde::{Deserialize, Serialize};

use super::invalid::Problem;
use crate::parameter::{WrongValue, any_of};
use text::toml_source::Value;

/// A group of results that is computed for every design of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Measure {
    /// Coverage: the fraction of the scale layer that a vertical line crosses as solid scale.
    ///
    /// The line passes through the top right corner of a scale.
    Coverage,
    /// Puncture of the middle scale of a row.
    Puncture,
    /// Bending of a strip of membrane that carries the scales.
    Flexure,
    /// Derivatives of the other measures with respect to every continuous parameter.
    Sensitivity,
}

impl Measure {
    /// All measures, in the order of the tables.
    pub const ALL: [Self; 4] = [Self::Coverage, Self::Puncture, Self::Flexure, Self::Sensitivity];

    /// The default measures.
    pub const USUAL: [Self; 3] = [Self::Coverage, Self::Puncture, Self::Flexure];

    /// Returns the name of the measure in a definition.
    pub fn key(self) -> &'static str {
        match self {
            Self::Coverage => "coverage",
            Self::Puncture => "puncture",
            Self::Flexure => "flexure",
            Self::Sensitivity => "sensitivity",
        }
    }

    /// Returns the measure with this name.
    pub fn named(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|measure| measure.key() == key)
    }

    /// Returns the sections with continuous parameters that the measure depends on.
    pub fn sections(self) -> &'static [&'static str] {
        match self {
            Self::Coverage => &["designs", "body"],
            Self::Puncture => {
                &["designs", "scale", "substrate", "body", "contact", "puncture", "array"]
            }
            Self::Flexure => &["designs", "scale", "contact", "flexure"],
            Self::Sensitivity => &[],
        }
    }

    /// Reads the measures from a list or a single word.
    pub(crate) fn read_list(value: &Value) -> Result<Vec<Self>, Problem> {
        let items = match value {
            Value::List(items) if !items.is_empty() => items.as_slice(),
            Value::Text(_) => std::slice::from_ref(value),
            _ => {
                return Err(WrongValue::not_accepted(
                    value,
                    format!("a list of at least one of {}", names()),
                )
                .into());
            }
        };
        let mut measures = Vec::new();
        for item in items {
            let measure = Self::read(item)?;
            if measures.contains(&measure) {
                return Err(Problem::Twice(item.to_string()));
            }
            measures.push(measure);
        }
        if measures == [Self::Sensitivity] {
            let expected = "sensitivity together with a measure that has derivatives".to_owned();
            return Err(WrongValue::not_accepted(value, expected).into());
        }
        // Sort the measures, so that a journal treats definitions that differ only in the order of
        // the measures as the same definition.
        measures.sort();
        Ok(measures)
    }

    fn read(value: &Value) -> Result<Self, WrongValue> {
        let Value::Text(text) = value else {
            return Err(WrongValue::not_accepted(value, names()));
        };
        Self::named(text).ok_or_else(|| match text::nearest(text, &Self::ALL.map(Self::key)) {
            Some(near) => {
                WrongValue::not_accepted(value, format!("{}; did you mean {near}?", names()))
            }
            None => WrongValue::not_accepted(value, names()),
        })
    }
}

fn names() -> String {
    any_of(&Measure::ALL.map(Measure::key))
}
