//! Figures of a sweep, from its table.

mod contours;
pub(crate) mod map;
pub(crate) mod multiples;
pub(crate) mod names;
mod parallel;
pub(crate) mod pareto;
mod quaternary;
mod search;
pub(crate) mod stiffness;
pub(crate) mod weight_slices;

use std::borrow::Cow;

use ranking::{CRITERIA, Ranking, Weights};
use results::Quantity::{Force, Length, Moment, Stiffness};
use results::columns::{is_invalid_after_fold, name, physical_source};

pub(crate) use names::name_with_unit;
use names::with_value;
pub use parallel::ParallelFigure;
pub use search::{EVALUATION, SearchFigure, SearchedDesign};

use crate::designs::Designs;
use crate::label::{Anchor, fitting, label, plain, wrapped};
use crate::paper::Paper;
use crate::svg::{Element, document, heading};
pub use map::{InvalidMap, MapRequest, map};

/// A figure: its file name and drawing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// File name without extension.
    pub name: String,
    /// The drawing, as SVG.
    pub svg: String,
    /// A note on panels that do not fit on narrow paper; `None` if all panels are drawn.
    pub omitted: Option<String>,
}

impl Figure {
    /// Creates a figure that omits no panel.
    pub fn new(name: &str, svg: String) -> Self {
        Self { name: name.to_owned(), svg, omitted: None }
    }
}

/// A quantity in figures: its column, and for random gaps the two columns of its quantile band.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub(crate) column: String,
    pub(crate) band: Option<[String; 2]>,
}

impl Quantity {
    /// Chooses the columns that show a measure, in physical units if the table has such columns.
    ///
    /// If designs have samples, the column is the median, and the band consists of the 5 % and 95 %
    /// quantiles. Otherwise the column is the nominal value.
    pub(crate) fn of(designs: &Designs, measure: &str) -> Self {
        let [low, median, high] = ["p05", "p50", "p95"]
            .map(|end| Some(format!("{measure}_{end}")).filter(|name| designs.has(name)));
        let band = low.zip(high);
        Self {
            column: shown_column(designs, median.as_deref().unwrap_or(measure)),
            band: band.map(|(low, high)| [low, high].map(|name| shown_column(designs, &name))),
        }
    }

    /// Returns all numbers that the axes must cover.
    fn numbers(&self, designs: &Designs) -> impl Iterator<Item = f64> {
        let columns = std::iter::once(&self.column).chain(self.band.iter().flatten());
        columns.flat_map(|column| designs.numbers(column))
    }
}

/// Returns true if a fold of the surface invalidates the values of a column.
pub(crate) fn is_affected_by_folds(column: &str) -> bool {
    is_invalid_after_fold(column)
}

/// Returns words that end the title of a figure of only the perfect designs.
///
/// Empty if the sweep has no samples of random gaps.
pub(crate) fn of_perfect(designs: &Designs) -> &'static str {
    let has_samples = MULTIPLES.iter().any(|(measure, _)| designs.has(&format!("{measure}_p50")));
    if has_samples { ", of the perfect designs" } else { "" }
}

/// Returns the column of a measure in physical units, if the table has one.
pub(crate) fn physical(designs: &Designs, measure: &str) -> Option<String> {
    physical_of(designs.headers().iter().map(String::as_str), measure).map(str::to_owned)
}

/// Returns the column of a measure in physical units, or otherwise its dimensionless column.
pub(crate) fn shown_column(designs: &Designs, measure: &str) -> String {
    physical(designs, measure).unwrap_or_else(|| measure.to_owned())
}

/// Returns the column among `headers` that contains a measure in physical units, if any.
pub(crate) fn physical_of<'h>(
    headers: impl IntoIterator<Item = &'h str>,
    measure: &str,
) -> Option<&'h str> {
    headers.into_iter().find(|name| {
        let source = physical_source(name);
        // Columns per width and inverted columns are different quantities.
        source.is_some_and(|(of, quantity)| {
            of == measure && matches!(quantity, Force | Length | Stiffness | Moment)
        })
    })
}

/// Maximum number of combinations of parameter values for which figures are drawn.
///
/// The parameters are all varied parameters besides gap, aspect ratio and slant.
pub(crate) const PARTS: usize = 24;

/// Draws every figure for which the table has values.
///
/// With a ranking, the figures include the Pareto fronts and the best designs for all weights. If a
/// sweep has axes besides gap, aspect ratio and slant, each combination of their values has its own
/// figures, for at most 24 combinations. The names and titles of these figures include the values.
///
/// Fronts and best designs come from the whole ranking, even if only some `designs` are shown. On
/// narrow paper figures have fewer panels.
pub fn figures(
    name: &str,
    designs: &Designs,
    ranking: Option<(&Designs, &Ranking<'_>)>,
    paper: Paper,
) -> Vec<Figure> {
    let parts = designs.parts();
    let mut figures = Vec::new();
    for (values, part) in parts.iter().take(PARTS) {
        let all = of_part(&title(name, values), part, paper).into_iter();
        figures
            .extend(all.map(|figure| Figure { name: file_name(&figure.name, values), ..figure }));
    }
    if let Some((designs, ranking)) = ranking {
        // Both figures need the four criteria of the paper, and user-defined criteria may differ.
        let is_drawn = has_paper_criteria(ranking);
        let ranked = is_drawn.then(|| ranking.by_fitness(Weights::BALANCED));
        let mut rows: Vec<usize> = ranked.into_iter().flatten().map(|d| d.row()).collect();
        // Sort the designs in the order of the table, as on the page.
        rows.sort_unstable();
        let axes = pareto::physical_axes(designs);
        let fronts = pareto::figure(name, designs, &rows, &axes, paper);
        figures.extend(fronts.map(|svg| Figure::new("pareto-fronts-pairwise", svg)));
        if is_drawn {
            let svg = quaternary::figure(name, designs, ranking, paper);
            figures.push(Figure::new("best-designs-by-weights-tetrahedron", svg));
        }
    }
    figures
}

/// Returns true if the criteria are the four of the paper, in any unit.
fn has_paper_criteria(ranking: &Ranking<'_>) -> bool {
    let criteria = &ranking.preferences().criteria;
    criteria.len() == CRITERIA.len()
        && criteria.iter().zip(&CRITERIA).all(|(own, papers)| {
            let source = physical_source(&own.column).map(|(source, _)| source);
            own.column == papers.column || source == Some(papers.column.as_ref())
        })
}

/// Returns the title of a figure: `name` and the parameters `values`.
fn title(name: &str, values: &[(&str, Cow<'_, str>)]) -> String {
    let words = values.iter().map(with_value);
    std::iter::once(name.to_owned()).chain(words).collect::<Vec<_>>().join(", ")
}

/// Returns the file name of a figure: `file` and the parameters `values`.
fn file_name(file: &str, values: &[(&str, Cow<'_, str>)]) -> String {
    let part = values.iter().map(|(axis, value)| format!("{}-{value}", axis.replace('_', "-")));
    std::iter::once(file.to_owned()).chain(part).collect::<Vec<_>>().join("-")
}

/// Measures with a figure against gap, aspect ratio and slant.
///
/// The second entry is the column that is `yes` for designs with filled marks. `None` fills all.
pub(crate) const MULTIPLES: [(&str, Option<&str>); 3] = [
    (name::CRITICAL_FORCE, None),
    (name::PENETRATION, None),
    (name::COMPLIANCE, Some(name::FLEXURE_CONTACT)),
];

/// Draws the figures of designs that differ in gap, aspect ratio and slant.
fn of_part(name: &str, designs: &Designs, paper: Paper) -> Vec<Figure> {
    let measured = MULTIPLES.into_iter().filter(|(measure, _)| designs.has(measure));
    let multiples = measured.map(|(measure, filled)| {
        let quantity = Quantity::of(designs, measure);
        Figure {
            name: format!("{}-by-gap-aspect-slant", measure.replace('_', "-")),
            svg: multiples::figure(name, designs, &quantity, filled, paper),
            omitted: multiples::omitted(designs, paper),
        }
    });
    let mut figures: Vec<_> = multiples.collect();
    if designs.has(name::CRITICAL_FORCE) {
        let svg = stiffness::figure(name, designs, paper);
        figures.push(Figure::new("stiffness-against-critical-force", svg));
    }
    if designs.has(name::COVERAGE) {
        let map = map::by_slant(name, designs, name::COVERAGE, paper);
        figures.push(Figure { name: "coverage-maps-by-slant".to_owned(), ..map });
    }
    let has_modes =
        (0..designs.count()).any(|row| !designs.text(name::FIRST_FAILURE, row).is_empty());
    if has_modes {
        let map = map::of_failures(name, designs, paper);
        figures.push(Figure { name: "first-failure-by-gap-slant".to_owned(), ..map });
    }
    figures
}

/// Usual font size of a title, and smallest font size on narrow paper, px.
const TITLE: [f64; 2] = [15.0, 10.0];

/// Returns a figure with a title.
///
/// A title that does not fit at the smallest font size is cut.
pub(crate) fn sheet(width: f64, height: f64, title: &str, inside: Vec<Element>) -> String {
    // Bold letters are wider.
    let room = (width - 36.0) / 1.05;
    let size = fitting(title, TITLE[0], room).max(TITLE[1]);
    let lines = wrapped(title, size, room);
    let shown = match lines.as_slice() {
        [first, _, ..] => format!("{first} …"),
        _ => title.to_owned(),
    };
    let head = heading(label(&shown, [20.0, 26.0], size, Anchor::Start));
    document(width, height, &plain(title), std::iter::once(head).chain(inside).collect())
}

/// Returns the number of columns of a grid of `count` panels.
pub(crate) fn columns(count: usize) -> usize {
    match count {
        0..=3 => count.max(1),
        4 => 2,
        5..=6 => 3,
        7..=8 => 4,
        _ => 5,
    }
}

/// Approximate maximum number of marks in a figure; more would overlap and enlarge pages.
const DRAWN: usize = 10_000;

/// Selects the designs that get a mark in each of `panels` panels.
///
/// Returns all indices below `count`, or every n-th index if all would exceed [`DRAWN`] marks.
pub(crate) fn thinned(count: usize, panels: usize) -> impl Iterator<Item = usize> {
    (0..count).step_by((count * panels).div_ceil(DRAWN).max(1))
}
