//! Writes a sweep as a complete definition, with the defaults of omitted keys.

use std::fmt::Write as _;

use super::measure::Measure;
use super::suggestion::{DESIGNS, TOLERANCE, VARIABLES, sections};
use crate::definition::Sweep;
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
        let variables = self.variables.iter().map(|v| (v.parameter().key.to_owned(), v.to_toml()));
        let deviations = self.deviations.iter().map(|d| (d.key(), d.to_toml()));
        let others = [(VARIABLES, entry_lines(variables)), (TOLERANCE, entry_lines(deviations))];
        let all = sections().into_iter().map(|section| (section, self.lines(section)));
        all.chain(others).filter(|(_, lines)| !lines.is_empty()).collect()
    }

    /// Returns the lines of the axes in `designs`, or of the shared values in another section.
    fn lines(&self, section: &str) -> String {
        if section != DESIGNS {
            let shared = self.shared().filter(|(parameter, _)| parameter.section == section);
            return entry_lines(shared.map(|(p, value)| (p.key.to_owned(), value.to_toml())));
        }
        // The grid has an axis for each variable, with the middle of its range as the only value.
        // The definition does not contain these axes.
        let fixed = self
            .grid()
            .axes()
            .iter()
            .filter(|axis| self.variables.iter().all(|v| v.parameter() != axis.parameter()));
        entry_lines(fixed.map(|axis| (axis.parameter().key.to_owned(), axis.to_toml())))
    }
}

fn entry_lines(entries: impl Iterator<Item = (String, String)>) -> String {
    let lines: Vec<_> = entries.map(|(key, value)| format!("{key} = {value}\n")).collect();
    lines.concat()
}
