//! Definition of a fit: a sweep with `[variables]` and one `[[curve]]` per file.

mod curve_table;

use std::fmt::Display;
use std::path::Path;

use sweep::{
    Case, InvalidDefinition, InvalidSetting, Parameter, Problem, Role, Setting, Sweep,
    VariableValues, WrongValue, read_entries,
};
use text::toml_source::{KeyValue, KeyValues, Location, Value};

pub use self::curve_table::curves_schema;
use self::curve_table::tables;
use crate::measured_curve::{CurveEvent, InvalidMeasured, MeasuredCurve};

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
    /// Name for messages: a key, the key and file of a specimen, or the offset of a file.
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
    /// Returns the value of a scaled unknown: 0 at the lower bound, 1 at the upper.
    pub(crate) fn value(&self, scaled: f64) -> f64 {
        self.from + scaled * (self.to - self.from)
    }

    /// Returns the key with which a definition sets the range of this unknown, for messages.
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

/// Quantity that an unknown represents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    /// Parameter with the same value for all curves.
    Parameter(&'static Parameter),
    /// Parameter of a single specimen, with the index of its curve.
    Specimen(&'static Parameter, usize),
    /// Offset of a curve: index of the curve, and index of the axis (0 or 1).
    Offset(usize, usize),
}

/// A measured curve with its specimen.
#[derive(Debug)]
pub(crate) struct TestCurve {
    /// The curve with its fitted points only: loading branch, then unloading branch.
    pub(crate) measured: MeasuredCurve,
    /// Number of fitted points of the unloading branch.
    pub(crate) unloading: usize,
    /// Displacement or curvature at which unloading begins, in the units of the curve.
    pub(crate) turn: f64,
    /// Events within the fitted range, e.g. first contact, reversals, holds and drops.
    pub(crate) events: Vec<CurveEvent>,
    /// The specimen: the design of the definition with the parameters in `fixed`.
    pub(crate) case: Case,
    /// Parameters set in the table of this curve. Unknowns do not change them.
    pub(crate) fixed: Vec<&'static Parameter>,
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

/// Key that lists the parameters that differ from specimen to specimen.
pub const PER_SPECIMEN: &str = "per_specimen";

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
            // Read the definition again with the values of this specimen, to check these values.
            let specimen = own.iter().map(|(_, setting)| setting);
            // The last value of a key applies: the specimen overrides the command line.
            let specimen: Vec<_> = settings.iter().chain(specimen).cloned().collect();
            let case = one_design(&read_entries(path, &specimen)?, &name)?.grid().case(0);
            let own: Vec<_> = own.into_iter().map(|(parameter, _)| parameter).collect();
            for measured in table.measured(folder)? {
                let curve = table.branches(measured, &case, &own)?;
                let measured = &curve.measured;
                // Check the material keys here, where the line of the curve is known.
                let missing = measured.test.units(&case).err().filter(|_| measured.is_physical);
                if let Some(missing) = missing {
                    let expected = format!("{missing} for a file in physical units");
                    let location = table.location();
                    return Err(not_accepted(location, "curve.file", &measured.file, &expected));
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

    /// Returns the unknowns of the fit.
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

fn refused(location: &Location, key: &str, problem: Problem) -> InvalidFit {
    let (location, key, problem) = (location.clone(), key.to_owned(), Box::new(problem));
    InvalidDefinition::Refused { location, key, problem }.into()
}

fn not_accepted(location: &Location, key: &str, found: impl Display, expected: &str) -> InvalidFit {
    let (found, expected) = (found.to_string(), expected.to_owned());
    refused(location, key, WrongValue::NotAccepted { found, expected }.into())
}

/// Returns the sweep of a definition, without the curves.
///
/// Each parameter must have a single value; parameters to be fitted belong in `[variables]`.
fn one_design(entries: &KeyValues, name: &str) -> Result<Sweep, InvalidFit> {
    let shared = entries.iter().filter(|e| !["curve", PER_SPECIMEN].contains(&e.key.as_str()));
    let entries = shared.cloned().collect();
    let sweep = Sweep::of_entries(&entries, name)?;
    match sweep.grid().axes().iter().find(|axis| axis.len() > 1) {
        Some(axis) => {
            let key = axis.parameter().key;
            let file = Location::File { name: name.into(), line: None };
            let expected = format!("one value, or {key} among [variables]");
            Err(not_accepted(&file, &format!("designs.{key}"), axis.to_toml(), &expected))
        }
        None => Ok(sweep),
    }
}

/// Returns the unknowns in `[variables]`.
fn parameters(entries: &KeyValues, sweep: &Sweep) -> Result<Vec<Unknown>, InvalidFit> {
    let written = entries.iter().filter(|entry| entry.key == "variables");
    let written: Vec<_> = written.filter_map(|entry| table(&entry.value)).flatten().collect();
    sweep
        .variables()
        .iter()
        .map(|variable| {
            let parameter = variable.parameter();
            let is_number = parameter.has(Role::Continuous) || parameter.has(Role::Toleranced);
            if let VariableValues::Between(from, to) = *variable.values()
                && is_number
            {
                let (name, source) = (parameter.key.to_owned(), Source::Parameter(parameter));
                return Ok(Unknown { name, unit: parameter.unit, from, to, source });
            }
            let entry = written.iter().find(|entry| entry.key == parameter.key);
            let location =
                entry.map_or(Location::Argument("[variables]".into()), |e| e.location.clone());
            let expected =
                "bounds of a continuous parameter of the skin, e.g. { from = 0.1, to = 1 }";
            let key = format!("variables.{}", parameter.key);
            Err(not_accepted(&location, &key, variable.to_toml(), expected))
        })
        .collect()
}

/// Replaces each parameter in `per_specimen` with one unknown for each curve.
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
        return Err(not_accepted(&entry.location, PER_SPECIMEN, &entry.value, expected));
    };
    for item in items {
        let named =
            unknowns.iter().enumerate().find_map(|(index, unknown)| match (item, unknown.source) {
                (Value::Text(text), Source::Parameter(p)) if text == p.key => Some((index, p)),
                _ => None,
            });
        let (index, parameter) = named.ok_or_else(|| {
            not_accepted(&entry.location, PER_SPECIMEN, &entry.value, "names of [variables]")
        })?;
        let shared = unknowns.remove(index);
        let open = curves.iter().enumerate().filter(|(_, curve)| !curve.fixed.contains(&parameter));
        let own: Vec<_> = open
            .map(|(k, curve)| Unknown {
                name: format!("{} of {}", shared.name, curve.measured.file),
                source: Source::Specimen(parameter, k),
                ..shared.clone()
            })
            .collect();
        if own.len() < 2 {
            let expected = "at least two [[curve]] that do not set this parameter";
            return Err(not_accepted(&entry.location, PER_SPECIMEN, &entry.value, expected));
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

impl TestCurve {
    /// Returns true if both curves are from specimens of the same design, in the same units.
    pub(crate) fn is_alike(&self, other: &Self) -> bool {
        let (one, two) = (&self.measured, &other.measured);
        one.test == two.test && one.is_physical == two.is_physical && self.case == other.case
    }

    /// Returns the fitted points of the loading branch.
    pub(crate) fn loading(&self) -> &[[f64; 2]] {
        &self.measured.points[..self.measured.points.len() - self.unloading]
    }

    /// Returns the size of one model unit on each axis, in the units of the curve.
    pub(crate) fn units(&self, case: &Case) -> [f64; 2] {
        let MeasuredCurve { test, is_physical, .. } = self.measured;
        // `FitDefinition::read` has checked that a case with a physical curve has all material
        // keys, so `units` succeeds.
        if is_physical { test.units(case).unwrap_or([f64::NAN; 2]) } else { [1.0; 2] }
    }
}
