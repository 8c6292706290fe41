//! The validated sweep.

mod axes;
mod deviations;
pub(crate) mod invalid;
mod lengths;
pub(crate) mod measure;
mod reader;
pub(crate) mod setting;
pub(crate) mod suggestion;
mod to_toml;
mod variables;

use std::io;
use std::path::Path;

use crate::case::Case;
use crate::deviation::Deviation;
use crate::grid::{Axis, Grid};
use crate::input::read_input;
use crate::parameter::Scalar;
use crate::parameter::{PARAMETERS, Parameter, key};
use crate::variable::Variable;
use invalid::InvalidDefinition;
use measure::Measure;
use reader::Reader;
use setting::Setting;
use text::number;
use text::reason;
use text::toml_source::{self, KeyValue, KeyValues, Place, Value};

/// A sweep that can run: its name, what it measures, its designs.
#[derive(Clone, Debug)]
pub struct Sweep {
    pub(crate) name: String,
    pub(crate) measures: Vec<Measure>,
    pub(crate) grid: Grid,
    pub(crate) variables: Vec<Variable>,
    pub(crate) deviations: Vec<Deviation>,
}

impl Sweep {
    /// The sweep that the file at `path` defines once `settings` are put in its place.
    ///
    /// # Errors
    /// If the file cannot be read or does not define a sweep; all that is wrong with it is told at once.
    pub fn read(path: &Path, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&read_entries(path, settings)?, &path.display().to_string())
    }

    /// The sweep that `text`, from the file `name`, defines once `settings` are put in its place.
    ///
    /// # Errors
    /// If the text does not define a sweep.
    pub fn parse(text: &str, name: &str, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&entries(text, name, settings)?, name)
    }

    /// The sweep that keys and values of the file `name` define.
    ///
    /// # Errors
    /// If they do not define a sweep.
    pub fn of_entries(entries: &KeyValues, name: &str) -> Result<Self, InvalidDefinition> {
        let mut reader = Reader::default();
        for entry in entries {
            reader.entry(entry);
        }
        reader.finish(&Place::File { name: name.into(), line: None })
    }

    /// The name, which is also that of the folder of its results.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The measures that every design is solved for.
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }

    /// What is measured, without the derivatives of it.
    pub fn plain_measures(&self) -> Vec<Measure> {
        let mut measures = self.measures.clone();
        measures.retain(|measure| *measure != Measure::Sensitivity);
        measures
    }

    /// This sweep, which measures sensitivities besides.
    #[must_use]
    pub fn with_sensitivity(mut self) -> Self {
        if !self.measures.contains(&Measure::Sensitivity) {
            self.measures.push(Measure::Sensitivity);
        }
        self
    }

    /// The designs.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The parameters that no design fixes. Until they are searched over or drawn, they stand in the middle of their values.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// How far what is made differs from what is drawn.
    pub fn deviations(&self) -> &[Deviation] {
        &self.deviations
    }

    /// The sweep with design `index` alone.
    #[must_use]
    pub fn only(&self, index: u64) -> Self {
        Self { grid: self.grid.only(index), ..self.clone() }
    }

    /// The sweep with the one design that has the values of `case` on every axis, whether or not they are among those of the axis.
    /// That sweep has no variables.
    #[must_use]
    pub fn at(&self, case: &Case) -> Self {
        Self { grid: self.grid.at(case), variables: Vec::new(), ..self.clone() }
    }

    /// Whether any of its designs is solved with imperfections too.
    pub fn is_imperfect(&self) -> bool {
        let largest = |key: &str| {
            let base = || Parameter::named(key).and_then(|p| p.get(self.grid.base()).number());
            // One design that scatters is enough for the whole table to have the columns.
            let axis = self.grid.axis(key).map(|axis| axis.span().1);
            axis.or_else(base).unwrap_or(0.0)
        };
        largest("gap_cv") > 0.0 || largest("slant_sd_deg") > 0.0
    }

    /// Whether the needle of any design is guided.
    pub fn is_guided(&self) -> bool {
        let base = || self.grid.base().puncture.needle.is_guided();
        let any = |axis: &Axis| (0..axis.len()).any(|k| axis.value(k) == Scalar::Word("guided"));
        self.grid.axis(key::NEEDLE).map_or_else(base, any)
    }

    /// Whether the designs have a value for the parameter of that name.
    pub fn gives(&self, key: &str) -> bool {
        let is_given = |parameter: &Parameter| {
            let is_said = |key| self.grid.axis(key).is_some();
            let in_mm =
                || parameter.in_mm().any(|p| is_said(p.key) || p.is_given(self.grid.base()));
            is_said(parameter.key) || parameter.is_given(self.grid.base()) || in_mm()
        };
        Parameter::named(key).is_some_and(is_given)
    }

    /// Whether lengths are given in mm, so that the thickness moves those over it.
    pub fn gives_millimetres(&self) -> bool {
        PARAMETERS.iter().any(|parameter| parameter.is_in_mm() && self.gives(parameter.key))
    }

    /// Whether another parameter of the skin follows from this one: a length over the thickness from a thickness, a ratio of contact from
    /// a modulus.
    pub fn has_followers(&self, parameter: &Parameter) -> bool {
        match parameter.key {
            key::THICKNESS => self.gives_millimetres(),
            key::SUBSTRATE_MODULUS | key::MEMBRANE_MODULUS => self.gives(key::SCALE_MODULUS),
            key::SCALE_MODULUS => true,
            _ => parameter.is_in_mm(),
        }
    }

    /// What is strange about the definition though it is valid: a modulus of soft tissue in the unit of another prefix.
    pub fn question(&self) -> Option<String> {
        let written = |parameter: &Parameter| {
            // The largest value: one design whose unit is wrong is enough to ask.
            let axis = self.grid.axis(parameter.key).map(|axis| axis.span().1);
            let variable = self.variables.iter().find(|v| v.parameter() == parameter);
            let variable = variable.and_then(|variable| variable.at(1.0).number());
            variable.or(axis).or_else(|| parameter.get(self.grid.base()).number())
        };
        let modulus = written(Parameter::named(key::SUBSTRATE_MODULUS)?)?;
        (modulus > STIFFEST_TISSUE).then(|| {
            format!(
                "material.{} is {} MPa, {} GPa: soft tissue has some 0.001 to 10 MPa; is it in MPa, and not in kPa or Pa?",
                key::SUBSTRATE_MODULUS,
                number::text(modulus),
                number::text(modulus / 1e3)
            )
        })
    }

    /// Whether the parameter of that name is an axis, or has another value than that by default.
    pub fn sets(&self, key: &str) -> bool {
        let is_set = |parameter: &Parameter| parameter.get(self.grid.base()) != parameter.default();
        self.grid.axis(key).is_some() || Parameter::named(key).is_some_and(is_set)
    }

    /// The parameters that all designs share, with their values. The length of a strip is none if its gaps are given, and
    /// the critical tilt none if the friction of the needle is.
    pub fn shared(&self) -> impl Iterator<Item = (&'static Parameter, Scalar)> {
        // Found once and few: asking every parameter about every other one took long.
        let alone: Vec<_> = PARAMETERS.iter().filter(|other| self.gives_alone(other)).collect();
        let shared = move |parameter: &&Parameter| {
            self.grid.axis(parameter.key).is_none()
                && parameter.is_given(self.grid.base())
                && !parameter.follows(self.grid.base())
                && !alone.iter().any(|other| parameter.is_said_by(other, self.grid.base()))
        };
        PARAMETERS.iter().filter(shared).map(|p| (p, p.get(self.grid.base())))
    }
}

impl Sweep {
    /// Whether the definition gives this parameter, so that it leaves nothing to the other way to say the same.
    fn gives_alone(&self, parameter: &Parameter) -> bool {
        let value = parameter.get(self.grid.base());
        let follows = parameter.follows(self.grid.base());
        let is_number = !matches!(value, Scalar::Word(_)) && !follows;
        self.grid.axis(parameter.key).is_some() || (parameter.is_optional() && is_number)
    }
}

/// Modulus in `MPa` above which nothing is soft tissue: that of bone is ten times as much, that of cartilage a hundredth.
const STIFFEST_TISSUE: f64 = 1e3;

/// Bytes of a definition, at most: a million values of an axis take a third of them.
const LONGEST: u64 = 1 << 26;

/// Largest number of keys in a definition. Each takes a kilobyte once it is parsed, so a file of sections would exhaust memory.
const MAX_KEYS: usize = 100_000;

/// The keys and values of the definition in the file at `path` once `settings` are put in its place.
///
/// # Errors
/// If the file cannot be read or is no TOML.
pub fn read_entries(path: &Path, settings: &[Setting]) -> Result<KeyValues, InvalidDefinition> {
    entries(&read_text(path)?, &path.display().to_string(), settings)
}

/// The keys and values of the definition `text`, from the file `name`, once `settings` are put in its place.
///
/// # Errors
/// If the text is no TOML.
pub fn entries(
    text: &str,
    name: &str,
    settings: &[Setting],
) -> Result<KeyValues, InvalidDefinition> {
    let mut table = definition_of(toml_source::parse(text, name)?);
    for setting in settings {
        setting.apply(&mut table);
    }
    Ok(table)
}

/// Reads the text of the definition at `path`.
///
/// # Errors
/// If the file cannot be read, or is larger than any definition.
pub fn read_text(path: &Path) -> Result<String, InvalidDefinition> {
    let checked = read_input(path, LONGEST).and_then(|text| match keys(&text) {
        0..=MAX_KEYS => Ok(text),
        _ => Err(io::Error::other(format!("it has more than {MAX_KEYS} keys"))),
    });
    checked.map_err(|error| {
        let reason = reason(&error);
        InvalidDefinition::Unreadable { file: path.display().to_string(), reason }
    })
}

/// The number of keys and sections of a definition, or a few more: an estimate that needs no memory.
fn keys(text: &str) -> usize {
    let is_section = |line: &&str| {
        let name = line.trim_start().trim_start_matches('[');
        name.len() < line.trim_start().len()
            && name.starts_with(|start: char| start.is_alphabetic() || "\"'_".contains(start))
    };
    text.matches('=').count() + text.lines().filter(is_section).count()
}

/// A run's own record holds its definition in a table of that name.
fn definition_of(mut table: KeyValues) -> KeyValues {
    let holds =
        |key: &str, entry: &KeyValue| entry.key == key && matches!(entry.value, Value::Table(_));
    // A table `definition` without that of a run is no record, and refused as an unknown key.
    if table.iter().any(|entry| holds("run", entry))
        && let Some(position) = table.iter().position(|entry| holds("definition", entry))
        && let Value::Table(definition) = table.swap_remove(position).value
    {
        return definition;
    }
    table
}
