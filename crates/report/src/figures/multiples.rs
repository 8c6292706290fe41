//! One value against the aspect ratio: a panel for each gap, a line for each slant (Figs. 7b and 12).

use super::{FigureQuantity, columns, sheet};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, MarkLook, NAME, fold_legend, mark, slant_legend};
use crate::designs::Designs;
use crate::label::{Anchor, label, upright};
use crate::palette::{INK, SlantPalette};
use crate::svg::{Element, Spot, polyline};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 84.0;
const BOTTOM: f64 = 54.0;
/// Between panels, across and down.
const BETWEEN: [f64; 2] = [12.0, 28.0];
const HEIGHT: f64 = 190.0;
/// Panels at most: of more gaps some are shown.
const PANELS: usize = 15;

/// The two lengths: one along the axis, one from panel to panel.
struct Lengths {
    along: &'static str,
    along_label: &'static str,
    across: &'static str,
    across_symbol: &'static str,
}

/// Returns the length with more values stands along the axis.
fn lengths(designs: &Designs) -> Lengths {
    let (gap, length) = ("gap_over_t", "length_over_t");
    if designs.values(length).len() >= designs.values(gap).len() {
        Lengths {
            along: length,
            along_label: "aspect ratio $L/t$, dimensionless",
            across: gap,
            across_symbol: "$d/t$",
        }
    } else {
        Lengths {
            along: gap,
            along_label: "gap $d/t$, dimensionless",
            across: length,
            across_symbol: "$L/t$",
        }
    }
}

/// Returns the figure of a quantity; dots are filled where the column `filled` says so.
pub(super) fn figure(
    name: &str,
    designs: &Designs,
    quantity: FigureQuantity,
    filled: Option<&str>,
) -> String {
    let lengths = lengths(designs);
    let x = ChartAxis::fit(lengths.along_label, designs.numbers(lengths.along));
    let y = ChartAxis::fit(quantity.label, designs.numbers(quantity.column));
    let values = some(designs.values(lengths.across));
    let columns = columns(values.len());
    let palette = designs.palette();
    let mut inside = vec![slant_legend(&palette, [LEFT, 50.0])];
    inside.extend(filled.map(|_| contact_legend(&palette, [LEFT + 470.0, 50.0])));
    inside.extend(designs.any_folded().then(|| fold_legend(&palette, [LEFT + 735.0, 50.0])));
    for (k, &value) in values.iter().enumerate() {
        let title = format!("{} = {value}", lengths.across_symbol);
        let (x_labels, y_labels) = (k + columns >= values.len(), k % columns == 0);
        let area = area(k, columns);
        let panel = ChartPanel { area, x: &x, y: &y, title, x_labels, y_labels };
        inside.push(panel.frame());
        let here =
            PanelSeries { designs, palette: &palette, lengths: &lengths, value, quantity, filled };
        inside.extend(palette.slants().iter().map(|&slant| here.series(&panel, slant)));
    }
    let bottom = area(values.len().saturating_sub(1), columns).bottom();
    let middle = 0.5 * (LEFT + WIDTH - RIGHT);
    inside.push(label(&x.label, [middle, bottom + 38.0], NAME, Anchor::Middle).with("fill", INK));
    inside.push(upright(&y.label, [18.0, 0.5 * (TOP + bottom)], NAME).with("fill", INK));
    let title = format!("{name}: {}", title(quantity.label));
    sheet(WIDTH, bottom + BOTTOM, &title, inside)
}

/// Returns the area of panel `k`, of `columns` in a row.
fn area(k: usize, columns: usize) -> Area {
    let (column, row) = ((k % columns) as f64, (k / columns) as f64);
    let width = (WIDTH - LEFT - RIGHT - BETWEEN[0] * (columns - 1) as f64) / columns as f64;
    let (left, top) = (LEFT + column * (width + BETWEEN[0]), TOP + row * (HEIGHT + BETWEEN[1]));
    Area { left, top, width, height: HEIGHT }
}

/// Returns the words of a label before its symbol.
fn title(label: &str) -> String {
    label.split(" $").next().unwrap_or(label).to_owned()
}

/// Returns at most as many of `values` as there is room for, from end to end.
fn some(values: Vec<f64>) -> Vec<f64> {
    if values.len() <= PANELS {
        return values;
    }
    (0..PANELS).map(|k| values[k * (values.len() - 1) / (PANELS - 1)]).collect()
}

/// The designs of one panel.
struct PanelSeries<'a> {
    designs: &'a Designs,
    palette: &'a SlantPalette,
    lengths: &'a Lengths,
    value: f64,
    quantity: FigureQuantity,
    filled: Option<&'a str>,
}

impl PanelSeries<'_> {
    /// Returns the designs of one slant: a line where each aspect ratio stands once, and their marks.
    fn series(&self, panel: &ChartPanel, slant: f64) -> Element {
        let designs = self.designs;
        let is_here = |row: &usize| {
            designs.number(self.lengths.across, *row) == Some(self.value)
                && designs.number("slant_deg", *row) == Some(slant)
        };
        let point = |row: usize| {
            let along = designs.number(self.lengths.along, row)?;
            let at = panel.place(along, designs.number(self.quantity.column, row)?)?;
            Some((along, at, row))
        };
        let mut points: Vec<(f64, Spot, usize)> =
            (0..designs.count()).filter(is_here).filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut series = Element::group("series").with("data-slant", slant.to_string());
        if points.windows(2).all(|pair| pair[0].0 < pair[1].0) {
            let color = self.palette.color(slant);
            // No line crosses the place where contact begins: the value jumps there.
            for part in points.chunk_by(|a, b| self.is_filled(a.2) == self.is_filled(b.2)) {
                let spots: Vec<Spot> = part.iter().map(|point| point.1).collect();
                series.add(polyline(&spots).with("stroke", color.as_str()).at("stroke-width", 1.2));
            }
        }
        for (_, at, row) in points {
            let look = MarkLook { filled: self.is_filled(row), folded: self.designs.folded(row) };
            series.add(mark(self.palette, slant, at, 3.2, look));
        }
        series
    }

    fn is_filled(&self, row: usize) -> bool {
        self.filled.is_none_or(|column| is_true(self.designs.text(column, row)))
    }
}

fn is_true(text: &str) -> bool {
    matches!(text, "true" | "yes" | "1")
}

fn contact_legend(palette: &SlantPalette, [x, y]: Spot) -> Element {
    let slant = palette.slants().first().copied().unwrap_or(0.0);
    Element::group("legend").containing([
        mark(palette, slant, [x, y], 4.5, MarkLook::FILLED),
        label("contact", [x + 10.0, y + 4.0], 12.0, Anchor::Start).with("fill", INK),
        mark(palette, slant, [x + 76.0, y], 4.5, MarkLook::OPEN),
        label("no contact: slants alike", [x + 86.0, y + 4.0], 12.0, Anchor::Start)
            .with("fill", INK),
    ])
}
