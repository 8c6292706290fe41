//! The command `squama check`, which checks a definition and describes it.

use std::path::Path;
use std::thread::available_parallelism;
use std::time::Duration;

use clap::Args;
use fit::FitDefinition;
use optimisation::DesignGoal;
use run::Estimate;
use serde_json::{Map, Value, json};
use sweep::{Axis, Measure, Parameter, Role, Setting, Sweep, key, read_entries};

use super::DONE;
use super::source::{Defined, Definition, defined, folder_of, print_notes, settings};
use crate::json;
use crate::print::{aligned, counted, digits, print, time};

/// Arguments of `squama check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama check sweeps/paper.toml
  squama check sweeps/paper.toml --set 'designs.c2=[0.23, 1.1]'
  squama check sweeps/paper.toml --json
  squama check sweeps/goals/pin.toml
  squama check sweeps/fit/palm.toml")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}

/// Smallest number of designs for which the run time is estimated, by solving a few designs.
const LARGE: u64 = 10_000;

/// Maximum number of values of an axis for which the report lists all values.
const LISTED: u64 = 12;

/// Checks a definition and describes its run, search or fit.
pub fn check(arguments: &Arguments) -> anyhow::Result<u8> {
    let path = &arguments.definition.path;
    let settings = settings(&arguments.definition.settings)?;
    if path.is_file() && is_fit(path, &settings)? {
        let fit = FitDefinition::read(path, &settings)?;
        print_notes(fit.sweep());
        if arguments.json {
            json::print(&fit_as_json(&fit))?;
        } else {
            print(&fit_report(&fit, path))?;
        }
        return Ok(DONE);
    }
    match (defined(&arguments.definition)?, arguments.json) {
        (Defined::Goal(goal), true) => json::print(&goal_as_json(&goal))?,
        (Defined::Goal(goal), false) => print(&goal_report(&goal, path))?,
        (Defined::Sweep(sweep), is_json) => {
            print_notes(&sweep);
            if is_json {
                json::print(&as_json(&sweep))?;
            } else {
                print(&report(&sweep, path))?;
            }
        }
    }
    Ok(DONE)
}

/// Returns true if a definition has measured curves, so that it defines a fit.
fn is_fit(path: &Path, settings: &[Setting]) -> anyhow::Result<bool> {
    Ok(read_entries(path, settings)?.iter().any(|entry| entry.key == "curve"))
}

/// Describes the curves and the unknowns of a fit.
fn fit_report(fit: &FitDefinition, path: &Path) -> String {
    let curves: Vec<_> = fit
        .curves()
        .map(|(file, test, points)| {
            [file.to_owned(), test.to_owned(), counted(points as u64, "point")]
        })
        .collect();
    let unknowns: Vec<_> = fit
        .unknowns()
        .iter()
        .map(|of| [of.name.clone(), format!("{} to {}", of.from, of.to), of.unit.to_owned()])
        .collect();
    format!(
        "{} is a valid test for squama fit\n{}\nunknowns\n{}\n{}",
        path.display(),
        aligned(&curves),
        aligned(&unknowns),
        changes(fit.sweep())
    )
}

fn fit_as_json(fit: &FitDefinition) -> Value {
    let curves = fit
        .curves()
        .map(|(file, test, points)| json!({ "file": file, "kind": test, "points": points }));
    let unknowns = fit
        .unknowns()
        .iter()
        .map(|of| json!({ "name": of.name, "unit": of.unit, "from": of.from, "to": of.to }));
    json!({
        "fit": fit.sweep().name(),
        "curves": curves.collect::<Vec<_>>(),
        "unknowns": unknowns.collect::<Vec<_>>(),
    })
}

/// Describes the objectives, requirements and variables of a search.
fn goal_report(goal: &DesignGoal, path: &Path) -> String {
    let sweep = goal.space.sweep();
    let aims = goal.objectives.iter().map(|aim| format!("{} {}", aim.goal.key(), aim.column));
    let mut rows = vec![row("name", goal.name()), row("aim", &aims.collect::<Vec<_>>().join(", "))];
    rows.extend(goal.requirements.iter().map(|required| row("require", &required.to_string())));
    rows.push(row("output", &folder_of(sweep, None).display().to_string()));
    let variables = sweep.variables().iter().map(|of| {
        let [from, to] = [of.at(0.0), of.at(1.0)].map(|end| end.to_string());
        [of.parameter().path(), format!("{from} to {to}"), of.parameter().unit.to_owned()]
    });
    format!(
        "{} is a valid goal for squama optimise\n{}\nvariables\n{}\n{}",
        path.display(),
        aligned(&rows),
        aligned(&variables.collect::<Vec<_>>()),
        changes(sweep)
    )
}

fn goal_as_json(goal: &DesignGoal) -> Value {
    let sweep = goal.space.sweep();
    let variables =
        sweep.variables().iter().map(|of| (of.parameter().path(), [of.at(0.0), of.at(1.0)]));
    let variables = variables.map(|(path, ends)| (path, json!(ends)));
    json!({
        "goal": goal.name(),
        "variables": variables.collect::<Map<_, _>>(),
        "requirements": goal.requirements,
        "output": folder_of(sweep, None).to_string_lossy(),
    })
}

fn report(sweep: &Sweep, path: &Path) -> String {
    let grid = sweep.grid();
    let measures: Vec<_> = sweep.measures().iter().map(|measure| measure.key()).collect();
    let mut rows = vec![
        row("name", sweep.name()),
        row("measures", &measures.join(", ")),
        row("designs", &grid.len().to_string()),
    ];
    if sweep.measures().contains(&Measure::Puncture) {
        rows.push(row("calibrations", &calibrations(sweep).to_string()));
    }
    if let Some(modes) = grid.case(0).judged_modes() {
        for (title, is_judged) in [("failure modes", true), ("not judged", false)] {
            let listed = modes.reasons().filter(|(_, reason)| reason.is_none() == is_judged);
            rows.push(row(title, &listed.map(|(mode, _)| mode).collect::<Vec<_>>().join(", ")));
        }
    }
    if let Some(moduli) = contact_moduli(sweep) {
        rows.push(row("contact modulus", &moduli));
    }
    rows.extend(estimate(sweep));
    rows.push(row("output", &folder_of(sweep, None).display().to_string()));
    let axes: Vec<_> = grid.axes().iter().map(axis_row).collect();
    format!(
        "{} is valid\n{}\naxes, the first one varies slowest\n{}\n{}",
        path.display(),
        aligned(&rows),
        aligned(&axes),
        changes(sweep)
    )
}

fn as_json(sweep: &Sweep) -> Value {
    let axes = sweep.grid().axes().iter().map(|axis| {
        let values = (0..axis.len()).map(|index| axis.value(index));
        json!({ "key": axis.parameter().key, "values": values.collect::<Vec<_>>() })
    });
    let parameters = sweep.shared().map(|(parameter, value)| (parameter.path(), json!(value)));
    let measures: Vec<_> = sweep.measures().iter().map(|measure| measure.key()).collect();
    json!({
        "sweep": sweep.name(),
        "measures": measures,
        "designs": sweep.grid().len(),
        "calibrations": sweep.measures().contains(&Measure::Puncture).then(|| calibrations(sweep)),
        "output": folder_of(sweep, None).to_string_lossy(),
        "axes": axes.collect::<Vec<_>>(),
        "parameters": parameters.collect::<Map<_, _>>(),
        "failure_modes": sweep.grid().case(0).judged_modes().map(|modes| json::failure_modes(&modes)),
    })
}

/// Formats the contact moduli of puncture and bending in `MPa`.
///
/// A contact modulus that is unknown, or that differs between designs, is omitted. Returns `None`
/// if both contact moduli are omitted.
fn contact_moduli(sweep: &Sweep) -> Option<String> {
    // Show both contact moduli, in puncture and in bending: they belong to the same scales, so a
    // difference between them reveals a wrong definition.
    let moduli = [
        ("puncture", ["substrate_modulus_MPa", "contact_modulus_over_substrate"]),
        ("bending", ["membrane_modulus_MPa", "contact_modulus_over_membrane"]),
    ];
    let parts = moduli.into_iter().filter_map(|(test, keys)| {
        let [of, ratio] = keys.map(|key| sweep.shared().find(|(p, _)| p.key == key)?.1.number());
        Some(format!("{} MPa in {test}", digits(of? * ratio?)))
    });
    let parts: Vec<_> = parts.collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

fn row(what: &str, value: &str) -> [String; 2] {
    [what, value].map(str::to_owned)
}

/// Estimates the time and disk space of a large sweep; returns no rows for a small one.
fn estimate(sweep: &Sweep) -> Vec<[String; 2]> {
    // Solving designs for the estimate would take longer than a small sweep itself.
    if sweep.grid().len() < LARGE {
        return Vec::new();
    }
    let estimate = Estimate::solve(sweep);
    let threads = available_parallelism().map_or(1, usize::from);
    let estimated = Duration::try_from_secs_f64(estimate.seconds / threads as f64);
    let duration = estimated.map_or_else(
        |_| "longer than a lifetime".to_owned(),
        |seconds| format!("about {}", time(seconds)),
    );
    let solved = counted(estimate.solved, "design");
    let threads = counted(threads as u64, "thread");
    vec![
        row("time", &format!("{duration} on {threads}, estimated from {solved}")),
        row("size", &format!("about {} of journal and tables", bytes(estimate.bytes))),
    ]
}

/// Formats a number of bytes with a decimal unit, such as `1.5 MB`.
fn bytes(bytes: f64) -> String {
    let units = ["B", "kB", "MB", "GB", "TB", "PB"];
    let power = (bytes.max(1.0).log10() / 3.0).floor().min(units.len() as f64 - 1.0);
    let value = bytes / 1000_f64.powf(power);
    let value = if value < 10.0 { format!("{value:.1}") } else { format!("{value:.0}") };
    format!("{value} {}", units[power as usize])
}

/// Returns the key, the number of values and the values of an axis.
fn axis_row(axis: &Axis) -> [String; 3] {
    [axis.parameter().key.to_owned(), counted(axis.len(), "value"), values(axis)]
}

/// Lists the values of an axis; of more than [`LISTED`], the first three and the last value.
fn values(axis: &Axis) -> String {
    let len = axis.len();
    if len > LISTED {
        let [first, second, third, last] = [0, 1, 2, len - 1].map(|index| axis.value(index));
        return format!("{first} {second} {third} … {last}");
    }
    let values: Vec<_> = (0..len).map(|index| axis.value(index).to_string()).collect();
    values.join(" ")
}

/// Returns the number of footprints for which the substrate is calibrated.
fn calibrations(sweep: &Sweep) -> u64 {
    let has_mm = sweep.gives_millimetres();
    // The springs depend on lengths divided by the thickness. If lengths are in mm, each thickness
    // therefore needs its own calibration.
    let matters =
        |of: &Parameter| of.has(Role::MovesSprings) || (has_mm && of.key == key::THICKNESS);
    let axes = sweep.grid().axes().iter();
    axes.filter(|axis| matters(axis.parameter())).map(Axis::len).product()
}

/// Lists the shared parameters that differ from their defaults.
fn changes(sweep: &Sweep) -> String {
    let changed = sweep.shared().filter(|(parameter, value)| parameter.default() != *value);
    let rows: Vec<_> = changed
        .map(|(p, value)| [p.path(), value.to_string(), format!("instead of {}", p.default())])
        .collect();
    if rows.is_empty() {
        return "parameters: all defaults\n".to_owned();
    }
    format!("parameters that differ from the defaults\n{}", aligned(&rows))
}
