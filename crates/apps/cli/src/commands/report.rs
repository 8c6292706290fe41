//! The command `squama report`, which writes an HTML page of a run or a search.

mod front;
mod search;

use std::path::PathBuf;

use anyhow::ensure;
use clap::Args;
use optimisation::SearchStatus;
use ranking::{CRITERIA, Criterion, Preferences, Ranking, Weights};
use rayon::prelude::*;
use report::{Explorer, Fact, GapFactors, Page, PageDesign, SolvedTable, drawings};
use results::columns::design_columns;
use results::{bending_units, puncture_units};
use run::{GapChange, MeasureChange, Patience, flat_design_warning};
use skin::puncture::{self, PunctureEnd};
use skin::{PathDetail, flexure};
use sweep::{Case, Sweep};
use text::shell_word;

use super::draw::substrate;
use super::figure_file::{utf8_name, write};
use super::folder_contents::FolderContents;
use super::source::{Partial, require_folder_of, verified_folder};
use super::{DONE, PROGRAM, derivation};
use crate::print::print;
use crate::progress::with_bar;

/// Arguments of `squama report`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama report results/paper
  squama report results/paper --out paper.html
  squama report results/pin        # a search, also while it is running
  squama report results/paper --front results/front      # and the designs that squama optimise found

Open the page in a browser; it needs no network and no server. For a search (squama optimise) the page has its
status, its history and all designs in parallel coordinates; while the search is running, the command writes it
again every few seconds, and the page reloads itself.")]
pub struct Arguments {
    /// Results folder of a run or a search, or the definition of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Page to write [default: RESULTS/report.html]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,

    /// Results folder of squama optimise; its designs are shown beside the grid
    #[arg(long, value_name = "DIR")]
    pub front: Option<PathBuf>,

    #[command(flatten)]
    pub partial: Partial,
}

/// Approximate maximum number of designs on a page, because larger pages overload a browser.
const MAX_DESIGNS: usize = 25_000;

/// Maximum number of designs solved again for their curves and their sensitivity to the gap.
const SOLVED: usize = 120;
/// Maximum number of designs that the command draws at the critical tilt.
///
/// These are the best design and the best design by each of the four criteria. The solver in the
/// page draws any other design.
// Five drawings keep the page of the paper below 2 MB, including the solver.
const DRAWN: usize = 5;
/// Maximum step along the curves of a solved design, as a fraction of the whole path.
const CURVE_STEP: f64 = 0.02;
/// Maximum size of all drawings together, in bytes.
const DRAWING_BYTES: usize = 1_500_000;

/// Writes the page of a sweep or of a search.
pub fn report(arguments: &Arguments) -> anyhow::Result<u8> {
    let folder = &arguments.results;
    let is_search = SearchStatus::is_search(folder);
    let results = if is_search {
        None
    } else {
        let verified = verified_folder(folder, arguments.partial.completeness())?;
        Some(FolderContents::read(&verified, MAX_DESIGNS)?)
    };
    let folder = results.as_ref().map_or(folder, |results| &results.folder);
    let out: PathBuf = arguments.out.clone().unwrap_or_else(|| folder.join("report.html"));
    let ending = out.extension().unwrap_or("html".as_ref());
    ensure!(
        ending == "html",
        "--out {}: not accepted, expected a name that ends in .html",
        out.display()
    );
    require_folder_of("--out", &out)?;
    let Some(results) = results else {
        ensure!(arguments.front.is_none(), "--front needs the results of a run, not of a search");
        return search::search_page(folder, &out);
    };
    let mut page = page(&results)?;
    if let Some(folder) = &arguments.front {
        let (front, failed) = front::front(folder, &results)?;
        page.front = Some(front);
        page.notes.extend(failed);
    }
    let folder = out.parent().map_or_else(PathBuf::new, PathBuf::from);
    let file = out.with_extension("html");
    let name = utf8_name(&file)?;
    // `make_folder` also removes partial pages of killed processes.
    results::make_folder(&folder)?;
    write(&folder, name, |file| page.write(file))?;
    derivation::record(results.verified(), "page", &folder, &[name])?;
    print(&format!("{}\n", folder.join(name).display()))?;
    Ok(DONE)
}

/// Returns the page of a sweep.
fn page(results: &FolderContents) -> anyhow::Result<Page> {
    let sweep = &results.sweep;
    let known = design_columns(sweep);
    let shared = sweep.shared().map(|(parameter, value)| {
        [parameter.path(), value.to_string(), parameter.meaning.to_owned()]
    });
    let rankings = results.rankings()?;
    let grid = sweep.grid();
    Ok(Page {
        explorer: Some(Explorer {
            sweep: sweep.clone(),
            source: shell_word(&results.folder.display().to_string()),
            // Set no requirements, because the user sets requirements on the page.
            requirements: Vec::new(),
            notes: Vec::new(),
            variables: Vec::new(),
            solved: SolvedTable::default(),
            version: PROGRAM.version.to_owned(),
        }),
        name: results.title(),
        version: PROGRAM.version.to_owned(),
        folder: results.folder.display().to_string(),
        criteria: Criterion::usual(Some(sweep)),
        axes: grid.axes().iter().map(|axis| axis.parameter().key.to_owned()).collect(),
        columns: results
            .designs
            .headers()
            .iter()
            .map(|header| {
                let column = known.iter().find(|column| column.name == *header);
                column.map_or_else(
                    || ("-".to_owned(), String::new()),
                    |column| (column.unit.to_owned(), column.meaning.to_owned()),
                )
            })
            .collect(),
        run: [results.run.clone(), judged_modes(sweep)].concat(),
        notes: flat_body(sweep, &rankings).into_iter().collect(),
        shared: shared.collect(),
        is_physical: [puncture_units, bending_units].map(|units| units(&grid.case(0)).is_some()),
        solved: solved(results, &rankings),
        opening: Preferences::read(results.verified())?
            .map_or_else(String::new, |last| opening(&last)),
        designs: results.designs.clone(),
        front: None,
    })
}

/// Returns a fact for each failure mode: whether it is judged, and the reason if it is not.
fn judged_modes(sweep: &Sweep) -> Vec<Fact> {
    let Some(modes) = sweep.grid().case(0).judged_modes() else { return Vec::new() };
    let facts = modes.reasons().map(|(mode, reason)| {
        (
            format!("failure mode {mode}"),
            reason.map_or("judged".to_owned(), |reason| format!("not judged: {reason}")),
        )
    });
    facts.collect()
}

/// Returns a warning that a leading design withstands less force on a curved body.
///
/// `None` if the sweep was solved on a body, or if no leading design withstands less force.
fn flat_body(sweep: &Sweep, rankings: &[Ranking<'_>]) -> Option<String> {
    let best = rankings.iter().flat_map(|ranking| {
        let named = std::iter::once(Weights::BALANCED).chain(Weights::alone());
        named.map(|weights| ranking.winner(weights).design())
    });
    best.take(DRAWN).find_map(|design| {
        let warning = flat_design_warning(sweep, design)?;
        Some(format!("The skin was solved flat. Design {design}: {warning}"))
    })
}

/// Formats the preferences of the last ranking as parameters in the address of the page.
fn opening(preferences: &Preferences) -> String {
    let criteria: Vec<_> = preferences.criteria.iter().map(ToString::to_string).collect();
    let weights: Vec<_> = preferences.weights.values().iter().map(ToString::to_string).collect();
    let (criteria, weights) = (criteria.join(","), weights.join(","));
    let scale = preferences.scale;
    let required =
        preferences.requirements.iter().map(|requirement| format!("require={requirement}"));
    let ranked = format!("criteria={criteria}&weights={weights}&scale={scale}");
    // Escape the plus sign, which means a space in an address.
    required.chain([ranked]).collect::<Vec<_>>().join("&").replace('+', "%2B")
}

/// Solves the leading designs of each group of comparable designs again, for curves and drawings.
fn solved(results: &FolderContents, rankings: &[Ranking<'_>]) -> Vec<PageDesign> {
    let mut groups: Vec<_> = rankings.iter().map(|ranking| leading(ranking).into_iter()).collect();
    let mut rows: Vec<usize> = Vec::new();
    // Take one design of each group in turn, so that every group is represented.
    while rows.len() < SOLVED && !groups.is_empty() {
        groups.retain_mut(|group| {
            group.next().is_some_and(|row| {
                rows.push(row);
                true
            })
        });
    }
    // The last round of the loop may exceed the limit.
    rows.truncate(SOLVED);
    let rows: Vec<_> = rows.into_iter().enumerate().collect();
    let mut all: Vec<_> = with_bar(rows.len(), |work| {
        rows.par_iter()
            .filter_map(|&(k, row)| {
                let solved = solve(results, row, k < DRAWN);
                work.count(1);
                solved
            })
            .collect()
    });
    let mut remaining = DRAWING_BYTES;
    for design in &mut all {
        // `all` begins with the best designs. Designs beyond the limit have curves but no drawing.
        remaining = remaining.saturating_sub(design.svg.len());
        if remaining == 0 {
            design.svg.clear();
        }
    }
    all
}

/// Returns the indices of the table rows of the best designs, without duplicates.
///
/// The order is: the best design for equal weights, the best by each criterion, the best for other
/// weights, and the following designs for equal weights.
fn leading(ranking: &Ranking<'_>) -> Vec<usize> {
    // The designs of `named` are drawn, so they come first.
    let named = std::iter::once(Weights::BALANCED).chain(Weights::alone());
    let named = named.map(|weights| ranking.winner(weights));
    let winners = named.chain(ranking.winners());
    let mut rows = Vec::new();
    for design in winners.chain(ranking.by_fitness(Weights::BALANCED)) {
        if rows.len() < SOLVED && !rows.contains(&design.row()) {
            rows.push(design.row());
        }
    }
    rows
}

/// Solves the design in `row` for its curves, and draws it if `is_drawn`.
///
/// `None` if the design cannot be solved.
fn solve(results: &FolderContents, row: usize, is_drawn: bool) -> Option<PageDesign> {
    let number = results.designs.design(row);
    let grid = results.sweep.grid();
    let mut case = grid.case(grid.parse_number(number).ok()?);
    // Use the step of the definition if it is smaller.
    case.common.solver.max_step = case.common.solver.max_step.min(CURVE_STEP);
    // Curves and drawings need only the path to the critical tilt; the table contains the measures.
    case.common.detail = PathDetail::Critical;
    let substrate = substrate(&case).ok()?;
    let solved =
        puncture::snapshots(&case.design, &substrate, &case.common, &case.punctured(), &[]).ok()?;
    // If the path does not reach the critical tilt, draw only the row at rest.
    let states = if solved.is_critical { std::slice::from_ref(&solved.end) } else { &[] };
    let name = format!("{} design {number}", results.sweep.name());
    let drawing = drawings::PunctureDrawing { name: &name, case: &case, states };
    let path = solved.puncture.path.iter().map(|point| [point.displacement, point.force]);
    Some(PageDesign {
        number: number.to_owned(),
        svg: if is_drawn { drawing.svg().ok()? } else { String::new() },
        puncture: path.map(|point| scaled(point, puncture_units(&case))).collect(),
        flexure: bending(&case)
            .into_iter()
            .map(|point| scaled(point, bending_units(&case)))
            .collect(),
        gap_factors: gap_factors(results, row, solved.puncture.end.as_ref()),
    })
}

/// Multiplies a point of a curve by its units, if there are units.
fn scaled([x, y]: [f64; 2], units: Option<[f64; 3]>) -> [f64; 2] {
    units.map_or([x, y], |[unit_x, unit_y, _]| [x * unit_x, y * unit_y])
}

/// Returns the factors by which the criteria change with a smaller and a larger gap.
///
/// Punctures with a changed gap start from `end`, the end of the puncture of the design itself.
fn gap_factors(results: &FolderContents, row: usize, end: Option<&PunctureEnd>) -> Vec<GapFactors> {
    let FolderContents { sweep, designs, .. } = results;
    let columns = CRITERIA.iter().map(|criterion| criterion.column.as_ref());
    let measured: Vec<(&str, f64)> =
        columns.filter_map(|column| Some((column, designs.number(column, row)?))).collect();
    let number = designs.design(row);
    let change = GapChange::beside(sweep, number, &measured, end, Patience::Milliseconds);
    let measures = change.map_or_else(Vec::new, |change| change.measures);
    measures
        .into_iter()
        .map(|MeasureChange { column, value, changed }| {
            // The quotient is not finite if the measure is zero.
            let factors = changed.map(|changed| Some(changed? / value).filter(|f| f.is_finite()));
            GapFactors { column, factors }
        })
        .collect()
}

/// Returns pairs of curvature and moment along the path of bending.
///
/// The list is empty if bending cannot be solved.
fn bending(case: &Case) -> Vec<[f64; 2]> {
    let solved = flexure::solve(&case.design, &case.common, &case.flexure);
    let path = solved.map_or_else(|_| Vec::new(), |solved| solved.path);
    path.iter().map(|point| [point.curvature, point.moment]).collect()
}
