//! Figures of a sweep, from its table.

mod coverage;
mod multiples;
mod pareto;
mod quaternary;
mod stiffness;

use ranking::Ranking;

use crate::designs::Designs;
use crate::label::{Anchor, label, plain};
use crate::palette::INK;
use crate::svg::{Element, document};

/// A figure: the name of its file, which says what it shows, and the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name, without an extension.
    pub name: &'static str,
    /// The drawing, as SVG.
    pub svg: String,
}

/// A criterion as figures name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub(crate) column: &'static str,
    pub(crate) label: &'static str,
}

pub(crate) const COVERAGE: Quantity =
    Quantity { column: "coverage", label: "coverage $λ$, dimensionless" };
pub(crate) const FORCE: Quantity = Quantity {
    column: "critical_force",
    label: "critical force $F_c^*$ = $F_c$(1 − $ν$^2)/($E_s L t$), dimensionless",
};
pub(crate) const PENETRATION: Quantity =
    Quantity { column: "penetration", label: "penetration $u_{max}/t$, dimensionless" };
pub(crate) const COMPLIANCE: Quantity = Quantity {
    column: "compliance",
    label: "flexural compliance $C_f^*$ = $C_f E_m I_m/t$, dimensionless",
};

/// Draws every figure for which the table has values; the Pareto front and the best designs for all weights
/// if they can be ranked.
pub fn figures(name: &str, designs: &Designs, ranking: Option<&Ranking<'_>>) -> Vec<Figure> {
    let multiples = [
        ("critical-force-by-gap-aspect-slant", FORCE, None),
        ("penetration-by-gap-aspect-slant", PENETRATION, None),
        ("compliance-by-gap-aspect-slant", COMPLIANCE, Some("flexure_contact")),
    ];
    let mut figures: Vec<Figure> = multiples
        .into_iter()
        .filter(|(_, quantity, _)| designs.has(quantity.column))
        .map(|(file, quantity, filled)| Figure {
            name: file,
            svg: multiples::figure(name, designs, quantity, filled),
        })
        .collect();
    if designs.has(FORCE.column) {
        let svg = stiffness::figure(name, designs);
        figures.push(Figure { name: "stiffness-against-critical-force", svg });
    }
    if designs.has(COVERAGE.column) {
        let svg = coverage::figure(name, designs);
        figures.push(Figure { name: "coverage-maps-by-slant", svg });
    }
    if let Some(ranking) = ranking {
        let pareto = pareto::figure(name, designs, ranking);
        figures.extend(pareto.map(|svg| Figure { name: "pareto-front-pairwise", svg }));
        let svg = quaternary::figure(name, designs, ranking);
        figures.push(Figure { name: "best-designs-by-weights-tetrahedron", svg });
    }
    figures
}

/// Returns a sheet of paper with a title.
pub(crate) fn sheet(width: f64, height: f64, title: &str, inside: Vec<Element>) -> String {
    let head = label(title, [20.0, 26.0], 15.0, Anchor::Start)
        .with("fill", INK)
        .with("font-weight", "bold");
    document(width, height, &plain(title), std::iter::once(head).chain(inside).collect())
}

/// Returns the number of columns in which `count` panels stand that share their axes.
pub(crate) fn columns(count: usize) -> usize {
    match count {
        0..=3 => count.max(1),
        4 => 2,
        5..=6 => 3,
        7..=8 => 4,
        _ => 5,
    }
}
