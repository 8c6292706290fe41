//! `squama report`.

use std::path::PathBuf;

use ranking::{Ranking, Weights};
use rayon::prelude::*;
use report::{Fact, Page, RankingEntry, drawings};
use results::columns::design_columns;
use skin::puncture;

use super::draw::substrate;
use super::figure_file::{Written, write_html};
use super::results_folder::ResultsFolder;
use super::{DONE, PROGRAM};
use crate::args;
use crate::print::print;

/// Designs that are drawn as they are at the critical tilt, at most: each is solved again.
const DRAWN: usize = 24;
/// Bytes of all their drawings, at most.
const ROOM: usize = 1_500_000;

/// Writes the page of a sweep.
pub fn report(arguments: &args::ReportArguments) -> anyhow::Result<u8> {
    let results = ResultsFolder::read(&arguments.results)?;
    let page = page(&results)?;
    let out: PathBuf = arguments.out.clone().unwrap_or_else(|| results.folder.join("report.html"));
    let folder = out.parent().map_or_else(PathBuf::new, PathBuf::from);
    results::make_folder(&folder)?;
    let name =
        out.file_stem().map_or_else(|| "report".to_owned(), |n| n.to_string_lossy().into_owned());
    let mut files = Written::default();
    write_html(&folder, &name, &page.html(), &mut files)?;
    print(&files.report(&folder))?;
    Ok(DONE)
}

fn page(results: &ResultsFolder) -> anyhow::Result<Page> {
    let sweep = &results.sweep;
    let known = design_columns(sweep);
    let column = |header: &String| {
        let column = known.iter().find(|column| column.name == *header);
        column.map_or_else(
            || ("-".to_owned(), String::new()),
            |column| (column.unit.to_owned(), column.meaning.to_owned()),
        )
    };
    let shared = sweep.shared().map(|(parameter, value)| {
        [parameter.path(), value.to_string(), parameter.meaning.to_owned()]
    });
    let ranking = results.ranking()?;
    Ok(Page {
        name: sweep.name().to_owned(),
        version: PROGRAM.version.to_owned(),
        folder: results.folder.display().to_string(),
        axes: sweep.grid().axes().iter().map(|axis| axis.parameter().key.to_owned()).collect(),
        columns: results.designs.headers().iter().map(column).collect(),
        run: results.run.clone(),
        shared: shared.collect(),
        drawings: ranking.as_ref().map_or_else(Vec::new, |ranking| drawn(results, ranking)),
        ranking: ranking.as_ref().map_or_else(Vec::new, RankingEntry::all),
        designs: results.designs.clone(),
    })
}

/// Drawings of the designs that are best for all criteria alike, for one alone, or for other weights,
/// as many as there is room for.
fn drawn(results: &ResultsFolder, ranking: &Ranking<'_>) -> Vec<Fact> {
    let named = std::iter::once(Weights::BALANCED).chain(Weights::alone());
    let named = named.map(|weights| ranking.winner(weights));
    let mut rows: Vec<usize> = Vec::new();
    for winner in named.chain(ranking.winners()).map(|winner| winner.row()) {
        if rows.len() < DRAWN && !rows.contains(&winner) {
            rows.push(winner);
        }
    }
    let drawings: Vec<_> = rows.par_iter().filter_map(|&row| drawing(results, row)).collect();
    let mut room = ROOM;
    let fits = |(_, svg): &Fact| {
        room = room.saturating_sub(svg.len());
        room > 0
    };
    drawings.into_iter().take_while(fits).collect()
}

/// A drawing, or none if the design cannot be solved: its row in the table says why.
fn drawing(results: &ResultsFolder, row: usize) -> Option<Fact> {
    let number = results.designs.text("design", row);
    let grid = results.sweep.grid();
    let case = grid.case(grid.parse_number(number).ok()?);
    let substrate = substrate(&case).ok()?;
    let at = [puncture::At::Tilt(case.puncture.critical_tilt_deg)];
    let solved =
        puncture::snapshots(&case.design, &substrate, &case.common, &case.puncture, &at).ok()?;
    let states: Vec<_> = solved.at.into_iter().flatten().collect();
    let name = format!("{} design {number}", results.sweep.name());
    let drawing = drawings::PunctureDrawing {
        name: &name,
        design: &case.design,
        load_position: case.puncture.load_position,
        thickness_mm: case.material.thickness_mm,
        states: &states,
    };
    Some((number.to_owned(), drawing.svg().ok()?))
}
