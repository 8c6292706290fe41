//! Parallel coordinates of the designs of a search.
//!
//! The figure has an axis for each variable, objective and requirement.

use super::names::name_with_unit;
use super::sheet;
use crate::axis::ends;
use crate::colors::{FAINT, INK, RED};
use crate::label::{Anchor, fitting, label};
use crate::svg::{Element, Spot, line, polyline};

/// Width and height of the figure, and its margins at the sides, above and below, px.
const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 430.0;
const SIDE: f64 = 70.0;
const TOP: f64 = 112.0;
const BOTTOM: f64 = 36.0;
/// Colours of designs that miss a requirement, and of feasible designs.
const COLORS: [&str; 2] = ["#d8d8d8", "#7f9fbf"];
/// Maximum number of drawn designs. If there are more, only the last ones are drawn.
const MOST: usize = 1500;

/// The designs of a search in parallel coordinates.
#[derive(Clone, Debug)]
pub struct ParallelFigure<'a> {
    /// The title.
    pub title: &'a str,
    /// Column names of the axes.
    pub axes: &'a [String],
    /// Values of each design on the axes, and true if the design meets every requirement.
    pub designs: &'a [(Vec<f64>, bool)],
    /// Index of the best design in `designs`.
    pub best: Option<usize>,
}

impl ParallelFigure<'_> {
    /// Returns the figure as SVG.
    pub fn svg(&self) -> String {
        let text = "red: the best so far; blue: designs that meet every requirement; grey: others";
        let mut inside = vec![label(text, [20.0, 52.0], 12.0, Anchor::Start).with("fill", INK)];
        let first = self.designs.len().saturating_sub(MOST);
        let ends: Vec<_> = (0..self.axes.len()).map(|k| self.ends(k)).collect();
        for is_met in [false, true] {
            let designs = self.designs[first..].iter().filter(|design| design.1 == is_met);
            let color = COLORS[usize::from(is_met)];
            let lines = designs.map(|(values, _)| {
                polyline(&self.spots(values, &ends))
                    .with("stroke", color)
                    .at("stroke-width", 0.8)
                    .with("stroke-opacity", "0.5")
            });
            inside.push(Element::group(if is_met { "met" } else { "short" }).containing(lines));
        }
        inside.extend((0..self.axes.len()).map(|k| self.axis(k)));
        inside.extend(self.best.map(|best| {
            let line = polyline(&self.spots(&self.designs[best].0, &ends)).with("stroke", RED);
            line.at("stroke-width", 2.0).with("class", "best")
        }));
        sheet(WIDTH, HEIGHT, self.title, inside)
    }

    /// Returns the distance between neighbouring axes, px.
    fn step(&self) -> f64 {
        (WIDTH - 2.0 * SIDE) / self.axes.len().saturating_sub(1).max(1) as f64
    }

    /// Returns the smallest and largest value on an axis.
    fn ends(&self, k: usize) -> (f64, f64) {
        ends(self.designs.iter().map(|(values, _)| values[k]))
    }

    fn spots(&self, values: &[f64], ends: &[(f64, f64)]) -> Vec<Spot> {
        let mut spots = Vec::new();
        for (k, value) in values.iter().enumerate() {
            let (low, high) = ends[k];
            let height = if high > low { (value - low) / (high - low) } else { 0.5 };
            let down = (HEIGHT - BOTTOM - TOP) * (1.0 - height);
            spots.push([SIDE + k as f64 * self.step(), TOP + down]);
        }
        spots
    }

    fn axis(&self, k: usize) -> Element {
        let (low, high) = self.ends(k);
        let x = SIDE + k as f64 * self.step();
        let name = name_with_unit(&self.axes[k]);
        // Names of neighbouring axes alternate between two heights, so that each may be two steps
        // wide.
        let above = [22.0, 36.0][k % 2];
        let room = 1.8 * self.step().min(90.0);
        let size = fitting(&name, 12.0, room);
        let texts = [
            (name, TOP - above, size),
            (text::number::rounded(high, 4), TOP - 6.0, 11.0),
            (text::number::rounded(low, 4), HEIGHT - BOTTOM + 16.0, 11.0),
        ];
        let texts = texts
            .map(|(text, y, size)| label(&text, [x, y], size, Anchor::Middle).with("fill", INK));
        Element::group("axis")
            .containing([line([x, TOP], [x, HEIGHT - BOTTOM], FAINT, 1.0)])
            .containing(texts)
    }
}
