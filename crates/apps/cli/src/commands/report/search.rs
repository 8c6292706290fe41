//! Writes the HTML page of a search, and rewrites the page while the search is running.

use std::path::Path;
use std::thread;
use std::time::Duration;

use optimisation::{OPTIMUM, SearchStatus};
use report::{EVALUATION, ParallelFigure, SearchFigure, SearchPage, SearchedDesign as Evaluated};

use crate::commands::answer::SearchedDesign;
use crate::commands::figure_file::write_file;
use crate::commands::status::search_report;
use crate::commands::{DONE, PROGRAM};
use crate::print::print;

/// Time after which the page is written again, in seconds.
const EVERY: u32 = 5;

/// Writes the page of the search in `folder` to `out`, again and again until the search ends.
pub fn search_page(folder: &Path, out: &Path) -> anyhow::Result<u8> {
    print(&format!("{}\n", out.display()))?;
    loop {
        let status = SearchStatus::read(folder)?;
        let mut html = Vec::new();
        page(folder, &status)?.write(&mut html)?;
        write_file(out, &html)?;
        if !status.in_use {
            return Ok(DONE);
        }
        thread::sleep(Duration::from_secs(EVERY.into()));
    }
}

/// Returns the page for the current status of the search.
fn page(folder: &Path, status: &SearchStatus) -> anyhow::Result<SearchPage> {
    let mut notes = Vec::new();
    if folder.join(OPTIMUM).is_file() && !status.in_use {
        let checks = SearchedDesign::read(folder)?.failed_checks.into_iter();
        notes.extend(checks.map(|check| format!("The optimum fails a check: {check}")));
    }
    Ok(SearchPage {
        title: format!("{}: search", status.goal),
        version: PROGRAM.version.to_owned(),
        status: search_report(status),
        notes,
        figures: figures(status),
        reload_after: status.in_use.then_some(EVERY),
    })
}

/// Draws the history of the first objective, and the designs in parallel coordinates, as SVG.
///
/// Returns no figures before the first design is evaluated.
fn figures(status: &SearchStatus) -> Vec<String> {
    let Some(goal) = status.definition.as_ref().filter(|_| !status.evaluations.is_empty()) else {
        return Vec::new();
    };
    let sign = if goal.objectives[0].goal == ranking::Goal::Maximize { 1.0 } else { -1.0 };
    let (mut designs, mut line) = (Vec::new(), Vec::<[f64; 2]>::new());
    for (index, design) in status.evaluations.iter().enumerate() {
        let point = [(index + 1) as f64, design.values[0]];
        designs.push(Evaluated { point, met: design.is_met });
        if design.is_met && line.last().is_none_or(|best| sign * point[1] > sign * best[1]) {
            line.push(point);
        }
    }
    let history = SearchFigure {
        title: &format!("{}: the search", goal.name()),
        axes: [EVALUATION, &goal.objectives[0].column],
        designs: &designs,
        line: &line,
        legend: "the best so far",
    };
    let (axes, values) = coordinates(goal, status);
    let parallel = ParallelFigure {
        title: &format!("{}: the designs", goal.name()),
        axes: &axes,
        designs: &values,
        best: status.best(),
    };
    vec![history.svg(), parallel.svg()]
}

/// Returns the axes of the parallel coordinates, and the values of each design on these axes.
///
/// The axes are variables with numeric values, objectives and requirements, in this order and
/// without duplicates. The flag of a design is true if the design meets the requirements.
fn coordinates(
    goal: &optimisation::DesignGoal,
    status: &SearchStatus,
) -> (Vec<String>, Vec<(Vec<f64>, bool)>) {
    let variables = goal.space.parameters().map(|parameter| parameter.key);
    let names: Vec<&str> = variables.chain(goal.columns()).collect();
    let mut kept: Vec<usize> = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let is_number = status.evaluations[0].variables.get(k).is_none_or(Option::is_some);
        if is_number && !kept.iter().any(|&other| names[other] == *name) {
            kept.push(k);
        }
    }
    let mut designs = Vec::new();
    for design in &status.evaluations {
        let all = design.variables.iter().copied().chain(design.values.iter().copied().map(Some));
        let all: Vec<Option<f64>> = all.collect();
        let values = kept.iter().map(|&k| all[k].unwrap_or_default()).collect();
        designs.push((values, design.is_met));
    }
    (kept.iter().map(|&k| names[k].to_owned()).collect(), designs)
}
