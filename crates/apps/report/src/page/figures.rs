//! The figures of a page, drawn by this crate and compressed.
//!
//! The scripts of the page decompress the visible figures, and mark and hide elements in them.

use std::collections::HashSet;
use std::io::{self, Write};

use ranking::{CRITERIA, TetrahedralGrid};
use results::columns::{name, parameter_of};
use serde_json::{Map, Value, json};

use super::data::cell;
use super::{Page, curves};
use crate::designs::{AxisValues, Designs};
use crate::figures::weight_slices::WeightSlices;
use crate::figures::{MULTIPLES, PARTS, Quantity, map, multiples, pareto, sheet, stiffness};
use crate::packed::write_packed;
use crate::paper::Paper;
use crate::svg::untitled;

/// Maximum number of measures with a figure, in addition to the paper's criteria.
const MEASURES: usize = 24;
/// Approximate maximum number of marks in all figures of these measures.
const MARKS: usize = 60_000;

/// Paper of the figures; the page scales them to its width.
const PAGE: Paper = Paper::WIDE;

/// Writes the figures of a page and collects their descriptions.
struct FigureWriter<'w, W> {
    out: &'w mut W,
    /// Descriptions of the figures written, for the scripts of the page.
    written: Vec<Value>,
}

impl<W: Write> FigureWriter<'_, W> {
    /// Writes a figure and records its description.
    ///
    /// `choice` is the variant of this kind of figure. `part` contains the values of the parameters
    /// besides gap, aspect ratio and slant.
    fn add(
        &mut self,
        kind: &str,
        choice: &str,
        part: &Map<String, Value>,
        svg: &str,
    ) -> io::Result<()> {
        // The page has its own headings above the figures.
        let svg = untitled(svg);
        // The page reserves space for figures that are not unpacked yet.
        let size = svg.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next());
        let id = format!("drawn-{}", self.written.len());
        write_packed(self.out, &id, svg.as_bytes())?;
        self.written
            .push(json!({"kind": kind, "choice": choice, "part": part, "size": size, "svg": id}));
        Ok(())
    }

    /// Writes `svg`, the only figure of its kind; writes nothing for `None`.
    fn only(&mut self, kind: &str, choice: &str, svg: Option<String>) -> io::Result<()> {
        svg.map_or(Ok(()), |svg| self.add(kind, choice, &Map::new(), &svg))
    }

    /// Writes the figures of designs that differ only in gap, aspect ratio and slant.
    fn part(
        &mut self,
        (values, designs): &(AxisValues<'_>, Designs),
        measures: &[String],
    ) -> io::Result<()> {
        let part: Map<_, _> =
            values.iter().map(|(axis, _)| ((*axis).to_owned(), cell(designs, axis, 0))).collect();
        for (measure, filled) in MULTIPLES.into_iter().filter(|(measure, _)| designs.has(measure)) {
            let quantity = Quantity::of(designs, measure);
            let kind = if measure == name::CRITICAL_FORCE { "critical-force" } else { measure };
            self.add(kind, "", &part, &multiples::figure("", designs, &quantity, filled, PAGE))?;
            self.add(
                "map",
                measure,
                &part,
                &map::by_slant("", designs, &quantity.column, PAGE).svg,
            )?;
        }
        if designs.has(name::CRITICAL_FORCE) && designs.has(name::MAX_STIFFNESS) {
            self.add("stiffness", "", &part, &stiffness::figure("", designs, PAGE))?;
        }
        if designs.has(name::COVERAGE) {
            self.add("coverage", "", &part, &map::by_slant("", designs, name::COVERAGE, PAGE).svg)?;
        }
        for measure in measures.iter().filter(|measure| designs.has(measure)) {
            let quantity = Quantity { column: measure.clone(), band: None };
            let svg = multiples::figure("", designs, &quantity, None, PAGE);
            self.add("measure", measure, &part, &svg)?;
        }
        Ok(())
    }
}

/// Writes the figures of a page; returns their descriptions for its scripts.
pub(super) fn write(out: &mut impl Write, page: &Page) -> io::Result<Vec<Value>> {
    let designs = &page.designs;
    let mut parts = designs.parts();
    // Parts with designs that were solved again come first, because these designs are the best.
    let solved: HashSet<&str> = page.solved.iter().map(|design| design.number.as_str()).collect();
    parts.sort_by_key(|(_, part)| !(0..part.count()).any(|row| solved.contains(part.design(row))));
    let measures = measures(designs);
    let mut figures = FigureWriter { out, written: Vec::new() };
    parts.iter().take(PARTS).try_for_each(|part| figures.part(part, &measures))?;
    figures.only(
        "pareto",
        "",
        pareto::figure("", designs, &rankable(designs), &pareto::physical_axes(designs), PAGE),
    )?;
    figures.only("weights", "", Some(weights()))?;
    for (choice, is_log) in [("linear", false), ("log", true)] {
        figures.only("curves", choice, curves::figure(page, is_log))?;
    }
    figures.only("front", "", page.front.as_ref().map(|front| front.figure(designs)))?;
    Ok(figures.written)
}

/// Returns the columns with a figure, in addition to the criteria of the paper.
///
/// Large tables have fewer of these figures, to limit the number of marks.
fn measures(designs: &Designs) -> Vec<String> {
    let most = MEASURES.min(MARKS / designs.count().max(1));
    let shown = designs.headers().iter().filter(|header| {
        let is_papers = MULTIPLES.iter().any(|(measure, _)| header == measure);
        let is_other = ["design", name::COVERAGE].contains(&header.as_str());
        !is_papers
            && !is_other
            && parameter_of(header).is_none()
            && designs.values(header).len() > 1
    });
    shown.take(most).cloned().collect()
}

/// Returns the rows of the designs for which all criteria of the paper are positive.
fn rankable(designs: &Designs) -> Vec<usize> {
    let positive = CRITERIA.each_ref().map(|criterion| designs.positive(&criterion.column));
    (0..designs.count()).filter(|row| positive.iter().all(|rows| rows[*row])).collect()
}

/// Draws the slices of all weightings; the page colours them by the best design.
fn weights() -> String {
    let grid = TetrahedralGrid::default();
    // The weightings have no valid rows: the page determines the best design for each of them.
    let winners = grid.nodes().map(|steps| (grid.weights(steps), usize::MAX)).collect();
    let slices = WeightSlices { resolution: grid.resolution(), winners, size: 1.0 };
    sheet(600.0, 624.0, "weights", slices.drawn(&Designs::default(), &[], &[]))
}
