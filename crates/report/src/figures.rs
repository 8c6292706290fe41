//! Figures of a sweep, from its table.

mod contours;
mod map;
mod multiples;
mod pareto;
mod quaternary;
mod search;
mod stiffness;
mod weight_slices;

use ranking::Ranking;

pub use search::{SearchFigure, SearchedDesign};

use crate::designs::{AxisValues, Designs};
use crate::label::{Anchor, label, plain};
use crate::svg::{Element, document, heading};
pub use map::{InvalidMap, MapRequest, map};

/// A figure: the name of its file, which says what it shows, and the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name, without an extension.
    pub name: String,
    /// The drawing, as SVG.
    pub svg: String,
}

/// A criterion as figures name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FigureQuantity {
    pub(crate) column: &'static str,
    pub(crate) label: &'static str,
}

pub(crate) const COVERAGE: FigureQuantity =
    FigureQuantity { column: "coverage", label: "coverage $λ$, dimensionless" };
pub(crate) const FORCE: FigureQuantity = FigureQuantity {
    column: "critical_force",
    label: "critical force $F_c^*$ = $F_c$(1 − $ν$^2)/($E_s L t$), dimensionless",
};
pub(crate) const PENETRATION: FigureQuantity =
    FigureQuantity { column: "penetration", label: "penetration $u_{max}/t$, dimensionless" };
pub(crate) const COMPLIANCE: FigureQuantity = FigureQuantity {
    column: "compliance",
    label: "flexural compliance $C_f^*$ = $C_f E_m I_m/t$, dimensionless",
};

/// Parts into which figures are divided, at most.
const PARTS: usize = 24;

/// Draws every figure for which the table has values; the Pareto fronts and the best designs for all weights
/// if they can be ranked.
///
/// A sweep with more axes than gap, aspect ratio and slant has figures for each value of those, up to 24; the name of a figure
/// and its title say which.
pub fn figures(name: &str, designs: &Designs, ranking: Option<&Ranking<'_>>) -> Vec<Figure> {
    let parts = designs.parts();
    let part = |(values, part): &(AxisValues<'_>, Designs)| {
        let all = of_part(&title(name, values), part).into_iter();
        all.map(|(file, svg)| Figure { name: file_name(file, values), svg }).collect::<Vec<_>>()
    };
    let mut figures: Vec<Figure> = parts.iter().take(PARTS).flat_map(part).collect();
    if let Some(ranking) = ranking {
        let fronts = pareto::figure(name, designs, ranking);
        figures.extend(fronts.map(|svg| Figure { name: "pareto-fronts-pairwise".to_owned(), svg }));
        let svg = quaternary::figure(name, designs, ranking);
        figures.push(Figure { name: "best-designs-by-weights-tetrahedron".to_owned(), svg });
    }
    figures
}

/// Returns the title of the figures of a part.
fn title(name: &str, values: &[(&str, &str)]) -> String {
    let words = values.iter().map(|(axis, value)| format!("{} {value}", in_words(axis)));
    std::iter::once(name.to_owned()).chain(words).collect::<Vec<_>>().join(", ")
}

/// Returns the name of a figure of a part.
fn file_name(file: &str, values: &[(&str, &str)]) -> String {
    let part = values.iter().map(|(axis, value)| format!("{}-{value}", axis.replace('_', "-")));
    std::iter::once(file.to_owned()).chain(part).collect::<Vec<_>>().join("-")
}

/// Returns the column of a parameter in words.
pub(crate) fn in_words(axis: &str) -> String {
    axis.replace("_over_t", "/t").replace('_', " ")
}

/// Draws the figures of designs that differ in gap, aspect ratio and slant.
fn of_part(name: &str, designs: &Designs) -> Vec<(&'static str, String)> {
    let multiples = [
        ("critical-force-by-gap-aspect-slant", FORCE, None),
        ("penetration-by-gap-aspect-slant", PENETRATION, None),
        ("compliance-by-gap-aspect-slant", COMPLIANCE, Some("flexure_contact")),
    ];
    let mut figures: Vec<_> = multiples
        .into_iter()
        .filter(|(_, quantity, _)| designs.has(quantity.column))
        .map(|(file, quantity, filled)| (file, multiples::figure(name, designs, quantity, filled)))
        .collect();
    if designs.has(FORCE.column) {
        figures.push(("stiffness-against-critical-force", stiffness::figure(name, designs)));
    }
    if designs.has(COVERAGE.column) {
        figures.push(("coverage-maps-by-slant", map::coverage(name, designs)));
    }
    figures
}

/// Returns a sheet of paper with a title.
pub(crate) fn sheet(width: f64, height: f64, title: &str, inside: Vec<Element>) -> String {
    let head = heading(label(title, [20.0, 26.0], 15.0, Anchor::Start));
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
