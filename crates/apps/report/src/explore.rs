//! The interactive page: sliders, drawings and the solver in one HTML file.

use std::io::{self, Write};

use results::columns::{mode_column, name, plain_goal};
use serde::Serialize;
use serde_json::Value;
use sweep::{Axis, Parameter, Scalar, Sweep, Variable, key};

use crate::packed::in_sevens;
use crate::page::{ELEMENTS, escaped, fill, fill_head, fill_json};

const PAGE: &str = concat!(
    include_str!("../assets/page/head.html"),
    include_str!("../assets/explore/explore.html")
);
/// The HTML section of the interactive design.
const SECTION: &str = include_str!("../assets/explore/explorer.html");
/// The style of the section on any page.
pub(crate) const STYLE: &str = include_str!("../assets/explore/explore.css");
/// The styles of a separate page.
const STYLES: [&str; 2] =
    [include_str!("../assets/page/styles/theme.css"), include_str!("../assets/explore/page.css")];
/// The scripts of the page, in the order in which they run.
pub(crate) const SCRIPTS: [&str; 7] = [
    include_str!("../assets/explore/solver.js"),
    include_str!("../assets/explore/skin.js"),
    include_str!("../assets/explore/pictures.js"),
    include_str!("../assets/explore/controls.js"),
    include_str!("../assets/explore/measures.js"),
    include_str!("../assets/explore/curves.js"),
    include_str!("../assets/explore/explorer.js"),
];
/// The script of the worker thread, which runs the solver.
const WORKER: &str = include_str!("../assets/explore/worker.js");
/// The solver as compressed WebAssembly, compiled by `scripts/wasm`.
const MODULE: &[u8] = include_bytes!("../assets/explore/solver.wasm.gz");

/// The initial state of an interactive page.
#[derive(Clone, Debug)]
pub struct Explorer {
    /// The definition of the sweep.
    pub sweep: Sweep,
    /// The definition or results folder with its settings, as on the command line.
    pub source: String,
    /// The requirements, such as `coverage >= 0.5`.
    pub requirements: Vec<String>,
    /// Warnings in the header of the page, such as checks that an optimum fails.
    pub notes: Vec<String>,
    /// The version of the program.
    pub version: String,
}

/// Removes comment lines from a script to shorten the page.
fn without_comments(script: &str) -> String {
    let is_code = |line: &&str| !["//", "/**"].iter().any(|own| line.trim_start().starts_with(own));
    script.lines().filter(is_code).flat_map(|line| [line, "\n"]).collect()
}

/// A control for a parameter.
#[derive(Clone, Debug, Serialize)]
struct Control {
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
    /// The change per key press.
    step: f64,
    /// The initial value: a number or a word.
    value: Value,
    /// The allowed words of a parameter that takes words.
    words: Option<[&'static str; 2]>,
    /// The kind of needle to which the parameter applies, if it is restricted.
    only: Option<&'static str>,
    /// True if range, step and value are curvatures, which the page shows as radii.
    is_radius: bool,
}

/// Default control of a parameter: key, label, range, initial fraction of the range, optional.
///
/// The range and initial value apply if the definition has none. An optional parameter has a
/// control only if the definition gives it.
type Offered = (&'static str, &'static str, [f64; 2], f64, bool);

/// Largest curvatures of a concave and a convex body with a control, in 1/mm and in 1/t.
const BODIES: [[f64; 2]; 2] = [[-1.0 / 40.0, 1.0 / 8.0], [-1.0 / 20.0, 1.0 / 4.0]];

/// The controls, with overlapping scales as the initial design.
const OFFERED: [Offered; 11] = [
    (key::GAP, "Gap", [0.02, 1.0], 0.1, false),
    (key::LENGTH, "Length", [0.05, 2.0], 0.5, false),
    (key::SLANT, "Slant", [0.0, 80.0], 0.7, false),
    (key::WIDTH, "Width", [0.25, 2.0], 0.5, false),
    (key::THICKNESS, "Thickness", [0.1, 10.0], 0.5, true),
    ("membrane_thickness_over_t", "Membrane", [0.02, 0.5], 0.5, false),
    (key::SUBSTRATE_MODULUS, "Tissue", [0.01, 10.0], 0.5, true),
    (key::FRICTION, "Scale friction", [0.0, 0.5], 0.0, false),
    (key::NEEDLE, "Needle", [0.0, 0.0], 0.0, false),
    (key::NEEDLE_FRICTION, "Needle friction", [0.0, 1.0], 0.2, false),
    (key::CRITICAL_TILT, "Critical tilt", [2.0, 30.0], 0.5, false),
];

/// A displayed measure.
#[derive(Serialize)]
struct Shown {
    name: &'static str,
    label: &'static str,
    /// The column in physical units that replaces it, if available.
    physical: &'static str,
    /// A short explanation.
    words: &'static str,
    /// True if the column is a curvature, which the page shows as a radius.
    is_curvature: bool,
    /// True if one direction is better, so that arrows can show how to improve it.
    has_goal: bool,
    /// The column with the failure mode of a force.
    mode: Option<&'static str>,
}

fn shown(
    name: &'static str,
    label: &'static str,
    physical: &'static str,
    words: &'static str,
) -> Shown {
    let has_goal = plain_goal(name).is_some();
    let (is_curvature, mode) = (name == name::CONTACT_CURVATURE, mode_column(name));
    Shown { name, label, physical, words, is_curvature, has_goal, mode }
}

/// Returns the displayed measures, with the failure force if it is sought.
fn measures(seeks_failure: bool) -> Vec<Shown> {
    let mut measures = vec![
        shown(name::COVERAGE, "Coverage", "", "fraction of the scale layer that is solid scale"),
        shown(
            name::CRITICAL_FORCE,
            "Critical force",
            "critical_force_N",
            "force at which a scale tilts over",
        ),
        shown(
            name::PENETRATION,
            "Penetration of bases",
            "penetration_mm",
            "how far scales sink into the tissue at the critical force",
        ),
        shown(
            name::CRITICAL_DISPLACEMENT,
            "Needle depth",
            "critical_displacement_mm",
            "how far the needle moves down up to the critical force",
        ),
        shown(name::COMPLIANCE, "Flexibility", "", "1: bends as easily as the membrane alone"),
        shown(
            name::CONTACT_CURVATURE,
            "Bends freely to",
            "bend_radius_mm",
            "radius at which scales touch",
        ),
        shown(
            name::SOUND_FORCE,
            "Valid up to",
            "sound_force_N",
            "beyond it the modelled surface folds",
        ),
    ];
    if seeks_failure {
        let words = "force at the first failure";
        measures.insert(2, shown(name::FAILURE_FORCE, "Failure force", "failure_force_N", words));
    }
    measures
}

/// The data for the scripts.
#[derive(Serialize)]
struct Data<'a> {
    definition: String,
    source: &'a str,
    base: String,
    /// Thickness of the scales, mm, if known.
    thickness: Option<f64>,
    controls: Vec<Control>,
    measures: Vec<Shown>,
    requirements: &'a [String],
}

impl Explorer {
    /// Writes a self-contained HTML page.
    ///
    /// # Errors
    /// Returns the errors of `out`.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        fill(out, PAGE, |out, place| match place {
            "style" => write!(out, "{}{STYLE}", STYLES.concat()),
            "notes" => self
                .notes
                .iter()
                .try_for_each(|note| writeln!(out, "<p class=\"doubt\">⚠ {}</p>", escaped(note))),
            "explorer" => self.write_section(out),
            "scripts" => write!(out, "{ELEMENTS}{}", without_comments(&SCRIPTS.concat())),
            _ => fill_head(out, place, self.sweep.name(), &self.version),
        })
    }

    /// Writes the interactive section of a page, with the solver.
    pub(crate) fn write_section(&self, out: &mut impl Write) -> io::Result<()> {
        let base = self.sweep.grid().base();
        let data = Data {
            definition: self.sweep.to_toml(),
            source: &self.source,
            base: Parameter::named("base")
                .map_or_else(String::new, |parameter| parameter.get(base).to_string()),
            thickness: base.material.thickness_mm,
            controls: self.controls(),
            measures: measures(self.sweep.grid().case(0).judged_modes().is_some()),
            requirements: &self.requirements,
        };
        fill(out, SECTION, |out, place| match place {
            "module" => out.write_all(in_sevens(MODULE).as_bytes()),
            "worker" => out.write_all(WORKER.as_bytes()),
            _ => fill_json(out, &data),
        })
    }

    /// Creates the controls of the page.
    fn controls(&self) -> Vec<Control> {
        let offered = OFFERED.iter().filter_map(|offered| self.control(offered));
        offered.chain(self.body_control()).collect()
    }

    /// Creates the control of the body: its curvature, because a flat body has no radius.
    ///
    /// The range contains the bodies of the definition.
    fn body_control(&self) -> Option<Control> {
        let grid = self.sweep.grid();
        let case = grid.case(0);
        let keys = [key::CURVATURE, key::RADIUS_MM, key::RADIUS];
        let axis = keys.into_iter().find_map(|key| grid.axis(key));
        let in_mm = case.material.thickness_mm.map(|_| key::RADIUS_MM);
        let key = axis.map_or(in_mm.unwrap_or(key::RADIUS), |axis| axis.parameter().key);
        let is_in_mm = key == key::RADIUS_MM;
        // A radius in mm is kept, because the division by the thickness rounds it.
        let given = Parameter::named(key)?.get(&case).number();
        let value = match (given, case.material.thickness_mm) {
            (Some(number), _) => curvature(key, number),
            (None, Some(thickness)) if is_in_mm => case.body().curvature / thickness,
            (None, _) => case.body().curvature,
        };
        let [mut min, mut max] = BODIES[usize::from(!is_in_mm)];
        let ends = axis.and_then(span).map(|ends| ends.map(|end| curvature(key, end)));
        for own in ends.into_iter().flatten().chain([value]) {
            (min, max) = (min.min(own), max.max(own));
        }
        Some(Control {
            key,
            label: "Body radius",
            unit: if is_in_mm { "mm" } else { "t" },
            min,
            max,
            step: (max - min) / 100.0,
            value: value.into(),
            words: None,
            only: None,
            is_radius: true,
        })
    }

    /// Creates the control of a parameter, over the values of its axis or variable, or a default
    /// range.
    fn control(&self, &(key, label, range, opens_at, if_given): &Offered) -> Option<Control> {
        let parameter = Parameter::named(key)?;
        let grid = self.sweep.grid();
        let own = parameter.get(&grid.case(0));
        let variables = || self.sweep.variables().iter();
        let span = grid.axis(key).and_then(span);
        let span = span.or_else(|| variables().find_map(|variable| interval(variable, key)));
        if if_given && span.is_none() && own.number().is_none() {
            return None;
        }
        // For a free needle, friction determines the critical tilt, so only one of them has a
        // control.
        let friction_is_given =
            grid.base().needle_friction.is_some() || grid.axis(key::NEEDLE_FRICTION).is_some();
        let friction_says_tilt = friction_is_given && !self.sweep.is_guided();
        let only = match key {
            key::NEEDLE_FRICTION if !friction_says_tilt => Some("guided"),
            key::CRITICAL_TILT if friction_says_tilt => Some("guided"),
            _ => None,
        };
        let [min, max] = span.unwrap_or(range);
        // The first design is a corner of the grid and seldom a good one.
        let middle = min + opens_at * (max - min);
        let number = own.number().filter(|_| span.is_none()).unwrap_or(middle);
        // The value in a definition may lie outside the default range.
        let (min, max) = (min.min(number), max.max(number));
        let (words, value) = match own {
            Scalar::Word(word) if key == key::NEEDLE => (Some(["free", "guided"]), word.into()),
            _ => (None, number.into()),
        };
        let (unit, step) = (parameter.unit, (max - min) / 100.0);
        Some(Control { key, label, unit, min, max, step, value, words, only, is_radius: false })
    }
}

/// Returns the curvature of a body with this value of the parameter `key`, a curvature or a radius.
fn curvature(key: &str, value: f64) -> f64 {
    if key == key::CURVATURE { value } else { value.recip() }
}

/// Returns the ends of an axis with several numeric values.
fn span(axis: &Axis) -> Option<[f64; 2]> {
    let values = (0..axis.len()).filter_map(|k| axis.value(k).number());
    let ends =
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    (ends[0] < ends[1]).then_some(ends)
}

/// Returns the bounds of a variable if it has this `key` and numeric bounds.
fn interval(variable: &Variable, key: &str) -> Option<[f64; 2]> {
    let ends = [0.0, 1.0].map(|share| variable.at(share).number());
    let [Some(low), Some(high)] = ends else { return None };
    (variable.parameter().key == key).then_some([low, high])
}
