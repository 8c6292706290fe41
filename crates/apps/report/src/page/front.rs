//! The figure of the designs that a search found, together with the designs of a grid.

use ranking::{Criterion, Requirement};
use serde_json::{Map, Value, json};
use text::visible;

use super::data::cells;
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel};
use crate::designs::Designs;
use crate::figures::names::axis_label;
use crate::figures::{sheet, thinned};
use crate::svg::{Element, Spot, circle, polygon, polyline};

/// Height of a panel, px.
const PANEL: f64 = 360.0;
/// Margins of a panel, px: left, right, above, below.
const MARGINS: [f64; 4] = [74.0, 16.0, 46.0, 58.0];
const WIDTH: f64 = 1000.0;
/// Colours of the front and of the grid designs.
const COLORS: [&str; 2] = ["#b34700", "#b9c1c9"];

/// The designs found by `squama optimise`, for the page of a grid.
#[derive(Clone, Debug)]
pub struct PageFront {
    /// The folder of the search, as given on the command line.
    pub folder: String,
    /// The criteria of the search, at least one.
    pub objectives: Vec<Criterion>,
    /// The requirements of the search.
    pub requirements: Vec<Requirement>,
    /// The columns of sample statistics that the search used.
    pub statistics: Vec<String>,
    /// True if the search excluded designs with a fold of the surface.
    pub sound: bool,
    /// The columns of the varied parameters.
    pub variables: Vec<String>,
    /// Fixed parameters of the search that differ from the grid, as text.
    pub differences: Vec<String>,
    /// The found designs, with the columns of the grid, binding constraints and prices.
    pub designs: Designs,
}

impl PageFront {
    /// Returns the columns on the axes of the panels: the objectives.
    ///
    /// If there is a single objective, the second axis is the first requirement or variable.
    fn axes(&self) -> Vec<&str> {
        let objectives = self.objectives.iter().map(|objective| objective.column.as_ref());
        let required = self.requirements.iter().map(|requirement| requirement.column.as_str());
        let others = required.chain(self.variables.iter().map(String::as_str));
        let others = others.filter(|other| *other != self.objectives[0].column);
        objectives.chain(others.take(usize::from(self.objectives.len() == 1))).collect()
    }

    /// Draws the found designs on top of the designs of `grid`, a panel for each pair of axes.
    pub(super) fn figure(&self, grid: &Designs) -> String {
        let axes = self.axes();
        let pairs = (0..axes.len()).flat_map(|i| (i + 1..axes.len()).map(move |j| (i, j)));
        let pairs: Vec<[&str; 2]> = pairs.map(|(i, j)| [axes[i], axes[j]]).collect();
        let [left, right, above, below] = MARGINS;
        let columns = pairs.len().clamp(1, 3);
        let step = (WIDTH - right) / columns as f64;
        let dot = circle([0.0, 0.0], 2.2).with("fill", "currentColor").with("id", "grid-design");
        let found = polygon(&[[0.0, -6.0], [6.0, 0.0], [0.0, 6.0], [-6.0, 0.0]]);
        let found = found.with("fill", COLORS[0]).with("stroke", "#fff").with("id", "found");
        let mut inside = vec![Element::new("defs").containing([dot, found])];
        for (k, pair) in pairs.iter().enumerate() {
            let area = Area {
                left: left + (k % columns) as f64 * step,
                top: above + (k / columns) as f64 * (PANEL + below),
                width: step - left,
                height: PANEL,
            };
            inside.extend(self.panel(grid, pair, area, pairs.len()));
        }
        let rows = pairs.len().div_ceil(columns) as f64;
        sheet(WIDTH, above + rows * (PANEL + below), "Designs found by the search", inside)
    }

    /// Draws one panel with the designs of the grid and the found designs.
    ///
    /// If the search had two objectives, the found designs form a front, and a line joins them.
    fn panel(&self, grid: &Designs, pair: &[&str; 2], area: Area, panels: usize) -> Vec<Element> {
        let [x, y] = &pair.map(|column| {
            let values = grid.numbers(column).chain(self.designs.numbers(column));
            ChartAxis::fit(&axis_label(column), values)
        });
        let panel = ChartPanel::new(area, x, y);
        let of_grid = thinned(grid.count(), panels).filter_map(|row| {
            let mark = mark("#grid-design", spot(&panel, grid, pair, row)?);
            let mark = mark.with("color", COLORS[1]);
            Some(mark.with("data-design", grid.design(row)))
        });
        let found = (0..self.designs.count())
            .filter_map(|row| Some((row, spot(&panel, &self.designs, pair, row)?)));
        let mut found: Vec<(usize, Spot)> = found.collect();
        // The line needs designs sorted from left to right; the table may have another order.
        found.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        let joined = if self.objectives.len() == 2 { found.as_slice() } else { &[] };
        let line: Vec<Spot> = joined.iter().map(|(_, spot)| *spot).collect();
        let line = polyline(&line).with("stroke", COLORS[0]).at("stroke-width", 2.0);
        let found =
            found.iter().map(|&(k, spot)| mark("#found", spot).with("data-front", k.to_string()));
        let grid = Element::group("grid").containing(of_grid);
        let found =
            Element::group("found").containing([line.with("class", "line")]).containing(found);
        vec![panel.frame(), panel.x_name(), panel.y_name(52.0), grid, found]
    }

    /// Returns the data of the front as the scripts of the page read them.
    pub(super) fn to_json(&self) -> Value {
        let headers = self.designs.headers().iter();
        let values = headers.map(|header| (header.clone(), cells(&self.designs, header).into()));
        json!({
            "folder": visible(&self.folder),
            "objectives": self.objectives.iter().map(|criterion| json!({
                "column": criterion.column, "goal": criterion.goal.key(),
            })).collect::<Vec<_>>(),
            "requirements": self.requirements.iter().map(|requirement| json!({
                "column": requirement.column, "sign": requirement.relation.sign(),
                "limit": requirement.limit,
            })).collect::<Vec<_>>(),
            "sound": self.sound,
            "made": self.statistics,
            "variables": self.variables,
            "differences": self.differences,
            "axes": self.axes(),
            "count": self.designs.count(),
            "values": values.collect::<Map<_, _>>(),
        })
    }
}

/// Returns the spot of the design in `row` on a panel with the two columns `pair` as axes.
///
/// `None` if the design has no value in a column, or lies outside the panel.
fn spot(panel: &ChartPanel, designs: &Designs, pair: &[&str; 2], row: usize) -> Option<Spot> {
    let [x, y] = pair.map(|column| designs.number(column, row));
    panel.place(x?, y?)
}

fn mark(shape: &str, [x, y]: Spot) -> Element {
    Element::new("use").with("href", shape).at("x", x).at("y", y)
}
