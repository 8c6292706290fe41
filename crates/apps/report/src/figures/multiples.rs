//! Figure of a measure against the aspect ratio, with a panel for each gap and a line for each
//! slant, like Figs. 7b and 12 of the paper.

use text::number::same;

use super::names::{axis_label, with_value};
use super::{Quantity, columns, is_affected_by_folds, sheet};
use crate::axis::ChartAxis;
use crate::chart::{
    Area, ChartPanel, LINE, MarkLook, NAME, design_mark, mark, mark_legend, upright_name,
};
use crate::colors::INK;
use crate::designs::Designs;
use crate::label::{Anchor, fitting, label};
use crate::palette::SlantPalette;
use crate::paper::{Paper, evenly_spaced};
use crate::svg::{Element, Spot, polygon, polyline};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 84.0;
const BOTTOM: f64 = 54.0;
/// Horizontal and vertical space between panels, px.
const BETWEEN: [f64; 2] = [12.0, 28.0];
const HEIGHT: f64 = 190.0;
/// Minimum width of a panel, px.
const LEAST: f64 = 120.0;
/// Maximum number of panels; of more values, only a selection has panels.
const PANELS: usize = 15;

/// Returns the column of the horizontal axis, and the column with a panel for each value.
///
/// The columns are gap and aspect ratio; the one with more values is the axis. Both are in mm if
/// the table has such columns.
fn lengths(designs: &Designs) -> [String; 2] {
    let (gap, length) = ("gap_over_t", "length_over_t");
    let is_longer = designs.values(length).len() >= designs.values(gap).len();
    let axes = if is_longer { [length, gap] } else { [gap, length] };
    axes.map(|axis| designs.in_mm(axis))
}

/// Returns the number of columns of panels, and the value of `across` in each panel.
fn panels(designs: &Designs, across: &str, paper: Paper) -> (usize, Vec<f64>) {
    let values = designs.values(across);
    let room = paper.width(WIDTH) - LEFT - RIGHT;
    let wanted = columns(values.len().min(PANELS));
    let columns = paper.columns(wanted, room, LEAST, BETWEEN[0]);
    (columns, evenly_spaced(values, paper.panels(WIDTH, columns, PANELS)))
}

/// Returns a note on panels that do not fit on the paper; `None` if all fit.
pub(crate) fn omitted(designs: &Designs, paper: Paper) -> Option<String> {
    let across = &lengths(designs)[1];
    let all = designs.values(across).len();
    let (_, shown) = panels(designs, across, paper);
    let example = designs.values(across).first().copied()?;
    (shown.len() < all).then(|| {
        format!(
            "shows {} of {all} values of {across}; choose with --at, e.g. --at {across}={example}",
            shown.len()
        )
    })
}

/// Draws a quantity of all designs in panels.
///
/// Designs with `yes` in the column `filled` have filled marks. If `filled` is `None`, all designs
/// have filled marks.
pub(crate) fn figure(
    name: &str,
    designs: &Designs,
    quantity: &Quantity,
    filled: Option<&str>,
    paper: Paper,
) -> String {
    let [along, across] = &lengths(designs);
    let full = paper.width(WIDTH);
    let x = ChartAxis::fit(&axis_label(along), designs.numbers(along));
    let y = ChartAxis::fit(&axis_label(&quantity.column), quantity.numbers(designs));
    let (columns, values) = panels(designs, across, paper);
    let width = (full - LEFT - RIGHT - BETWEEN[0] * (columns - 1) as f64) / columns as f64;
    let palette = designs.palette();
    let has_folds = is_affected_by_folds(&quantity.column) && designs.any_folded();
    // On narrow paper the legend starts at the left edge.
    let start = if paper.is_narrow(WIDTH) { 20.0 } else { LEFT };
    let (legend, mut below) = mark_legend(&palette, has_folds, [start, 50.0], full - RIGHT);
    let mut inside = vec![legend];
    let is_beside = start + 630.0 + CONTACT_LEGEND < full;
    if filled.is_some() {
        let spot = if is_beside { [start + 630.0, 50.0] } else { [start + 6.0, below] };
        inside.push(contact_legend(&palette, spot));
        below += if is_beside { 0.0 } else { LINE };
    }
    if quantity.band.is_some() {
        let text = "line: median; band: 5 % to 95 % of the samples";
        inside.push(label(text, [start, below], 12.0, Anchor::Start).with("fill", INK));
        below += LINE;
    }
    let first = Area { left: LEFT, top: TOP.max(below + 16.0), width, height: HEIGHT };
    for (k, &value) in values.iter().enumerate() {
        let title = with_value(&(across.as_str(), &text::number::text(value)));
        let (x_labels, y_labels) = (k + columns >= values.len(), k % columns == 0);
        let area = first.panel(k, columns, BETWEEN);
        let panel = ChartPanel { title, x_labels, y_labels, ..ChartPanel::new(area, &x, &y) };
        inside.push(panel.frame());
        let is_here =
            |row: &usize| designs.number(across, *row).is_some_and(|own| same(own, value));
        let rows: Vec<usize> = (0..designs.count()).filter(is_here).collect();
        let here = PanelSeries { designs, palette: &palette, along, rows, quantity, filled };
        inside.extend(palette.slants().iter().map(|&slant| here.series(&panel, slant)));
    }
    let bottom = first.panel(values.len().saturating_sub(1), columns, BETWEEN).bottom();
    let middle = 0.5 * (LEFT + full - RIGHT);
    let size = fitting(&x.label, NAME, full - LEFT - RIGHT);
    inside.push(label(&x.label, [middle, bottom + 38.0], size, Anchor::Middle).with("fill", INK));
    let (center, room) = (0.5 * (first.top + bottom), bottom - first.top);
    inside.push(upright_name(&y.label, [18.0, center], room));
    let title = format!("{name}: {}", super::name_with_unit(&quantity.column));
    sheet(full, bottom + BOTTOM, &title, inside)
}

/// The designs of one panel.
struct PanelSeries<'a> {
    designs: &'a Designs,
    palette: &'a SlantPalette,
    along: &'a str,
    rows: Vec<usize>,
    quantity: &'a Quantity,
    filled: Option<&'a str>,
}

impl PanelSeries<'_> {
    /// Draws the designs of one slant.
    ///
    /// A line joins the marks, with a band for random gaps, if no two designs share an x value.
    fn series(&self, panel: &ChartPanel, slant: f64) -> Element {
        let designs = self.designs;
        let own =
            |row: &&usize| designs.number("slant_deg", **row).is_some_and(|own| same(own, slant));
        let mut points: Vec<(f64, Spot, usize)> =
            self.rows.iter().filter(own).filter_map(|&row| self.point(panel, row)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut series = Element::group("series").with("data-slant", slant.to_string());
        // A line through several designs at the same x value would zigzag.
        if points.windows(2).all(|pair| pair[0].0 < pair[1].0) {
            let color = self.palette.color(slant);
            let band = self.quantity.band.as_ref().map(|band| self.band(panel, &points, band));
            // The outline is visible even where the band has no width, such as at a single design.
            let stroked = band.map(|band| band.with("fill", &color).with("stroke", &color));
            series = series.containing(stroked);
            // Interrupt the line where contact begins, because the value jumps there.
            for part in points.chunk_by(|a, b| self.is_filled(a.2) == self.is_filled(b.2)) {
                let spots: Vec<Spot> = part.iter().map(|point| point.1).collect();
                series.add(polyline(&spots).with("stroke", color.as_str()).at("stroke-width", 1.2));
            }
        }
        series.containing(points.iter().filter_map(|&(_, at, row)| {
            design_mark(designs, self.palette, row, at, self.look(row))
        }))
    }

    /// Returns x value, spot and row of a design; `None` if it has no value or is off the panel.
    fn point(&self, panel: &ChartPanel, row: usize) -> Option<(f64, Spot, usize)> {
        let along = self.designs.number(self.along, row)?;
        let value = self.designs.number(&self.quantity.column, row)?;
        Some((along, panel.place(along, value)?, row))
    }

    /// Draws the area between two columns of quantiles for the designs at `points`.
    fn band(
        &self,
        panel: &ChartPanel,
        points: &[(f64, Spot, usize)],
        quantiles: &[String; 2],
    ) -> Element {
        let [low, high] = quantiles.each_ref().map(|column| -> Vec<Spot> {
            points
                .iter()
                .filter_map(|&(along, _, row)| {
                    panel.place(along, self.designs.number(column, row)?)
                })
                .collect()
        });
        let around: Vec<Spot> = low.into_iter().chain(high.into_iter().rev()).collect();
        polygon(&around)
            .with("class", "band")
            .with("fill-opacity", "0.18")
            .with("stroke-opacity", "0.3")
    }

    fn look(&self, row: usize) -> MarkLook {
        match self.is_filled(row) {
            false => MarkLook::Open,
            true if is_affected_by_folds(&self.quantity.column) => MarkLook::of(self.designs, row),
            true => MarkLook::Filled,
        }
    }

    fn is_filled(&self, row: usize) -> bool {
        self.filled.is_none_or(|column| self.designs.text(column, row) == "yes")
    }
}

/// Width of the legend of contact, px.
const CONTACT_LEGEND: f64 = 230.0;

fn contact_legend(palette: &SlantPalette, [x, y]: Spot) -> Element {
    let slant = palette.slants().first().copied().unwrap_or(0.0);
    Element::group("legend").containing([
        mark(palette, slant, [x, y], MarkLook::Filled),
        label("contact", [x + 10.0, y + 4.0], 12.0, Anchor::Start).with("fill", INK),
        mark(palette, slant, [x + 76.0, y], MarkLook::Open),
        label("no contact: slants alike", [x + 86.0, y + 4.0], 12.0, Anchor::Start)
            .with("fill", INK),
    ])
}
