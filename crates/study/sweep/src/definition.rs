//! The validated sweep.

mod axes;
mod deviations;
pub(crate) mod invalid;
mod lengths;
pub(crate) mod measure;
mod reader;
pub(crate) mod schema;
pub(crate) mod setting;
pub(crate) mod suggestion;
mod to_toml;
mod variables;

use std::io;
use std::path::Path;

use crate::case::Case;
use crate::deviation::Deviation;
use crate::grid::Grid;
use crate::input::read_input;
use crate::parameter::{PARAMETERS, Parameter, key};
use crate::scalar::Scalar;
use crate::variable::Variable;
use invalid::InvalidDefinition;
use measure::Measure;
use reader::Reader;
use setting::Setting;
use text::number;
use text::reason;
use text::toml_source::{self, KeyValue, KeyValues, Location, Value};

/// A validated sweep: name, measures, designs.
#[derive(Clone, Debug)]
pub struct Sweep {
    pub(crate) name: String,
    pub(crate) measures: Vec<Measure>,
    pub(crate) grid: Grid,
    pub(crate) variables: Vec<Variable>,
    pub(crate) deviations: Vec<Deviation>,
}

impl Sweep {
    /// Reads the sweep from the file at `path`. `settings` replace values of the file.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or does not define a sweep. The error lists all problems.
    pub fn read(path: &Path, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&read_entries(path, settings)?, &path.display().to_string())
    }

    /// Parses the definition `text` of the file `name`. `settings` replace values of the text.
    ///
    /// # Errors
    ///
    /// If the text does not define a sweep.
    pub fn parse(text: &str, name: &str, settings: &[Setting]) -> Result<Self, InvalidDefinition> {
        Self::of_entries(&entries(text, name, settings)?, name)
    }

    /// Creates the sweep from the keys and values `entries` of the file `name`.
    ///
    /// # Errors
    ///
    /// If the entries do not define a sweep. The error lists all problems.
    pub fn of_entries(entries: &KeyValues, name: &str) -> Result<Self, InvalidDefinition> {
        let mut reader = Reader::default();
        for entry in entries {
            reader.entry(entry);
        }
        reader.finish(&Location::File { name: name.into(), line: None })
    }

    /// Returns the name of the sweep, which is also the name of its results folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the measures that are computed for every design.
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }

    /// Returns all measures except [`Measure::Sensitivity`].
    pub fn plain_measures(&self) -> Vec<Measure> {
        let mut measures = self.measures.clone();
        measures.retain(|measure| *measure != Measure::Sensitivity);
        measures
    }

    /// Returns this sweep with sensitivity added to the measures.
    #[must_use]
    pub fn with_sensitivity(mut self) -> Self {
        if !self.measures.contains(&Measure::Sensitivity) {
            self.measures.push(Measure::Sensitivity);
        }
        self
    }

    /// Returns the grid of designs.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Returns the variables: the parameters that a search or a random draw sets.
    ///
    /// In the designs of the grid, a variable has the value in the middle of its range.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Returns the manufacturing deviations.
    pub fn deviations(&self) -> &[Deviation] {
        &self.deviations
    }

    /// Returns this sweep with design `index` as its only design.
    #[must_use]
    pub fn only(&self, index: u64) -> Self {
        Self { grid: self.grid.only(index), ..self.clone() }
    }

    /// Returns this sweep with a single design, for which `case` gives the value on every axis.
    ///
    /// The axes of this sweep need not contain these values. The returned sweep has no variables.
    #[must_use]
    pub fn at(&self, case: &Case) -> Self {
        Self { grid: self.grid.at(case), variables: Vec::new(), ..self.clone() }
    }

    /// Returns true if any design is also solved with imperfections.
    pub fn is_imperfect(&self) -> bool {
        ["gap_cv", "slant_sd_deg"].into_iter().any(|key| {
            // Check the largest value, because a single imperfect design adds sample columns.
            let largest = self.grid.axis(key).map(|axis| axis.span().1);
            largest
                .or_else(|| Parameter::named(key)?.get(self.grid.base()).number())
                .is_some_and(|largest| largest > 0.0)
        })
    }

    /// Returns true if the needle of any design is guided.
    pub fn is_guided(&self) -> bool {
        self.grid.axis(key::NEEDLE).map_or_else(
            || self.grid.base().puncture.needle.is_guided(),
            |axis| (0..axis.len()).any(|k| axis.value(k) == Scalar::Word("guided")),
        )
    }

    /// Returns true if the designs have a value for the parameter `key`, directly or in mm.
    pub fn gives(&self, key: &str) -> bool {
        Parameter::named(key).is_some_and(|parameter| {
            std::iter::once(parameter)
                .chain(parameter.in_mm())
                .any(|p| self.grid.axis(p.key).is_some() || p.is_given(self.grid.base()))
        })
    }

    /// Returns true if a length is given in mm, so that its ratio depends on the thickness.
    pub fn gives_millimetres(&self) -> bool {
        PARAMETERS.iter().any(|parameter| parameter.is_in_mm() && self.gives(parameter.key))
    }

    /// Returns true if another parameter of the skin follows from `parameter`.
    ///
    /// Ratios of lengths to the thickness follow from the thickness and from lengths in mm. Ratios
    /// to a modulus follow from moduli, strengths and the force.
    pub fn has_followers(&self, parameter: &Parameter) -> bool {
        match parameter.key {
            key::THICKNESS => self.gives_millimetres() || self.gives(key::NEEDLE_FORCE_N),
            key::SUBSTRATE_MODULUS | key::MEMBRANE_MODULUS => PARAMETERS.iter().any(|above| {
                let mut ratios = above.ratios();
                ratios.any(|(_, below)| below == parameter.key) && self.gives(above.key)
            }),
            _ if parameter.ratios().next().is_some() => true,
            _ => parameter.is_in_mm(),
        }
    }

    /// Returns notes on values that are valid but doubtful.
    pub fn notes(&self) -> Vec<String> {
        self.stiff_tissue().into_iter().chain(self.narrow_body()).collect()
    }

    /// Returns a note on a convex body that is narrow for the pitch of the scales.
    fn narrow_body(&self) -> Option<String> {
        // Return early for flat bodies, because creating the cases of a large grid takes time.
        let axis =
            self.grid.axis_in_any_unit(key::CURVATURE).or(self.grid.axis_in_any_unit(key::RADIUS));
        if axis.is_none() && self.grid.base().body().is_flat() {
            return None;
        }
        let count = self.grid.len().min(MOST_CHECKED);
        let narrow = (0..count).filter_map(|index| {
            let case = self.grid.case(index);
            let radius_in_pitches = (case.body().curvature * case.pitch()).recip();
            (0.0..FEWEST_PITCHES).contains(&radius_in_pitches).then_some(radius_in_pitches)
        });
        let narrow: Vec<_> = narrow.collect();
        let least = narrow.iter().copied().reduce(f64::min)?;
        let of = match narrow.len() {
            1 => "in one design".to_owned(),
            several => format!("in {several} designs"),
        };
        Some(format!(
            "the radius of the convex body is less than {FEWEST_PITCHES} pitches {of}, the smallest \
             {least:.1}: the tissue then differs from the half-space or layer of the model"
        ))
    }

    /// Returns a note on a substrate modulus that is too large for soft tissue.
    ///
    /// Such a modulus is probably in `kPa` or `Pa` instead of `MPa`.
    fn stiff_tissue(&self) -> Option<String> {
        let parameter = Parameter::named(key::SUBSTRATE_MODULUS)?;
        // Check the largest value of the axis or the variable.
        let axis = self.grid.axis(parameter.key).map(|axis| axis.span().1);
        let variable = self.variables.iter().find(|v| v.parameter() == parameter);
        let variable = variable.and_then(|variable| variable.at(1.0).number());
        let modulus = variable.or(axis).or_else(|| parameter.get(self.grid.base()).number())?;
        (modulus > STIFFEST_TISSUE).then(|| {
            format!(
                "material.{} is {} MPa, {} GPa: soft tissue has 0.001 to 10 MPa; check that the unit is MPa, not kPa or Pa",
                key::SUBSTRATE_MODULUS,
                number::text(modulus),
                number::text(modulus / 1e3)
            )
        })
    }

    /// Returns true if the parameter `key` is an axis or differs from its default.
    pub fn sets(&self, key: &str) -> bool {
        self.grid.axis(key).is_some()
            || Parameter::named(key)
                .is_some_and(|parameter| parameter.get(self.grid.base()) != parameter.default())
    }

    /// Returns the parameters shared by all designs, with their values.
    ///
    /// Omits parameters that follow from a length in mm, a modulus or an alternative. For example,
    /// the critical tilt of a free needle follows from its friction.
    pub fn shared(&self) -> impl Iterator<Item = (&'static Parameter, Scalar)> {
        // Filter the list once, because comparing all pairs of parameters is slow.
        let alone: Vec<_> = PARAMETERS.iter().filter(|other| self.gives_alone(other)).collect();
        PARAMETERS
            .iter()
            .filter(move |parameter| {
                self.grid.axis(parameter.key).is_none()
                    && parameter.is_given(self.grid.base())
                    && !parameter.follows(self.grid.base())
                    && !alone
                        .iter()
                        .any(|other| parameter.is_alternative_of(other, self.grid.base()))
            })
            .map(|p| (p, p.get(self.grid.base())))
    }
}

impl Sweep {
    /// Returns true if the definition gives `parameter`, so that its alternatives do not apply.
    fn gives_alone(&self, parameter: &Parameter) -> bool {
        let value = parameter.get(self.grid.base());
        let follows = parameter.follows(self.grid.base());
        let is_number = !matches!(value, Scalar::Word(_)) && !follows;
        self.grid.axis(parameter.key).is_some() || (parameter.is_optional() && is_number)
    }
}

/// Modulus in `MPa` above which a substrate is not soft tissue.
///
/// Cartilage has a hundredth of this modulus, bone ten times this modulus.
const STIFFEST_TISSUE: f64 = 1e3;

/// Radius of a convex body, in pitches, below which the flat model of the substrate is inaccurate.
const FEWEST_PITCHES: f64 = 2.0;

/// Maximum number of designs that the note on narrow bodies checks.
const MOST_CHECKED: u64 = 100_000;

/// Maximum length of a definition in bytes.
///
/// A list of a million axis values takes a third of this length.
const LONGEST: u64 = 1 << 26;

/// Maximum number of keys in a definition.
///
/// A parsed key takes a kilobyte, so a file with millions of empty sections would exhaust the
/// memory.
const MAX_KEYS: usize = 100_000;

/// Reads the keys and values of the file at `path`. `settings` replace values of the file.
///
/// # Errors
///
/// If the file cannot be read or is not TOML.
pub fn read_entries(path: &Path, settings: &[Setting]) -> Result<KeyValues, InvalidDefinition> {
    entries(&read_text(path)?, &path.display().to_string(), settings)
}

/// Parses the keys and values of the definition `text`.
///
/// `settings` replace values of the text. `name` is the file name in messages.
///
/// # Errors
///
/// If the text is not TOML.
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
///
/// If the file cannot be read, or exceeds the maximum length.
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

/// Estimates the number of keys and sections of a TOML text.
///
/// Neither parses the text nor allocates memory. The estimate is too high if texts or comments
/// contain `=`.
fn keys(text: &str) -> usize {
    text.matches('=').count()
        + text
            .lines()
            .filter(|line| {
                let name = line.trim_start().trim_start_matches('[');
                name.len() < line.trim_start().len()
                    && name
                        .starts_with(|start: char| start.is_alphabetic() || "\"'_".contains(start))
            })
            .count()
}

/// Returns the definition inside the record of a run; any other table is returned unchanged.
///
/// A record, such as the file `run.toml`, has the tables `run` and `definition`.
fn definition_of(mut table: KeyValues) -> KeyValues {
    let holds =
        |key: &str, entry: &KeyValue| entry.key == key && matches!(entry.value, Value::Table(_));
    // A table `definition` without a table `run` is no record; later it is refused as unknown key.
    if table.iter().any(|entry| holds("run", entry))
        && let Some(position) = table.iter().position(|entry| holds("definition", entry))
        && let Value::Table(definition) = table.swap_remove(position).value
    {
        return definition;
    }
    table
}
