//! From keys and values to a sweep.

use super::axes;
use super::invalid::{InvalidDefinition, Problem, refuse};
use super::measure::Measure;
use super::suggestion;
use crate::case::Case;
use crate::definition::Sweep;
use crate::grid::{Axis, Grid};
use crate::number;
use crate::parameter::{Parameter, Scalar, WrongValue};
use crate::toml_source::{KeyValue, Place, Value};

/// Keys that are refused before the rest is left unread: nobody corrects more at a time.
const MOST: usize = 50;

/// A reader of definitions, with the keys that it has understood so far, and what it has refused.
#[derive(Debug, Default)]
pub(crate) struct Reader {
    name: Option<String>,
    measures: Option<Vec<Measure>>,
    case: Case,
    shared: Vec<(&'static Parameter, Place)>,
    axes: Vec<WrittenAxis>,
    refused: Vec<InvalidDefinition>,
}

/// An axis, and where it stands.
#[derive(Debug)]
struct WrittenAxis {
    axis: Axis,
    place: Place,
}

impl Reader {
    /// Understands one key outside of the sections, or one section.
    pub fn entry(&mut self, entry: &KeyValue) {
        if self.refused.len() >= MOST {
            return;
        }
        let understood = match entry.key.as_str() {
            "name" => self.read_name(entry),
            "measures" => self.read_measures(entry),
            section if suggestion::is_section(section) => self.section(section, entry),
            _ => Err(unknown("", entry)),
        };
        self.refused.extend(understood.err());
    }

    fn read_name(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        // A name that is refused is not missing as well.
        let name = self.name.insert(String::new());
        *name = name_of(&entry.value)
            .map_err(|problem| refuse(&entry.place, &entry.key, Problem::Value(problem)))?;
        Ok(())
    }

    fn read_measures(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let measures = Measure::read_list(&entry.value);
        self.measures = Some(measures.map_err(|p| refuse(&entry.place, &entry.key, p))?);
        Ok(())
    }

    fn section(&mut self, section: &str, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let Value::Table(entries) = &entry.value else {
            let found = entry.value.to_string();
            let expected = format!("a section, e.g. [{section}]");
            return Err(refuse(&entry.place, section, WrongValue::NotAccepted { found, expected }));
        };
        for entry in entries {
            if self.refused.len() >= MOST {
                break;
            }
            let understood = self.parameter(section, entry);
            self.refused.extend(understood.err());
        }
        Ok(())
    }

    fn parameter(&mut self, section: &str, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let key = format!("{section}.{}", entry.key);
        let belongs = |p: &&Parameter| section == "designs" || section == p.section;
        let Some(parameter) = Parameter::named(&entry.key).filter(belongs) else {
            return Err(unknown(section, entry));
        };
        let wrong = |problem| refuse(&entry.place, &key, problem);
        if section == "designs" {
            let axis = axes::read(parameter, &entry.value).map_err(wrong)?;
            self.axes.push(WrittenAxis { axis, place: entry.place.clone() });
        } else {
            let value = parameter.read(&entry.value).map_err(|problem| wrong(problem.into()))?;
            parameter.set(&mut self.case, value);
            self.shared.push((parameter, entry.place.clone()));
        }
        Ok(())
    }

    /// The sweep, once every key of `file` is understood; or everything that is wrong with it.
    pub fn finish(mut self, file: &Place) -> Result<Sweep, InvalidDefinition> {
        let contradictions: Vec<_> = self.contradictions().collect();
        // A default in the place of a refused step says nothing about the others.
        let steps = if self.refused.is_empty() { self.check_steps(file) } else { Ok(()) };
        self.refused.extend(contradictions);
        self.refused.extend(self.check_alternatives().err());
        self.refused.extend(steps.err());
        self.refused.extend(self.name.is_none().then(|| missing_name(file)));
        InvalidDefinition::of(self.refused)?;
        let measures = self.measures.unwrap_or_else(|| Measure::USUAL.to_vec());
        let axes = axes::ordered(self.axes.into_iter().map(|written| written.axis).collect());
        let grid = Grid::new(axes, self.case).map_err(|error| refuse(file, "designs", error))?;
        Ok(Sweep { name: self.name.unwrap_or_default(), measures, grid })
    }

    /// Every parameter that is set in its section and is an axis too.
    fn contradictions(&self) -> impl Iterator<Item = InvalidDefinition> {
        self.axes.iter().filter_map(|written| {
            let parameter = written.axis.parameter();
            let (_, place) = self.shared.iter().find(|(shared, _)| shared.key == parameter.key)?;
            let value = parameter.get(&self.case).to_toml();
            let other = format!("designs.{}", parameter.key);
            let problem = Problem::Contradiction { value, other, place: written.place.clone() };
            Some(refuse(place, &parameter.path(), problem))
        })
    }

    /// Refuses a number of gaps besides the length of the strip, or a friction besides the critical tilt.
    fn check_alternatives(&self) -> Result<(), InvalidDefinition> {
        for (parameter, place) in &self.shared {
            let gives = !matches!(parameter.get(&self.case), Scalar::Word(_));
            self.check_alternative(parameter, place, gives)?;
        }
        for written in &self.axes {
            self.check_alternative(written.axis.parameter(), &written.place, true)?;
        }
        Ok(())
    }

    /// Refuses a parameter that `gives` a value if its alternative does too.
    fn check_alternative(
        &self,
        parameter: &Parameter,
        place: &Place,
        gives: bool,
    ) -> Result<(), InvalidDefinition> {
        let other = parameter.alternative().filter(|other| gives && !self.leaves_open(other));
        let Some((other, there)) = other.and_then(|other| Some((other, self.place(other.key)?)))
        else {
            return Ok(());
        };
        let problem = Problem::Alternative { other: other.path(), place: there.clone() };
        Err(refuse(place, &parameter.path(), problem))
    }

    /// Whether every design has the word `auto` for a parameter.
    fn leaves_open(&self, parameter: &Parameter) -> bool {
        let is_axis = self.axes.iter().any(|written| written.axis.parameter() == parameter);
        !is_axis && matches!(parameter.get(&self.case), Scalar::Word(_))
    }

    /// Refuses a smallest step above the first or the largest one, for any design of the grid.
    fn check_steps(&self, file: &Place) -> Result<(), InvalidDefinition> {
        let (_, smallest) = self.span("min_step");
        for other in ["first_step", "max_step"] {
            let (limit, _) = self.span(other);
            if smallest > limit {
                let other_key = format!("solver.{other} = {}", number::text(limit));
                let problem =
                    Problem::StepOrder { value: number::text(smallest), other: other_key };
                // One of the two is written, because the defaults are in order.
                let place = self.place("min_step").or_else(|| self.place(other)).unwrap_or(file);
                return Err(refuse(place, "solver.min_step", problem));
            }
        }
        Ok(())
    }

    /// The smallest and the largest value of a number.
    fn span(&self, key: &str) -> (f64, f64) {
        let axis = self.axes.iter().find(|written| written.axis.parameter().key == key);
        let shared =
            || Parameter::named(key).and_then(|parameter| parameter.get(&self.case).number());
        axis.map_or_else(
            || shared().map_or((f64::NAN, f64::NAN), |number| (number, number)),
            |written| written.axis.span(),
        )
    }

    /// The place at which a parameter is written.
    fn place(&self, key: &str) -> Option<&Place> {
        let axes = self.axes.iter().map(|written| (written.axis.parameter(), &written.place));
        let shared = self.shared.iter().map(|(parameter, place)| (*parameter, place));
        axes.chain(shared).find(|(parameter, _)| parameter.key == key).map(|(_, place)| place)
    }
}

fn unknown(section: &str, entry: &KeyValue) -> InvalidDefinition {
    let dot = if section.is_empty() { "" } else { "." };
    let key = format!("{section}{dot}{}", entry.key);
    let hint = suggestion::for_key(section, &entry.key);
    refuse(&entry.place, &key, Problem::Unknown { value: entry.value.to_string(), hint })
}

fn missing_name(file: &Place) -> InvalidDefinition {
    let expected = "the name of the sweep, e.g. name = \"paper\"";
    refuse(file, "name", Problem::Missing { expected })
}

/// Whether Windows keeps the name for a device, whatever follows its first dot.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_lowercase();
    let numbered = |device| {
        let number = stem.strip_prefix(device).and_then(|rest: &str| {
            let mut digits = rest.chars();
            digits.next().filter(|_| digits.next().is_none())
        });
        number.is_some_and(|digit| "123456789¹²³".contains(digit))
    };
    ["con", "prn", "aux", "nul"].contains(&stem.as_str()) || numbered("com") || numbered("lpt")
}

/// A name that is a folder on any system.
fn name_of(value: &Value) -> Result<String, WrongValue> {
    let allowed = |c: char| c.is_alphanumeric() || "-_.+ ".contains(c);
    match value {
        Value::Text(name)
            if name.chars().next().is_some_and(char::is_alphanumeric)
                && name.chars().all(allowed)
                && !name.ends_with([' ', '.'])
                && name.len() <= 100
                && !is_device(name) =>
        {
            Ok(name.clone())
        }
        value => Err(WrongValue::NotAccepted {
            found: value.to_string(),
            expected:
                "a name for a folder on any system: letters, digits, - _ + . and spaces, a letter or digit first, and no device as con or lpt1"
                    .to_owned(),
        }),
    }
}
