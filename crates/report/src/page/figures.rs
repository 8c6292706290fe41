//! The figures of a page: as the crate draws them, packed. The page unpacks those in sight, and marks and hides what they hold.

use std::io::Write as _;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use ranking::TetrahedralGrid;
use results::columns::{name, parameter_of};
use serde_json::{Map, Value, json};

use super::data::cell;
use super::{Page, curves};
use crate::designs::{AxisValues, Designs};
use crate::figures::weight_slices::WeightSlices;
use crate::figures::{MULTIPLES, PARTS, Quantity, map, multiples, pareto, sheet, stiffness};
use crate::svg::untitled;

/// Measures beyond those of the paper that have a figure, at most.
const MEASURES: usize = 24;
/// Marks of all their figures, about, at most.
const MARKS: usize = 60_000;

/// A figure that the page may show: which kind it is, what of it was chosen, the further parameters that it holds.
struct PageFigure {
    kind: &'static str,
    choice: String,
    part: Map<String, Value>,
    svg: String,
}

impl PageFigure {
    /// Creates a figure of which there is one.
    fn only(kind: &'static str, choice: &str, svg: String) -> Self {
        Self { kind, choice: choice.to_owned(), part: Map::new(), svg }
    }

    fn to_json(&self) -> Value {
        // The page has headings of its own, above the figures.
        let svg = untitled(&self.svg);
        // The page keeps room for a figure that it has not unpacked yet.
        let size = svg.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next());
        json!({"kind": self.kind, "choice": self.choice, "part": self.part, "size": size, "svg": packed(&svg)})
    }
}

/// Returns the figures of a page, as its scripts read them.
pub(super) fn of(page: &Page) -> Vec<Value> {
    let designs = &page.designs;
    let mut parts = designs.parts();
    // Of many parts those that hold the best designs, which are the ones that were solved again.
    let is_solved = |number: &str| page.solved.iter().any(|design| design.number == number);
    parts
        .sort_by_key(|(_, part)| !(0..part.count()).any(|row| is_solved(part.text("design", row))));
    let measures = measures(designs);
    let mut figures: Vec<PageFigure> =
        parts.iter().take(PARTS).flat_map(|part| of_part(part, &measures)).collect();
    let pareto = pareto::figure("", designs, &worths(designs));
    figures.extend(pareto.map(|svg| PageFigure::only("pareto", "", svg)));
    figures.push(PageFigure::only("weights", "", weights()));
    for (choice, is_log) in [("linear", false), ("log", true)] {
        let drawn = curves::figure(page, is_log);
        figures.extend(drawn.map(|svg| PageFigure::only("curves", choice, svg)));
    }
    let front = page.front.as_ref().map(|front| front.figure(designs));
    figures.extend(front.map(|svg| PageFigure::only("front", "", svg)));
    figures.iter().map(PageFigure::to_json).collect()
}

/// Draws designs that differ in gap, aspect ratio and slant.
fn of_part((values, designs): &(AxisValues<'_>, Designs), measures: &[String]) -> Vec<PageFigure> {
    let part: Map<_, _> =
        values.iter().map(|(axis, _)| ((*axis).to_owned(), cell(designs, axis, 0))).collect();
    let figure = |kind, choice: &str, svg| PageFigure {
        kind,
        choice: choice.to_owned(),
        part: part.clone(),
        svg,
    };
    let mut figures = Vec::new();
    for (measure, filled) in MULTIPLES.into_iter().filter(|(measure, _)| designs.has(measure)) {
        let quantity = Quantity::of(designs, measure);
        let kind = if measure == name::CRITICAL_FORCE { "critical-force" } else { measure };
        figures.push(figure(kind, "", multiples::figure("", designs, &quantity, filled)));
        figures.push(figure("map", measure, map::by_slant("", designs, &quantity.column)));
    }
    if designs.has(name::CRITICAL_FORCE) && designs.has(name::MAX_STIFFNESS) {
        figures.push(figure("stiffness", "", stiffness::figure("", designs)));
    }
    if designs.has(name::COVERAGE) {
        figures.push(figure("coverage", "", map::by_slant("", designs, name::COVERAGE)));
    }
    for measure in measures.iter().filter(|measure| designs.has(measure)) {
        let quantity = Quantity { column: measure.clone(), band: None };
        figures.push(figure("measure", measure, multiples::figure("", designs, &quantity, None)));
    }
    figures
}

/// Returns the measures that have a figure besides those of the paper: of large tables fewer.
fn measures(designs: &Designs) -> Vec<String> {
    let is_shown = |header: &&String| {
        let is_papers = MULTIPLES.iter().any(|(measure, _)| header == measure);
        let is_other = ["design", name::COVERAGE].contains(&header.as_str());
        !is_papers
            && !is_other
            && parameter_of(header).is_none()
            && designs.values(header).len() > 1
    };
    let most = MEASURES.min(MARKS / designs.count().max(1));
    designs.headers().iter().filter(is_shown).take(most).cloned().collect()
}

/// Returns what designs are worth by the criteria of the paper: the covered ones that have all four.
fn worths(designs: &Designs) -> Vec<(usize, [f64; 4])> {
    let worth = |row| {
        let value = |column: &str| designs.number(column, row).filter(|value| *value > 0.0);
        let [coverage, force] = [value(name::COVERAGE)?, value(name::CRITICAL_FORCE)?];
        Some((row, [coverage, force, 1.0 / value(name::PENETRATION)?, value(name::COMPLIANCE)?]))
    };
    (0..designs.count()).filter_map(worth).collect()
}

/// Draws every weighting of four criteria, which the page colours by the design that is best for it.
fn weights() -> String {
    let grid = TetrahedralGrid::default();
    // No row of a design: the page looks up itself which one is best for a weighting.
    let winners = grid.nodes().map(|steps| (grid.weights(steps), usize::MAX)).collect();
    let slices = WeightSlices { resolution: grid.resolution(), winners };
    sheet(600.0, 610.0, "weights", slices.drawn(&Designs::default(), &[], &[]))
}

/// Returns a drawing as base64 of its deflated text: drawings repeat themselves, so that a tenth is left of them.
pub(super) fn packed(svg: &str) -> String {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
    // A vector takes whatever is written.
    let written = encoder.write_all(svg.as_bytes()).and_then(|()| encoder.finish());
    written.map(|bytes| BASE64_STANDARD.encode(bytes)).unwrap_or_default()
}
