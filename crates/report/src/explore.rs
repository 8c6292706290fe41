//! The page that solves: sliders, the skin under the hand, and the solver itself, in one HTML file.

use serde::Serialize;
use sweep::{Axis, Parameter, Sweep, Variable, visible};

use crate::page::{escaped, filled};

const PAGE: &str = include_str!("../assets/explore/explore.html");
const STYLES: [&str; 2] = [
    include_str!("../assets/page/styles/theme.css"),
    include_str!("../assets/explore/explore.css"),
];
const SCRIPTS: [&str; 4] = [
    include_str!("../assets/page/scripts/elements.js"),
    include_str!("../assets/explore/solver.js"),
    include_str!("../assets/explore/scene.js"),
    include_str!("../assets/explore/explorer.js"),
];
/// The thread in which the page solves.
const WORKER: &str = include_str!("../assets/explore/worker.js");
/// The crate `live` as WebAssembly, compressed, in base 64: `scripts/live` makes it.
const MODULE: &str = include_str!("../assets/explore/live.wasm.gz.base64");

/// The content of a page that solves.
#[derive(Clone, Debug)]
pub struct Explorer<'a> {
    /// The definition, of which the page takes all that it does not move.
    pub sweep: &'a Sweep,
    /// The text of the definition.
    pub definition: String,
    /// The file of the definition, as commands name it.
    pub file: String,
    /// What a design must keep, as `coverage >= 0.5`.
    pub requirements: Vec<String>,
    /// The version of the program.
    pub version: String,
}

/// A parameter under the hand.
#[derive(Clone, Debug, Serialize)]
struct Control {
    key: &'static str,
    section: &'static str,
    label: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
    /// What one press of a key moves.
    step: f64,
    value: f64,
}

/// Parameters that a hand may move, with the range where the definition gives none, and whether the page has them in any case.
const CONTROLS: [(&str, &str, [f64; 2], bool); 6] = [
    ("gap_over_t", "Gap", [0.02, 1.0], true),
    ("length_over_t", "Length", [0.05, 2.0], true),
    ("slant_deg", "Slant", [0.0, 80.0], true),
    ("width_over_t", "Width", [0.25, 4.0], true),
    ("membrane_thickness_over_t", "Membrane", [0.02, 0.5], true),
    ("thickness_mm", "Thickness", [0.1, 10.0], false),
];

/// The measures that are shown, with the column in physical units that takes their place where there is one.
const SHOWN: [(&str, &str, &str); 6] = [
    ("coverage", "Coverage", ""),
    ("critical_force", "Critical force", "critical_force_N"),
    ("penetration", "Penetration", "penetration_mm"),
    ("sound_force", "Force before folding", "sound_force_N"),
    ("compliance", "Compliance", ""),
    ("first_contact_curvature", "Bends freely to", "bend_radius_mm"),
];

#[derive(Serialize)]
struct Shown {
    name: &'static str,
    label: &'static str,
    physical: &'static str,
}

/// What the scripts read.
#[derive(Serialize)]
struct Data<'a> {
    name: String,
    definition: &'a str,
    file: &'a str,
    base: String,
    controls: Vec<Control>,
    measures: Vec<Shown>,
    /// Measures of which less is better.
    small: [&'static str; 1],
    requirements: &'a [String],
}

impl Explorer<'_> {
    /// Returns the page as HTML that needs no other file.
    pub fn html(&self) -> String {
        let base = Parameter::named("base").map(|base| base.get(self.sweep.grid().base()).to_string());
        let shown = |&(name, label, physical): &(_, _, _)| Shown { name, label, physical };
        let data = Data {
            name: visible(self.sweep.name()).into_owned(),
            definition: &self.definition,
            file: &self.file,
            base: base.unwrap_or_default(),
            controls: CONTROLS.iter().filter_map(|control| self.control(control)).collect(),
            measures: SHOWN.iter().map(shown).collect(),
            small: ["penetration"],
            requirements: &self.requirements,
        };
        // Neither `</script` nor `<!--` may end or bend the script that holds the data.
        let data = serde_json::to_string(&data).unwrap_or_default().replace('<', "\\u003c");
        let scripts = SCRIPTS.map(|script| format!("<script>\n{script}</script>"));
        let parts = [
            ("{{title}}", escaped(&visible(self.sweep.name()))),
            ("{{version}}", escaped(&self.version)),
            ("{{style}}", STYLES.concat()),
            ("{{module}}", MODULE.trim().to_owned()),
            ("{{worker}}", WORKER.to_owned()),
            ("{{data}}", data),
            ("{{scripts}}", scripts.join("\n")),
        ];
        filled(PAGE, &parts)
    }

    /// The control of a parameter: over the values of its axis or variable where there are several, over a range of its own elsewhere.
    fn control(
        &self,
        &(key, label, range, always): &(&'static str, &'static str, [f64; 2], bool),
    ) -> Option<Control> {
        let parameter = Parameter::named(key)?;
        let value = parameter.get(self.sweep.grid().base()).number();
        let axis = self.sweep.grid().axis(key).and_then(span);
        let variable = self.sweep.variables().iter().find_map(|variable| interval(variable, key));
        if !always && value.is_none() && axis.is_none() && variable.is_none() {
            return None;
        }
        let [min, max] = axis.or(variable).unwrap_or(range);
        let value = value.filter(|value| (min..=max).contains(value));
        let is_free = axis.is_some() || variable.is_some();
        let value = value.filter(|_| !is_free).unwrap_or(0.5 * (min + max));
        let (min, max) = (min.min(value), max.max(value));
        let step = (max - min) / 100.0;
        let section = parameter.section;
        Some(Control { key, section, label, unit: parameter.unit, min, max, step, value })
    }
}

/// The ends of an axis of several numbers.
fn span(axis: &Axis) -> Option<[f64; 2]> {
    let values = (0..axis.len()).filter_map(|k| axis.value(k).number());
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    (ends[0] < ends[1]).then_some(ends)
}

/// The ends of a variable, if it is the one of `key` and its values are numbers.
fn interval(variable: &Variable, key: &str) -> Option<[f64; 2]> {
    let is_this = variable.parameter().key == key;
    let ends = [0.0, 1.0].map(|share| variable.at(share).number());
    if let (true, [Some(low), Some(high)]) = (is_this, ends) { Some([low, high]) } else { None }
}
