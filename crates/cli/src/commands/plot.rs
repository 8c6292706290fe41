//! `squama plot`.

use std::path::Path;

use anyhow::bail;
use report::{DesignCurves, curves, figures};
use skin::Status;
use skin::flexure::{self, Flexure};
use skin::puncture::{self, Puncture};
use sweep::{Case, DesignNumber, Sweep};

use super::draw::{designs, substrate};
use super::figure_file::{Written, write_svg};
use super::results_folder::ResultsFolder;
use super::{DONE, INCOMPLETE, folder_of, read};
use crate::args;
use crate::print::print;

/// Largest step along a curve, as a fraction of the whole path.
const CURVE_STEP: f64 = 0.004;

/// Curves that end where the puncture does.
const OF_PUNCTURES: [&str; 2] = ["force-displacement-curves", "puncture-energies"];

/// Draws the figures of a sweep, or the curves of designs.
pub fn plot(arguments: &args::PlotArguments) -> anyhow::Result<u8> {
    match (&arguments.what, &arguments.results) {
        (Some(args::PlotWhat::Curves(arguments)), _) => plot_curves(arguments),
        (None, Some(results)) => plot_results(results, arguments),
        (None, None) => bail!("nothing to plot, expected RESULTS or curves SWEEP.toml"),
    }
}

fn plot_results(results: &Path, arguments: &args::PlotArguments) -> anyhow::Result<u8> {
    let results = ResultsFolder::read(results)?;
    let folder = arguments.out.clone().unwrap_or_else(|| results.folder.join("figures"));
    results::make_folder(&folder)?;
    let mut files = Written::default();
    let ranking = results.ranking()?;
    for figure in figures(results.sweep.name(), &results.designs, ranking.as_ref()) {
        write_svg(&folder, &figure.name, &figure.svg, arguments.png, &mut files)?;
    }
    print(&files.report(&folder))?;
    Ok(DONE)
}

fn plot_curves(arguments: &args::CurvesArguments) -> anyhow::Result<u8> {
    let sweep = read(&arguments.definition)?;
    let chosen = designs(&sweep, &arguments.definition.path, &arguments.designs)?;
    let solve = |(_, case): &(DesignNumber, Case)| solve(case, arguments.to);
    let solved = chosen.iter().map(solve).collect::<anyhow::Result<Vec<_>>>()?;
    let shown: Vec<_> = solved
        .iter()
        .zip(&chosen)
        .map(|((puncture, flexure), (number, case))| DesignCurves {
            number: number.to_string(),
            design: &case.design,
            puncture: Some(puncture),
            flexure: Some(flexure),
        })
        .collect();
    let folder = arguments.out.clone().unwrap_or_else(|| folder_of(&sweep, None).join("curves"));
    results::make_folder(&folder)?;
    let mut files = Written::default();
    let names = numbers(&sweep, &arguments.designs);
    for figure in curves(sweep.name(), &shown) {
        // Where a puncture ends is a part of what its curves show.
        let to = arguments.to.filter(|_| OF_PUNCTURES.contains(&figure.name.as_str()));
        let to = to.map_or_else(String::new, |to| format!("-to-u-{to}"));
        let file = format!("{}{to}-of-{names}", figure.name);
        write_svg(&folder, &file, &figure.svg, arguments.png, &mut files)?;
    }
    print(&files.report(&folder))?;
    let failed = solved
        .iter()
        .any(|(puncture, flexure)| [puncture.status, flexure.status] != [Status::Complete; 2]);
    Ok(if failed { INCOMPLETE } else { DONE })
}

/// The puncture of a design, to the critical tilt or to a displacement, and its bending.
fn solve(case: &Case, to: Option<f64>) -> anyhow::Result<(Puncture, Flexure)> {
    let substrate = substrate(case)?;
    let mut common = case.common;
    // Close enough for a line.
    common.solver.max_step = common.solver.max_step.min(CURVE_STEP);
    let at: Vec<_> = to.into_iter().map(puncture::At::Displacement).collect();
    let mut puncture =
        puncture::snapshots(&case.design, &substrate, &common, &case.puncture, &at)?.puncture;
    if let Some(to) = to {
        let beyond = puncture.path.iter().position(|point| point.displacement > to);
        puncture.path.truncate(beyond.map_or(usize::MAX, |beyond| beyond + 1));
        let path = &puncture.path;
        puncture.events.retain(|event| path.contains(&event.point));
    }
    Ok((puncture, flexure::solve(&case.design, &common, &case.flexure)?))
}

/// The numbers of designs, for the name of a file.
fn numbers(sweep: &Sweep, designs: &[String]) -> String {
    let number = |text: &String| {
        let index = sweep.grid().parse_number(text.trim());
        index.map_or_else(|_| text.clone(), |index| sweep.grid().number(index).to_string())
    };
    designs.iter().map(number).collect::<Vec<_>>().join("-")
}
