//! Definition of a fit: a sweep with `[variables]` and one `[[curve]]` per file.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value as Json, json};
use sweep::{
    Case, InvalidDefinition, InvalidSetting, PARAMETERS, Parameter, Problem, Role, Setting, Sweep,
    Variable, VariableValues, WrongValue, read_entries,
};
use text::toml_source::{KeyValue, KeyValues, Place, Value};

use crate::measured_curve::{
    Branches, CurveEvent, CurveEventKind, InvalidMeasured, MeasuredCurve, Test,
};

/// Unknowns of a fit, and the measured curves that determine them.
#[derive(Debug)]
pub struct FitDefinition {
    pub(crate) sweep: Sweep,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) curves: Vec<TestCurve>,
}

/// A number to be fitted, between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Key of a parameter, or name of the offset of a curve.
    pub name: String,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// Lower bound.
    pub from: f64,
    /// Upper bound.
    pub to: f64,
    pub(crate) source: Source,
}

impl Unknown {
    /// Returns how the definition states the range of this unknown, for messages.
    pub fn key(&self) -> String {
        match self.source {
            Source::Parameter(parameter) | Source::Specimen(parameter, _) => {
                format!("variables.{}", parameter.key)
            }
            Source::Offset(..) => {
                let axis = self.name.split(' ').next().unwrap_or_default();
                format!("its range, offsets = {{ {axis} = [from, to] }} in [[curve]]")
            }
        }
    }
}

/// Quantity that an unknown stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    Parameter(&'static Parameter),
    /// Parameter of the specimen of one curve.
    Specimen(&'static Parameter, usize),
    /// Offset of a curve: its number, then 0 for the first axis or 1 for the second.
    Offset(usize, usize),
}

/// A measured curve with its specimen.
#[derive(Debug)]
pub(crate) struct TestCurve {
    /// The fitted points: loading, then unloading.
    pub(crate) measured: MeasuredCurve,
    /// Number of points of the unloading branch.
    pub(crate) unloading: usize,
    /// Displacement or curvature at which unloading begins.
    pub(crate) turn: f64,
    /// Ends of branches, holds and drops.
    pub(crate) events: Vec<CurveEvent>,
    pub(crate) case: Case,
    /// Parameters set in the table of this curve. Unknowns do not change them.
    pub(crate) own: Vec<&'static Parameter>,
}

/// Error in the definition of a fit.
#[derive(Debug, thiserror::Error)]
pub enum InvalidFit {
    /// A key or a value is not accepted.
    #[error(transparent)]
    Definition(#[from] InvalidDefinition),
    /// A value of a specimen is not accepted.
    #[error(transparent)]
    Setting(#[from] InvalidSetting),
    /// A file of measurements is not accepted.
    #[error(transparent)]
    Measured(#[from] InvalidMeasured),
}

/// Keys of a `[[curve]]` besides parameters.
const KEYS: [&str; 8] = ["file", "kind", "columns", "specimen", "branch", "from", "to", "offsets"];

/// Returns the JSON schema of the tables `[[curve]]`.
pub fn curves_schema() -> Json {
    let number = |about: &str| json!({ "type": "number", "description": about });
    let texts = json!({ "type": "array", "items": { "type": "string" } });
    let range = json!({
        "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
    });
    let axes = ["displacement", "force", "curvature", "moment"];
    let ranges = axes.map(|axis| (axis.to_owned(), range.clone()));
    // In the order of `KEYS`. A key without a schema does not compile.
    let about: [Json; KEYS.len()] = [
        json!({ "type": "string", "description": "CSV file, relative to the definition" }),
        json!({ "enum": [Test::Puncture.name(), Test::Bending.name()], "description": "kind of test" }),
        json!({ "type": "array", "items": { "type": "string" }, "description": "names of the columns" }),
        json!({ "type": ["string", "integer"], "description": "name or number of the specimen in the file" }),
        json!({ "enum": ["loading", "unloading", "both"], "description": "branches that are fitted" }),
        number("first value of the first column that is fitted"),
        number("last value of the first column that is fitted"),
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

/// Key that lists the parameters that differ from specimen to specimen.
pub const PER_SPECIMEN: &str = "per_specimen";

/// Maximum number of points of a curve.
///
/// Longer curves are averaged over neighbouring points.
const MOST_POINTS: usize = 200;

impl FitDefinition {
    /// Reads the definition at `path` and applies `settings`.
    ///
    /// Paths of curves are relative to the folder of the definition.
    ///
    /// # Errors
    ///
    /// If a file cannot be read, or a key or a value is not accepted.
    pub fn read(path: &Path, settings: &[Setting]) -> Result<Self, InvalidFit> {
        let name = path.display().to_string();
        let entries = read_entries(path, settings)?;
        let sweep = one_design(&entries, &name)?;
        let mut unknowns = parameters(&entries, &sweep)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut curves = Vec::new();
        let mut paths = Vec::new();
        for table in tables(&entries, &name)? {
            let own = table.own_values()?;
            // Each specimen is read as a definition of its own, which checks its values.
            let specimen = own.iter().map(|(_, setting)| setting);
            // The last value of a key counts, so the specimen overrides the command line.
            let specimen: Vec<_> = settings.iter().chain(specimen).cloned().collect();
            let case = one_design(&read_entries(path, &specimen)?, &name)?.grid().case(0);
            let own: Vec<_> = own.into_iter().map(|(parameter, _)| parameter).collect();
            for measured in table.measured(folder)? {
                let curve = table.branches(measured, &case, &own)?;
                let measured = &curve.measured;
                // Checked here, because the line of the curve is known only here.
                let missing = measured.test.units(&case).err().filter(|_| measured.is_physical);
                if let Some(missing) = missing {
                    let expected = format!("{missing} beside a file in mm and N");
                    let place = &table.0[0].place;
                    return Err(not_accepted(place, "curve.file", &measured.file, &expected));
                }
                for (TestCurve { measured: other, .. }, path) in curves.iter().zip(&paths) {
                    let is_same = (&measured.specimen, &measured.points, &table.path(folder))
                        == (&other.specimen, &other.points, path);
                    if is_same {
                        let expected = "each measured curve once";
                        return Err(table.not_accepted("file", &measured.file, expected));
                    }
                }
                unknowns.extend(table.offsets(measured, curves.len())?);
                curves.push(curve);
                paths.push(table.path(folder));
            }
        }
        unknowns = per_specimen(&entries, unknowns, &curves)?;
        Ok(Self { sweep, unknowns, curves })
    }

    /// Returns the numbers to be fitted.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// Returns the file, the kind of test and the number of points of each measured curve.
    pub fn curves(&self) -> impl Iterator<Item = (&str, &'static str, usize)> {
        self.curves.iter().map(|TestCurve { measured, .. }| {
            (measured.file.as_str(), measured.test.name(), measured.points.len())
        })
    }

    /// Returns the definition as a sweep with the unknown parameters as variables.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }
}

fn refused(place: &Place, key: &str, problem: Problem) -> InvalidFit {
    let (place, key, problem) = (place.clone(), key.to_owned(), Box::new(problem));
    InvalidDefinition::Refused { place, key, problem }.into()
}

fn not_accepted(place: &Place, key: &str, found: impl Display, expected: &str) -> InvalidFit {
    let (found, expected) = (found.to_string(), expected.to_owned());
    refused(place, key, WrongValue::NotAccepted { found, expected }.into())
}

/// Reads the definition without its curves.
///
/// Apart from its variables, it must have a single design.
fn one_design(entries: &KeyValues, name: &str) -> Result<Sweep, InvalidFit> {
    let shared = entries.iter().filter(|e| !["curve", PER_SPECIMEN].contains(&e.key.as_str()));
    let entries = shared.cloned().collect();
    let sweep = Sweep::of_entries(&entries, name)?;
    match sweep.grid().axes().iter().find(|axis| axis.len() > 1) {
        Some(axis) => {
            let key = axis.parameter().key;
            let file = Place::File { name: name.into(), line: None };
            let expected = format!("one value, or {key} among [variables]");
            Err(not_accepted(&file, &format!("designs.{key}"), axis.to_toml(), &expected))
        }
        None => Ok(sweep),
    }
}

/// Returns the parameters listed in `[variables]`.
fn parameters(entries: &KeyValues, sweep: &Sweep) -> Result<Vec<Unknown>, InvalidFit> {
    let written = entries.iter().filter(|entry| entry.key == "variables");
    let written: Vec<_> = written.filter_map(|entry| table(&entry.value)).flatten().collect();
    let unknown = |variable: &Variable| {
        let parameter = variable.parameter();
        let is_number = parameter.has(Role::Continuous) || parameter.has(Role::Made);
        if let VariableValues::Between(from, to) = *variable.values()
            && is_number
        {
            let (name, source) = (parameter.key.to_owned(), Source::Parameter(parameter));
            return Ok(Unknown { name, unit: parameter.unit, from, to, source });
        }
        let entry = written.iter().find(|entry| entry.key == parameter.key);
        let place = entry.map_or(Place::Argument("[variables]".into()), |e| e.place.clone());
        let expected = "bounds of a number that the curve follows, e.g. { from = 0.1, to = 1 }";
        let key = format!("variables.{}", parameter.key);
        Err(not_accepted(&place, &key, variable.to_toml(), expected))
    };
    sweep.variables().iter().map(unknown).collect()
}

/// Replaces the parameters in `per_specimen` with an unknown for each curve.
fn per_specimen(
    entries: &KeyValues,
    mut unknowns: Vec<Unknown>,
    curves: &[TestCurve],
) -> Result<Vec<Unknown>, InvalidFit> {
    let Some(entry) = entries.iter().find(|entry| entry.key == PER_SPECIMEN) else {
        return Ok(unknowns);
    };
    let Value::List(items) = &entry.value else {
        let expected = "a list of [variables], e.g. [\"substrate_modulus_MPa\"]";
        return Err(not_accepted(&entry.place, PER_SPECIMEN, &entry.value, expected));
    };
    for item in items {
        let named =
            unknowns.iter().enumerate().find_map(|(index, unknown)| match (item, unknown.source) {
                (Value::Text(text), Source::Parameter(p)) if text == p.key => Some((index, p)),
                _ => None,
            });
        let (index, parameter) = named.ok_or_else(|| {
            not_accepted(&entry.place, PER_SPECIMEN, &entry.value, "names of [variables]")
        })?;
        let shared = unknowns.remove(index);
        let own = curves.iter().enumerate().filter(|(_, curve)| !curve.own.contains(&parameter));
        let own: Vec<_> = own
            .map(|(k, curve)| Unknown {
                name: format!("{} of {}", shared.name, curve.measured.file),
                source: Source::Specimen(parameter, k),
                ..shared.clone()
            })
            .collect();
        if own.len() < 2 {
            let expected = "at least two curves without a value of their own";
            return Err(not_accepted(&entry.place, PER_SPECIMEN, &entry.value, expected));
        }
        unknowns.splice(index..index, own);
    }
    Ok(unknowns)
}

fn table(value: &Value) -> Option<&[KeyValue]> {
    match value {
        Value::Table(entries) => Some(entries),
        _ => None,
    }
}

/// Returns the `[[curve]]` tables, at least one.
fn tables<'e>(entries: &'e KeyValues, name: &str) -> Result<Vec<CurveTable<'e>>, InvalidFit> {
    let file = Place::File { name: name.into(), line: None };
    let entry = entries.iter().find(|entry| entry.key == "curve");
    let place = entry.map_or(&file, |entry| &entry.place);
    let items = match entry.map(|entry| &entry.value) {
        Some(Value::List(items)) => items.as_slice(),
        _ => &[],
    };
    let keys = items.iter().map(|item| table(item).filter(|keys| !keys.is_empty()));
    let keys = keys.collect::<Option<Vec<_>>>().filter(|keys| !keys.is_empty());
    let keys = keys.ok_or_else(|| {
        let expected = "at least one [[curve]] with a file and its kind";
        refused(place, "curve", Problem::Missing(expected))
    })?;
    Ok(keys.into_iter().map(CurveTable).collect())
}

/// A `[[curve]]` table with at least one key.
#[derive(Clone, Copy)]
struct CurveTable<'e>(&'e [KeyValue]);

impl CurveTable<'_> {
    fn entry(&self, key: &str) -> Option<&KeyValue> {
        self.0.iter().find(|entry| entry.key == key)
    }

    /// Returns the error for a key with an unaccepted value, or without one.
    fn wrong(&self, key: &str, expected: &'static str) -> InvalidFit {
        let name = format!("curve.{key}");
        match self.entry(key) {
            Some(entry) => not_accepted(&entry.place, &name, &entry.value, expected),
            None => refused(&self.0[0].place, &name, Problem::Missing(expected)),
        }
    }

    fn text(&self, key: &str, expected: &'static str) -> Result<&str, InvalidFit> {
        match self.entry(key).map(|entry| &entry.value) {
            Some(Value::Text(text)) => Ok(text),
            _ => Err(self.wrong(key, expected)),
        }
    }

    /// Returns the number of an optional key.
    fn number(&self, key: &str) -> Result<Option<f64>, InvalidFit> {
        let read = |entry: &KeyValue| match &entry.value {
            Value::Number(text) => text.parse().ok(),
            _ => None,
        };
        let wrong = || self.wrong(key, "a number, in the unit of the first column");
        self.entry(key).map(|entry| read(entry).ok_or_else(wrong)).transpose()
    }

    /// Returns the texts of an optional key.
    fn texts(&self, key: &str) -> Result<Option<Vec<String>>, InvalidFit> {
        let read = |entry: &KeyValue| match &entry.value {
            Value::List(items) => items
                .iter()
                .map(|item| match item {
                    Value::Text(text) => Some(text.clone()),
                    _ => None,
                })
                .collect::<Option<_>>(),
            _ => None,
        };
        self.entry(key)
            .map(|entry| read(entry).ok_or_else(|| self.wrong(key, "a list of names in quotes")))
            .transpose()
    }

    /// Returns the error for a key of this table with a value that is not accepted.
    fn not_accepted(&self, key: &str, found: impl Display, expected: &str) -> InvalidFit {
        let place = self.entry(key).map_or(&self.0[0].place, |entry| &entry.place);
        not_accepted(place, &format!("curve.{key}"), found, expected)
    }

    /// Returns the path of the file, without links and `./` if it exists.
    fn path(&self, folder: &Path) -> PathBuf {
        let file = self.text("file", "").unwrap_or_default();
        let path = folder.join(file);
        path.canonicalize().unwrap_or(path)
    }

    /// Reads the measured curves of the chosen specimens.
    fn measured(&self, folder: &Path) -> Result<Vec<MeasuredCurve>, InvalidFit> {
        let file = self.text("file", "the name of a CSV file")?;
        let kind = self.text("kind", "\"puncture\" or \"bending\"")?;
        let columns = self.texts("columns")?;
        let mut curves = MeasuredCurve::read(&folder.join(file), columns.as_deref())?;
        if kind != curves[0].test.name() {
            let expected = match curves[0].test {
                Test::Puncture => "\"puncture\", as the columns of the file say",
                Test::Bending => "\"bending\", as the columns of the file say",
            };
            return Err(self.wrong("kind", expected));
        }
        if let Some(entry) = self.entry("specimen") {
            let index = self.specimen(entry, &curves)?;
            curves = vec![curves.swap_remove(index)];
        }
        // Messages name the file as the definition does, without the folder.
        for curve in &mut curves {
            curve.set_file(file);
        }
        Ok(curves)
    }

    /// Returns the index of the specimen with the name or the number in `entry`.
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
                [] => "no specimen: the file holds one".to_owned(),
                names => format!("a number from 1 to {}, or {}", names.len(), names.join(", ")),
            };
            self.not_accepted("specimen", &entry.value, &expected)
        })
    }

    /// Returns true for each branch that is fitted: loading and unloading.
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

    /// Selects the fitted branches of a curve from `from` to `to`, averaged if they are long.
    fn branches(
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
        let left_out = [(&mut loading, is_loading), (&mut unloading, is_unloading)]
            .into_iter()
            .filter(|(_, is_fitted)| !is_fitted)
            .map(|(branch, _)| std::mem::take(branch).len());
        let left_out: usize = left_out.sum();
        for event in events.iter_mut().filter(|e| e.kind == CurveEventKind::TurnsBack) {
            event.left_out = left_out;
        }
        let from = self.number("from")?.unwrap_or(f64::NEG_INFINITY) * curve.x_unit;
        let to = self.number("to")?.unwrap_or(f64::INFINITY) * curve.x_unit;
        // Select the range before averaging, so that no mean includes points outside of it.
        let is_within = |index: &usize| (from..=to).contains(&curve.points[*index][0]);
        loading.retain(is_within);
        unloading.retain(is_within);
        events.retain(|event| (from..=to).contains(&event.at));
        let count = loading.len() + unloading.len();
        if count == 0 {
            let key = if self.entry("from").is_some() { "from" } else { "to" };
            return Err(self.wrong(key, "a range with points of the file in it"));
        }
        // Machines record thousands of points, and the noise of neighbouring points is correlated.
        let part = count.div_ceil(MOST_POINTS);
        let mean = |indices: &[usize]| {
            [0, 1].map(|axis| {
                let sum: f64 = indices.iter().map(|index| curve.points[*index][axis]).sum();
                sum / indices.len() as f64
            })
        };
        let unloading: Vec<_> = unloading.chunks(part).map(mean).collect();
        let loading = loading.chunks(part).map(mean);
        curve.points = loading.chain(unloading.iter().copied()).collect();
        self.require_load(&curve)?;
        Ok(TestCurve {
            measured: curve,
            unloading: unloading.len(),
            turn,
            events,
            case: *case,
            own: own.to_vec(),
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

    /// Returns the parameters that this specimen sets itself, with their values.
    fn own_values(&self) -> Result<Vec<(&'static Parameter, Setting)>, InvalidFit> {
        let own = |entry: &KeyValue| {
            let name = format!("curve.{}", entry.key);
            let parameter = Parameter::named(&entry.key).ok_or_else(|| {
                let keys = KEYS.join(", ");
                let hint =
                    format!("expected {keys} or what this specimen has alone, e.g. gap_over_t");
                let value = entry.value.to_string();
                refused(&entry.place, &name, Problem::Unknown { value, hint })
            })?;
            let text = format!("designs.{}={}", entry.key, entry.value);
            Ok((parameter, Setting::from_option(&format!("{}: {name}", entry.place), &text)?))
        };
        self.0.iter().filter(|entry| !KEYS.contains(&entry.key.as_str())).map(own).collect()
    }

    /// Returns the offsets of this curve that are fitted.
    ///
    /// `offsets` lists the axes, or gives a range for each: `{ displacement = [-0.1, 3] }`.
    fn offsets(&self, measured: &MeasuredCurve, curve: usize) -> Result<Vec<Unknown>, InvalidFit> {
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

/// Returns the increasing bounds in a list of two numbers.
fn range(value: &Value) -> Option<[f64; 2]> {
    let Value::List(items) = value else { return None };
    let mut numbers = items.iter().map(|item| match item {
        Value::Number(text) => text.parse().ok().filter(|number: &f64| number.is_finite()),
        _ => None,
    });
    let [from, to] = [numbers.next()??, numbers.next()??];
    (numbers.next().is_none() && from < to).then_some([from, to])
}

impl TestCurve {
    /// Returns true for a curve of another specimen of the same design, in the same units.
    pub(crate) fn is_alike(&self, other: &Self) -> bool {
        let (one, two) = (&self.measured, &other.measured);
        one.test == two.test && one.is_physical == two.is_physical && self.case == other.case
    }

    /// Returns the points of the loading branch.
    pub(crate) fn loading(&self) -> &[[f64; 2]] {
        &self.measured.points[..self.measured.points.len() - self.unloading]
    }

    /// Returns one model unit on each axis, in the units of the curve.
    pub(crate) fn units(&self, case: &Case) -> [f64; 2] {
        let MeasuredCurve { test, is_physical, .. } = self.measured;
        // `FitDefinition::read` has checked that physical curves have their units.
        if is_physical { test.units(case).unwrap_or([f64::NAN; 2]) } else { [1.0; 2] }
    }
}
