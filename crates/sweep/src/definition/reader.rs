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

/// A reader of definitions, with the keys that it has understood so far.
#[derive(Debug, Default)]
pub(crate) struct Reader {
    name: Option<String>,
    measures: Option<Vec<Measure>>,
    case: Case,
    shared: Vec<(&'static Parameter, Place)>,
    axes: Vec<WrittenAxis>,
}

/// An axis, and where it stands.
#[derive(Debug)]
struct WrittenAxis {
    axis: Axis,
    place: Place,
}

impl Reader {
    /// Understands one key outside of the sections, or one section.
    pub fn entry(&mut self, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let wrong = |problem| refuse(&entry.place, &entry.key, Problem::Value(problem));
        match entry.key.as_str() {
            "name" => self.name = Some(read_name(&entry.value).map_err(wrong)?),
            "measures" => {
                let measures = Measure::read_list(&entry.value);
                self.measures = Some(measures.map_err(|p| refuse(&entry.place, &entry.key, p))?);
            }
            section if suggestion::is_section(section) => return self.section(section, entry),
            _ => return Err(unknown("", entry)),
        }
        Ok(())
    }

    fn section(&mut self, section: &str, entry: &KeyValue) -> Result<(), InvalidDefinition> {
        let Value::Table(entries) = &entry.value else {
            let found = entry.value.to_string();
            let expected = format!("a section, e.g. [{section}]");
            return Err(refuse(&entry.place, section, WrongValue::NotAccepted { found, expected }));
        };
        for entry in entries {
            self.parameter(section, entry)?;
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

    /// The sweep, once every key of `file` is understood.
    pub fn finish(self, file: &Place) -> Result<Sweep, InvalidDefinition> {
        self.check_contradictions()?;
        self.check_alternatives()?;
        self.check_steps(file)?;
        let expected = "the name of the sweep, e.g. name = \"paper\"";
        let missing = || refuse(file, "name", Problem::Missing { expected });
        let name = self.name.ok_or_else(missing)?;
        let measures = self.measures.unwrap_or_else(|| Measure::USUAL.to_vec());
        let axes = axes::ordered(self.axes.into_iter().map(|written| written.axis).collect());
        let grid = Grid::new(axes, self.case).map_err(|error| refuse(file, "designs", error))?;
        Ok(Sweep { name, measures, grid })
    }

    /// Refuses what is set in its section and is an axis too.
    fn check_contradictions(&self) -> Result<(), InvalidDefinition> {
        for written in &self.axes {
            let parameter = written.axis.parameter();
            if let Some((_, place)) =
                self.shared.iter().find(|(shared, _)| shared.key == parameter.key)
            {
                let value = parameter.get(&self.case).to_toml();
                let other = format!("designs.{}", parameter.key);
                let problem = Problem::Contradiction { value, other, place: written.place.clone() };
                return Err(refuse(place, &parameter.path(), problem));
            }
        }
        Ok(())
    }

    /// Refuses a number of gaps besides the length of the strip.
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

/// A name that is a folder on any system.
fn read_name(value: &Value) -> Result<String, WrongValue> {
    let allowed = |c: char| c.is_alphanumeric() || "-_.+ ".contains(c);
    match value {
        Value::Text(name)
            if name.chars().next().is_some_and(char::is_alphanumeric)
                && name.chars().all(allowed)
                && !name.ends_with([' ', '.'])
                && name.len() <= 100 =>
        {
            Ok(name.clone())
        }
        value => Err(WrongValue::NotAccepted {
            found: value.to_string(),
            expected:
                "a name for a folder: letters, digits, - _ + . and spaces, a letter or digit first"
                    .to_owned(),
        }),
    }
}
