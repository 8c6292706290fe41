//! The chart with the curves of all solved designs; the page shows the curves of two designs.

use super::simplified::simplified;
use super::{Page, PageDesign};
use crate::axis::{ChartAxis, ends};
use crate::chart::{Area, ChartPanel};
use crate::figures::sheet;
use crate::svg::{Element, Spot, polyline};

const PANEL: [f64; 2] = [400.0, 250.0];
/// Margins of a panel, px: left, above, below.
const MARGINS: [f64; 3] = [78.0, 44.0, 52.0];
/// A logarithmic axis starts at the smallest maximum of a curve, divided by this factor.
const DECADES: f64 = 100.0;

/// A kind of curve: puncture or bending.
struct Kind {
    /// Returns the points of this curve of a design.
    points: fn(&PageDesign) -> &[[f64; 2]],
    /// Labels of the x axis and the y axis: first dimensionless, then in physical units.
    labels: [[&'static str; 2]; 2],
}

const KINDS: [Kind; 2] = [
    Kind {
        points: |design| &design.puncture,
        labels: [
            ["displacement $u/t$, dimensionless", "force $F^*$, dimensionless"],
            ["displacement (mm)", "force (N)"],
        ],
    },
    Kind {
        points: |design| &design.flexure,
        labels: [
            ["curvature $κ^*$, dimensionless", "moment $M^*$, dimensionless"],
            ["curvature (1/mm)", "moment (N mm)"],
        ],
    },
];

/// Draws force–displacement and moment–curvature curves; `None` if there are no curves.
pub(super) fn figure(page: &Page, is_log: bool) -> Option<String> {
    let has_curves =
        |kind: &&Kind| page.solved.iter().any(|design| (kind.points)(design).len() > 1);
    let kinds = KINDS.iter().zip(page.is_physical).filter(|(kind, _)| has_curves(kind));
    let kinds: Vec<_> = kinds.collect();
    let [left, above, below] = MARGINS;
    let between = left + 20.0;
    let first = Area { left, top: above, width: PANEL[0], height: PANEL[1] };
    let panels = kinds.iter().enumerate();
    let inside: Vec<_> = panels
        .flat_map(|(k, (kind, is_physical))| {
            panel(
                page,
                kind,
                kind.labels[usize::from(*is_physical)],
                is_log,
                first.panel(k, kinds.len(), [between; 2]),
            )
        })
        .collect();
    let [width, height] = [(PANEL[0] + between) * kinds.len() as f64, above + PANEL[1] + below];
    (!inside.is_empty()).then(|| sheet(width, height, "Curves", inside))
}

/// Draws the curves of one kind, each scaled to the full panel, and ticks for every possible axis.
///
/// The page shows two curves: it selects an axis that contains both, and scales both curves to this
/// axis. A logarithmic y axis is the same for all curves.
fn panel(page: &Page, kind: &Kind, labels: [&str; 2], is_log: bool, area: Area) -> Vec<Element> {
    let solved: Vec<(&PageDesign, [f64; 2])> = page
        .solved
        .iter()
        .filter(|design| (kind.points)(design).len() > 1)
        .map(|design| {
            let points = (kind.points)(design);
            (design, [0, 1].map(|k| points.iter().map(|point| point[k]).fold(0.0, f64::max)))
        })
        .collect();
    let ends =
        [0, 1].map(|k| ends(solved.iter().map(|(_, size)| size[k]).filter(|size| *size > 0.0)));
    let logarithmic =
        is_log.then(|| ChartAxis::logarithmic(labels[1], ends[1].0 / DECADES, ends[1].1));
    let [across, up] = [0, 1].map(|k| rungs(ends[k]));
    let up = if is_log { vec![1.0] } else { up };
    let mut drawn = Vec::new();
    for (name, ticks) in [("x", &across), ("y", &up)] {
        for &high in ticks {
            let [x, y] = axes(labels, logarithmic.as_ref(), high);
            let panel = ChartPanel::new(area, &x, &y);
            let ticks = if name == "x" { panel.x_ticks() } else { panel.y_ticks() };
            let rung = Element::group("rung").with("data-axis", name);
            drawn.push(rung.with("data-high", high.to_string()).containing(ticks));
        }
    }
    let [x, y] = axes(labels, logarithmic.as_ref(), 1.0);
    let panel = ChartPanel::new(area, &x, &y);
    drawn.extend([area.border(), panel.x_name(), panel.y_name(56.0)]);
    let origin = format!("{} {}", area.left, area.bottom());
    let curves = solved.iter().map(|(design, size)| {
        let [width, height] = if is_log { [size[0], 1.0] } else { *size };
        // Omit points that a logarithmic axis cannot show.
        let points = (kind.points)(design).iter();
        let places = points.filter_map(|&[x, y]| panel.place(x / width, y / height));
        let spots: Vec<Spot> = simplified(&places.collect::<Vec<_>>());
        let curve = polyline(&spots).with("class", "curve").with("data-x", width.to_string());
        curve.with("data-y", height.to_string()).with("data-design", design.number.as_str())
    });
    let curves = Element::group("curves").at("stroke-width", 2.2).containing(curves);
    let whole = Element::group("panel").with("data-origin", origin);
    vec![whole.containing(drawn).containing([curves])]
}

/// Returns axes from 0 to `high`.
///
/// If `logarithmic` is given, the y axis is this axis.
fn axes(labels: [&str; 2], logarithmic: Option<&ChartAxis>, high: f64) -> [ChartAxis; 2] {
    let [x, y] = labels.map(|label| ChartAxis::exact(label, 0.0, high));
    [x, logarithmic.cloned().unwrap_or(y)]
}

/// Returns the round numbers at which axes end, for curves with maxima from `low` to `high`.
fn rungs((low, high): (f64, f64)) -> Vec<f64> {
    let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let steps = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|step| step * 10f64.powi(decade)));
    steps.filter(|step| *step >= low && *step < 5.0 * high).collect()
}
