//! Figure of a fit: measured points, the fitted curve, and the residuals.

use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel};
use crate::colors::{FAINT, INK, RED};
use crate::figures::sheet;
use crate::label::{Anchor, label};
use crate::svg::{Element, Spot, circle, line, polyline};

/// A measured curve with its fitted curve.
#[derive(Clone, Copy, Debug)]
pub struct FitPanel<'a> {
    /// Name of the file with the measured curve.
    pub file: &'a str,
    /// Names of the x axis and the y axis, each with its unit after a comma.
    pub axes: &'a [String; 2],
    /// Position, measured value and fitted value of each point.
    pub points: &'a [[f64; 3]],
    /// Standard deviation of the residuals.
    pub noise: f64,
}

/// Width and height of a panel, px.
const PANEL: [f64; 2] = [330.0, 230.0];
/// Top of the first panel, px.
const TOP: f64 = 92.0;
/// Horizontal and vertical space between panels, px.
const ROOM: [f64; 2] = [92.0, 92.0];

/// Draws each measured and fitted curve, with the residuals to the right of the curve.
///
/// Lines mark a residual of zero and the range of 95 % of normally distributed residuals.
pub fn fit_figure(name: &str, curves: &[FitPanel]) -> String {
    let [width, height] = PANEL;
    let first = Area { left: 78.0, top: TOP, width, height };
    let note = "left: measured points and the fitted curve; right: residuals (95 % of random \
                residuals lie between the outer lines)";
    let mut inside = vec![label(note, [20.0, 48.0], 12.0, Anchor::Start).with("fill", INK)];
    for (row, curve) in curves.iter().enumerate() {
        let [left, right] = [0, 1].map(|column| first.panel(2 * row + column, 2, ROOM));
        inside.extend(curve.curve(left));
        inside.extend(curve.residuals(right));
        let text = Element::new("text").at("x", left.left).at("y", left.top - 12.0);
        let text = text.at("font-size", 13.0);
        inside.push(text.with("fill", INK).text(curve.file));
    }
    let paper = [2.0 * width + ROOM[0] + 110.0, TOP + curves.len() as f64 * (height + ROOM[1])];
    sheet(paper[0], paper[1], &format!("{name}: measured and fitted curves, and residuals"), inside)
}

impl FitPanel<'_> {
    fn curve(&self, area: Area) -> Vec<Element> {
        let values = self.points.iter().flat_map(|point| [point[1], point[2]]);
        let (x, y) = (self.x_axis(), ChartAxis::spanning(&self.axes[1], values));
        let panel = ChartPanel::new(area, &x, &y);
        let mut fitted = self.points.to_vec();
        // The measured points may have any order, but the line needs sorted points.
        fitted.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let fitted = polyline(&panel.spots(fitted.iter().map(|p| [p[0], p[2]])));
        let fitted = fitted.with("stroke", INK).at("stroke-width", 1.6);
        let measured = dots(panel.spots(self.points.iter().map(|p| [p[0], p[1]])));
        panel.axes(58.0).into_iter().chain(measured).chain([fitted, area.border()]).collect()
    }

    fn residuals(&self, area: Area) -> Vec<Element> {
        let residuals: Vec<_> = self.points.iter().map(|p| [p[0], p[1] - p[2]]).collect();
        let bounds = [-1.96 * self.noise, 0.0, 1.96 * self.noise];
        let unit = self.axes[1].find(", ").map_or("", |end| &self.axes[1][end..]);
        let name = format!("measured − fitted{unit}");
        let y = ChartAxis::spanning(&name, residuals.iter().map(|p| p[1]).chain(bounds));
        let x = self.x_axis();
        let panel = ChartPanel::new(area, &x, &y);
        let bounds = bounds.into_iter().filter_map(|value| {
            let [_, y] = panel.place(self.points[0][0], value)?;
            Some(line([area.left, y], [area.right(), y], FAINT, 1.0))
        });
        panel.axes(58.0).into_iter().chain(bounds).chain(dots(panel.spots(residuals))).collect()
    }

    /// Returns the axis of the measured positions.
    fn x_axis(&self) -> ChartAxis {
        ChartAxis::spanning(&self.axes[0], self.points.iter().map(|point| point[0]))
    }
}

fn dots(spots: Vec<Spot>) -> impl Iterator<Item = Element> {
    spots.into_iter().map(|spot| circle(spot, 2.4).with("fill", "none").with("stroke", RED))
}
