//! Figure of a fit: measured points and the fitted curve, and beside them what is left between the two.

use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel};
use crate::colors::{FAINT, INK, RED};
use crate::figures::sheet;
use crate::label::{Anchor, label};
use crate::svg::{Element, Spot, circle, line, polyline};

/// A measured curve beside the fitted one.
#[derive(Clone, Copy, Debug)]
pub struct FitPanel<'a> {
    /// The name of its file.
    pub file: &'a str,
    /// What its axes are, with their units.
    pub axes: &'a [String; 2],
    /// Place, measured value, fitted value.
    pub points: &'a [[f64; 3]],
    /// Standard deviation of the residuals.
    pub noise: f64,
}

/// Width and height of a panel, and the room around it, px.
const PANEL: [f64; 2] = [330.0, 230.0];
const ROOM: [f64; 2] = [92.0, 92.0];

/// Draws a row for each curve: the curve, and its residuals with the range in which 95 % of them lie if they are chance alone.
pub fn fit_figure(name: &str, curves: &[FitPanel]) -> String {
    let [width, height] = PANEL;
    let mut inside = Vec::new();
    for (row, curve) in curves.iter().enumerate() {
        let top = 74.0 + row as f64 * (height + ROOM[1]);
        let area =
            |column: f64| Area { left: 78.0 + column * (width + ROOM[0]), top, width, height };
        inside.extend(curve.curve(area(0.0)));
        inside.extend(curve.residuals(area(1.0)));
        let text = Element::new("text").at("x", 78.0).at("y", top - 12.0).at("font-size", 13.0);
        inside.push(text.with("fill", INK).text(curve.file));
    }
    let paper = [2.0 * width + ROOM[0] + 110.0, 74.0 + curves.len() as f64 * (height + ROOM[1])];
    sheet(paper[0], paper[1], &format!("{name}: measured and fitted, and the difference"), inside)
}

impl FitPanel<'_> {
    fn curve(&self, area: Area) -> Vec<Element> {
        let values = self.points.iter().flat_map(|point| [point[1], point[2]]);
        let y = ChartAxis::spanning(&self.axes[1], values);
        self.panel(area, &y, |panel, spots| {
            let mut fitted = self.points.to_vec();
            // Points may be measured in any order, but a line goes from left to right.
            fitted.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let fitted = spots(&fitted.iter().map(|p| [p[0], p[2]]).collect::<Vec<_>>());
            let fitted = polyline(&fitted).with("stroke", INK).at("stroke-width", 1.6);
            let mut inside =
                dots(&spots(&self.points.iter().map(|p| [p[0], p[1]]).collect::<Vec<_>>()));
            inside.extend([fitted, panel.border()]);
            inside
        })
    }

    fn residuals(&self, area: Area) -> Vec<Element> {
        let left: Vec<_> = self.points.iter().map(|p| [p[0], p[1] - p[2]]).collect();
        let bounds = [-1.96 * self.noise, 0.0, 1.96 * self.noise];
        let (_, unit) = self.axes[1].split_once(", ").unwrap_or(("", ""));
        let name = if unit.is_empty() {
            "measured − fitted".to_owned()
        } else {
            format!("measured − fitted, {unit}")
        };
        let y = ChartAxis::spanning(&name, left.iter().map(|p| p[1]).chain(bounds));
        self.panel(area, &y, |panel, spots| {
            let across = |value: f64| {
                let [_, y] = panel.place(self.points[0][0], value)?;
                Some(line([area.left, y], [area.right(), y], FAINT, 1.0))
            };
            let mut inside: Vec<_> = bounds.into_iter().filter_map(across).collect();
            let upper = panel.place(self.points[0][0], bounds[2]);
            let words =
                "between the outer lines: 95 % of the points, if chance alone scatters them";
            inside.extend(upper.map(|[_, y]| {
                label(words, [area.left, y - 4.0], 10.0, Anchor::Start).with("fill", INK)
            }));
            inside.extend(dots(&spots(&left)));
            inside
        })
    }

    fn panel(
        &self,
        area: Area,
        y: &ChartAxis,
        draw: impl Fn(&ChartPanel, &dyn Fn(&[[f64; 2]]) -> Vec<Spot>) -> Vec<Element>,
    ) -> Vec<Element> {
        let x = ChartAxis::spanning(&self.axes[0], self.points.iter().map(|point| point[0]));
        let panel = ChartPanel::new(area, &x, y);
        let spots = |points: &[[f64; 2]]| -> Vec<Spot> {
            points.iter().filter_map(|&[x, y]| panel.place(x, y)).collect()
        };
        let mut inside = panel.axes(58.0).to_vec();
        inside.extend(draw(&panel, &spots));
        inside
    }
}

fn dots(spots: &[Spot]) -> Vec<Element> {
    let dot = |spot: &Spot| circle(*spot, 2.4).with("fill", "none").with("stroke", RED);
    spots.iter().map(dot).collect()
}
