//! Limits of failure on curves of force against displacement, with names that do not overlap.

use skin::puncture::FailureMode;

use super::Curve;
use crate::chart::{Area, ChartPanel};
use crate::colors::{INK, failure_color};
use crate::label::{Anchor, label, width};
use crate::svg::{Element, Spot, circle, line};

/// A limit of failure of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FailureLimit {
    /// The mode of failure.
    pub mode: FailureMode,
    /// `u*` at which the path first reaches the limit.
    ///
    /// `None` for a limit across the row, which has only a force.
    pub displacement: Option<f64>,
    /// `F*` at the limit.
    pub force: f64,
    /// True for the first failure of the design.
    pub is_first: bool,
}

/// Font size of names, px.
const SIZE: f64 = 11.5;
/// Height of a name with a margin, px.
const HEIGHT: f64 = 14.0;
/// Radius of a mark, px.
const RADIUS: f64 = 4.2;
/// Possible distances of a name from its mark, px.
const DISTANCES: [f64; 9] = [11.0, 17.0, 26.0, 38.0, 52.0, 70.0, 92.0, 120.0, 160.0];
/// Number of directions from a mark in which its name may be placed.
const DIRECTIONS: u32 = 32;
/// Distance beyond which a line joins a name and its mark, px.
const JOINED: f64 = 13.0;
/// Distance between neighbouring samples of a line, px.
const SAMPLE: f64 = 2.0;
/// Horizontal distance between neighbouring positions that a name may have, px.
const ALONG: f64 = 12.0;

/// A rectangle on the sheet, px.
#[derive(Clone, Copy)]
struct Bounds {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Bounds {
    /// Returns the bounds of a text of this width.
    ///
    /// `(x, y)` is the left end of the text if `begins` is true, otherwise the right end, at half
    /// of the height.
    fn beside([x, y]: Spot, width: f64, begins: bool) -> Self {
        let left = if begins { x } else { x - width };
        let (top, bottom) = (y - 0.5 * HEIGHT, y + 0.5 * HEIGHT);
        Self { left, top, right: left + width, bottom }
    }

    fn is_inside(&self, area: Area) -> bool {
        self.left > area.left + 2.0
            && self.right < area.right() - 2.0
            && self.top > area.top + 2.0
            && self.bottom < area.bottom() - 2.0
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// Counts the spots within `margin` of this rectangle.
    fn count(&self, spots: &[Spot], margin: f64) -> usize {
        let near = spots.iter().filter(|[x, y]| {
            *x > self.left - margin
                && *x < self.right + margin
                && *y > self.top - margin
                && *y < self.bottom + margin
        });
        near.count()
    }
}

/// The name of a limit and its position.
struct Name {
    text: String,
    is_first: bool,
    bounds: Bounds,
    /// The line from the mark to the name; `None` for a name next to its mark.
    leader: Option<[Spot; 2]>,
}

/// Places names in a panel, without overlaps with marks and other names.
///
/// A name covers a curve only if no better position is free.
struct Names {
    area: Area,
    marks: Vec<Spot>,
    /// Samples of the curves.
    curves: Vec<Spot>,
    /// Samples of the leaders.
    leaders: Vec<Spot>,
    placed: Vec<Name>,
}

impl Names {
    /// Adds a name at the best of the free `positions`; adds nothing if none is free.
    fn add(&mut self, (text, is_first): (String, bool), positions: impl Iterator<Item = Position>) {
        let mut best: Option<(f64, Bounds, Option<[Spot; 2]>)> = None;
        for (bounds, leader, distance) in positions {
            // The cost of a position is at least its distance, so skip positions that are farther
            // away than the lowest cost.
            let is_worse = best.as_ref().is_some_and(|(least, ..)| distance >= *least);
            if is_worse || !self.is_free(&bounds) {
                continue;
            }
            let line = leader.map(samples).unwrap_or_default();
            // A crossing of a leader and a name has the highest cost.
            let crossed: usize = self.placed.iter().map(|name| name.bounds.count(&line, 1.0)).sum();
            let crossed = crossed + bounds.count(&self.leaders, 1.0);
            let on_curve = bounds.count(&self.curves, 1.5);
            let cost = distance + 20.0 * on_curve as f64 + 1e4 * crossed as f64;
            if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                best = Some((cost, bounds, leader));
            }
        }
        if let Some((_, bounds, leader)) = best {
            self.leaders.extend(leader.map(samples).unwrap_or_default());
            self.placed.push(Name { text, is_first, bounds, leader });
        }
    }

    /// Returns true if a name with these bounds overlaps no border, mark or other name.
    fn is_free(&self, bounds: &Bounds) -> bool {
        bounds.is_inside(self.area)
            && bounds.count(&self.marks, RADIUS + 2.0) == 0
            && self.placed.iter().all(|name| !name.bounds.overlaps(bounds))
    }

    fn drawn(&self) -> impl Iterator<Item = Element> {
        self.placed.iter().flat_map(|name| {
            let leader = name.leader.map(|[from, to]| line(from, to, INK, 0.6));
            let spot = [name.bounds.left, name.bounds.bottom - 3.5];
            let text = label(&name.text, spot, SIZE, Anchor::Start).with("fill", INK);
            let weight = if name.is_first { "bold" } else { "normal" };
            leader.into_iter().chain([text.with("font-weight", weight)])
        })
    }
}

/// Formats a force with three significant digits.
fn three_digits(force: f64) -> String {
    let decimals = 2.0 - force.abs().max(f64::MIN_POSITIVE).log10().floor();
    format!("{force:.*}", decimals.clamp(0.0, 12.0) as usize)
}

/// Returns points on the line between two spots, at most [`SAMPLE`] apart.
fn samples([from, to]: [Spot; 2]) -> Vec<Spot> {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let parts = (length / SAMPLE).ceil().max(1.0) as usize;
    let fractions = (0..=parts).map(|k| k as f64 / parts as f64);
    fractions.map(|part| [0, 1].map(|i| from[i] + (to[i] - from[i]) * part)).collect()
}

/// A position of a name: its bounds, its leader, and its distance from the mark.
type Position = (Bounds, Option<[Spot; 2]>, f64);

/// Lists possible positions of a name: first around its mark, then on a grid over the panel.
///
/// The grid is for marks without free space around them.
fn around(mark: Spot, width: f64, area: Area) -> impl Iterator<Item = Position> {
    let near = DISTANCES.into_iter().flat_map(|r| (0..DIRECTIONS).map(move |k| (r, k)));
    let near = near.map(move |(distance, k)| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(DIRECTIONS)).sin_cos();
        let spot = [mark[0] + distance * cos, mark[1] + distance * sin];
        let from = [mark[0] + RADIUS * cos, mark[1] + RADIUS * sin];
        let bounds = Bounds::beside(spot, width, cos >= 0.0);
        (bounds, (distance > JOINED).then_some([from, spot]), distance)
    });
    let [columns, rows] = [area.width / ALONG, area.height / HEIGHT].map(|count| count as usize);
    let grid = (0..columns).flat_map(move |column| (0..rows).map(move |row| (column, row)));
    let grid = grid.map(move |(column, row)| {
        let x = area.left + 3.0 + ALONG * column as f64;
        let y = area.top + 3.0 + HEIGHT * (row as f64 + 0.5);
        let bounds = Bounds::beside([x, y], width, true);
        let end = if mark[0] > x + 0.5 * width { [bounds.right, y] } else { [x, y] };
        let distance = (end[0] - mark[0]).hypot(end[1] - mark[1]);
        (bounds, Some([mark, end]), distance)
    });
    near.chain(grid)
}

/// Lists possible positions of the name of a horizontal line, from right to left.
///
/// Positions alternate between above and below the line.
fn along(y: f64, area: Area, width: f64) -> impl Iterator<Item = Position> {
    let steps = ((area.width - width) / ALONG).max(0.0) as usize;
    let all = (0..steps).flat_map(move |k| [-1.0, 1.0].map(|side| (k as f64 * ALONG, side)));
    all.map(move |(back, side)| {
        let spot = [area.right() - 6.0 - back, y + side * 0.6 * HEIGHT];
        (Bounds::beside(spot, width, false), None, back)
    })
}

/// Draws the limits of all curves of a panel with their names and forces.
pub(super) fn limits(panel: &ChartPanel, curves: &[Curve]) -> Option<Element> {
    let mut names = Names {
        area: panel.area,
        marks: Vec::new(),
        curves: Vec::new(),
        leaders: Vec::new(),
        placed: Vec::new(),
    };
    let (mut drawn, mut levels, mut marks) = (Vec::new(), Vec::new(), Vec::new());
    for curve in curves {
        let spots = panel.spots(curve.values.points.iter().copied());
        names.curves.extend(spots.windows(2).flat_map(|ends| samples([ends[0], ends[1]])));
        for (limit, [x, y]) in &curve.values.limits {
            let Some(spot) = panel.place(*x, *y) else { continue };
            let text = format!("{} {}", limit.mode.name(), three_digits(*y));
            // Bold letters are wider.
            let name = (text.clone(), limit.is_first);
            let wide = width(&text, SIZE) * if limit.is_first { 1.1 } else { 1.0 } + 2.0;
            if limit.displacement.is_some() {
                names.marks.push(spot);
                marks.push((name, wide, spot, failure_color(limit.mode.name())));
            } else {
                let ends = [[panel.area.left, spot[1]], [panel.area.right(), spot[1]]];
                names.curves.extend(samples(ends));
                let level = line(ends[0], ends[1], &curve.color, 1.2);
                drawn.push(level.with("stroke-dasharray", "8 4").with("class", "level"));
                levels.push((name, wide, spot[1]));
            }
        }
    }
    // Names of levels are placed first, because they have fewer possible positions.
    for (name, wide, y) in levels {
        names.add(name, along(y, panel.area, wide));
    }
    // The name of the first failure is placed first, then other names from the bottom upwards.
    marks.sort_by(|one, other| {
        let is_first = other.0.1.cmp(&one.0.1);
        is_first.then(other.2[1].total_cmp(&one.2[1]))
    });
    for (name, wide, spot, _) in &marks {
        names.add(name.clone(), around(*spot, *wide, panel.area));
    }
    drawn.extend(names.drawn());
    drawn.extend(marks.iter().map(|(.., spot, color)| {
        circle(*spot, RADIUS).with("fill", *color).with("stroke", INK).with("class", "limit")
    }));
    (!drawn.is_empty()).then(|| Element::group("limits").containing(drawn))
}
