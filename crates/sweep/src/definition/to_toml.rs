//! A sweep as a definition again, complete: what was left out is written with its default.

use std::fmt::Write as _;

use super::measure::Measure;
use super::suggestion::sections;
use crate::definition::Sweep;
use crate::grid::Axis;
use crate::parameter::{Parameter, Scalar};
use crate::toml_source::quoted;

impl Sweep {
    /// The complete definition in TOML, which reads back as the same sweep.
    pub fn to_toml(&self) -> String {
        let mut text = self.top();
        for (section, lines) in self.sections() {
            // Writing to a string cannot fail.
            let _ = write!(text, "\n[{section}]\n{lines}");
        }
        text
    }

    /// The complete definition within a table `parent`.
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

    /// The lines of every section that has any.
    fn sections(&self) -> Vec<(&'static str, String)> {
        let lines = |section: &&'static str| {
            let lines = match *section {
                "designs" => self.grid().axes().iter().map(axis_line).collect(),
                section => self.shared_lines(section),
            };
            (*section, lines)
        };
        sections().iter().map(lines).filter(|(_, lines): &(_, String)| !lines.is_empty()).collect()
    }

    fn shared_lines(&self, section: &str) -> String {
        let belongs = |(parameter, _): &(&Parameter, Scalar)| parameter.section == section;
        let line = |(parameter, value): (&Parameter, Scalar)| {
            format!("{} = {}\n", parameter.key, value.to_toml())
        };
        self.shared().filter(belongs).map(line).collect()
    }
}

fn axis_line(axis: &Axis) -> String {
    format!("{} = {}\n", axis.parameter().key, axis.to_toml())
}
