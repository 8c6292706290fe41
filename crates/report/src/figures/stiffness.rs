//! Stiffness against critical force (Fig. 8).

use results::columns::{MAX_STIFFNESS, SECANT_STIFFNESS};

use super::{FORCE, sheet};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, MarkLook, fold_legend, mark, slant_legend};
use crate::designs::Designs;

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 520.0;

/// The stiffnesses that a puncture has.
const STIFFNESSES: [(&str, &str, &str); 2] = [
    (
        MAX_STIFFNESS,
        "largest slope of the path",
        "stiffness $K_{max}^*$ = $K_{max}$/($E_s t$), dimensionless",
    ),
    (
        SECANT_STIFFNESS,
        "secant at the critical tilt",
        "stiffness $K_{sec}^*$ = $K_{sec}$/($E_s t$), dimensionless",
    ),
];

pub(super) fn figure(name: &str, designs: &Designs) -> String {
    let palette = designs.palette();
    let mut inside = vec![slant_legend(&palette, [78.0, 50.0])];
    inside.extend(designs.any_folded().then(|| fold_legend(&palette, [738.0, 50.0])));
    let x = ChartAxis::fit(FORCE.label, designs.numbers(FORCE.column));
    let width = 0.5 * (WIDTH - 2.0 * 78.0 - 20.0);
    for (k, (column, title, label)) in STIFFNESSES.into_iter().enumerate() {
        let y = ChartAxis::fit(label, designs.numbers(column));
        let panel = ChartPanel {
            area: Area {
                left: 78.0 + k as f64 * (width + 78.0),
                top: 92.0,
                width,
                height: HEIGHT - 92.0 - 60.0,
            },
            x: &x,
            y: &y,
            title: title.to_owned(),
            x_labels: true,
            y_labels: true,
        };
        inside.extend([panel.frame(), panel.x_name(), panel.y_name(52.0)]);
        inside.extend((0..designs.count()).filter_map(|row| {
            let at =
                panel.place(designs.number(FORCE.column, row)?, designs.number(column, row)?)?;
            let look = MarkLook { filled: true, folded: designs.folded(row) };
            Some(mark(&palette, designs.number("slant_deg", row)?, at, 3.4, look))
        }));
    }
    let title = format!("{name}: puncture stiffness against critical force");
    sheet(WIDTH, HEIGHT, &title, inside)
}
