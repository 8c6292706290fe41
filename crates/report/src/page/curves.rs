//! The curves of the designs that were solved again, all in one chart, of which the page shows those of two designs.

use super::simplified::simplified;
use super::{Page, PageDesign};
use crate::axis::{ChartAxis, ends};
use crate::chart::{Area, ChartPanel};
use crate::figures::sheet;
use crate::svg::{Element, Spot, polyline};

const PANEL: [f64; 2] = [400.0, 250.0];
/// Room around a panel: left, above, below.
const MARGINS: [f64; 3] = [78.0, 44.0, 52.0];
/// The smallest highest value of a curve over the lowest that a logarithmic axis shows.
const DECADES: f64 = 100.0;

/// The chart of one kind of curve: which of a design it is, and the labels of its axes.
struct Kind {
    points: fn(&PageDesign) -> &[[f64; 2]],
    labels: [&'static str; 2],
}

const KINDS: [Kind; 2] = [
    Kind {
        points: |design| &design.puncture,
        labels: ["displacement $u/t$, dimensionless", "force $F^*$, dimensionless"],
    },
    Kind {
        points: |design| &design.flexure,
        labels: ["curvature $κ^*$, dimensionless", "moment $M^*$, dimensionless"],
    },
];

/// Draws force against displacement and moment against curvature, as far as there are any; `None` if there are none.
pub(super) fn figure(page: &Page, is_log: bool) -> Option<String> {
    let has_curves =
        |kind: &&Kind| page.solved.iter().any(|design| (kind.points)(design).len() > 1);
    let kinds: Vec<&Kind> = KINDS.iter().filter(has_curves).collect();
    let [left, above, below] = MARGINS;
    let step = left + PANEL[0] + 20.0;
    let area = |k: usize| Area {
        left: left + k as f64 * step,
        top: above,
        width: PANEL[0],
        height: PANEL[1],
    };
    let panels = kinds.iter().enumerate();
    let inside: Vec<_> = panels.flat_map(|(k, kind)| panel(page, kind, is_log, area(k))).collect();
    let [width, height] = [step * kinds.len() as f64, above + PANEL[1] + below];
    (!inside.is_empty()).then(|| sheet(width, height, "Curves", inside))
}

fn panel(page: &Page, kind: &Kind, is_log: bool, area: Area) -> Vec<Element> {
    let points = || page.solved.iter().flat_map(kind.points);
    let x = ChartAxis::spanning(kind.labels[0], points().map(|point| point[0]));
    let y = if is_log {
        let highest = page
            .solved
            .iter()
            .map(|design| (kind.points)(design).iter().map(|point| point[1]).fold(0.0, f64::max));
        let (low, high) = ends(highest.filter(|highest| *highest > 0.0));
        ChartAxis::logarithmic(kind.labels[1], low / DECADES, high)
    } else {
        ChartAxis::spanning(kind.labels[1], points().map(|point| point[1]))
    };
    let (x, y, title) = (&x, &y, String::new());
    let panel = ChartPanel { area, x, y, title, x_labels: true, y_labels: true };
    let curve = |design: &PageDesign| {
        // What a logarithmic axis has no place for is left out.
        let places = (kind.points)(design).iter().filter_map(|&[x, y]| panel.place(x, y));
        let spots: Vec<Spot> = simplified(&places.collect::<Vec<_>>());
        polyline(&spots).with("class", "curve").with("data-design", design.number.as_str())
    };
    let curves = page.solved.iter().map(curve);
    vec![
        panel.frame(),
        panel.x_name(),
        panel.y_name(56.0),
        Element::group("curves").at("stroke-width", 2.2).containing(curves),
    ]
}
