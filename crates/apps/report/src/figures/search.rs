//! Figures of a search: history of the evaluated designs, and front.

use super::names::axis_label;
use super::sheet;
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel};
use crate::colors::{INK, RED};
use crate::label::{Anchor, label};
use crate::svg::{Element, circle, polyline};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 480.0;
const AREA: Area =
    Area { left: 84.0, top: 78.0, width: WIDTH - 84.0 - 30.0, height: HEIGHT - 78.0 - 60.0 };

/// Colours of designs that violate a requirement, and of feasible designs.
const SHADES: [&str; 2] = ["#d8d8d8", "#7f9fbf"];

/// Name of the axis that counts evaluations.
pub const EVALUATION: &str = "evaluation";

/// A design evaluated by a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchedDesign {
    /// Values on the x axis and the y axis.
    pub point: [f64; 2],
    /// True if the design meets every requirement.
    pub met: bool,
}

/// A chart of a search: all evaluated designs, and a line through the best.
#[derive(Clone, Debug)]
pub struct SearchFigure<'a> {
    /// The title.
    pub title: &'a str,
    /// Columns of the x axis and the y axis, or [`EVALUATION`].
    pub axes: [&'a str; 2],
    /// All evaluated designs.
    pub designs: &'a [SearchedDesign],
    /// The points of the line, in order.
    pub line: &'a [[f64; 2]],
    /// The meaning of the line, in words.
    pub legend: &'a str,
}

impl SearchFigure<'_> {
    /// Returns the label of axis `k`. A count of evaluations has no unit.
    fn name(&self, k: usize) -> String {
        if self.axes[k] == EVALUATION { EVALUATION.to_owned() } else { axis_label(self.axes[k]) }
    }

    /// Returns the chart as SVG.
    pub fn svg(&self) -> String {
        let [x, y] = [0, 1].map(|k| {
            let designs = self.designs.iter().map(|design| design.point[k]);
            let all = designs.chain(self.line.iter().map(|point| point[k]));
            ChartAxis::fit(&self.name(k), all)
        });
        let panel = ChartPanel::new(AREA, &x, &y);
        let dots = [false, true].map(|met| {
            let designs = self.designs.iter().filter(|design| design.met == met);
            let spots = panel.spots(designs.map(|design| design.point));
            let shade = SHADES[usize::from(met)];
            let dots = spots.into_iter().map(|spot| circle(spot, 1.8).with("fill", shade));
            Element::group(if met { "met" } else { "short" }).containing(dots)
        });
        let spots = panel.spots(self.line.iter().copied());
        let line = polyline(&spots).with("stroke", RED).at("stroke-width", 1.6);
        let ends = spots.into_iter().map(|spot| circle(spot, 2.6).with("fill", RED));
        let text = format!(
            "red: {}; blue: designs that meet every requirement; grey: others",
            self.legend
        );
        let legend = label(&text, [AREA.left, 52.0], 12.0, Anchor::Start).with("fill", INK);
        let mut inside = vec![legend];
        inside.extend(panel.axes(54.0));
        inside.extend(dots);
        inside.extend([line, Element::group("best").containing(ends)]);
        sheet(WIDTH, HEIGHT, self.title, inside)
    }
}
