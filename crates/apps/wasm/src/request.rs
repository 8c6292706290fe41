//! The request from a page.

use std::collections::BTreeMap;

use serde::Deserialize;
use substrate::Coupling;
use sweep::{Case, Measure, Parameter};
use text::number;
use text::toml_source::Value;

/// A request to solve a design.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// An identifier that is repeated in the answer.
    #[serde(default)]
    pub id: u64,
    /// The definition of a sweep, in TOML.
    pub definition: String,
    /// Values that replace the parameters of the first design of the sweep, by key.
    #[serde(default)]
    pub set: BTreeMap<String, Setting>,
    /// Requirements, as in `coverage >= 0.6`.
    #[serde(default)]
    pub require: Vec<String>,
    /// True for a complete answer, with derivatives, smooth curves and neighbouring gaps.
    #[serde(default)]
    pub fine: bool,
    /// True for an answer with the measures, but without paths and drawings.
    #[serde(default)]
    pub bare: bool,
    /// Fractions of the paths of puncture and bending to draw: 0 at rest, 1 at the end.
    #[serde(default)]
    pub drawn: Option<[f64; 2]>,
    /// A parameter to follow to its next limit.
    #[serde(default)]
    pub follow: Option<Follow>,
}

/// A value of a parameter.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Setting {
    /// A number.
    Number(f64),
    /// A text, such as the name of a needle.
    Word(String),
}

/// A request to follow one parameter.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Follow {
    /// The key of the parameter.
    pub key: String,
    /// The value at which following stops if there is no limit before.
    pub to: f64,
    /// The column to improve.
    pub measure: String,
}

impl Request {
    /// Returns the measures to compute for `case`.
    ///
    /// On a layer with full coupling there are no derivatives, because each of their nine
    /// calibrations takes seconds.
    pub(crate) fn measures(&self, case: &Case) -> Vec<Measure> {
        let is_slow = case.tissue_thickness.is_some() && case.coupling == Coupling::Full;
        let differentiates = self.fine && !is_slow;
        let all = [Measure::Coverage, Measure::Puncture, Measure::Flexure, Measure::Sensitivity];
        all[..if differentiates { 4 } else { 3 }].to_vec()
    }

    /// Applies the parameters of the request to `case`.
    ///
    /// # Errors
    /// If there is no such parameter, or a value is rejected, with the message of the commands.
    pub(crate) fn case(&self, case: &Case) -> Result<Case, String> {
        self.set.iter().try_fold(*case, |case, (key, value)| put(&case, key, value))
    }
}

/// Returns `case` with another value of the parameter `key`.
pub(crate) fn put(case: &Case, key: &str, value: &Setting) -> Result<Case, String> {
    let parameter = Parameter::named(key).ok_or_else(|| format!("{key}: no such parameter"))?;
    // Convert to text, so that bounds and errors are the same as in definitions.
    let written = match value {
        Setting::Number(value) => Value::Number(number::text(*value)),
        Setting::Word(word) => Value::Text(word.clone()),
    };
    let value = parameter.read(&written).map_err(|error| format!("{key}: {error}"))?;
    Ok(parameter.replace(case, value))
}
