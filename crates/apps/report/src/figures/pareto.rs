//! Pareto fronts of the four criteria in pairs.

use results::columns::name;

use super::{of_perfect, sheet, thinned};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, MarkLook, design_mark, mark_legend};
use crate::colors::{FAINT, INK};
use crate::designs::Designs;
use crate::label::{Anchor, label};
use crate::palette::SlantPalette;
use crate::svg::{Element, Spot, circle, polyline};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 74.0;
const BETWEEN: [f64; 2] = [74.0, 62.0];
const FIRST: Area = Area { left: LEFT, top: 80.0, width: 244.0, height: 240.0 };

/// The criteria, all to be maximised, with their columns; the labels fit along a panel.
const CRITERIA: [(&str, &str); 4] = [
    (name::COVERAGE, "coverage $λ$, dimensionless"),
    (name::CRITICAL_FORCE, "critical force $F_c^*$, dimensionless"),
    (name::PENETRATION, "resistance $t/u_{max}$, dimensionless"),
    (name::COMPLIANCE, "compliance $C_f^*$, dimensionless"),
];
const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
/// Colour of dominated designs.
const BEATEN: &str = "#b5b5b5";

/// Draws the designs in all pairs of criteria; `None` for fewer than two designs.
pub(crate) fn figure(
    name: &str,
    designs: &Designs,
    worths: &[(usize, [f64; 4])],
) -> Option<String> {
    if worths.len() < 2 {
        return None;
    }
    let axis = |k: usize| ChartAxis::fit(CRITERIA[k].1, worths.iter().map(|(_, worth)| worth[k]));
    let axes: Vec<ChartAxis> = (0..4).map(axis).collect();
    let palette = designs.palette();
    let dot = circle([0.0, 0.0], 1.6).with("fill", "currentColor").with("id", "dot");
    let mut inside = vec![mark_legend(&palette, designs.any_folded(), [LEFT, 50.0])];
    let legend = "on the line: no other is better in both; grey: the others";
    let legend = label(legend, [LEFT, 68.0], 12.0, Anchor::Start).with("fill", INK);
    inside.extend([Element::new("defs").containing([dot]), legend]);
    for (k, (i, j)) in PAIRS.into_iter().enumerate() {
        let panel = ChartPanel::new(FIRST.panel(k, 3, BETWEEN), &axes[i], &axes[j]);
        inside.extend(panel.axes(48.0));
        let point = |(row, worth): &(usize, [f64; 4])| {
            let criteria = [worth[i], worth[j]];
            Some(Point { row: *row, criteria, spot: panel.place(criteria[0], criteria[1])? })
        };
        let points: Vec<Point> = worths.iter().filter_map(point).collect();
        let pair = [CRITERIA[i].0, CRITERIA[j].0].join(" ");
        inside.push(front(&points, designs, &palette).with("data-criteria", pair));
    }
    let title = format!("{name}: non-dominated designs in two criteria{}", of_perfect(designs));
    Some(sheet(WIDTH, FIRST.top + 2.0 * (FIRST.height + BETWEEN[1]), &title, inside))
}

/// A design in a panel.
struct Point {
    row: usize,
    criteria: [f64; 2],
    spot: Spot,
}

/// Draws dominated designs as grey dots, and the front with its line.
fn front(points: &[Point], designs: &Designs, palette: &SlantPalette) -> Element {
    // [`ranking::pareto_front`] takes four criteria; two constant ones do not affect dominance.
    let criteria: Vec<_> =
        points.iter().map(|&Point { criteria: [a, b], .. }| [a, b, 0.0, 0.0]).collect();
    let on_front = ranking::pareto_front(&criteria);
    let mut front: Vec<&Point> =
        points.iter().zip(&on_front).filter(|(_, on)| **on).map(|(point, _)| point).collect();
    front.sort_by(|a, b| a.criteria[0].total_cmp(&b.criteria[0]));
    // The front keeps all its marks; dominated designs of long tables are thinned.
    let beaten = thinned(points.len(), PAIRS.len()).filter(|&k| !on_front[k]).map(|k| {
        let (point, dot) = (&points[k], Element::new("use").with("href", "#dot"));
        let dot = dot.at("x", point.spot[0]).at("y", point.spot[1]).with("color", BEATEN);
        dot.with("data-design", designs.design(point.row))
    });
    let spots: Vec<Spot> = front.iter().map(|point| point.spot).collect();
    let line = polyline(&spots).with("stroke", FAINT).at("stroke-width", 1.2);
    let marks = front
        .iter()
        .filter_map(|p| design_mark(designs, palette, p.row, p.spot, MarkLook::of(designs, p.row)));
    Element::group("front")
        .containing(beaten)
        .containing([line.with("class", "line")])
        .containing(marks)
}
