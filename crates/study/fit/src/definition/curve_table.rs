//! The `[[curve]]` tables of a fit: file, specimen, range and offsets of a measured curve.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value as Json, json};
use sweep::{Case, PARAMETERS, Parameter, Problem, Setting};
use text::toml_source::{KeyValue, KeyValues, Location, Value};

use super::{InvalidFit, Source, TestCurve, Unknown, not_accepted, refused, table};
use crate::measured_curve::{Branches, CurveEventKind, MeasuredCurve, Test};

/// Keys of a `[[curve]]` table, apart from the keys of parameters.
const KEYS: [&str; 8] = ["file", "kind", "columns", "specimen", "branch", "from", "to", "offsets"];

/// Returns the JSON schema of the tables `[[curve]]`.
pub fn curves_schema() -> Json {
    let texts = json!({ "type": "array", "items": { "type": "string" } });
    let range = json!({
        "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
    });
    let axes = ["displacement", "force", "curvature", "moment"];
    let ranges = axes.map(|axis| (axis.to_owned(), range.clone()));
    // Schemas in the order of `KEYS`. The length of the array ensures one schema for each key.
    let about: [Json; KEYS.len()] = [
        json!({ "type": "string", "description": "CSV file, relative to the definition" }),
        json!({ "enum": [Test::Puncture.name(), Test::Bending.name()], "description": "kind of test" }),
        json!({ "type": "array", "items": { "type": "string" }, "description": "names of the columns" }),
        json!({ "type": ["string", "integer"], "description": "name or number of the specimen in the file" }),
        json!({ "enum": ["loading", "unloading", "both"], "description": "branches that are fitted" }),
        number_schema("lower limit of the fitted range, in the unit of the first column"),
        number_schema("upper limit of the fitted range, in the unit of the first column"),
        json!({
            "anyOf": [texts, {
                "type": "object", "additionalProperties": false,
                "properties": ranges.into_iter().collect::<Map<_, _>>(),
            }],
            "description": "offsets of the axes that are fitted, or their ranges",
        }),
    ];
    let mut keys: Map<_, _> = KEYS.into_iter().map(str::to_owned).zip(about).collect();
    // A specimen may set any parameter.
    keys.extend(PARAMETERS.iter().map(|p| (p.key.to_owned(), p.schema())));
    json!({
        "type": "array", "minItems": 1,
        "description": "Measured curves of a fit",
        "items": {
            "type": "object", "properties": keys,
            "required": ["file", "kind"], "additionalProperties": false,
        },
    })
}

fn number_schema(about: &str) -> Json {
    json!({ "type": "number", "description": about })
}

/// Maximum number of fitted points of a curve.
///
/// In longer curves, neighbouring points are averaged.
const MOST_POINTS: usize = 200;

/// Returns the `[[curve]]` tables of a definition. The definition must have at least one.
pub(super) fn tables<'e>(
    entries: &'e KeyValues,
    name: &str,
) -> Result<Vec<CurveTable<'e>>, InvalidFit> {
    let file = Location::File { name: name.into(), line: None };
    let entry = entries.iter().find(|entry| entry.key == "curve");
    let location = entry.map_or(&file, |entry| &entry.location);
    let items = match entry.map(|entry| &entry.value) {
        Some(Value::List(items)) => items.as_slice(),
        _ => &[],
    };
    let keys = items.iter().map(|item| table(item).filter(|keys| !keys.is_empty()));
    let keys = keys.collect::<Option<Vec<_>>>().filter(|keys| !keys.is_empty());
    let keys = keys.ok_or_else(|| {
        let expected = "at least one [[curve]] with a file and its kind";
        refused(location, "curve", Problem::Missing(expected))
    })?;
    Ok(keys.into_iter().map(CurveTable).collect())
}

/// A `[[curve]]` table with at least one key.
#[derive(Clone, Copy)]
pub(super) struct CurveTable<'e>(&'e [KeyValue]);

impl CurveTable<'_> {
    /// Returns the location of the first key of this table, for messages.
    pub fn location(&self) -> &Location {
        &self.0[0].location
    }

    fn entry(&self, key: &str) -> Option<&KeyValue> {
        self.0.iter().find(|entry| entry.key == key)
    }

    /// Returns the error for a key that is missing or has a value of a wrong type.
    fn wrong(&self, key: &str, expected: &'static str) -> InvalidFit {
        let name = format!("curve.{key}");
        match self.entry(key) {
            Some(entry) => not_accepted(&entry.location, &name, &entry.value, expected),
            None => refused(self.location(), &name, Problem::Missing(expected)),
        }
    }

    fn text(&self, key: &str, expected: &'static str) -> Result<&str, InvalidFit> {
        match self.entry(key).map(|entry| &entry.value) {
            Some(Value::Text(text)) => Ok(text),
            _ => Err(self.wrong(key, expected)),
        }
    }

    /// Converts the value of an optional key with `read`.
    fn optional<T>(
        &self,
        key: &str,
        expected: &'static str,
        read: impl Fn(&Value) -> Option<T>,
    ) -> Result<Option<T>, InvalidFit> {
        let Some(entry) = self.entry(key) else { return Ok(None) };
        read(&entry.value).map(Some).ok_or_else(|| self.wrong(key, expected))
    }

    /// Returns the number of an optional key.
    fn number(&self, key: &str) -> Result<Option<f64>, InvalidFit> {
        self.optional(key, "a number, in the unit of the first column", |value| match value {
            Value::Number(text) => text.parse().ok(),
            _ => None,
        })
    }

    /// Returns the list of texts of an optional key.
    fn texts(&self, key: &str) -> Result<Option<Vec<String>>, InvalidFit> {
        self.optional(key, "a list of names in quotes", |value| {
            let Value::List(items) = value else { return None };
            let texts = items.iter().map(|item| match item {
                Value::Text(text) => Some(text.clone()),
                _ => None,
            });
            texts.collect()
        })
    }

    /// Returns the error that the value `found` of a key of this table is not accepted.
    pub fn not_accepted(&self, key: &str, found: impl Display, expected: &str) -> InvalidFit {
        let location = self.entry(key).map_or(self.location(), |entry| &entry.location);
        not_accepted(location, &format!("curve.{key}"), found, expected)
    }

    /// Returns the path of the measured file, in canonical form if the file exists.
    pub fn path(&self, folder: &Path) -> PathBuf {
        let file = self.text("file", "").unwrap_or_default();
        let path = folder.join(file);
        path.canonicalize().unwrap_or(path)
    }

    /// Reads the curves of the specimen in this table, by default of all specimens in the file.
    pub fn measured(&self, folder: &Path) -> Result<Vec<MeasuredCurve>, InvalidFit> {
        let file = self.text("file", "the name of a CSV file")?;
        let kind = self.text("kind", "\"puncture\" or \"bending\"")?;
        let columns = self.texts("columns")?;
        let mut curves = MeasuredCurve::read(&folder.join(file), columns.as_deref())?;
        if kind != curves[0].test.name() {
            let expected = match curves[0].test {
                Test::Puncture => "\"puncture\", as the columns of the file state",
                Test::Bending => "\"bending\", as the columns of the file state",
            };
            return Err(self.wrong("kind", expected));
        }
        if let Some(entry) = self.entry("specimen") {
            let index = self.specimen(entry, &curves)?;
            curves = vec![curves.swap_remove(index)];
        }
        // Messages name the file as written in the definition, without the folder.
        for curve in &mut curves {
            curve.set_file(file);
        }
        Ok(curves)
    }

    /// Returns the index of the specimen with the name or the number (from 1) in `entry`.
    fn specimen(&self, entry: &KeyValue, curves: &[MeasuredCurve]) -> Result<usize, InvalidFit> {
        let chosen = match &entry.value {
            Value::Text(text) | Value::Number(text) => text.as_str(),
            _ => "",
        };
        let names: Vec<_> = curves.iter().filter_map(|curve| curve.specimen.as_deref()).collect();
        let number = chosen.parse().ok().filter(|number| (1..=curves.len()).contains(number));
        let named = names.iter().position(|name| *name == chosen);
        named.or_else(|| number.map(|number| number - 1)).ok_or_else(|| {
            let expected = match names.as_slice() {
                [] => "no key specimen: the file has a single specimen".to_owned(),
                names => format!("a number from 1 to {}, or {}", names.len(), names.join(", ")),
            };
            self.not_accepted("specimen", &entry.value, &expected)
        })
    }

    /// Returns whether the loading branch (first) and the unloading branch (second) are fitted.
    fn fitted_branches(&self, test: Test, case: &Case) -> Result<[bool; 2], InvalidFit> {
        let Some(entry) = self.entry("branch") else {
            let unloads = match test {
                Test::Puncture => case.puncture.unload,
                Test::Bending => case.flexure.unload,
            };
            return Ok([true, unloads]);
        };
        let fitted = match &entry.value {
            Value::Text(text) => match text.as_str() {
                "loading" => Some([true, false]),
                "unloading" => Some([false, true]),
                "both" => Some([true, true]),
                _ => None,
            },
            _ => None,
        };
        fitted.ok_or_else(|| self.wrong("branch", "\"loading\", \"unloading\" or \"both\""))
    }

    /// Selects the fitted points: the chosen branches, limited by the keys `from` and `to`.
    ///
    /// Neighbouring points of long curves are averaged.
    pub fn branches(
        &self,
        mut curve: MeasuredCurve,
        case: &Case,
        own: &[&'static Parameter],
    ) -> Result<TestCurve, InvalidFit> {
        let Branches { mut loading, mut unloading, mut events } = curve.branches();
        let turn = loading.last().map_or(0.0, |last| curve.points[*last][0]);
        let [is_loading, is_unloading] = self.fitted_branches(curve.test, case)?;
        if is_unloading && unloading.is_empty() && self.entry("branch").is_some() {
            return Err(self.wrong("branch", "\"loading\": the curve does not turn back"));
        }
        let excluded_points = [(&mut loading, is_loading), (&mut unloading, is_unloading)]
            .into_iter()
            .filter(|(_, is_fitted)| !is_fitted)
            .map(|(branch, _)| std::mem::take(branch).len());
        let excluded_points: usize = excluded_points.sum();
        for event in events.iter_mut().filter(|e| e.kind == CurveEventKind::TurnsBack) {
            event.excluded_points = excluded_points;
        }
        let from = self.number("from")?.unwrap_or(f64::NEG_INFINITY) * curve.x_unit;
        let to = self.number("to")?.unwrap_or(f64::INFINITY) * curve.x_unit;
        // Select the range before averaging, so that no mean includes points outside of the range.
        for branch in [&mut loading, &mut unloading] {
            branch.retain(|index| (from..=to).contains(&curve.points[*index][0]));
        }
        events.retain(|event| (from..=to).contains(&event.at));
        let count = loading.len() + unloading.len();
        if count == 0 {
            let key = if self.entry("from").is_some() { "from" } else { "to" };
            return Err(self.wrong(key, "a range with points of the file in it"));
        }
        // Average neighbouring points: machines record thousands of points with correlated noise.
        let part = count.div_ceil(MOST_POINTS);
        let [loading, unloading] = [loading, unloading].map(|branch| {
            let means = branch.chunks(part).map(|indices| mean_point(&curve.points, indices));
            means.collect::<Vec<_>>()
        });
        curve.points = [loading, unloading.clone()].concat();
        self.require_load(&curve)?;
        Ok(TestCurve {
            measured: curve,
            unloading: unloading.len(),
            turn,
            events,
            case: *case,
            fixed: own.to_vec(),
        })
    }

    /// Refuses a constant force or moment, which determines no parameter.
    fn require_load(&self, curve: &MeasuredCurve) -> Result<(), InvalidFit> {
        let first = curve.points[0][1];
        let is_constant = curve.points.iter().all(|point| point[1] == first);
        if !is_constant || (curve.points.len() == 1 && first != 0.0) {
            return Ok(());
        }
        let [_, (load, _)] = curve.test.axes();
        let count = curve.points.len();
        let expected = format!(
            "a {load} that varies: it is {first} at all {count} points, so check the load cell, from and to"
        );
        Err(self.not_accepted("file", &curve.file, &expected))
    }

    /// Returns the parameters that this table sets for its specimen, with their values.
    pub fn own_values(&self) -> Result<Vec<(&'static Parameter, Setting)>, InvalidFit> {
        self.0
            .iter()
            .filter(|entry| !KEYS.contains(&entry.key.as_str()))
            .map(|entry| {
                let name = format!("curve.{}", entry.key);
                let parameter = Parameter::named(&entry.key).ok_or_else(|| {
                    let keys = KEYS.join(", ");
                    let hint = format!(
                        "expected {keys} or a parameter of this specimen alone, e.g. gap_over_t"
                    );
                    let value = entry.value.to_string();
                    refused(&entry.location, &name, Problem::Unknown { value, hint })
                })?;
                let text = format!("designs.{}={}", entry.key, entry.value);
                Ok((
                    parameter,
                    Setting::from_option(&format!("{}: {name}", entry.location), &text)?,
                ))
            })
            .collect()
    }

    /// Returns the unknown offsets of the curve with index `curve`.
    ///
    /// The key `offsets` lists axes, or has a range for each axis: `{ displacement = [-0.1, 3] }`.
    pub fn offsets(
        &self,
        measured: &MeasuredCurve,
        curve: usize,
    ) -> Result<Vec<Unknown>, InvalidFit> {
        let mut ranges: Vec<(String, Option<[f64; 2]>)> = Vec::new();
        if let Some(KeyValue { value: Value::Table(entries), .. }) = self.entry("offsets") {
            for entry in entries {
                let range = range(&entry.value).ok_or_else(|| {
                    self.wrong("offsets", "ranges, e.g. { displacement = [-0.1, 3] }")
                })?;
                ranges.push((entry.key.clone(), Some(range)));
            }
        } else {
            let names = self.texts("offsets")?.unwrap_or_default();
            ranges.extend(names.into_iter().map(|name| (name, None)));
        }
        let axes = measured.test.axes();
        let mut offsets = Vec::new();
        for (name, range) in ranges {
            let expected = match measured.test {
                Test::Puncture => "\"displacement\", \"force\" or both",
                Test::Bending => "\"curvature\", \"moment\" or both",
            };
            let axis = axes.iter().position(|(axis, _)| *axis == name);
            let axis = axis.ok_or_else(|| self.wrong("offsets", expected))?;
            let [from, to] = range.unwrap_or_else(|| measured.offset_range(axis));
            let unit = if measured.is_physical { axes[axis].1 } else { "-" };
            let name = format!("{name} offset of {}", measured.file);
            offsets.push(Unknown { name, unit, from, to, source: Source::Offset(curve, axis) });
        }
        Ok(offsets)
    }
}

/// Returns the bounds in a list of two increasing numbers; `None` for other values.
fn range(value: &Value) -> Option<[f64; 2]> {
    let Value::List(items) = value else { return None };
    let mut numbers = items.iter().map(|item| match item {
        Value::Number(text) => text.parse().ok().filter(|number: &f64| number.is_finite()),
        _ => None,
    });
    let [from, to] = [numbers.next()??, numbers.next()??];
    (numbers.next().is_none() && from < to).then_some([from, to])
}

/// Returns the mean of the points with these indices.
fn mean_point(points: &[[f64; 2]], indices: &[usize]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let sum: f64 = indices.iter().map(|index| points[*index][axis]).sum();
        sum / indices.len() as f64
    })
}
