//! Pareto fronts of the four criteria in pairs.

use ranking::Criterion;
use results::Quantity;
use results::columns::{Goal, name, physical_source, plain_goal};

use super::names::{axis_label, name_with_unit};
use super::{of_perfect, sheet, thinned};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, MarkLook, design_mark, mark_legend};
use crate::colors::{FAINT, INK};
use crate::designs::Designs;
use crate::label::{Anchor, label};
use crate::palette::SlantPalette;
use crate::paper::Paper;
use crate::svg::{Element, Spot, circle, polyline};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 74.0;
const BETWEEN: [f64; 2] = [74.0, 62.0];
/// Margin at the right, px.
const MARGIN: f64 = 46.0;
const FIRST_TOP: f64 = 80.0;
/// Maximum height of a panel, px.
const HEIGHT: f64 = 240.0;

/// Minimum width of a panel, px.
const LEAST: f64 = 110.0;

/// A criterion as an axis of a panel.
pub(crate) struct CriterionAxis {
    /// Name of the column.
    column: String,
    /// Labels of the axis for wide and for narrow panels.
    labels: [String; 2],
    /// True if the axis shows the inverse of the column.
    is_inverse: bool,
    /// 1 if larger values on the axis are better, −1 if smaller values are better.
    sign: f64,
}

impl CriterionAxis {
    /// Returns the value of a design on the axis; `None` if the design has no value.
    fn value(&self, designs: &Designs, row: usize) -> Option<f64> {
        let value = designs.number(&self.column, row)?;
        Some(if self.is_inverse { value.recip() } else { value })
    }

    /// Returns the column as a criterion, which is maximised or minimised.
    pub(crate) fn criterion(&self) -> Criterion {
        let is_better_large = (self.sign > 0.0) != self.is_inverse;
        let goal = if is_better_large { Goal::Maximize } else { Goal::Minimize };
        Criterion::new(&self.column, goal)
    }
}

/// Returns the axes of the four criteria of the paper; larger values are better on each.
fn papers_axes() -> [CriterionAxis; 4] {
    let axes = [
        (name::COVERAGE, "coverage ", "$λ$"),
        (name::CRITICAL_FORCE, "critical force ", "$F_c^*$"),
        (name::PENETRATION, "resistance ", "$t/u_{max}$"),
        (name::COMPLIANCE, "compliance ", "$C_f^*$"),
    ];
    axes.map(|(papers, words, symbol)| CriterionAxis {
        column: papers.to_owned(),
        labels: [format!("{words}{symbol}, dimensionless"), symbol.to_owned()],
        is_inverse: papers == name::PENETRATION,
        sign: 1.0,
    })
}

/// Returns the axes of the four criteria, in physical units where the table has such columns.
pub(crate) fn physical_axes(designs: &Designs) -> [CriterionAxis; 4] {
    papers_axes().map(|axis| {
        let headers = designs.headers().iter();
        let mut own = headers.filter_map(|header| {
            let (source, quantity) = physical_source(header)?;
            let is_shown = quantity != Quantity::ForcePerWidth;
            (source == axis.column && is_shown).then_some(header)
        });
        let Some((column, goal)) = own.find_map(|h| Some((h, plain_goal(h)?))) else {
            return axis;
        };
        CriterionAxis {
            column: column.clone(),
            labels: [axis_label(column), name_with_unit(column)],
            is_inverse: false,
            sign: if goal == Goal::Maximize { 1.0 } else { -1.0 },
        }
    })
}
/// Indices of the two criteria of each panel.
const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
/// Colour of dominated designs.
const DOMINATED: &str = "#b5b5b5";

/// Draws the designs in `rows`, with a panel for each pair of criteria.
///
/// `None` for fewer than two designs.
pub(crate) fn figure(
    name: &str,
    designs: &Designs,
    rows: &[usize],
    criteria: &[CriterionAxis; 4],
    paper: Paper,
) -> Option<String> {
    if rows.len() < 2 {
        return None;
    }
    let full = paper.width(WIDTH);
    let between = if paper.is_narrow(WIDTH) { [64.0, 58.0] } else { BETWEEN };
    let [left, margin] = if paper.is_narrow(WIDTH) { [60.0, 16.0] } else { [LEFT, MARGIN] };
    let room = full - left - margin;
    let columns = paper.columns(3, room, LEAST, between[0]);
    let width = (room - between[0] * (columns - 1) as f64) / columns as f64;
    let axes: Vec<ChartAxis> = criteria
        .iter()
        .map(|criterion| {
            let label = &criterion.labels[usize::from(width < 200.0)];
            ChartAxis::fit(label, rows.iter().filter_map(|row| criterion.value(designs, *row)))
        })
        .collect();
    let palette = designs.palette();
    let dot = circle([0.0, 0.0], 1.6).with("fill", "currentColor").with("id", "dot");
    let start = if paper.is_narrow(WIDTH) { 20.0 } else { LEFT };
    let (marks, below) = mark_legend(&palette, designs.any_folded(), [start, 50.0], full - 16.0);
    let legend = "line: no other design is better in both; grey: the others";
    let legend = label(legend, [start, below], 12.0, Anchor::Start).with("fill", INK);
    let mut inside = vec![marks, Element::new("defs").containing([dot]), legend];
    let top = FIRST_TOP.max(below + 12.0);
    // Narrow panels are square.
    let first = Area { left, top, width, height: width.min(HEIGHT) };
    for (k, (i, j)) in PAIRS.into_iter().enumerate() {
        let panel = ChartPanel::new(first.panel(k, columns, between), &axes[i], &axes[j]);
        inside.extend(panel.axes(48.0));
        let points = rows.iter().filter_map(|&row| {
            let [x, y] =
                [&criteria[i], &criteria[j]].map(|criterion| criterion.value(designs, row));
            let (x, y) = x.zip(y)?;
            let better = [criteria[i].sign * x, criteria[j].sign * y];
            Some(Point { row, criteria: better, spot: panel.place(x, y)? })
        });
        let points: Vec<Point> = points.collect();
        let pair = [criteria[i].column.as_str(), &criteria[j].column].join(" ");
        inside.push(front(&points, designs, &palette).with("data-criteria", pair));
    }
    let title = format!("{name}: non-dominated designs in two criteria{}", of_perfect(designs));
    let rows = PAIRS.len().div_ceil(columns) as f64;
    Some(sheet(full, top + rows * (first.height + between[1]), &title, inside))
}

/// A design in a panel.
struct Point {
    row: usize,
    /// Values of both criteria, with signs so that larger values are better.
    criteria: [f64; 2],
    spot: Spot,
}

/// Draws dominated designs as grey dots, and the Pareto front as marks on a line.
fn front(points: &[Point], designs: &Designs, palette: &SlantPalette) -> Element {
    // `pareto_front` needs four criteria. Two constant criteria do not affect dominance.
    let criteria: Vec<_> =
        points.iter().map(|&Point { criteria: [a, b], .. }| [a, b, 0.0, 0.0]).collect();
    let on_front = ranking::pareto_front(&criteria);
    let mut front: Vec<&Point> =
        points.iter().zip(&on_front).filter(|(_, on)| **on).map(|(point, _)| point).collect();
    front.sort_by(|a, b| a.criteria[0].total_cmp(&b.criteria[0]));
    // Every design of the front has a mark. If the table is long, only some of the dominated
    // designs have one.
    let dominated = thinned(points.len(), PAIRS.len()).filter(|&k| !on_front[k]).map(|k| {
        let (point, dot) = (&points[k], Element::new("use").with("href", "#dot"));
        let dot = dot.at("x", point.spot[0]).at("y", point.spot[1]).with("color", DOMINATED);
        dot.with("data-design", designs.design(point.row))
    });
    let spots: Vec<Spot> = front.iter().map(|point| point.spot).collect();
    let line = polyline(&spots).with("stroke", FAINT).at("stroke-width", 1.2);
    let marks = front
        .iter()
        .filter_map(|p| design_mark(designs, palette, p.row, p.spot, MarkLook::of(designs, p.row)));
    Element::group("front")
        .containing(dominated)
        .containing([line.with("class", "line")])
        .containing(marks)
}
