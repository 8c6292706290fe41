//! The command `squama plot`, which plots figures of a sweep, maps, and curves of designs.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::{Args, Subcommand};
use fit::{MeanCurve, MeasuredCurve, Test};
use report::{DesignCurves, FailureLimit, MapRequest, MeasuredCurves, curves, figures, map};
use run::Evaluator;
use skin::Status;
use skin::flexure::{self, Flexure};
use skin::puncture::{
    self, CriticalEvent, FailureMode, Puncture, PunctureMeasures, PunctureParameters, Snapshots,
};
use sweep::{Case, PARAMETERS, Parameter, Scalar, key};

use super::draw::{require_non_negative, substrate};
use super::figure_file::{FigureFiles, FigureOutput, check_sizes, joined};
use super::folder_contents::FolderContents;
use super::measured::Reading;
use super::options::decimal;
use super::selection::{SelectedDesign, Selection, select};
use super::source::{Definition, Partial, folder_within, verified_folder};
use super::{DONE, INCOMPLETE};
use crate::print::note;
use crate::progress::with_bar;

/// Arguments of `squama plot`.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  squama plot results/paper
  squama plot results/paper --png --out figures
  squama plot results/paper --width 85 --at gap_over_t=0.1 --at gap_over_t=0.5
  squama plot curves sweeps/paper.toml --design 0417,0418
  squama plot map results/paper --x gap_over_t --y slant_deg --of critical_force"
)]
pub struct Arguments {
    /// Plot curves of designs or a map instead of the figures of a sweep
    #[command(subcommand)]
    pub what: Option<PlotWhat>,

    /// Results folder of a run, or its definition
    #[arg(value_name = "RESULTS")]
    pub results: Option<PathBuf>,

    /// Show only designs with this value of a parameter (may be repeated, also for one parameter);
    /// fronts and best designs are computed from all designs
    #[arg(long, value_name = "COLUMN=VALUE")]
    pub at: Vec<String>,

    #[command(flatten)]
    pub output: FigureOutput,

    #[command(flatten)]
    pub partial: Partial,
}

/// Subcommands of `squama plot`; without a subcommand it plots the figures of a sweep.
#[derive(Debug, Subcommand)]
pub enum PlotWhat {
    /// Plot force–displacement and moment–curvature curves, and the energies of designs
    Curves(CurvesArguments),
    /// Plot a column as a map over two parameters, with contours
    Map(MapArguments),
}

/// Arguments of `squama plot map`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama plot map results/paper --x gap_over_t --y slant_deg --of critical_force
  squama plot map results/paper --x gap_over_t --y slant_deg --of compliance --at length_over_t=0.1")]
pub struct MapArguments {
    /// Results folder of a run, or its definition
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Column of the parameter on the horizontal axis
    #[arg(long, value_name = "COLUMN")]
    pub x: String,

    /// Column of the parameter on the vertical axis
    #[arg(long, value_name = "COLUMN")]
    pub y: String,

    /// Column to plot, of numbers or failure modes; the colours are logarithmic if its values span
    /// decades
    #[arg(long, value_name = "COLUMN")]
    pub of: String,

    /// Fix another parameter (may be repeated, also for one parameter); each value of a parameter
    /// that is not fixed gets its own map
    #[arg(long, value_name = "COLUMN=VALUE")]
    pub at: Vec<String>,

    #[command(flatten)]
    pub output: FigureOutput,

    #[command(flatten)]
    pub partial: Partial,
}

/// Arguments of `squama plot curves`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama plot curves sweeps/paper.toml --design 0417,0418
  squama plot curves sweeps/paper.toml --design 0067,0070,0072 --to 0.7 --png
  squama plot curves results/paper --gap 0.1 --length 1
  squama plot curves palm.toml --design 1 --measured test.csv
  squama plot curves sweeps/paper.toml --set 'body = { radius_over_t = -16, radius_to_over_t = 4 }'

A measured file is a text file of a testing machine, as for squama fit. Its header names the columns with their units,
in any order: displacement_mm (or _um, _m) and force_N (_mN, _kN), or curvature_per_m (_per_mm) and moment_N_mm (_mN_m,
_N_m); other columns are ignored. Several specimens beside one design also show their mean and standard deviation as a
band. A file with units needs a [material] with a thickness and a modulus; curves are then in mm, N and mJ.
Columns without a unit are dimensionless, as in path.csv and flexure_path.csv.")]
pub struct CurvesArguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub selection: Selection,

    /// Follow punctures to this displacement u/t instead of the critical tilt
    #[arg(long, value_name = "U", allow_hyphen_values = true, value_parser = decimal)]
    pub to: Option<f64>,

    /// Overlay a measured curve (may be repeated, for files of one test)
    #[arg(long, value_name = "FILE.csv")]
    pub measured: Vec<PathBuf>,

    /// Names of the first columns of measured files, if their first lines do not name them
    #[arg(long, value_name = "X,Y", value_delimiter = ',', requires = "measured")]
    pub measured_columns: Option<Vec<String>>,

    #[command(flatten)]
    pub output: FigureOutput,
}

/// Maximum step along a curve, as a fraction of the whole path.
const CURVE_STEP: f64 = 0.004;

/// Names of the figures with curves of the puncture, to which `--to` applies.
const OF_PUNCTURES: [&str; 2] = ["force-displacement-curves", "puncture-energies"];

/// Plots the figures of a sweep, a map, or the curves of designs.
pub fn plot(arguments: &Arguments) -> anyhow::Result<u8> {
    match (&arguments.what, &arguments.results) {
        (Some(PlotWhat::Curves(arguments)), _) => plot_curves(arguments),
        (Some(PlotWhat::Map(arguments)), _) => plot_map(arguments),
        (None, Some(results)) => plot_results(results, arguments),
        (None, None) => bail!("nothing to plot, expected RESULTS or curves SWEEP.toml"),
    }
}

/// Plots the figures of a sweep.
fn plot_results(results: &Path, arguments: &Arguments) -> anyhow::Result<u8> {
    check_sizes(&arguments.output)?;
    // Read all designs, because the figures themselves reduce the number of drawn points.
    let results = FolderContents::read(
        &verified_folder(results, arguments.partial.completeness())?,
        usize::MAX,
    )?;
    let shown = results.designs.at(&fixed(&arguments.at)?)?;
    let mut files = FigureFiles::new(&arguments.output, || results.folder.join("figures"))?;
    let ranking = results.comparable_ranking()?;
    let ranking = ranking.as_ref().map(|ranking| (&results.designs, ranking));
    for figure in figures(&results.title(), &shown, ranking, arguments.output.paper()) {
        files.figure(&figure)?;
    }
    files.record(results.verified())?;
    files.print()?;
    Ok(DONE)
}

/// Parses each text `COLUMN=VALUE` into its column and value.
fn fixed(at: &[String]) -> anyhow::Result<Vec<(String, String)>> {
    let mut fixed = Vec::new();
    for text in at {
        let parts = text.split_once('=').map(|(axis, value)| (axis.trim(), value.trim()));
        let (axis, value) = parts.with_context(|| {
            format!("--at {text}: is not accepted, expected COLUMN=VALUE, e.g. length_over_t=0.1")
        })?;
        fixed.push((axis.to_owned(), value.to_owned()));
    }
    Ok(fixed)
}

/// Plots one column as a map over two parameters.
fn plot_map(arguments: &MapArguments) -> anyhow::Result<u8> {
    check_sizes(&arguments.output)?;
    let at = fixed(&arguments.at)?;
    let verified = verified_folder(&arguments.results, arguments.partial.completeness())?;
    let results = FolderContents::read(&verified, usize::MAX)?;
    let request = MapRequest {
        x: arguments.x.clone(),
        y: arguments.y.clone(),
        of: arguments.of.clone(),
        at,
        paper: arguments.output.paper(),
    };
    let figure = map(&results.title(), &results.designs, &request)?;
    let mut files = FigureFiles::new(&arguments.output, || results.folder.join("figures"))?;
    files.figure(&figure)?;
    files.record(results.verified())?;
    files.print()?;
    Ok(DONE)
}

/// Solves designs and plots their curves.
fn plot_curves(arguments: &CurvesArguments) -> anyhow::Result<u8> {
    check_sizes(&arguments.output)?;
    require_non_negative("--to", "a displacement u/t", arguments.to.as_slice())?;
    let designs = select(&arguments.definition, &arguments.selection)?;
    let cases: Vec<_> = designs.iter().map(SelectedDesign::case).collect();
    let measured = measured(arguments, &cases)?;
    let solved = with_bar(cases.len(), |work| {
        let solved = cases.iter().zip(&designs).map(|(case, design)| {
            let name = format!("design {}", design.label());
            let solved = work.track(&name, || solve(case, arguments.to));
            work.count(1);
            solved
        });
        solved.collect::<anyhow::Result<Vec<_>>>()
    })?;
    let shown = solved.iter().zip(&designs).zip(&cases);
    let evaluator = Evaluator::new(&[]);
    let bodies: Vec<_> = cases.iter().map(|case| on_bodies(case, &evaluator)).collect();
    let shown: Vec<_> = shown
        .zip(&bodies)
        .map(|((((puncture, flexure, limits), design), case), on_bodies)| DesignCurves {
            number: number(design, &cases),
            case,
            puncture: Some(puncture),
            flexure: Some(flexure),
            on_bodies,
            limits,
        })
        .collect();
    // There is at least one design, because `select` returns an error otherwise.
    let sweep = &designs[0].sweep;
    let mut files = FigureFiles::new(&arguments.output, || {
        folder_within(&arguments.definition, sweep, "curves")
    })?;
    let names: Vec<_> = designs.iter().map(SelectedDesign::label).collect();
    let names = joined(&names, "designs");
    for figure in curves(sweep.name(), &shown, measured.as_ref(), arguments.output.paper()) {
        // The file names of puncture curves state the end of the path.
        let to = arguments.to.filter(|_| OF_PUNCTURES.contains(&figure.name.as_str()));
        let to = to.map_or_else(String::new, |to| format!("-to-u-{to}"));
        let file = format!("{}{to}-of-{names}", figure.name);
        files.svg(&file, &figure.svg)?;
    }
    files.print()?;
    let failed = solved
        .iter()
        .any(|(puncture, flexure, _)| [puncture.status, flexure.status] != [Status::Complete; 2]);
    Ok(if failed { INCOMPLETE } else { DONE })
}

/// Reads the measured curves; `None` if there are none.
///
/// Returns an error if the curves differ in test or units, or if a design lacks the material
/// parameters for curves in physical units.
fn measured(arguments: &CurvesArguments, cases: &[Case]) -> anyhow::Result<Option<MeasuredCurves>> {
    let paths: Vec<_> = arguments.measured.iter().map(|file| file.canonicalize().ok()).collect();
    for (k, file) in arguments.measured.iter().enumerate() {
        if paths[k].is_some() && paths[..k].contains(&paths[k]) {
            bail!("{}: given twice with --measured, expected each file once", file.display());
        }
    }
    let mut read = Vec::new();
    for file in &arguments.measured {
        // A file may contain curves of several specimens.
        read.extend(MeasuredCurve::read(file, arguments.measured_columns.as_deref())?);
    }
    let Some(first) = read.first() else { return Ok(None) };
    // All measured curves share one panel with one pair of axes.
    let kind = (first.test, first.is_physical);
    if let Some(other) = read.iter().find(|curve| (curve.test, curve.is_physical) != kind) {
        bail!(
            "{}: differs from {} in its test or units; overlay curves of one test in the same units",
            other.file,
            first.file
        );
    }
    // Only curves in physical units need the material parameters of the designs.
    cases.iter().filter(|_| first.is_physical).try_for_each(|case| {
        first.test.units(case).map(|_| ()).map_err(|missing| {
            let definition = arguments.definition.path.display();
            anyhow::anyhow!(
                "{definition}: {} is in mm and N; to overlay it, the definition needs {missing}",
                first.file
            )
        })
    })?;
    let (bending, is_physical) = (first.test == Test::Bending, first.is_physical);
    let axes = first.test.axes().map(|(name, _)| name);
    for curve in &read {
        let (skipped_lines, reversed) = (&curve.skipped_lines, curve.reversed);
        for text in (Reading { axes, is_physical, skipped_lines, reversed }).notes() {
            note(&format!("{}: {text}", curve.file));
        }
    }
    // With one design, all measured curves are from specimens of this design, so average them.
    let loading = read.iter().map(|curve| (curve.file.as_str(), curve.loading()));
    let mean = MeanCurve::new(&loading.collect::<Vec<_>>()).filter(|_| cases.len() == 1);
    let band = mean.map_or_else(Vec::new, |mean| mean.points);
    let curves = read.into_iter().map(|curve| (curve.file, curve.points)).collect();
    Ok(Some(MeasuredCurves { bending, is_physical, curves, band }))
}

/// Failure modes of a scale for which the solver locates the limit on the path.
const OF_SCALES: [FailureMode; 4] =
    [FailureMode::Break, FailureMode::Bend, FailureMode::Debond, FailureMode::Perforate];

/// Fraction of the critical tilt at which the limit `tilt` is marked on a path up to `--to`.
const AT_THE_TILT: f64 = 1.0 - 1e-9;

/// Solves the puncture and the bending of a design.
///
/// The puncture ends at the displacement `to`, or at the critical tilt if `to` is `None`. The list
/// of failure limits is empty if the design does not request the first failure.
fn solve(case: &Case, to: Option<f64>) -> anyhow::Result<(Puncture, Flexure, Vec<FailureLimit>)> {
    let substrate = substrate(case)?;
    let mut common = case.common;
    // Use steps that are short enough for a smooth curve.
    common.solver.max_step = common.solver.max_step.min(CURVE_STEP);
    let parameters = case.punctured();
    let single = PunctureParameters { places: None, ..parameters };
    let judged = OF_SCALES.into_iter().filter(|mode| {
        parameters.failure.is_some() && mode.not_judged(&parameters, false).is_none()
    });
    let judged: Vec<_> = judged.collect();
    let mut at: Vec<_> = judged.iter().copied().map(puncture::At::Limit).collect();
    let Snapshots { mut puncture, at: found, .. } = match to {
        None => puncture::snapshots_to_end(&case.design, &substrate, &common, &single, &at)?,
        Some(to) => {
            at.extend([
                puncture::At::Tilt(AT_THE_TILT * parameters.critical_tilt_deg),
                puncture::At::Displacement(to),
            ]);
            puncture::snapshots(&case.design, &substrate, &common, &single, &at)?
        }
    };
    let reached = judged.into_iter().chain([FailureMode::Tilt]).zip(&found);
    let reached = reached.filter_map(|(mode, row)| Some((mode, row.as_ref()?)));
    let reached: Vec<_> =
        reached.map(|(mode, row)| (mode, [row.displacement, row.force])).collect();
    // Keep the step size of the case, because the figure shows only the critical force at each
    // load position.
    puncture.places =
        puncture::load_positions(&case.design, &substrate, &case.common, &parameters)?;
    if let Some(to) = to {
        let beyond = puncture.path.iter().position(|point| point.displacement > to);
        // Keep one point beyond `to`, so that the curve reaches `to`.
        puncture.path.truncate(beyond.map_or(usize::MAX, |beyond| beyond + 1));
        let path = &puncture.path;
        // Remove later events, which would be drawn off the curve.
        puncture.events.retain(|event| path.contains(&event.point));
        puncture.folds.retain(|fold| fold.point.displacement <= to);
    }
    let limits = if parameters.failure.is_some() {
        limits(case, &puncture, reached, to)
    } else {
        Vec::new()
    };
    Ok((puncture, flexure::solve(&case.design, &common, &case.flexure)?, limits))
}

/// Lists the failure limits on the puncture path, up to the displacement `to` if it is given.
///
/// `reached` contains failure modes with displacement and force at their limits. The critical force
/// of the row across is added; it has no displacement on this path.
fn limits(
    case: &Case,
    puncture: &Puncture,
    mut reached: Vec<(FailureMode, [f64; 2])>,
    to: Option<f64>,
) -> Vec<FailureLimit> {
    let PunctureMeasures { critical_force, critical_displacement, passage, failure, .. } =
        &puncture.measures;
    if to.is_none()
        && let Some(end) = critical_displacement.zip(*critical_force)
    {
        let through = passage.critical_event == Some(CriticalEvent::Through);
        let mode = if through { FailureMode::Through } else { FailureMode::Tilt };
        reached.push((mode, end.into()));
    }
    let fold = puncture.folds.first().map(|fold| fold.point);
    let fold = fold.map(|point| (FailureMode::Fold, [point.displacement, point.force]));
    reached.extend(fold);
    reached.retain(|(_, [displacement, _])| to.is_none_or(|to| *displacement <= to));
    let across = case.across().and_then(|across| {
        Some(Evaluator::new(&[]).critical_force(&across).ok()? * case.across_factor())
    });
    let along = if to.is_none() {
        failure.mode.zip(failure.force)
    } else {
        // `failure` is for a path to the critical tilt, but this path ends at `to`.
        let first = reached.iter().min_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
        first.map(|(mode, [_, force])| (*mode, *force))
    };
    let is_across_first =
        across.is_some_and(|across| along.is_none_or(|(_, along)| across < along));
    let first =
        if is_across_first { Some(FailureMode::Across) } else { along.map(|(mode, _)| mode) };
    let reached =
        reached.into_iter().map(|(mode, [displacement, force])| (mode, Some(displacement), force));
    let across = across.map(|force| (FailureMode::Across, None, force));
    reached
        .chain(across)
        .map(|(mode, displacement, force)| FailureLimit {
            mode,
            displacement,
            force,
            is_first: first == Some(mode),
        })
        .collect()
}

/// Number of bodies between the two radii of a case for which the critical force is plotted.
const BODIES: u32 = 25;

/// Returns curvature and critical force for bodies between the two radii of a case.
///
/// The pairs are in the order of ascending curvature. The list is empty for a case with one body.
fn on_bodies(case: &Case, evaluator: &Evaluator) -> Vec<(f64, Option<f64>)> {
    let mut forces = Vec::new();
    for k in 0..BODIES {
        let fraction = f64::from(k) / f64::from(BODIES - 1);
        let Some(on_body) = case.on_body_between(fraction) else { break };
        forces.push((on_body.body().curvature, evaluator.critical_force(&on_body).ok()));
    }
    forces.sort_by(|one, other| one.0.total_cmp(&other.0));
    forces
}

/// Returns the label of a design in a legend.
///
/// The label contains the number of the design, and the parameters that differ between the designs
/// apart from the geometry.
fn number(design: &SelectedDesign, cases: &[Case]) -> String {
    let number = design.number.map_or("off the grid".to_owned(), |number| number.to_string());
    let own = design.case();
    let differing = PARAMETERS.iter().filter(|parameter| {
        // The thickness counts as geometry, because it scales all lengths in mm.
        let is_geometry = ["gap_over_t", "length_over_t", "slant_deg", key::THICKNESS];
        !is_geometry.contains(&parameter.key)
            && cases.iter().any(|other| !is_alike(parameter, other, &own))
    });
    let values = differing.map(|parameter| {
        format!(
            "{} {}",
            parameter.key.replace("_over_t", "/t").replace('_', " "),
            parameter.get(&own)
        )
    });
    let values: Vec<_> = values.collect();
    if values.is_empty() { number } else { format!("{}  ({number})", values.join(", ")) }
}

/// Returns true if a parameter has the same value in two cases.
///
/// A length may agree in mm or divided by the thickness.
fn is_alike(parameter: &Parameter, one: &Case, other: &Case) -> bool {
    let values = [one, other].map(|case| parameter.get(case));
    let in_mm = [(one, &values[0]), (other, &values[1])].map(|(case, value)| match value {
        Scalar::Number(value) if parameter.key.ends_with("_over_t") => {
            Some(value * case.material.thickness_mm?)
        }
        _ => None,
    });
    let is_same_in_mm = matches!(in_mm, [Some(a), Some(b)] if text::number::same(a, b));
    values[0] == values[1] || is_same_in_mm
}
