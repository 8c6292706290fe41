//! The Pareto front of the four criteria, two at a time.

use ranking::{RankedDesign, Ranking, Weights};

use super::{COVERAGE, sheet};
use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel, mark, slant_legend};
use crate::designs::Designs;
use crate::label::{Anchor, label};
use crate::palette::INK;
use crate::svg::{Element, circle};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 74.0;
const BETWEEN: [f64; 2] = [74.0, 62.0];
const TOP: f64 = 80.0;
const PANEL: [f64; 2] = [244.0, 240.0];

/// The criteria, each the larger the better.
const LABELS: [&str; 4] = [
    COVERAGE.label,
    "critical force $F_c^*$, dimensionless",
    "penetration resistance $t/u_{max}$, dimensionless",
    "flexural compliance $C_f^*$, dimensionless",
];

/// Draws the figure; `None` if fewer than two designs have every criterion.
pub(super) fn figure(name: &str, designs: &Designs, ranking: &Ranking<'_>) -> Option<String> {
    let all = ranking.by_fitness(Weights::BALANCED);
    (all.len() > 1).then(|| draw(name, designs, &all))
}

fn draw(name: &str, designs: &Designs, all: &[RankedDesign<'_>]) -> String {
    let axis = |k: usize| ChartAxis::fit(LABELS[k], all.iter().map(|design| design.criteria()[k]));
    let axes: Vec<ChartAxis> = (0..4).map(axis).collect();
    let (front, beaten): (Vec<_>, Vec<_>) = all.iter().partition(|design| design.on_front());
    let palette = designs.palette();
    let mut inside = vec![slant_legend(&palette, [LEFT, 50.0]), legend(front.len(), beaten.len())];
    let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    for (k, (i, j)) in pairs.into_iter().enumerate() {
        let panel = ChartPanel {
            area: Area {
                left: LEFT + (k % 3) as f64 * (PANEL[0] + BETWEEN[0]),
                top: TOP + (k / 3) as f64 * (PANEL[1] + BETWEEN[1]),
                width: PANEL[0],
                height: PANEL[1],
            },
            x: &axes[i],
            y: &axes[j],
            title: String::new(),
            x_labels: true,
            y_labels: true,
        };
        inside.extend([panel.frame(), panel.x_name(), panel.y_name(48.0)]);
        let at = |design: &RankedDesign<'_>| {
            let criteria = design.criteria();
            panel.place(criteria[i], criteria[j])
        };
        let dot =
            |design: &&RankedDesign<'_>| Some(circle(at(design)?, 1.6).with("fill", "#b5b5b5"));
        inside.push(Element::group("beaten").containing(beaten.iter().filter_map(dot)));
        let marked = |design: &&RankedDesign<'_>| {
            let slant = designs.number("slant_deg", design.row())?;
            Some(mark(&palette, slant, at(design)?, 3.4, true))
        };
        inside.push(Element::group("front").containing(front.iter().filter_map(marked)));
    }
    let title = format!("{name}: designs that no other beats in all four criteria");
    sheet(WIDTH, TOP + 2.0 * (PANEL[1] + BETWEEN[1]), &title, inside)
}

fn legend(front: usize, beaten: usize) -> Element {
    let text = format!("{front} designs on the front; grey: the other {beaten}");
    label(&text, [LEFT + 520.0, 54.0], 12.0, Anchor::Start).with("fill", INK)
}
