//! Stiffness against critical force (Fig. 8).

use results::columns::name;

use super::names::axis_label;
use super::{of_perfect, physical, sheet, thinned};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, MarkLook, design_mark, mark_legend};
use crate::designs::Designs;

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 520.0;

/// The stiffnesses of a puncture, each with its description.
const STIFFNESSES: [(&str, &str); 2] = [
    (name::MAX_STIFFNESS, "largest slope of the path"),
    (name::SECANT_STIFFNESS, "secant at the critical tilt"),
];

pub(crate) fn figure(name: &str, designs: &Designs) -> String {
    let palette = designs.palette();
    let mut inside = vec![mark_legend(&palette, designs.any_folded(), [78.0, 50.0])];
    // Samples have no stiffness, so both axes show the perfect design.
    let physical = |measure: &str| physical(designs, measure).unwrap_or(measure.to_owned());
    let force = physical(name::CRITICAL_FORCE);
    let x = ChartAxis::fit(&axis_label(&force), designs.numbers(&force));
    let width = 0.5 * (WIDTH - 2.0 * 78.0 - 20.0);
    for (k, (measure, title)) in STIFFNESSES.into_iter().enumerate() {
        let stiffness = physical(measure);
        let y = ChartAxis::fit(&axis_label(&stiffness), designs.numbers(&stiffness));
        let left = 78.0 + k as f64 * (width + 78.0);
        let area = Area { left, top: 92.0, width, height: HEIGHT - 92.0 - 60.0 };
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
    sheet(WIDTH, HEIGHT, &title, inside)
}
