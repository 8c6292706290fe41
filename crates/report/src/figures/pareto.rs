//! The Pareto front of the four criteria, two at a time.

use super::{COVERAGE, sheet};
use crate::axis::Axis;
use crate::chart::{Area, Panel, mark, slant_legend};
use crate::criteria::{Criteria, ranked};
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

/// `None` if fewer than two designs have every criterion.
pub(super) fn figure(name: &str, designs: &Designs) -> Option<String> {
    let all = ranked(designs);
    (all.len() > 1).then(|| draw(name, designs, &all))
}

fn draw(name: &str, designs: &Designs, all: &[(usize, Criteria)]) -> String {
    let axes: Vec<Axis> =
        (0..4).map(|k| Axis::fit(LABELS[k], all.iter().map(|(_, criteria)| criteria[k]))).collect();
    let front: Vec<bool> = all.iter().map(|(_, own)| is_unbeaten(own, all)).collect();
    let count = front.iter().filter(|on| **on).count();
    let slants = designs.values("slant_deg");
    let mut inside = vec![slant_legend(&slants, [LEFT, 50.0]), legend(count, all.len())];
    let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    for (k, (i, j)) in pairs.into_iter().enumerate() {
        let panel = Panel {
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
        let at = |criteria: &Criteria| panel.place(criteria[i], criteria[j]);
        let beaten = all.iter().zip(&front).filter(|(_, on)| !**on);
        let dot = |((_, criteria), _): (&(usize, Criteria), &bool)| {
            Some(circle(at(criteria)?, 1.6).with("fill", "#b5b5b5"))
        };
        inside.push(Element::group("beaten").containing(beaten.filter_map(dot)));
        let best = all.iter().zip(&front).filter(|(_, on)| **on);
        let marked = |((row, criteria), _): (&(usize, Criteria), &bool)| {
            Some(mark(designs.number("slant_deg", *row)?, at(criteria)?, 3.4, true))
        };
        inside.push(Element::group("front").containing(best.filter_map(marked)));
    }
    let title = format!("{name}: designs that no other beats in all four criteria");
    sheet(WIDTH, TOP + 2.0 * (PANEL[1] + BETWEEN[1]), &title, inside)
}

/// Whether no other design is at least as good in every criterion and better in one.
fn is_unbeaten(own: &Criteria, all: &[(usize, Criteria)]) -> bool {
    let beats = |other: &Criteria| {
        other.iter().zip(own).all(|(a, b)| a >= b) && other.iter().zip(own).any(|(a, b)| a > b)
    };
    !all.iter().any(|(_, other)| beats(other))
}

fn legend(front: usize, all: usize) -> Element {
    let text = format!("{front} designs on the front; grey: the other {}", all - front);
    label(&text, [LEFT + 520.0, 54.0], 12.0, Anchor::Start).with("fill", INK)
}
