//! The Pareto fronts of the four criteria, two at a time.

use ranking::{RankedDesign, Ranking, Weights};

use super::{COVERAGE, sheet};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, MarkLook, fold_legend, mark, slant_legend};
use crate::designs::Designs;
use crate::label::{Anchor, label};
use crate::palette::{FAINT, INK, SlantPalette};
use crate::svg::{Element, Spot, circle, polyline};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 74.0;
const BETWEEN: [f64; 2] = [74.0, 62.0];
const TOP: f64 = 80.0;
const PANEL: [f64; 2] = [244.0, 240.0];

/// The criteria, each the larger the better; all labels fit along a panel.
const LABELS: [&str; 4] = [
    COVERAGE.label,
    "critical force $F_c^*$, dimensionless",
    "resistance $t/u_{max}$, dimensionless",
    "compliance $C_f^*$, dimensionless",
];

/// Draws the figure; `None` if fewer than two designs have every criterion of the paper.
pub(super) fn figure(name: &str, designs: &Designs, ranking: &Ranking<'_>) -> Option<String> {
    let all = ranking.by_fitness(Weights::BALANCED);
    let is_drawn = all.len() > 1 && ranking.preferences().are_the_papers();
    is_drawn.then(|| draw(name, designs, &all))
}

fn draw(name: &str, designs: &Designs, all: &[RankedDesign<'_>]) -> String {
    let axis = |k: usize| ChartAxis::fit(LABELS[k], all.iter().map(|design| design.criteria()[k]));
    let axes: Vec<ChartAxis> = (0..4).map(axis).collect();
    let palette = designs.palette();
    let mut inside = vec![slant_legend(&palette, [LEFT, 50.0]), legend()];
    inside.extend(designs.any_folded().then(|| fold_legend(&palette, [LEFT + 740.0, 50.0])));
    let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    for (k, (i, j)) in pairs.into_iter().enumerate() {
        let area = Area {
            left: LEFT + (k % 3) as f64 * (PANEL[0] + BETWEEN[0]),
            top: TOP + (k / 3) as f64 * (PANEL[1] + BETWEEN[1]),
            width: PANEL[0],
            height: PANEL[1],
        };
        let (x, y, title) = (&axes[i], &axes[j], String::new());
        let panel = ChartPanel { area, x, y, title, x_labels: true, y_labels: true };
        inside.extend([panel.frame(), panel.x_name(), panel.y_name(48.0)]);
        let points: Vec<Point> =
            all.iter().filter_map(|design| point(&panel, design, (i, j))).collect();
        inside.extend(dots(&points, designs, &palette));
    }
    let title = format!("{name}: designs that no other beats in two criteria");
    sheet(WIDTH, TOP + 2.0 * (PANEL[1] + BETWEEN[1]), &title, inside)
}

/// A design in a panel.
struct Point {
    row: usize,
    criteria: [f64; 2],
    spot: Spot,
}

fn point(panel: &ChartPanel, design: &RankedDesign<'_>, (i, j): (usize, usize)) -> Option<Point> {
    let criteria = [design.criteria()[i], design.criteria()[j]];
    Some(Point { row: design.row(), criteria, spot: panel.place(criteria[0], criteria[1])? })
}

/// Returns grey dots for the designs that are beaten, and the front with its line.
fn dots(points: &[Point], designs: &Designs, palette: &SlantPalette) -> [Element; 3] {
    let criteria: Vec<_> =
        points.iter().map(|&Point { criteria: [a, b], .. }| [a, b, 0.0, 0.0]).collect();
    let on_front = ranking::pareto_front(&criteria);
    let split = |is_front: bool| {
        let all = points.iter().zip(&on_front);
        all.filter(move |(_, on)| **on == is_front).map(|(point, _)| point)
    };
    let beaten = split(false).map(|point| circle(point.spot, 1.6).with("fill", "#b5b5b5"));
    let mut front: Vec<&Point> = split(true).collect();
    front.sort_by(|a, b| a.criteria[0].total_cmp(&b.criteria[0]));
    let spots: Vec<Spot> = front.iter().map(|point| point.spot).collect();
    let marked = |point: &&Point| {
        let look = MarkLook { filled: true, folded: designs.folded(point.row) };
        Some(mark(palette, designs.number("slant_deg", point.row)?, point.spot, 3.4, look))
    };
    [
        Element::group("beaten").containing(beaten),
        polyline(&spots).with("stroke", FAINT).at("stroke-width", 1.2),
        Element::group("front").containing(front.iter().filter_map(marked)),
    ]
}

fn legend() -> Element {
    let text = "on the line: no other is better in both; grey: the others";
    label(text, [LEFT + 420.0, 54.0], 12.0, Anchor::Start).with("fill", INK)
}
