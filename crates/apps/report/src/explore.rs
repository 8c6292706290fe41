//! The interactive page: sliders, drawings and the solver in one HTML file.

use std::io::{self, Write};

use results::columns::{mode_column, name, plain_goal};
use serde::Serialize;
use serde_json::Value;
use sweep::{Axis, Parameter, Scalar, Sweep, Variable, key};

use crate::packed::in_sevens;
use crate::template::{ELEMENTS, escaped, fill, fill_head, fill_json};

const PAGE: &str = concat!(
    include_str!("../assets/page/head.html"),
    include_str!("../assets/explore/explore.html")
);
/// The HTML section with the interactive design.
const SECTION: &str = include_str!("../assets/explore/explorer.html");
/// The style of this section, for any page that contains the section.
pub(crate) const STYLE: &str = include_str!("../assets/explore/explore.css");
/// Additional styles of a page that contains only this section.
const STYLES: [&str; 2] =
    [include_str!("../assets/page/styles/theme.css"), include_str!("../assets/explore/page.css")];
/// The scripts of the page, in the order in which they run.
pub(crate) const SCRIPTS: [&str; 8] = [
    include_str!("../assets/explore/solver.js"),
    include_str!("../assets/explore/skin.js"),
    include_str!("../assets/explore/pictures.js"),
    include_str!("../assets/explore/controls.js"),
    include_str!("../assets/explore/measures.js"),
    include_str!("../assets/explore/curves.js"),
    include_str!("../assets/explore/sentence.js"),
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
    /// If the design is an optimum, the variables of the search that found it.
    pub variables: Vec<Variable>,
    /// Solved designs of the sweep, at which the search for a design that meets requirements
    /// starts.
    pub solved: SolvedTable,
    /// The definition or results folder with its settings, as on the command line.
    pub source: String,
    /// The requirements, such as `coverage >= 0.5`.
    pub requirements: Vec<String>,
    /// Warnings in the header of the page, such as checks that an optimum fails.
    pub notes: Vec<String>,
    /// The version of the program.
    pub version: String,
}

/// Solved designs, as a table with a row for each design.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SolvedTable {
    /// Names of the varied parameters and of the columns with results.
    pub columns: Vec<String>,
    /// Values of each design, in the order of `columns`; `None` for a missing value.
    pub rows: Vec<Vec<Option<f64>>>,
}

/// Returns a script without its comment lines, to shorten the page.
fn without_comments(script: &str) -> String {
    script
        .lines()
        .filter(|line| !["//", "/**"].iter().any(|own| line.trim_start().starts_with(own)))
        .flat_map(|line| [line, "\n"])
        .collect()
}

/// A control for a parameter.
#[derive(Clone, Debug, Serialize)]
struct Control {
    key: &'static str,
    /// For a length in mm, the key of this length divided by the thickness; otherwise `key`.
    over_t: &'static str,
    label: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
    /// Change of the value for each press of an arrow key.
    step: f64,
    /// Initial value: a number or a word; null if another parameter determines the value.
    value: Value,
    /// Word for the value 0: `flat` for a body, `sharp` for a needle without a radius.
    zero: Option<&'static str>,
    /// Possible values of a parameter with words as values.
    words: Option<[&'static str; 2]>,
    /// Kind of needle for which the control is shown; `None` for all kinds.
    only: Option<&'static str>,
    /// True if range, step and value are curvatures, which the page shows as radii.
    is_radius: bool,
}

/// Default control: key of the parameter, label, range, initial value, and true if optional.
///
/// The initial value is a fraction of the range. Lengths are divided by the thickness; a definition
/// in mm has controls in mm. Range and initial value apply if the definition has none. An optional
/// parameter has a control only if the definition gives it.
type Offered = (&'static str, &'static str, [f64; 2], f64, bool);

/// Thickness that converts default ranges to mm if the definition has no thickness, mm.
const DEFAULT_THICKNESS: f64 = 1.0;

/// Default range of the curvature of the body, from concave to convex, in 1/mm and in 1/t.
const BODIES: [[f64; 2]; 2] = [[-1.0 / 40.0, 1.0 / 8.0], [-1.0 / 20.0, 1.0 / 4.0]];

/// The controls, with overlapping scales as the initial design.
///
/// The page shows the first four, and the others on request.
const OFFERED: [Offered; 14] = [
    (key::GAP, "Gap", [0.02, 1.0], 0.1, false),
    (key::LENGTH, "Length", [0.05, 2.0], 0.5, false),
    (key::SLANT, "Slant", [0.0, 80.0], 0.7, false),
    (key::THICKNESS, "Thickness", [0.1, 10.0], 0.5, true),
    (key::WIDTH, "Width", [0.25, 2.0], 0.5, false),
    (key::MEMBRANE_THICKNESS, "Membrane", [0.02, 0.5], 0.5, false),
    (key::SUBSTRATE_MODULUS, "Tissue modulus", [0.01, 10.0], 0.5, true),
    (key::TISSUE, "Tissue depth", [0.5, 20.0], 0.25, true),
    (key::FRICTION, "Scale friction", [0.0, 0.5], 0.0, false),
    (key::NEEDLE, "Needle", [0.0, 0.0], 0.0, false),
    (key::LOAD_POSITION, "Needle position", [0.0, 1.0], 1.0, false),
    (key::NEEDLE_RADIUS, "Needle radius", [0.0, 2.0], 0.0, false),
    (key::NEEDLE_FRICTION, "Needle friction", [0.0, 1.0], 0.2, false),
    (key::CRITICAL_TILT, "Critical tilt", [2.0, 30.0], 0.5, false),
];

/// A displayed measure.
#[derive(Serialize)]
struct Shown {
    name: &'static str,
    label: &'static str,
    /// Column in physical units, shown instead of this measure if the column has a value.
    physical: &'static str,
    /// Short explanation of the measure.
    words: &'static str,
    /// True if the column is a curvature, which the page shows as a radius.
    is_curvature: bool,
    /// True if the measure has a better direction, so that arrows can show improvements.
    has_goal: bool,
    /// Column with the failure mode that belongs to a force.
    mode: Option<&'static str>,
}

/// Number of measures that the page always shows.
const FIRST_MEASURES: usize = 4;

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

/// Returns the displayed measures; if `seeks_failure`, they include the failure force.
///
/// The page shows the first four, and the others on request.
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
            name::CRITICAL_DISPLACEMENT,
            "Needle depth",
            "critical_displacement_mm",
            "how far the needle moves down up to the critical force",
        ),
        shown(
            name::CONTACT_CURVATURE,
            "Bends freely to",
            "bend_radius_mm",
            "radius at which scales touch",
        ),
        shown(name::COMPLIANCE, "Flexibility", "", "1: bends as easily as the membrane alone"),
        shown(
            name::PENETRATION,
            "Penetration of bases",
            "penetration_mm",
            "how far scales sink into the tissue at the critical force",
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
        measures.insert(1, shown(name::FAILURE_FORCE, "Failure force", "failure_force_N", words));
        // The failure force replaces the critical force among the first measures, because the
        // critical tilt is one of the failures.
        let critical = measures.remove(2);
        measures.insert(FIRST_MEASURES, critical);
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
    /// Number of measures that are always shown.
    first_measures: usize,
    requirements: &'a [String],
    solved: &'a SolvedTable,
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
            first_measures: FIRST_MEASURES,
            requirements: &self.requirements,
            solved: &self.solved,
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

    /// Creates the control of the body.
    ///
    /// It controls the curvature, because a flat body has no radius. The range contains all bodies
    /// of the definition.
    fn body_control(&self) -> Option<Control> {
        let grid = self.sweep.grid();
        let case = grid.case(0);
        let keys = [key::CURVATURE, key::RADIUS_MM, key::RADIUS];
        let axis = keys.into_iter().find_map(|key| grid.axis(key));
        let in_mm = case.material.thickness_mm.map(|_| key::RADIUS_MM);
        let key = axis.map_or(in_mm.unwrap_or(key::RADIUS), |axis| axis.parameter().key);
        let is_in_mm = key == key::RADIUS_MM;
        // Use a given radius in mm directly: a division by the thickness would round the radius.
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
            over_t: key,
            label: "Body radius",
            unit: if is_in_mm { "mm" } else { "t" },
            min,
            max,
            step: (max - min) / 100.0,
            value: value.into(),
            zero: Some("flat"),
            words: None,
            only: None,
            is_radius: true,
        })
    }

    /// Returns the kind of needle that a control requires, if any.
    fn needle_of_control(&self, over_t: &str) -> Option<&'static str> {
        // For a free needle, friction determines the critical tilt, so only one of these two
        // parameters has a control.
        let grid = self.sweep.grid();
        let friction_is_given =
            grid.base().needle_friction.is_some() || grid.axis(key::NEEDLE_FRICTION).is_some();
        let friction_says_tilt = friction_is_given && !self.sweep.is_guided();
        match over_t {
            key::NEEDLE_FRICTION if !friction_says_tilt => Some("guided"),
            key::CRITICAL_TILT if friction_says_tilt => Some("guided"),
            key::NEEDLE_RADIUS => Some("guided"),
            _ => None,
        }
    }

    /// Creates the control of a parameter; `None` for an optional parameter that is not given.
    ///
    /// The range is the range of its axis or variable in the definition, or the default range.
    fn control(&self, &(over_t, label, range, opens_at, if_given): &Offered) -> Option<Control> {
        let grid = self.sweep.grid();
        let case = grid.case(0);
        let offered = Parameter::named(over_t)?;
        // In mm, the radius of a needle stays constant while the thickness changes.
        let is_needle = over_t == key::NEEDLE_RADIUS
            && self.sweep.gives(key::THICKNESS)
            && !self.sweep.gives(over_t);
        let in_mm =
            offered.in_mm().find(|one| one.key != key::PITCH && (is_needle || self.gives(one)));
        let (parameter, factor) =
            in_mm.map_or((offered, 1.0), |parameter| (parameter, self.thickness()));
        let (key, own) = (parameter.key, parameter.get(&case));
        let axis = grid.axis(key).and_then(span);
        let span = axis.or_else(|| self.variables().find_map(|variable| interval(variable, key)));
        if if_given && span.is_none() && own.number().is_none() {
            return None;
        }
        let [min, max] = span.unwrap_or(range.map(|end| end * factor));
        // Start inside the range: the first design of a grid lies at a corner, and is seldom good.
        let middle = min + opens_at * (max - min);
        let is_variable = self.sweep.variables().iter().any(|one| one.parameter() == parameter);
        let is_fixed = axis.is_none() && !is_variable;
        let number = own.number().filter(|_| is_fixed).unwrap_or(middle);
        // The value in a definition may lie outside the default range.
        let (mut min, max) = (min.min(number), max.max(number));
        let is_sharp = over_t == key::NEEDLE_RADIUS && own.number().is_none();
        if over_t == key::NEEDLE_RADIUS && !is_sharp {
            // A radius of 0 is refused.
            min = min.max(1e-3 * max);
        }
        let (words, value) = match own {
            Scalar::Word(word) if key == key::NEEDLE => (Some(["free", "guided"]), word.into()),
            // The inset of the definition applies until the user drags the needle.
            _ if key == key::LOAD_POSITION && case.load_inset.is_some() => (None, Value::Null),
            _ => (None, number.into()),
        };
        Some(Control {
            key,
            over_t,
            label,
            unit: parameter.unit,
            min,
            max,
            step: (max - min) / 100.0,
            value,
            zero: is_sharp.then_some("sharp"),
            words,
            only: self.needle_of_control(over_t),
            is_radius: false,
        })
    }

    /// Returns true if the definition gives a parameter, as a value, an axis or a variable.
    fn gives(&self, parameter: &Parameter) -> bool {
        let grid = self.sweep.grid();
        grid.axis(parameter.key).is_some()
            || parameter.is_given(&grid.case(0))
            || self.variables().any(|variable| variable.parameter() == parameter)
    }

    /// Returns the variables of the definition, and of the search if the design is an optimum.
    fn variables(&self) -> impl Iterator<Item = &Variable> {
        self.sweep.variables().iter().chain(&self.variables)
    }

    /// Returns the thickness of the scales, mm: its value, or the middle of the range of a
    /// variable.
    fn thickness(&self) -> f64 {
        let range = self.variables().find_map(|variable| interval(variable, key::THICKNESS));
        let middle = range.map(|[from, to]| 0.5 * (from + to));
        let own = self.sweep.grid().case(0).material.thickness_mm;
        own.or(middle).unwrap_or(DEFAULT_THICKNESS)
    }
}

/// Returns the curvature of a body; `value` is the value of the parameter `key`.
///
/// The parameter is either a curvature or a radius.
fn curvature(key: &str, value: f64) -> f64 {
    if key == key::CURVATURE { value } else { value.recip() }
}

/// Returns the smallest and the largest value of an axis with several numeric values.
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
