//! Figure of stiffness against critical force, like Fig. 8 of the paper.

use results::columns::name;

use super::names::axis_label;
use super::{of_perfect, sheet, shown_column, thinned};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, MarkLook, design_mark, mark_legend};
use crate::designs::Designs;
use crate::paper::Paper;

const WIDTH: f64 = 1000.0;

/// The stiffnesses of a puncture, each with its description.
const STIFFNESSES: [(&str, &str); 2] = [
    (name::MAX_STIFFNESS, "largest slope of the path"),
    (name::SECANT_STIFFNESS, "secant at the critical tilt"),
];

/// Margins left and right of the panels, px.
const MARGINS: [f64; 2] = [78.0, 20.0];
/// Minimum width of a panel, px.
const LEAST: f64 = 240.0;
/// Height of a panel on wide and narrow paper, px.
const HEIGHTS: [f64; 2] = [368.0, 220.0];

pub(crate) fn figure(name: &str, designs: &Designs, paper: Paper) -> String {
    let palette = designs.palette();
    let full = paper.width(WIDTH);
    let between = [MARGINS[0], 76.0];
    let room = full - MARGINS[0] - MARGINS[1];
    let columns = paper.columns(STIFFNESSES.len(), room, LEAST, between[0]);
    let start = if paper.is_narrow(WIDTH) { 20.0 } else { MARGINS[0] };
    let (legend, below) = mark_legend(&palette, designs.any_folded(), [start, 50.0], full - 16.0);
    let mut inside = vec![legend];
    // Tables have no stiffness of samples, so both axes show the perfect designs.
    let force = shown_column(designs, name::CRITICAL_FORCE);
    let x = ChartAxis::fit(&axis_label(&force), designs.numbers(&force));
    let first = Area {
        left: MARGINS[0],
        top: (below + 24.0).max(92.0),
        width: (room - between[0] * (columns - 1) as f64) / columns as f64,
        height: HEIGHTS[usize::from(columns == 1)],
    };
    for (k, (measure, title)) in STIFFNESSES.into_iter().enumerate() {
        let stiffness = shown_column(designs, measure);
        let y = ChartAxis::fit(&axis_label(&stiffness), designs.numbers(&stiffness));
        let area = first.panel(k, columns, between);
        let title = title.to_owned();
        let panel = ChartPanel { title, ..ChartPanel::new(area, &x, &y) };
        inside.extend(panel.axes(52.0));
        inside.extend(thinned(designs.count(), STIFFNESSES.len()).filter_map(|row| {
            let [force, stiffness] = [&force, &stiffness].map(|name| designs.number(name, row));
            design_mark(
                designs,
                &palette,
                row,
                panel.place(force?, stiffness?)?,
                MarkLook::of(designs, row),
            )
        }));
    }
    let title = format!("{name}: puncture stiffness against critical force{}", of_perfect(designs));
    let last = first.panel(STIFFNESSES.len() - 1, columns, between);
    sheet(full, last.bottom() + 60.0, &title, inside)
}
