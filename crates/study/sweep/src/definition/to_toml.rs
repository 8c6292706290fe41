//! Writes a sweep as a complete definition, with the defaults of omitted keys.

use std::fmt::Write as _;

use super::measure::Measure;
use super::suggestion::{TOLERANCE, VARIABLES, sections};
use crate::definition::Sweep;
use crate::grid::Axis;
use text::toml_source::quoted;

impl Sweep {
    /// Returns the complete definition in TOML, which reads back as the same sweep.
    pub fn to_toml(&self) -> String {
        let mut text = self.top();
        for (section, lines) in self.sections() {
            // Writing to a string cannot fail.
            let _ = write!(text, "\n[{section}]\n{lines}");
        }
        text
    }

    /// Returns the complete definition inside a table `parent`.
    pub fn to_toml_under(&self, parent: &str) -> String {
        let mut text = format!("[{parent}]\n{}", self.top());
        for (section, lines) in self.sections() {
            let _ = write!(text, "\n[{parent}.{section}]\n{lines}");
        }
        text
    }

    fn top(&self) -> String {
        let measures: Vec<_> =
            self.measures().iter().map(|measure| quoted(Measure::key(*measure))).collect();
        format!("name = {}\nmeasures = [{}]\n", quoted(self.name()), measures.join(", "))
    }

    /// Returns the lines of every section that is not empty.
    fn sections(&self) -> Vec<(&'static str, String)> {
        let lines = |section: &&'static str| {
            let lines = match *section {
                "designs" => self.fixed_axes().map(axis_line).collect(),
                section => self.shared_lines(section),
            };
            (*section, lines)
        };
        let variables = self.variables.iter().map(|v| (v.parameter().key.to_owned(), v.to_toml()));
        let deviations = self.deviations.iter().map(|d| (d.key(), d.to_toml()));
        let others =
            [(VARIABLES, entry_lines(variables)), (TOLERANCE, entry_lines(deviations))].into_iter();
        let all = sections().into_iter().map(|section| lines(&section)).chain(others);
        all.filter(|(_, lines): &(_, String)| !lines.is_empty()).collect()
    }

    /// Returns the axes without the axes of variables.
    fn fixed_axes(&self) -> impl Iterator<Item = &Axis> {
        // A variable adds an axis with one value, its middle, which the definition does not
        // contain.
        let is_variable =
            |axis: &Axis| self.variables.iter().any(|v| v.parameter() == axis.parameter());
        self.grid().axes().iter().filter(move |axis| !is_variable(axis))
    }

    fn shared_lines(&self, section: &str) -> String {
        let shared = self.shared().filter(|(parameter, _)| parameter.section == section);
        entry_lines(shared.map(|(parameter, value)| (parameter.key.to_owned(), value.to_toml())))
    }
}

fn axis_line(axis: &Axis) -> String {
    format!("{} = {}\n", axis.parameter().key, axis.to_toml())
}

fn entry_lines(entries: impl Iterator<Item = (String, String)>) -> String {
    let lines: Vec<_> = entries.map(|(key, value)| format!("{key} = {value}\n")).collect();
    lines.concat()
}
