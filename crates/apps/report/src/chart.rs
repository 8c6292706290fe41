//! A panel of a figure: a frame with two axes and its content.

use crate::axis::ChartAxis;
use crate::colors::{FAINT, GRID, INK, RED};
use crate::designs::Designs;
use crate::label::{Anchor, fitting, label, upright, width};
use crate::palette::{Mark, SlantPalette};
use crate::svg::{Element, Spot, line, rect};

/// Size of tick labels, px.
const TICK: f64 = 11.0;
/// Size of axis labels, px.
pub(crate) const NAME: f64 = 13.0;

/// A rectangle on the sheet of a figure, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Area {
    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Returns the area of panel `k` in a grid with this number of columns; `self` is panel 0.
    ///
    /// `between` is the horizontal and the vertical space between panels, px.
    pub(crate) fn panel(self, k: usize, columns: usize, between: [f64; 2]) -> Self {
        let [column, row] = [k % columns, k / columns].map(|place| place as f64);
        let left = self.left + column * (self.width + between[0]);
        Self { left, top: self.top + row * (self.height + between[1]), ..self }
    }

    /// Draws the border of the area.
    pub(crate) fn border(&self) -> Element {
        rect([self.left, self.top], [self.width, self.height])
            .with("fill", "none")
            .with("stroke", FAINT)
    }

    pub(crate) fn center(&self) -> Spot {
        [self.left + 0.5 * self.width, self.top + 0.5 * self.height]
    }
}

/// A frame in a figure, with an x axis and a y axis.
#[derive(Clone, Debug)]
pub(crate) struct ChartPanel<'a> {
    pub(crate) area: Area,
    pub(crate) x: &'a ChartAxis,
    pub(crate) y: &'a ChartAxis,
    /// The title of the panel.
    pub(crate) title: String,
    /// True if the x axis has tick labels.
    pub(crate) x_labels: bool,
    /// True if the y axis has tick labels.
    pub(crate) y_labels: bool,
}

impl<'a> ChartPanel<'a> {
    /// Creates a panel without a title, with tick labels at both axes.
    pub(crate) fn new(area: Area, x: &'a ChartAxis, y: &'a ChartAxis) -> Self {
        Self { area, x, y, title: String::new(), x_labels: true, y_labels: true }
    }

    /// Draws the frame and the names of both axes; the y name is `away` px left of the panel.
    pub(crate) fn axes(&self, away: f64) -> [Element; 3] {
        [self.frame(), self.x_name(), self.y_name(away)]
    }

    /// Returns the position of the point `(x, y)` on the sheet; `None` outside the axes.
    pub(crate) fn place(&self, x: f64, y: f64) -> Option<Spot> {
        Some([self.across(x)?, self.down(y)?])
    }

    /// Returns the positions of `points` on the sheet, without the points outside the axes.
    pub(crate) fn spots(&self, points: impl IntoIterator<Item = [f64; 2]>) -> Vec<Spot> {
        points.into_iter().filter_map(|[x, y]| self.place(x, y)).collect()
    }

    fn across(&self, x: f64) -> Option<f64> {
        Some(self.area.left + self.area.width * self.x.place(x)?)
    }

    fn down(&self, y: f64) -> Option<f64> {
        Some(self.area.bottom() - self.area.height * self.y.place(y)?)
    }

    /// Draws frame, grid, ticks and title.
    pub(crate) fn frame(&self) -> Element {
        let area = &self.area;
        // The title may extend beyond the panel, up to the tick labels of the next panel.
        let size = fitting(&self.title, 12.0, area.width + 20.0);
        let title = label(&self.title, [area.center()[0], area.top - 6.0], size, Anchor::Middle);
        Element::group("frame")
            .containing(self.x_ticks())
            .containing(self.y_ticks())
            .containing([self.area.border(), title.with("fill", INK)])
    }

    pub(crate) fn x_ticks(&self) -> Vec<Element> {
        let area = self.area;
        let wanted = (area.width / 42.0).clamp(2.0, 9.0) as usize;
        let mut drawn = Vec::new();
        let mut free = f64::NEG_INFINITY;
        for tick in self.x.ticks(wanted) {
            let Some(x) = self.across(tick.value) else { continue };
            let long = if tick.label.is_some() { 5.0 } else { 2.5 };
            if tick.label.is_some() {
                drawn.push(line([x, area.top], [x, area.bottom()], GRID, 0.8));
            }
            drawn.push(line([x, area.bottom()], [x, area.bottom() - long], FAINT, 0.8));
            let Some(text) = tick.label.filter(|_| self.x_labels) else { continue };
            let half = 0.5 * width(&text, TICK);
            // Omit a label that would overlap the previous label.
            if x - half > free {
                free = x + half + 5.0;
                let spot = [x, area.bottom() + 15.0];
                drawn.push(label(&text, spot, TICK, Anchor::Middle).with("fill", INK));
            }
        }
        drawn
    }

    pub(crate) fn y_ticks(&self) -> Vec<Element> {
        let area = self.area;
        let wanted = (area.height / 34.0).clamp(2.0, 9.0) as usize;
        let mut drawn = Vec::new();
        for tick in self.y.ticks(wanted) {
            let Some(y) = self.down(tick.value) else { continue };
            let long = if tick.label.is_some() { 5.0 } else { 2.5 };
            if tick.label.is_some() {
                drawn.push(line([area.left, y], [area.right(), y], GRID, 0.8));
            }
            drawn.push(line([area.left, y], [area.left + long, y], FAINT, 0.8));
            if let Some(text) = tick.label.filter(|_| self.y_labels) {
                let spot = [area.left - 6.0, y + 4.0];
                drawn.push(label(&text, spot, TICK, Anchor::End).with("fill", INK));
            }
        }
        drawn
    }

    /// Draws the name of the x axis under the panel.
    pub(crate) fn x_name(&self) -> Element {
        let spot = [self.area.center()[0], self.area.bottom() + 36.0];
        let size = fitting(&self.x.label, NAME, 1.1 * self.area.width);
        label(&self.x.label, spot, size, Anchor::Middle).with("fill", INK)
    }

    /// Draws the name of the y axis, `away` px left of the panel.
    pub(crate) fn y_name(&self, away: f64) -> Element {
        let spot = [self.area.left - away, self.area.center()[1]];
        upright_name(&self.y.label, spot, self.area.height)
    }
}

/// Draws the name of a vertical axis, centred at `spot` and at most `room` px long.
///
/// A longer name loses its formula, the text after ` = `, but keeps its unit. If the shortened name
/// is still too long, it has a smaller font.
pub(crate) fn upright_name(name: &str, spot: Spot, room: f64) -> Element {
    let is_long = width(name, NAME) > room;
    let short = name.split_once(" = ").filter(|_| is_long).map(|(symbol, formula)| {
        let unit = formula.rsplit_once(", ").map_or("", |(_, unit)| unit);
        if unit.is_empty() { symbol.to_owned() } else { format!("{symbol}, {unit}") }
    });
    let name = short.as_deref().unwrap_or(name);
    upright(name, spot, fitting(name, NAME, room)).with("fill", INK)
}

/// Radius of a circle with about the same area as a mark, px.
const MARK: f64 = 3.4;

/// The style of the mark of a design. The slant determines the shape and colour of the mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MarkLook {
    Filled,
    Open,
    /// Pale and crossed out: the surface of the substrate folds.
    Folded,
}

impl MarkLook {
    const ALL: [Self; 3] = [Self::Filled, Self::Open, Self::Folded];

    /// Returns the style of the design in `row`, for figures of measures that a fold invalidates.
    pub(crate) fn of(designs: &Designs, row: usize) -> Self {
        if designs.folded(row) { Self::Folded } else { Self::Filled }
    }

    /// Returns the `id` of the SVG shape of `mark` in this style.
    fn shape(self, mark: Mark) -> String {
        match self {
            Self::Filled => mark.name(),
            Self::Open => format!("{}-open", mark.name()),
            Self::Folded => format!("{}-folded", mark.name()),
        }
    }

    /// Draws `mark` in this style at the origin; each `use` element sets the colour.
    fn draw(self, mark: Mark) -> Element {
        let shape = mark.draw([0.0, 0.0], MARK);
        match self {
            Self::Filled => Self::filled(shape),
            Self::Open => {
                let shape = shape.with("fill", "#fff").with("stroke", "currentColor");
                shape.at("stroke-width", 1.3)
            }
            Self::Folded => {
                // Only the shape is pale; the crossing line stays opaque.
                let pale = Self::filled(shape).with("opacity", "0.45");
                let [from, to] = [-1.4, 1.4].map(|s| [s * MARK, -s * MARK]);
                Element::new("g").containing([pale, line(from, to, RED, 1.3)])
            }
        }
    }

    fn filled(shape: Element) -> Element {
        shape.with("fill", "currentColor").with("stroke", "#fff").at("stroke-width", 0.5)
    }
}

/// Returns SVG definitions of the shapes of all marks in `palette`.
///
/// Marks refer to these shapes with `use`, because a page may have 100 000 marks.
pub(crate) fn shapes(palette: &SlantPalette) -> Element {
    let marks = Mark::ALL
        .into_iter()
        .filter(|mark| palette.slants().iter().any(|&of| palette.mark(of) == *mark));
    let looks = marks.flat_map(|mark| MarkLook::ALL.map(|look| (look, mark)));
    Element::new("defs")
        .containing(looks.map(|(look, mark)| look.draw(mark).with("id", look.shape(mark))))
}

/// Draws the mark of a slant at the position `at`.
pub(crate) fn mark(palette: &SlantPalette, slant_deg: f64, at: Spot, look: MarkLook) -> Element {
    Element::new("use")
        .with("href", format!("#{}", look.shape(palette.mark(slant_deg))))
        .at("x", at[0])
        .at("y", at[1])
        .with("color", palette.color(slant_deg))
}

/// Draws the mark of the design in `row`; `None` if the design has no slant.
///
/// The attribute `data-design` of the mark is the number of the design.
pub(crate) fn design_mark(
    designs: &Designs,
    palette: &SlantPalette,
    row: usize,
    at: Spot,
    look: MarkLook,
) -> Option<Element> {
    let mark = mark(palette, designs.number("slant_deg", row)?, at, look);
    Some(mark.with("data-design", designs.design(row)))
}

/// Height of a line of a legend, px.
pub(crate) const LINE: f64 = 18.0;

/// Draws a legend of the slants at `(x, y)`; also returns the y coordinate below the legend.
///
/// If `has_folds`, the legend also explains the marks of designs with folds. An entry that would
/// extend beyond `right` starts a new line.
pub(crate) fn mark_legend(
    palette: &SlantPalette,
    has_folds: bool,
    [x, mut y]: Spot,
    right: f64,
) -> (Element, f64) {
    let name = label("slant $α$", [x, y + 4.0], 12.0, Anchor::Start).with("fill", INK);
    // The legend contains the definitions of the shapes, because every figure with marks has a
    // legend.
    let mut legend = Element::group("legend").containing([shapes(palette), name]);
    let mut left = x + 64.0;
    let slants =
        palette.slants().iter().map(|&slant| (slant, MarkLook::Filled, format!("{slant}°")));
    let last = palette.slants().last().filter(|_| has_folds);
    let folded =
        last.map(|&slant| (slant, MarkLook::Folded, "surface folds: not valid".to_owned()));
    for (slant, look, text) in slants.chain(folded) {
        if left + 9.0 + width(&text, 12.0) > right {
            (left, y) = (x + 6.0, y + LINE);
        }
        legend.add(mark(palette, slant, [left, y], look));
        legend.add(label(&text, [left + 9.0, y + 4.0], 12.0, Anchor::Start).with("fill", INK));
        left += 28.0 + width(&text, 12.0);
    }
    (legend, y + LINE)
}
