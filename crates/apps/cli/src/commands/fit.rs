//! The command `squama fit`, which fits parameters of a skin to test data.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

use ::fit::{
    CurveEvent, CurveEventKind, Estimate, FitDefinition, FitError, Fitted, FittedCurve, Scatter,
};
use anyhow::Context as _;
use clap::Args;
use report::{FitPanel, fit_figure};
use results::{Claim, Column, Maker, ResultsFolder, columns, write_rows};
use run::WorkMeter;
use serde_json::{Value, json};
use sweep::Role;

use super::measured::Reading;
use super::options::SolveOptions;
use super::source::{folder_of, print_notes, settings};
use super::{DONE, INCOMPLETE};
use crate::interrupt::Interrupt;
use crate::json;
use crate::print::{aligned, counted, digits, note};
use crate::progress::Display;

/// Arguments of `squama fit`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama fit test.toml
  squama fit test.toml --set 'variables.friction={ from = 0, to = 0.5 }' --json

TEST.toml defines the skin that was tested. [variables] lists the unknowns with their bounds, such as
substrate_modulus_MPa = { from = 0.1, to = 2 }, and each measured curve has a table:
  [[curve]]
  file = \"puncture.csv\"          # columns displacement_mm and force_N (see squama plot curves --help)
  kind = \"puncture\"              # or \"bending\": curvature_per_m and moment_N_mm
  offsets = [\"displacement\"]     # also fit the zero of this axis
  branch = \"both\"                # fit unloading, too (or \"unloading\"; default \"loading\")
  to = 2.5                       # leave out points beyond (from: before), in the unit of the first column
  gap_over_t = 0.3               # a parameter of this specimen only
Fits all curves together by least squares, each weighted by its own noise, with exact derivatives. Shows the values
with 95 % confidence intervals, strong correlations, and unknowns that the data do not determine.
per_specimen = [\"substrate_modulus_MPa\"] at the top of TEST.toml fits this parameter for each curve, and shows its mean
and standard deviation.
Writes fit.csv, residuals.csv, mean_curves.csv (several curves of one design), residuals.svg, and fitted.toml, a
definition for squama run, design and tolerance.
Exit code: 0 done, 1 the data do not determine all unknowns, 2 bad input or a disk error.")]
pub struct Arguments {
    /// Definition of the test in TOML
    #[arg(value_name = "TEST.toml")]
    pub path: PathBuf,

    /// Set a key of the definition, e.g. scale.base=2L (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    /// Folder for the files [default: results/NAME/fit]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub solving: SolveOptions,
}

/// Names of the files that `squama fit` writes.
pub(super) const FILES: [&str; 5] =
    ["fit.csv", "residuals.csv", "mean_curves.csv", "residuals.svg", "fitted.toml"];

/// Message that is printed after the first termination signal.
const ENDING: &str = "ending without a fit";

/// Smallest absolute correlation of two unknowns that is reported.
const STRONG: f64 = 0.9;

/// Fits the unknown parameters of a skin to test data, and writes the results.
pub fn fit(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let path = arguments.path.display();
    let definition = FitDefinition::read(&arguments.path, &settings(&arguments.settings)?)?;
    print_notes(definition.sweep());
    let folder = ResultsFolder::new(
        arguments.out.clone().unwrap_or_else(|| folder_of(definition.sweep(), None).join("fit")),
    );
    // Before the slow fit, reject a folder in which the fit would overwrite files of the user.
    Claim::check(&folder, Maker::Fit)?;
    interrupt.end_gracefully();
    let display =
        Display::<WorkMeter>::new(arguments.solving.quiet, interrupt, Arc::default(), ENDING);
    let pool = arguments.solving.threads.pool()?;
    let fitted = pool.install(|| definition.fit(interrupt.stop(), display.watched()));
    // Remove the progress bar before printing.
    drop(display);
    let fitted = match fitted {
        Err(stopped @ FitError::Stopped) => {
            note(&format!("{path}: {stopped}"));
            return Ok(interrupt.exit_code().unwrap_or(INCOMPLETE));
        }
        fitted => fitted.with_context(|| path.to_string())?,
    };
    write(&folder, &fitted)?;
    let (record, text) = (|| record(&fitted), || text(&fitted));
    json::answer(arguments.solving.json, record, text, (folder.path(), &FILES))?;
    let is_determined = !fitted.estimates.iter().any(Estimate::is_undetermined);
    Ok(if is_determined { DONE } else { INCOMPLETE })
}

/// Writes the tables, the figure and the definition of the fitted skin.
fn write(folder: &ResultsFolder, fitted: &Fitted) -> anyhow::Result<()> {
    let claim = Claim::take(folder, Maker::Fit)?;
    let [table, residuals, means, figure, definition] = FILES;
    let format = folder.csv_format();
    write_rows(folder, table, format, ESTIMATES, &fitted.estimates)?;
    let rows = fitted.curves.iter().flat_map(|curve| curve.points.iter().map(move |p| (curve, *p)));
    let rows: Vec<Point> = rows.map(|(curve, point)| (curve.file.clone(), point)).collect();
    write_rows(folder, residuals, format, POINTS, rows)?;
    let rows = fitted.means.iter().flat_map(|mean| {
        let files = mean.files.join("; ");
        mean.points.iter().map(move |point| (files.clone(), *point))
    });
    write_rows(folder, means, format, MEANS, rows.collect::<Vec<Point>>())?;
    let panels = fitted.curves.iter().map(|curve| {
        let FittedCurve { file, axes, points, noise, .. } = curve;
        FitPanel { file, axes, points, noise: *noise }
    });
    let panels: Vec<_> = panels.collect();
    folder.write_text(figure, &fit_figure(fitted.sweep.name(), &panels))?;
    folder.write_text(definition, &fitted_toml(fitted))?;
    claim.finish(&FILES)?;
    Ok(())
}

/// Returns the definition of the fitted skin, with the scatter of the specimens as tolerances.
fn fitted_toml(fitted: &Fitted) -> String {
    let mut text = fitted.sweep.to_toml();
    let deviations: Vec<_> = fitted.scatter.iter().filter_map(deviation).collect();
    // Tolerances that the definition of the test contains take precedence over the scatter.
    if !deviations.is_empty() && fitted.sweep.deviations().is_empty() {
        let _ = write!(text, "\n[tolerance]\n{}\n", deviations.join("\n"));
    }
    text
}

/// Returns the entry in `[tolerance]` for the scatter of a parameter.
///
/// `None` if the parameter does not vary between the specimens, or is no property of the product.
fn deviation(scatter: &Scatter) -> Option<String> {
    let Scatter { parameter, deviation, .. } = scatter;
    let is_possible = parameter.has(Role::Toleranced) && *deviation > 0.0;
    is_possible.then(|| format!("{} = {{ batch_sd = {} }}", parameter.key, digits(*deviation)))
}

/// Unit text of the columns of `fit.csv` in which the unit differs from row to row.
const UNIT_OF_ROW: &str = "see the column unit";

/// The columns of `fit.csv`.
pub(super) static ESTIMATES: &[Column<Estimate>] = &columns! { Estimate:
    "sought", "-", |e| e.unknown.name.clone(), "key of a parameter, or offset of a curve";
    "unit", "-", |e| e.unknown.unit, "unit of the parameter or offset";
    "value", UNIT_OF_ROW, |e| e.value, "least-squares estimate";
    "low", UNIT_OF_ROW, |e| e.interval[0], "lower end of the 95 % confidence interval; empty if it is open";
    "high", UNIT_OF_ROW, |e| e.interval[1], "upper end of the 95 % confidence interval; empty if it is open";
    "from", UNIT_OF_ROW, |e| e.unknown.from, "lower bound of the parameter";
    "to", UNIT_OF_ROW, |e| e.unknown.to, "upper bound of the parameter";
};

/// A row of `residuals.csv` or `mean_curves.csv`: the name of the file or files, and three values.
pub(super) type Point = (String, [f64; 3]);

/// Units of the columns of curves, which depend on the test.
const UNIT_OF_CURVE: &str = "mm and N, or 1/mm and N mm; none if the curve has no units";

/// The columns of `residuals.csv`.
pub(super) static POINTS: &[Column<Point>] = &columns! { Point:
    "curve", "-", |(file, _)| file.clone(), "file of the measured curve";
    "x", UNIT_OF_CURVE, |(_, point)| point[0], "displacement or curvature";
    "measured", UNIT_OF_CURVE, |(_, point)| point[1], "measured force or moment";
    "fitted", UNIT_OF_CURVE, |(_, point)| point[2], "force or moment of the fitted skin";
};

/// The columns of `mean_curves.csv`.
pub(super) static MEANS: &[Column<Point>] = &columns! { Point:
    "curves", "-", |(files, _)| files.clone(), "measured curves of one design";
    "x", UNIT_OF_CURVE, |(_, point)| point[0], "displacement or curvature";
    "mean", UNIT_OF_CURVE, |(_, point)| point[1], "mean force or moment while loading";
    "sd", UNIT_OF_CURVE, |(_, point)| point[2], "standard deviation of the force or moment over the curves";
};

/// Formats the estimates, warnings and curves of the fit.
fn text(fitted: &Fitted) -> String {
    let points: usize = fitted.curves.iter().map(|curve| curve.points.len()).sum();
    let Fitted { estimates, curves, solutions, .. } = fitted;
    let mut text = format!(
        "{}: {} from {points} points of {}, {solutions} solutions\n\n",
        fitted.sweep.name(),
        counted(estimates.len() as u64, "unknown"),
        counted(curves.len() as u64, "curve")
    );
    let header = ["", "value", "", "95 % interval"].map(str::to_owned);
    let rows = std::iter::once(header).chain(estimates.iter().map(estimate_row));
    text.push_str(&aligned(&rows.collect::<Vec<_>>()));
    text.push_str(&undetermined_text(fitted));
    text.push('\n');
    text.push_str(&curves_text(fitted));
    text
}

/// Returns the name, value, unit and interval of an estimate.
fn estimate_row(estimate: &Estimate) -> [String; 4] {
    let Estimate { unknown, value, interval, is_at_bound, .. } = estimate;
    let interval = match interval.map(|end| end.map(digits)) {
        [Some(low), Some(high)] => format!("{low} to {high}"),
        [Some(low), None] => format!("at least {low}"),
        [None, Some(high)] => format!("at most {high}"),
        [None, None] => "undetermined".to_owned(),
    };
    let end = if *is_at_bound {
        format!("  (!) at a bound of its range: widen {}", unknown.key())
    } else {
        String::new()
    };
    let unit = if unknown.unit == "-" { "" } else { unknown.unit };
    [unknown.name.clone(), digits(*value), unit.to_owned(), format!("{interval}{end}")]
}

/// Describes undetermined and correlated unknowns, and the scatter of specimens.
fn undetermined_text(fitted: &Fitted) -> String {
    let mut text = String::new();
    // Ignore the results of `writeln!`, because writing to a string cannot fail.
    for group in &fitted.undetermined {
        let _ = match names(fitted, group).as_slice() {
            [name] => writeln!(
                text,
                "  (!) The data do not determine {name}: they exclude no value of its range"
            ),
            names => writeln!(
                text,
                "  (!) The data determine only a combination of {}: fix one of them, or add a curve of another kind or specimen",
                names.join(" and ")
            ),
        };
    }
    for scatter in &fitted.scatter {
        let _ = writeln!(text, "  {}", scatter_text(scatter));
    }
    for estimate in
        fitted.estimates.iter().filter(|estimate| !estimate.depends_on_range_of.is_empty())
    {
        let _ = writeln!(
            text,
            "  The interval of {} depends on the range of {}",
            estimate.unknown.name,
            names(fitted, &estimate.depends_on_range_of).join(" and ")
        );
    }
    for (i, row) in fitted.correlations.iter().enumerate() {
        for (j, correlation) in
            row.iter().enumerate().skip(i + 1).filter(|(_, c)| c.abs() >= STRONG)
        {
            let names = names(fitted, &[i, j]).join(" and ");
            let _ = writeln!(text, "  {names} are correlated: {correlation:.3}");
        }
    }
    text
}

/// Lists the curves with their numbers of points and noise, then remarks and mean curves.
fn curves_text(fitted: &Fitted) -> String {
    let rows = fitted.curves.iter().map(|curve| {
        let unit = curve.axes[1].split_once(", ").map_or("", |(_, unit)| unit);
        let largest = curve.points.iter().map(|point| point[1].abs()).fold(0.0, f64::max);
        let percent = 100.0 * curve.noise / largest;
        let points = counted(curve.points.len() as u64, "point");
        [
            curve.file.clone(),
            points,
            format!("noise {} {unit}, {percent:.1} % of the largest value", digits(curve.noise)),
        ]
    });
    let mut text = aligned(&rows.collect::<Vec<_>>());
    for curve in &fitted.curves {
        text.push_str(&remarks(curve, &fitted.estimates));
    }
    for mean in &fitted.means {
        let [.., [x, last_mean, deviation]] = mean.points.as_slice() else { continue };
        let _ = writeln!(
            text,
            "  mean of {}: {} at {}, standard deviation {}",
            mean.files.join(", "),
            digits(*last_mean),
            digits(*x),
            digits(*deviation)
        );
    }
    let differenced: usize = fitted.curves.iter().map(|curve| curve.differenced).sum();
    if differenced > 0 {
        let _ = writeln!(
            text,
            "  {differenced} derivatives are finite differences of whole solutions, where a contact sticks or the skin is unloaded"
        );
    }
    text
}

/// Returns the names of the unknowns with the given indices.
fn names<'f>(fitted: &'f Fitted, indices: &[usize]) -> Vec<&'f str> {
    indices.iter().map(|&j| fitted.estimates[j].unknown.name.as_str()).collect()
}

/// Describes the mean and standard deviation of a parameter over the specimens.
fn scatter_text(scatter: &Scatter) -> String {
    let Scatter { parameter, specimens, mean, mean_interval, .. } = scatter;
    let [mean_low, mean_high] = mean_interval.map(digits);
    let [low, high] = scatter.deviation_interval.map(digits);
    let tolerance = deviation(scatter).map_or_else(String::new, |entry| {
        format!("; to use it in squama tolerance, set tolerance.{entry}")
    });
    format!(
        "{} of {} specimens: mean {} (95 %: {mean_low} to {mean_high}), standard deviation {} (95 %: {low} to {high}){tolerance}",
        parameter.key,
        specimens.len(),
        digits(*mean),
        digits(scatter.deviation)
    )
}

/// Lists the warnings about a fitted curve, marked by `(!)`, and then the notes.
fn remarks(curve: &FittedCurve, estimates: &[Estimate]) -> String {
    let FittedCurve { file, beyond, events, .. } = curve;
    let [x, y] = curve.axes.each_ref().map(|axis| axis.split_once(',').map_or(&**axis, |a| a.0));
    let warnings = [
        curve.has_suspect_signs.then(|| {
            format!("no point has both {x} and {y} above 0: check the signs of the test data")
        }),
        (*beyond > 0).then(|| {
            let points = counted(*beyond as u64, "point");
            format!("{points} beyond the end of the fitted curve, where the scale has tilted; leave them out with to = …")
        }),
        curve.trend.map(|trend| {
            let factor = curve.widening;
            format!("neighbouring residuals are correlated ({trend:.2}): the model may lack an effect; the intervals are {factor:.1} times as wide as for independent residuals; see residuals.svg")
        }),
    ];
    let (is_physical, reversed) = (curve.is_physical, curve.reversed);
    let notes =
        Reading { axes: [x, y], is_physical, skipped_lines: &curve.skipped_lines, reversed }
            .notes();
    let offset = format!("{x} offset of {file}");
    let has_offset = estimates.iter().any(|estimate| estimate.unknown.name == offset);
    let (as_notes, as_warnings): (Vec<_>, Vec<_>) =
        events.iter().partition(|event| is_note(event, has_offset));
    let as_warnings = as_warnings.into_iter().map(|event| event_text(event, [x, y], has_offset));
    let as_notes = as_notes.into_iter().map(|event| event_text(event, [x, y], has_offset));
    let warnings = warnings.into_iter().flatten().chain(as_warnings);
    let warnings = warnings.map(|text| format!("  (!) {file}: {text}\n"));
    let notes = notes.into_iter().chain(as_notes);
    warnings.chain(notes.map(|text| format!("  {file}: {text}\n"))).collect()
}

/// Returns true if the definition takes an event into account, so that the event is no warning.
fn is_note(event: &CurveEvent, has_offset: bool) -> bool {
    match event.kind {
        CurveEventKind::Touches => has_offset,
        CurveEventKind::TurnsBack => event.excluded_points == 0,
        _ => false,
    }
}

/// Describes an event of a curve; `x` and `y` are the names of the axes of the curve.
///
/// `has_offset` is true if the fit determines an offset of `x` for this curve.
fn event_text(event: &CurveEvent, [x, y]: [&str; 2], has_offset: bool) -> String {
    let CurveEvent { kind, line, excluded_points, at } = *event;
    let points = counted(excluded_points as u64, "point");
    let is_or_are = if excluded_points == 1 { "is" } else { "are" };
    match kind {
        CurveEventKind::Touches => {
            let advice = if has_offset {
                String::new()
            } else {
                format!("; offsets = [\"{x}\"] in [[curve]] fits the point of contact")
            };
            format!(
                "the {y} does not rise up to line {line}, at the {x} {}: an approach before contact{advice}",
                digits(at)
            )
        }
        CurveEventKind::TurnsBack if excluded_points == 0 => {
            format!("the {x} turns back after line {line}; both branches are fitted")
        }
        CurveEventKind::TurnsBack => format!(
            "the {x} turns back after line {line}; {points} of the other branch {is_or_are} left out; branch = \"both\" also fits them"
        ),
        CurveEventKind::TurnsAgain => {
            format!(
                "the {x} grows again after line {line}; the {points} after it {is_or_are} left out"
            )
        }
        CurveEventKind::Fails => format!(
            "the {y} drops after line {line} and does not recover; the {points} after it {is_or_are} left out"
        ),
        CurveEventKind::Drops => {
            format!(
                "the {y} drops after line {line}, but the curve continues; the later points are kept (to = … leaves them out)"
            )
        }
        CurveEventKind::Held => {
            format!("the {x} is held after line {line}; {points} of the hold {is_or_are} left out")
        }
    }
}

/// Returns the name of a kind of event in the JSON output.
fn kind_name(kind: CurveEventKind) -> &'static str {
    match kind {
        CurveEventKind::Touches => "touches",
        CurveEventKind::TurnsBack => "turns_back",
        CurveEventKind::TurnsAgain => "turns_again",
        CurveEventKind::Fails => "fails",
        CurveEventKind::Drops => "drops",
        CurveEventKind::Held => "held",
    }
}

fn scatter_record(scatter: &Scatter, fitted: &Fitted) -> Value {
    let Scatter { parameter, specimens, mean, mean_interval, deviation, deviation_interval } =
        scatter;
    let specimens = specimens.iter().map(|j| &fitted.estimates[*j].unknown.name);
    json!({
        "parameter": parameter.key,
        "specimens": specimens.collect::<Vec<_>>(),
        "mean": mean,
        "mean_interval": mean_interval,
        "deviation": deviation,
        "deviation_interval": deviation_interval,
    })
}

/// Returns the fit as JSON.
fn record(fitted: &Fitted) -> Value {
    json!({
        "name": fitted.sweep.name(),
        "estimates": fitted.estimates.iter().map(|e| json!({
            "sought": e.unknown.name, "unit": e.unknown.unit, "value": e.value, "interval": e.interval,
            "at_end": e.is_at_bound, "depends_on_range_of": names(fitted, &e.depends_on_range_of),
        })).collect::<Vec<_>>(),
        "scatter": fitted.scatter.iter().map(|s| scatter_record(s, fitted)).collect::<Vec<_>>(),
        "correlations": fitted.correlations,
        "not_told_apart": fitted.undetermined.iter().map(|group| names(fitted, group)).collect::<Vec<_>>(),
        "curves": fitted.curves.iter().map(|c| json!({
            "file": c.file, "points": c.points.len(), "left_out": c.skipped_lines, "reversed": c.reversed,
            "events": c.events.iter().map(|e| json!({
                "kind": kind_name(e.kind), "line": e.line, "left_out": e.excluded_points,
            })).collect::<Vec<_>>(),
            "noise": c.noise, "trend": c.trend, "widening": c.widening, "beyond": c.beyond,
            "differenced": c.differenced,
        })).collect::<Vec<_>>(),
        "solutions": fitted.solutions,
        "restarts": fitted.restarts,
        "files": FILES,
    })
}
