//! Builds a sweep from the keys and values of a definition, or reports all errors.

use super::axes;
use super::deviations;
use super::invalid::{InvalidDefinition, Problem, refuse};
use super::lengths;
use super::measure::Measure;
use super::suggestion;
use super::variables;
use crate::case::Case;
use crate::definition::Sweep;
use crate::deviation::Deviation;
use crate::grid::{Axis, Grid};
use crate::named_values::{NAME_KEYS, NameKey, NamedValues, short_name_key};
use crate::parameter::{Parameter, WrongValue, any_of, key};
use crate::scalar::Scalar;
use crate::variable::{Variable, VariableValues};
use text::number;
use text::toml_source::{KeyValue, KeyValues, Location, Value};

/// Number of errors at which reading stops.
///
/// Otherwise, a file in another format would print thousands of errors.
const MOST: usize = 50;

/// Collects the accepted keys of a definition and the errors of the refused keys.
#[derive(Debug, Default)]
pub(crate) struct Reader {
    name: Option<String>,
    measures: Option<Vec<Measure>>,
    case: Case,
    shared: Vec<(&'static Parameter, Location)>,
    named: Vec<(&'static NamedValues, Location)>,
    axes: Vec<WrittenAxis>,
    variables: Vec<(Variable, Location)>,
    deviations: Vec<(Deviation, Location)>,
    refused: Vec<InvalidDefinition>,
}

/// An axis and its position in the definition.
#[derive(Debug)]
struct WrittenAxis {
    axis: Axis,
    location: Location,
}

impl Reader {
    /// Reads one top-level key or one section.
    pub fn entry(&mut self, entry: &KeyValue) {
        if self.refused.len() >= MOST {
            return;
        }
        let result = match entry.key.as_str() {
            "name" => self.read_name(entry),
            "measures" => self.read_measures(entry),
            suggestion::VARIABLES => self.entries(entry, Self::read_variable),
            suggestion::TOLERANCE => self.entries(entry, Self::read_deviation),
            section if suggestion::sections().contains(&section) => match short_name_key(section) {
                // `material = "PLA"` names the material of the scales, `body = "finger"` the body.
                Some(key) if matches!(entry.value, Value::Text(_)) => self.read_name_of(key, entry),
                _ => self.section(section, entry),
            },
            _ => Err(unknown("", entry)),
        };
        self.refused.extend(result.err());
    }

    fn read_name(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        // Insert an empty name first, so that a refused name is not also reported as missing.
        let name = self.name.insert(String::new());
        *name = name_of(&entry.value)
            .map_err(|problem| refuse(&entry.location, &entry.key, Problem::Value(problem)))?;
        Ok(())
    }

    fn read_measures(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let measures = Measure::read_list(&entry.value);
        self.measures = Some(measures.map_err(|p| refuse(&entry.location, &entry.key, p))?);
        Ok(())
    }

    /// Reads the name of a material or body.
    fn read_name_of(
        &mut self,
        name_key: &'static NameKey,
        entry: &KeyValue,
    ) -> Result<(), InvalidDefinition> {
        let NameKey { section, key, known } = name_key;
        let named = match &entry.value {
            Value::Text(name) => name_key.find(name),
            _ => None,
        };
        let Some(named) = named else {
            let names: Vec<_> = known.iter().map(|known| known.name).collect();
            let wrong = WrongValue::not_accepted(&entry.value, any_of(&names));
            return Err(refuse(&entry.location, &format!("{section}.{key}"), wrong));
        };
        self.named.push((named, entry.location.clone()));
        Ok(())
    }

    /// Sets the parameters that named materials and bodies define, unless the definition gives
    /// them.
    fn supply_named(&mut self) {
        for (named, location) in std::mem::take(&mut self.named) {
            for (key, value) in named.values {
                let Some(parameter) = Parameter::named(key) else { continue };
                let is_given = self.gives(key)
                    || parameter.others_in(&self.case).any(|other| self.gives(other.key));
                if is_given {
                    continue;
                }
                parameter.set(&mut self.case, Scalar::Number(*value));
                self.shared.push((parameter, location.clone()));
            }
        }
    }

    fn section(&mut self, section: &str, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        self.entries(entry, |reader, entry| reader.parameter(section, entry))
    }

    /// Reads each entry of a section with the function `read_entry`, and collects the errors.
    fn entries(
        &mut self,
        section: &KeyValue,
        mut read_entry: impl FnMut(&mut Self, &KeyValue) -> Result<(), InvalidDefinition>,
    ) -> Result<(), InvalidDefinition> {
        for entry in table(section)? {
            if self.refused.len() >= MOST {
                break;
            }
            let result = read_entry(self, entry);
            self.refused.extend(result.err());
        }
        Ok(())
    }

    fn read_variable(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let Some(parameter) = Parameter::named(&entry.key) else {
            return Err(unknown(suggestion::VARIABLES, entry));
        };
        let key = format!("{}.{}", suggestion::VARIABLES, entry.key);
        let variable = variables::read(parameter, &entry.value);
        let variable = variable.map_err(|problem| refuse(&entry.location, &key, problem))?;
        self.variables.push((variable, entry.location.clone()));
        Ok(())
    }

    fn read_deviation(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let key = format!("{}.{}", suggestion::TOLERANCE, entry.key);
        let deviation =
            deviations::read(entry).map_err(|problem| refuse(&entry.location, &key, problem))?;
        // `gap_mm` and `gap_over_t` are the same deviation in two units.
        let other = self.deviations.iter().find(|(d, _)| d.parameter() == deviation.parameter());
        if let Some((other, location)) = other {
            let other = format!("{}.{}", suggestion::TOLERANCE, other.key());
            let problem = Problem::Alternative { other, location: location.clone() };
            return Err(refuse(&entry.location, &key, problem));
        }
        self.deviations.push((deviation, entry.location.clone()));
        Ok(())
    }

    fn parameter(&mut self, section: &str, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let key = format!("{section}.{}", entry.key);
        let mut names = NAME_KEYS.iter().filter(|name| name.section == section);
        if let Some(name) = names.find(|name| name.key == entry.key) {
            return self.read_name_of(name, entry);
        }
        // Any parameter may be an axis, whatever its section.
        let Some(parameter) =
            Parameter::named(&entry.key).filter(|p| section == "designs" || section == p.section)
        else {
            return Err(unknown(section, entry));
        };
        if section == "designs" {
            let axis = axes::read(parameter, &entry.value);
            let axis = axis.map_err(|problem| refuse(&entry.location, &key, problem))?;
            self.axes.push(WrittenAxis { axis, location: entry.location.clone() });
        } else {
            let value = parameter.read(&entry.value);
            let value = value.map_err(|problem| refuse(&entry.location, &key, problem))?;
            parameter.set(&mut self.case, value);
            self.shared.push((parameter, entry.location.clone()));
        }
        Ok(())
    }

    /// Returns the sweep after all keys of `file` have been read, or all errors.
    pub fn finish(mut self, file: &Location) -> Result<Sweep, InvalidDefinition> {
        self.supply_named();
        // If a gap is also given, the pitch determines the length of a scale.
        self.case.in_mm.pitch_determines_length = self.gives(key::PITCH) && self.gives(key::GAP);
        let wrong_together = self.wrong_together(file);
        self.refused.extend(wrong_together);
        // The checks below need designs, which can be created only from keys without errors.
        InvalidDefinition::refuse_any(std::mem::take(&mut self.refused))?;
        let written: Vec<_> =
            self.written().map(|(k, p, location)| (k, p, location.clone())).collect();
        let measures = self.measures.unwrap_or_else(|| Measure::USUAL.to_vec());
        let variables: Vec<_> = self.variables.into_iter().map(|(variable, _)| variable).collect();
        let deviations = self.deviations.into_iter().map(|(deviation, _)| deviation).collect();
        // A variable has the middle of its range until a search or a random draw sets it.
        let middles = variables.iter().map(|v| Axis::list(v.parameter(), vec![v.at(0.5)]));
        let axes = self.axes.into_iter().map(|written| written.axis);
        let axes = axes::ordered(axes.chain(middles).collect(), &self.case);
        let grid = Grid::new(axes, self.case).map_err(|error| refuse(file, "designs", error))?;
        for (key, parameter, location) in &written {
            let checked = lengths::check(parameter, &grid, &variables);
            checked.map_err(|problem| refuse(location, key, problem))?;
        }
        Ok(Sweep { name: self.name.unwrap_or_default(), measures, grid, variables, deviations })
    }

    /// Returns errors for keys with values that are valid alone but not in combination.
    fn wrong_together(&self, file: &Location) -> Vec<InvalidDefinition> {
        let mut wrong: Vec<_> = self.contradictions().collect();
        wrong.extend(self.fixed_variables());
        wrong.extend(self.deviations_without_unit());
        let checked = [
            self.check_alternatives(),
            self.check_needle(),
            self.check_radius(),
            self.check_bending(),
        ];
        wrong.extend(checked.into_iter().filter_map(Result::err));
        wrong.extend(self.lengths_without_thickness());
        wrong.extend(self.ratios_without_modulus());
        wrong.extend(self.force_without_thickness());
        // A refused step still has its default value, so do not compare it with the other steps.
        if self.refused.is_empty() {
            wrong.extend(self.check_steps(file).err());
        }
        wrong.extend(self.name.is_none().then(|| missing_name(file)));
        wrong
    }

    /// Returns an error for every variable that the definition also fixes.
    ///
    /// A value of its parameter, or of an alternative parameter, fixes a variable.
    fn fixed_variables(&self) -> impl Iterator<Item = InvalidDefinition> {
        let variables = self.variables.iter().enumerate();
        variables.filter_map(|(k, (variable, location))| {
            let parameter = variable.parameter();
            let others = parameter.others_in(&self.case).filter(|other| !self.leaves_open(other));
            let mut all = std::iter::once(parameter).chain(others);
            let (fixed, (other, there)) = all.find_map(|fixed| {
                let is_axis = self.axes.iter().any(|axis| axis.axis.parameter() == fixed);
                let section = if is_axis { "designs" } else { fixed.section };
                let given = self.location(fixed.key);
                let given = given.map(|there| (format!("{section}.{}", fixed.key), there));
                // If two variables define the same quantity, only the later one is refused.
                let mut earlier = self.variables[..k].iter();
                let earlier = earlier.find(|(variable, _)| variable.parameter() == fixed);
                let key = format!("{}.{}", suggestion::VARIABLES, fixed.key);
                Some((fixed, given.or_else(|| Some((key, &earlier?.1)))?))
            })?;
            let key = format!("{}.{}", suggestion::VARIABLES, parameter.key);
            Some(refuse(location, &key, conflict(parameter, fixed, other, there)))
        })
    }

    /// Returns an error for every deviation that requires a missing key.
    ///
    /// For example, a deviation in mm requires the thickness.
    fn deviations_without_unit(&self) -> impl Iterator<Item = InvalidDefinition> {
        self.deviations.iter().filter_map(|(deviation, location)| {
            let needed = deviation.needs().find(|needed| !self.gives(needed))?;
            let problem = Problem::Needs(Parameter::named(needed)?.path());
            let key = format!("{}.{}", suggestion::TOLERANCE, deviation.key());
            Some(refuse(location, &key, problem))
        })
    }

    /// Returns an error for every axis that is also set in its section.
    fn contradictions(&self) -> impl Iterator<Item = InvalidDefinition> {
        self.axes.iter().filter_map(|written| {
            let parameter = written.axis.parameter();
            let (_, location) =
                self.shared.iter().find(|(shared, _)| shared.key == parameter.key)?;
            let value = parameter.get(&self.case).to_toml();
            let other = format!("designs.{}", parameter.key);
            let problem =
                Problem::Contradiction { value, other, location: written.location.clone() };
            Some(refuse(location, &parameter.path(), problem))
        })
    }

    /// Refuses two alternative parameters that are both given.
    ///
    /// Examples are the number of gaps and the length of the strip, and the friction and the
    /// critical tilt of a free needle.
    fn check_alternatives(&self) -> Result<(), InvalidDefinition> {
        for (parameter, location) in &self.shared {
            let gives = !matches!(parameter.get(&self.case), Scalar::Word(_));
            self.check_alternative(parameter, location, gives)?;
        }
        for written in &self.axes {
            self.check_alternative(written.axis.parameter(), &written.location, true)?;
        }
        Ok(())
    }

    /// Checks the friction of the needle.
    ///
    /// A guided needle needs one path per friction, so it accepts no list of frictions. The
    /// critical tilt of a free needle is the arctangent of its friction, so a friction of 0 is
    /// refused.
    fn check_needle(&self) -> Result<(), InvalidDefinition> {
        let Some((frictions, path, location)) = self.values(key::NEEDLE_FRICTION) else {
            return Ok(());
        };
        let needles = self.values(key::NEEDLE).map(|(needles, ..)| needles);
        let needles = needles.unwrap_or_else(|| vec![Scalar::Word("free")]);
        let [may_be_free, may_be_guided] =
            ["free", "guided"].map(|needle| needles.contains(&Scalar::Word(needle)));
        let refused = frictions.into_iter().find_map(|friction| {
            // Lists are ascending, so the first value is the smallest.
            let (is_list, least) = match friction {
                Scalar::List(all) => (true, all.as_slice().first().copied()),
                single => (false, single.number()),
            };
            let expected = if is_list && may_be_guided {
                "a number: a guided needle has a path for each friction, as an axis in [designs]"
            } else if may_be_free && least.is_some_and(|friction| friction < 1e-10) {
                "a number of at least 1e-10: its arctangent is the critical tilt of a free needle"
            } else {
                return None;
            };
            Some((friction, expected))
        });
        let Some((friction, expected)) = refused else { return Ok(()) };
        let wrong = WrongValue::not_accepted(friction.to_toml(), expected);
        Err(refuse(location, &path, wrong))
    }

    /// Returns the values of a parameter, its dotted key and its position in the definition.
    ///
    /// The values of a variable with bounds are the two bounds. `None` if the definition does not
    /// give the parameter.
    fn values(&self, key: &str) -> Option<(Vec<Scalar>, String, &Location)> {
        let (path, parameter, location) = self.written().find(|(_, p, _)| p.key == key)?;
        let axis = self.axes.iter().find(|written| written.axis.parameter() == parameter);
        let variable = self.variables.iter().find(|(v, _)| v.parameter() == parameter);
        let values = match (axis, variable.map(|(variable, _)| variable.values())) {
            (Some(WrittenAxis { axis, .. }), _) => (0..axis.len()).map(|k| axis.value(k)).collect(),
            (None, Some(VariableValues::OneOf(values))) => values.clone(),
            (None, Some(VariableValues::Between(from, to))) => {
                vec![Scalar::Number(*from), Scalar::Number(*to)]
            }
            (None, None) => vec![parameter.get(&self.case)],
        };
        Some((values, path, location))
    }

    /// Refuses a needle radius without a guided needle.
    fn check_radius(&self) -> Result<(), InvalidDefinition> {
        let radius = self.written().find(|(_, parameter, _)| {
            parameter.is_or_determines(key::NEEDLE_RADIUS) && !self.leaves_open(parameter)
        });
        let Some((key, _, location)) = radius else { return Ok(()) };
        // If the needle is an axis, some designs have a free needle, which cannot have a radius.
        let varies = self.axes.iter().any(|written| written.axis.parameter().key == key::NEEDLE);
        if self.case.puncture.needle.is_guided() && !varies {
            return Ok(());
        }
        let needed = r#"puncture.needle = "guided""#.to_owned();
        Err(refuse(location, &key, Problem::Needs(needed)))
    }

    /// Returns true if `kind` is true for any value that the definition gives to a parameter.
    fn may_be(&self, key: &str, kind: fn(&Scalar) -> bool) -> bool {
        self.values(key).is_some_and(|(values, ..)| values.iter().any(kind))
    }

    /// Refuses elastic scales with friction or a guided needle, which their model does not cover.
    fn check_bending(&self) -> Result<(), InvalidDefinition> {
        let Some((bending, path, location)) = self.values(key::BENDING) else { return Ok(()) };
        if !bending.contains(&Scalar::Word("elastic")) {
            return Ok(());
        }
        let needed = if self.may_be(key::NEEDLE, |needle| *needle == Scalar::Word("guided")) {
            r#"puncture.needle = "free""#
        } else if self.may_be(key::FRICTION, |friction| friction.number() != Some(0.0)) {
            "contact.friction = 0"
        } else {
            return Ok(());
        };
        Err(refuse(location, &path, Problem::Needs(needed.to_owned())))
    }

    /// Returns an error for every length in mm without a scale thickness.
    fn lengths_without_thickness(&self) -> impl Iterator<Item = InvalidDefinition> {
        let unknown = !self.gives(key::THICKNESS);
        let in_mm = self.written().filter(move |(_, parameter, _)| unknown && parameter.is_in_mm());
        in_mm.map(|(key, _, location)| {
            let other = format!("material.{}", key::THICKNESS);
            refuse(location, &key, Problem::Needs(other))
        })
    }

    /// Returns an error for every numerator of a ratio without the modulus in its denominator.
    ///
    /// Numerators are the modulus of the scales, strengths and the force; denominators are the
    /// moduli of substrate and membrane. Only ratios that the requested measures use are checked.
    fn ratios_without_modulus(&self) -> impl Iterator<Item = InvalidDefinition> {
        let measures = self.measures.as_deref().unwrap_or(&Measure::USUAL);
        self.written().filter_map(move |(key, parameter, location)| {
            let mut needed = parameter.ratios().filter(|(ratio, _)| {
                measures.iter().any(|measure| measure.sections().contains(&ratio.section))
            });
            let (_, below) = needed.find(|(_, below)| !self.gives(below))?;
            Some(refuse(location, &key, Problem::Needs(format!("material.{below}"))))
        })
    }

    /// Returns an error for a needle force in N without a thickness.
    fn force_without_thickness(&self) -> Option<InvalidDefinition> {
        let mut written = self.written().filter(|_| !self.gives(key::THICKNESS));
        let (key, _, location) = written.find(|(_, p, _)| p.key == key::NEEDLE_FORCE_N)?;
        Some(refuse(location, &key, Problem::Needs(format!("material.{}", key::THICKNESS))))
    }

    /// Refuses a parameter if an alternative also has a value.
    ///
    /// `gives` is false if the value of the parameter is a word, which selects the alternative.
    fn check_alternative(
        &self,
        parameter: &Parameter,
        location: &Location,
        gives: bool,
    ) -> Result<(), InvalidDefinition> {
        let mut others = parameter.others_in(&self.case).filter(|p| gives && !self.leaves_open(p));
        let Some((other, there)) =
            others.find_map(|other| Some((other, self.location(other.key)?)))
        else {
            return Ok(());
        };
        let problem = conflict(parameter, other, other.path(), there);
        Err(refuse(location, &parameter.path(), problem))
    }

    /// Returns true if no design gives the parameter a number: its value is a word, or missing.
    fn leaves_open(&self, parameter: &Parameter) -> bool {
        let is_axis = self.axes.iter().any(|written| written.axis.parameter() == parameter);
        !is_axis && matches!(parameter.get(&self.case), Scalar::Word(_))
    }

    /// Refuses a smallest step above the first or the largest step of any design.
    fn check_steps(&self, file: &Location) -> Result<(), InvalidDefinition> {
        let (_, smallest) = self.span("min_step");
        for other in ["first_step", "max_step"] {
            let (limit, _) = self.span(other);
            if smallest > limit {
                let other_key = format!("solver.{other} = {}", number::text(limit));
                let problem =
                    Problem::StepOrder { value: number::text(smallest), other: other_key };
                // At least one of the two keys is in the definition, because the defaults are in
                // order.
                let location =
                    self.location("min_step").or_else(|| self.location(other)).unwrap_or(file);
                return Err(refuse(location, "solver.min_step", problem));
            }
        }
        Ok(())
    }

    /// Returns the smallest and the largest value of a numeric parameter over all designs.
    fn span(&self, key: &str) -> (f64, f64) {
        let axis = self.axes.iter().find(|written| written.axis.parameter().key == key);
        let shared =
            || Parameter::named(key).and_then(|parameter| parameter.get(&self.case).number());
        axis.map_or_else(
            // Comparisons with `NaN` are false, so the caller does not refuse a missing number.
            || shared().map_or((f64::NAN, f64::NAN), |number| (number, number)),
            |written| written.axis.span(),
        )
    }

    /// Returns the parameters that the definition gives, with their dotted keys and positions.
    fn written(&self) -> impl Iterator<Item = (String, &'static Parameter, &Location)> {
        let shared = self.shared.iter().map(|(p, location)| (p.path(), *p, location));
        let axes = self.axes.iter().map(|WrittenAxis { axis, location }| {
            (format!("designs.{}", axis.parameter().key), axis.parameter(), location)
        });
        let variables = self.variables.iter().map(|(variable, location)| {
            let parameter = variable.parameter();
            (format!("{}.{}", suggestion::VARIABLES, parameter.key), parameter, location)
        });
        shared.chain(axes).chain(variables)
    }

    /// Returns true if the definition gives a parameter, directly or in mm.
    fn gives(&self, key: &str) -> bool {
        self.written().any(|(_, parameter, _)| parameter.is_or_determines(key))
    }

    /// Returns the position in the definition of the axis or the value of a parameter.
    ///
    /// `None` if the parameter is neither an axis nor set in its section.
    fn location(&self, key: &str) -> Option<&Location> {
        let axes = self.axes.iter().map(|written| (written.axis.parameter(), &written.location));
        let shared = self.shared.iter().map(|(parameter, location)| (*parameter, location));
        axes.chain(shared).find(|(parameter, _)| parameter.key == key).map(|(_, location)| location)
    }
}

/// Creates the error of two parameters that exclude each other.
///
/// `other` is the key of the parameter `two`, and `there` its position in the definition.
fn conflict(one: &Parameter, two: &Parameter, other: String, there: &Location) -> Problem {
    let location = there.clone();
    if one == two || [one, two].iter().all(|parameter| parameter.key != key::PITCH) {
        Problem::Alternative { other, location }
    } else {
        Problem::Pitch { other, location }
    }
}

fn unknown(section: &str, entry: &KeyValue) -> InvalidDefinition {
    let dot = if section.is_empty() { "" } else { "." };
    let key = format!("{section}{dot}{}", entry.key);
    let hint = suggestion::for_key(section, &entry.key);
    refuse(&entry.location, &key, Problem::Unknown { value: entry.value.to_string(), hint })
}

/// Returns the entries of a section.
fn table(section: &KeyValue) -> Result<&KeyValues, InvalidDefinition> {
    match &section.value {
        Value::Table(entries) => Ok(entries),
        other => {
            let expected = format!("a section, e.g. [{}]", section.key);
            Err(refuse(&section.location, &section.key, WrongValue::not_accepted(other, expected)))
        }
    }
}

fn missing_name(file: &Location) -> InvalidDefinition {
    let expected = "the name of the sweep, e.g. name = \"paper\"";
    refuse(file, "name", Problem::Missing(expected))
}

/// Returns true if Windows reserves the name for a device, also with an extension.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_lowercase();
    let number = stem.strip_prefix("com").or_else(|| stem.strip_prefix("lpt"));
    // Windows treats these three superscripts as digits.
    ["con", "prn", "aux", "nul"].contains(&stem.as_str())
        || number.is_some_and(|n| n.chars().count() == 1 && "123456789¹²³".contains(n))
}

/// Returns the text in `value` if it is a valid folder name on any operating system.
fn name_of(value: &Value) -> Result<String, WrongValue> {
    match value {
        Value::Text(name)
            if name.chars().next().is_some_and(char::is_alphanumeric)
                && name.chars().all(|c| c.is_alphanumeric() || "-_.+ ".contains(c))
                && !name.ends_with([' ', '.'])
                && name.len() <= 100
                && !is_device(name) =>
        {
            Ok(name.clone())
        }
        value => Err(WrongValue::not_accepted(
            value,
            "a name for a folder on any system: letters, digits, - _ + . and spaces, a letter or digit first, and not a device name of Windows such as con or lpt1",
        )),
    }
}
