//! Maps of a column over two parameters, with contours.
//!
//! A figure has a map for each combination of the values of all other parameters.

use std::collections::{BTreeSet, HashMap};

use results::columns::name;
use text::number::{self, DistinctNumbers};

use super::contours::{contours, joined};
use super::names::{axis_label, in_short, name_with_unit, with_value};
use super::{Figure, columns, is_affected_by_folds, sheet};
use crate::axis::ChartAxis;
use crate::chart::{Area, NAME, upright_name};
use crate::colors::{FAILURES, FAINT, INK, RED, failure_color, map_color};
use crate::designs::{AxisValues, Designs};
use crate::label::{Anchor, fitting, label, width};
use crate::paper::{Paper, evenly_spaced};
use crate::svg::{Element, Spot, line, polyline, rect};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 118.0;
const TOP: f64 = 74.0;
const BETWEEN: [f64; 2] = [16.0, 34.0];
/// Height of a map among several, and of a single map, px.
const HEIGHTS: [f64; 2] = [200.0, 420.0];
/// Minimum width of a map, px.
const LEAST: f64 = 90.0;
/// Font size of the values at contours, px.
const VALUE: f64 = 10.0;
/// Maximum number of maps in a figure.
const MAPS: usize = 24;
/// Number of steps of the colour bar.
const STEPS: u32 = 60;

/// A column with a fixed colour scale from 0 to 1; folds do not affect it.
const COVERAGE: &str = name::COVERAGE;

/// A requested map: a column over two parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct MapRequest {
    /// Column name of the horizontal parameter.
    pub x: String,
    /// Column name of the vertical parameter.
    pub y: String,
    /// Column to show.
    pub of: String,
    /// Fixed parameters: pairs of column name and value.
    ///
    /// Several pairs with the same name select several values. The figure has a map for each
    /// combination of values that remain.
    pub at: Vec<(String, String)>,
    /// The paper size for which the figure is laid out.
    pub paper: Paper,
}

/// The reason why a map cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidMap {
    /// An axis is not a varied parameter.
    #[error("{option} {found}: is not a parameter that varies, expected one of {}", known.join(", "))]
    NoAxis {
        /// Option that names the axis, `--x` or `--y`.
        option: &'static str,
        /// Name that the user gave.
        found: String,
        /// Varied parameters.
        known: Vec<String>,
    },
    /// The two axes show the same parameter.
    #[error("--y {0}: is on the horizontal axis already; choose another parameter")]
    Twice(String),
    /// The column has no numbers.
    #[error("--of {0}: designs.csv has no numeric column of this name")]
    NoNumbers(String),
    /// No design has the given values.
    #[error("--at {found}: no design has this value, expected one of {}", known.join(", "))]
    NoValue {
        /// The requested column and value.
        found: String,
        /// The available values.
        known: Vec<String>,
    },
    /// There are too many maps.
    #[error("{count} maps, one for each value of {}, expected at most {MAPS}: fix a parameter with --at, e.g. --at {example}", axes.join(" and "))]
    TooMany {
        /// Number of maps.
        count: usize,
        /// Parameters that are neither axes nor fixed.
        axes: Vec<String>,
        /// Example of a value that fixes one of the parameters.
        example: String,
    },
}

/// Draws maps of a column over two parameters.
///
/// The figure has a map for each combination of the values of all other parameters.
///
/// # Errors
/// If an axis does not vary, the column has no numbers, no design has the given values, or there
/// are too many maps.
pub fn map(name: &str, designs: &Designs, request: &MapRequest) -> Result<Figure, InvalidMap> {
    // Parameters with words as values may vary, too, but cannot be axes.
    let known = designs.varied().into_iter().filter(|axis| designs.has(axis));
    let known: Vec<String> = known.map(str::to_owned).collect();
    let selected = designs.at(&request.at)?;
    let mut axes = Vec::new();
    for (option, axis) in [("--x", &request.x), ("--y", &request.y)] {
        // A length in mm also selects the axis of this length divided by the thickness.
        let varied = selected.varied_as(axis).filter(|varied| designs.has(varied));
        axes.push(varied.ok_or_else(|| InvalidMap::NoAxis {
            option,
            found: axis.clone(),
            known: known.clone(),
        })?);
    }
    if axes[0] == axes[1] {
        return Err(InvalidMap::Twice(request.y.clone()));
    }
    // The numbers in the column `design` are names of designs, not values.
    let is_shown = designs.has(&request.of) || request.of == name::FIRST_FAILURE;
    if !is_shown || !designs.headers().contains(&request.of) || request.of == "design" {
        return Err(InvalidMap::NoNumbers(request.of.clone()));
    }
    // A parameter that is requested in mm is shown in mm.
    let x = if designs.has(&request.x) { request.x.as_str() } else { axes[0] };
    let y = if designs.has(&request.y) { request.y.as_str() } else { axes[1] };
    let of = request.of.as_str();
    let parts = selected.parts_by(&axes);
    if parts.len() > MAPS {
        return Err(too_many(&parts));
    }
    // All maps have the same scale, so that their colours are comparable.
    let scale = ChartAxis::fit(&axis_label(of), selected.numbers(of));
    let subject = MapSubject { x, y, of, scale };
    let at = request.at.iter().filter(|(axis, _)| is_single(&request.at, axis));
    let at = at.map(|(axis, value)| (axis.as_str(), value.as_str().into()));
    let at: AxisValues<'_> = at.collect();
    let title = super::title(
        &format!("{name}: {} over {} and {}", name_with_unit(of), in_short(x), in_short(y)),
        &at,
    );
    let file = format!("map-of-{of}-over-{x}-and-{y}").replace('_', "-");
    let figure = subject.figure(&title, &parts, request.paper);
    Ok(Figure { name: super::file_name(&file, &at), ..figure })
}

/// Returns true if a parameter is fixed at one value.
fn is_single(at: &[(String, String)], axis: &str) -> bool {
    at.iter().filter(|(other, _)| other == axis).count() == 1
}

/// Draws maps of a column over aspect ratio and gap, one for each slant.
pub(crate) fn by_slant(name: &str, designs: &Designs, of: &str, paper: Paper) -> Figure {
    let axes = ["length_over_t", "gap_over_t"];
    let [x, y] = axes.map(|axis| designs.in_mm(axis));
    let label = axis_label(of);
    let scale = match of {
        COVERAGE => ChartAxis::exact(&format!("{label}; white: none"), 0.0, 1.0),
        _ => ChartAxis::fit(&label, designs.numbers(of)),
    };
    let title = format!("{name}: {} by gap, aspect ratio and slant", name_with_unit(of));
    MapSubject { x: &x, y: &y, of, scale }.figure(&title, &designs.parts_by(&axes), paper)
}

/// Draws maps of the first failure over gap and slant, one for each aspect ratio.
pub(crate) fn of_failures(sweep: &str, designs: &Designs, paper: Paper) -> Figure {
    let axes = ["gap_over_t", "slant_deg"];
    let ([x, y], of) = (axes.map(|axis| designs.in_mm(axis)), name::FIRST_FAILURE);
    // A map of failure modes does not use the numeric scale.
    let scale = ChartAxis::exact("", 0.0, 1.0);
    let title = format!("{sweep}: first failure by gap, slant and aspect ratio");
    MapSubject { x: &x, y: &y, of, scale }.figure(&title, &designs.parts_by(&axes), paper)
}

impl Designs {
    /// Returns the designs with the values `at`, given as pairs of column name and value.
    ///
    /// If `at` contains several values of a column, a design needs one of these values.
    ///
    /// # Errors
    /// If no design has one of the values.
    pub fn at(&self, at: &[(String, String)]) -> Result<Self, InvalidMap> {
        let mut chosen: Vec<bool> = vec![true; self.count()];
        for (axis, _) in at {
            let values = at.iter().filter(|(other, _)| other == axis);
            let mut is_at = vec![false; self.count()];
            for (_, value) in values {
                for row in self.rows_at(axis, value)? {
                    is_at[row] = true;
                }
            }
            chosen.iter_mut().zip(is_at).for_each(|(chosen, is_at)| *chosen &= is_at);
        }
        let rows: Vec<usize> = (0..self.count()).filter(|row| chosen[*row]).collect();
        match at.last() {
            Some((axis, value)) if rows.is_empty() => Err(self.no_value(axis, value)),
            _ => Ok(self.only(&rows)),
        }
    }

    /// Returns the rows in which the column `axis` has this value; at least one row.
    fn rows_at(&self, axis: &str, value: &str) -> Result<Vec<usize>, InvalidMap> {
        // The notation of a number may differ from the table, for example 0.10 instead of 0.1.
        let number = value.parse::<f64>().ok();
        let mut rows = Vec::new();
        for row in 0..self.count() {
            let both = self.number(axis, row).zip(number);
            if self.text(axis, row) == value || both.is_some_and(|(a, b)| number::same(a, b)) {
                rows.push(row);
            }
        }
        if rows.is_empty() { Err(self.no_value(axis, value)) } else { Ok(rows) }
    }

    fn no_value(&self, axis: &str, value: &str) -> InvalidMap {
        let known: Vec<&str> = if self.texts(axis).len() > 1 { vec![axis] } else { self.varied() };
        let all = known.into_iter().flat_map(|axis| {
            self.texts(axis).into_iter().map(move |value| format!("{axis}={value}"))
        });
        InvalidMap::NoValue { found: format!("{axis}={value}"), known: all.collect() }
    }
}

fn too_many(parts: &[(AxisValues<'_>, Designs)]) -> InvalidMap {
    let first: &[(&str, _)] = parts.first().map_or(&[], |(values, _)| values);
    let axes = first.iter().map(|(axis, _)| (*axis).to_owned()).collect();
    let example = first.first().map_or_else(String::new, |(axis, value)| format!("{axis}={value}"));
    InvalidMap::TooMany { count: parts.len(), axes, example }
}

/// The column of a map and the parameters of its axes.
struct MapSubject<'a> {
    x: &'a str,
    y: &'a str,
    of: &'a str,
    /// The colour scale.
    scale: ChartAxis,
}

impl MapSubject<'_> {
    /// Draws a figure with a map for each of `parts`. The figure has no file name yet.
    fn figure(&self, title: &str, parts: &[(AxisValues<'_>, Designs)], paper: Paper) -> Figure {
        let full = paper.width(WIDTH);
        let [left, right] = if paper.is_narrow(WIDTH) { [56.0, 96.0] } else { [LEFT, RIGHT] };
        let room = full - left - right;
        let count = paper.columns(columns(parts.len()), room, LEAST, BETWEEN[0]);
        let all = parts.len();
        let omitted = parts.first().and_then(|(values, _)| values.first());
        let omitted = omitted.map(|(axis, value)| format!("--at {axis}={value}"));
        let parts = &evenly_spaced(parts.to_vec(), paper.panels(WIDTH, count, all));
        let omitted = omitted.filter(|_| parts.len() < all).map(|example| {
            format!("shows {} of {all} maps; choose with --at, e.g. {example}", parts.len())
        });
        let rows = parts.len().div_ceil(count);
        let width = (room - BETWEEN[0] * (count - 1) as f64) / count as f64;
        // Maps on narrow paper are about square.
        let height = HEIGHTS[usize::from(parts.len() == 1)].min((1.1 * width).max(120.0));
        let first = Area { left, top: TOP, width, height };
        let mut inside = Vec::new();
        for (k, (values, designs)) in parts.iter().enumerate() {
            let map = Map {
                subject: self,
                designs,
                area: first.panel(k, count, BETWEEN),
                x: designs.distinct(self.x),
                y: designs.distinct(self.y),
            };
            let title = values.iter().map(with_value).collect::<Vec<_>>().join(", ");
            inside.extend(map.drawn(&title, k + count >= parts.len(), k % count == 0));
        }
        let bottom = TOP + rows as f64 * (height + BETWEEN[1]) - BETWEEN[1];
        let middle = 0.5 * (left + full - right);
        let across = axis_label(self.x);
        let size = fitting(&across, NAME, room);
        inside
            .push(label(&across, [middle, bottom + 38.0], size, Anchor::Middle).with("fill", INK));
        let up = axis_label(self.y);
        inside.push(upright_name(&up, [20.0, 0.5 * (TOP + bottom)], bottom - TOP));
        let bar = [full - right + 22.0, full - 12.0];
        let scale = if self.is_of_modes() {
            self.modes(parts, bar[0])
        } else {
            self.bar(bottom - TOP, bar)
        };
        inside.push(scale);
        if self.marks_folds() && parts.iter().any(|(_, part)| part.any_folded()) {
            let text = "struck through: the surface folds, so the force is not valid";
            let size = fitting(text, 12.0, full - left - 12.0);
            inside.push(label(text, [left, 46.0], size, Anchor::Start).with("fill", INK));
        }
        Figure { name: String::new(), svg: sheet(full, bottom + 54.0, title, inside), omitted }
    }

    /// Returns true if a fold of the substrate surface invalidates the column.
    fn marks_folds(&self) -> bool {
        is_affected_by_folds(self.of)
    }

    /// Returns true for a map of failure modes. Their values are words.
    fn is_of_modes(&self) -> bool {
        self.of == name::FIRST_FAILURE
    }

    /// Returns the colour of the cell of a design; `None` if the design has no value.
    fn color_of(&self, designs: &Designs, row: usize) -> Option<String> {
        if self.is_of_modes() {
            let mode = designs.text(self.of, row);
            return (!mode.is_empty()).then(|| failure_color(&mode).to_owned());
        }
        self.color(designs.number(self.of, row)?)
    }

    /// Draws the legend of the failure modes that occur, with its left edge at `left`.
    fn modes(&self, parts: &[(AxisValues<'_>, Designs)], left: f64) -> Element {
        let cells = parts.iter().map(|(_, part)| part.texts(self.of));
        let occurring: BTreeSet<_> = cells.flatten().collect();
        let all = FAILURES.into_iter().chain([("", "#fff")]);
        let entries = all.filter(|(mode, _)| occurring.contains(*mode)).enumerate();
        let drawn = entries.flat_map(|(k, (mode, color))| {
            let y = TOP + 24.0 * k as f64;
            let text = label(
                if mode.is_empty() { "none" } else { mode },
                [left + 24.0, y + 13.0],
                12.0,
                Anchor::Start,
            );
            let square = rect([left, y], [16.0, 16.0]).with("fill", color).with("stroke", INK);
            [square.at("stroke-width", 0.8), text.with("fill", INK)]
        });
        Element::group("legend").containing(drawn.collect::<Vec<_>>())
    }

    fn color(&self, value: f64) -> Option<String> {
        if self.of == COVERAGE && value <= 0.0 {
            return Some("#fff".to_owned());
        }
        self.scale.place(value).map(map_color)
    }

    /// Returns the levels of the contours as positions on the scale, with their values as text.
    fn levels(&self) -> Vec<(f64, String)> {
        let ticks = self.scale.ticks(6).into_iter();
        ticks
            .filter_map(|tick| Some((self.scale.place(tick.value)?, tick.label?)))
            // A contour at an end of the scale would have all values on one side.
            .filter(|(place, _)| (0.01..0.99).contains(place))
            .collect()
    }

    /// Draws the colour bar from x = `left`, with its name at x = `name`.
    ///
    /// Its labels are at the levels of the contours.
    fn bar(&self, height: f64, [left, name]: [f64; 2]) -> Element {
        let width = 16.0;
        let step = height / f64::from(STEPS);
        let cells = (0..STEPS).map(|k| {
            rect([left, TOP + height - f64::from(k + 1) * step], [width, step + 0.3])
                .with("fill", map_color((f64::from(k) + 0.5) / f64::from(STEPS)))
        });
        let ticks = self.scale.ticks(6).into_iter().filter_map(|tick| {
            let y = TOP + height * (1.0 - self.scale.place(tick.value)?);
            let text = label(&tick.label?, [left + width + 7.0, y + 4.0], 11.0, Anchor::Start);
            Some([line([left, y], [left + width + 4.0, y], FAINT, 0.8), text.with("fill", INK)])
        });
        let name = upright_name(&self.scale.label, [name, TOP + 0.5 * height], height);
        Element::group("scale").containing(cells).containing(ticks.flatten()).containing([name])
    }
}

/// Returns half the width and half the height of the text at a contour with its halo, px.
fn half_size(text: &str) -> [f64; 2] {
    [0.5 * width(text, VALUE) + 3.0, 0.5 * VALUE + 2.0]
}

/// One map, with a cell for each pair of values of the two parameters.
struct Map<'a> {
    subject: &'a MapSubject<'a>,
    designs: &'a Designs,
    area: Area,
    x: DistinctNumbers,
    y: DistinctNumbers,
}

impl Map<'_> {
    fn drawn(&self, title: &str, x_labels: bool, y_labels: bool) -> [Element; 3] {
        let at = self.rows();
        [self.cells(&at), self.contours(&at), self.frame(title, x_labels, y_labels)]
    }

    /// Returns the number of columns and the number of rows of cells.
    fn size(&self) -> [usize; 2] {
        [&self.x, &self.y].map(|values| values.as_slice().len())
    }

    fn cell(&self) -> [f64; 2] {
        let [columns, rows] = self.size();
        [self.area.width / columns as f64, self.area.height / rows as f64]
    }

    /// Maps each cell (column and row of the map) to the row of its design in the table.
    fn rows(&self) -> HashMap<[usize; 2], usize> {
        let axes = [(&self.x, self.subject.x), (&self.y, self.subject.y)];
        let rows = (0..self.designs.count()).filter_map(|row| {
            let [x, y] =
                axes.map(|(values, column)| values.position(self.designs.number(column, row)?));
            Some(([x?, y?], row))
        });
        rows.collect()
    }

    fn cells(&self, at: &HashMap<[usize; 2], usize>) -> Element {
        let [width, height] = self.cell();
        let mut map = Element::group("map");
        // Iterate in a fixed order, because the order of a hash map is random.
        let [columns, rows] = self.size();
        for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
            let Some(&row) = at.get(&[i, j]) else { continue };
            let Some(color) = self.subject.color_of(self.designs, row) else { continue };
            let [left, top] =
                [self.area.left + i as f64 * width, self.area.bottom() - (j + 1) as f64 * height];
            // Rectangles are slightly larger than cells, so that no gaps are visible between them.
            map.add(
                rect([left, top], [width + 0.3, height + 0.3])
                    .with("fill", color)
                    .with("data-design", self.designs.design(row)),
            );
            if self.subject.marks_folds() && self.designs.folded(row) {
                map.add(line([left, top + height], [left + width, top], RED, 1.4));
            }
        }
        map
    }

    /// Draws contours at the labelled ticks of the colour scale, with their values.
    fn contours(&self, at: &HashMap<[usize; 2], usize>) -> Element {
        let value = |i, j| {
            let value = self.designs.number(self.subject.of, *at.get(&[i, j])?)?;
            // Interpolate positions on the scale, so that contours of logarithmic scales follow the
            // colours.
            self.subject.scale.place(value)
        };
        let [width, height] = self.cell();
        let size = self.size();
        let (mut drawn, mut values) = (Vec::new(), Vec::new());
        for (level, text) in self.subject.levels() {
            for line in joined(contours(size, &value, level)) {
                let line = line.into_iter().map(|[i, j]| {
                    [self.area.left + (i + 0.5) * width, self.area.bottom() - (j + 0.5) * height]
                });
                let line: Vec<Spot> = line.collect();
                // A dark line over a wider light one is visible on all colours.
                drawn.extend([("#fff", 2.8), (INK, 1.2)].map(|(color, width)| {
                    polyline(&line).with("stroke", color).at("stroke-width", width)
                }));
                values.extend(self.free_spot(&line, &text, &values).map(|at| (at, text.clone())));
            }
        }
        let values = values.into_iter().map(|([x, y], text)| {
            let text = label(&text, [x, y + 3.5], VALUE, Anchor::Middle).with("fill", INK);
            text.with("stroke", "#fff").at("stroke-width", 3.0).with("paint-order", "stroke")
        });
        Element::group("contours")
            .with("stroke-linecap", "round")
            .with("stroke-linejoin", "round")
            .containing(drawn)
            .containing(values)
    }

    /// Returns a spot on a contour for its value, inside the map and without overlaps.
    ///
    /// `None` if every spot is outside or overlaps another value, or if the contour is too short
    /// for its value.
    fn free_spot(&self, line: &[Spot], text: &str, others: &[(Spot, String)]) -> Option<Spot> {
        let [across, down] = half_size(text);
        let lengths = line.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]));
        if lengths.sum::<f64>() < 2.5 * across {
            return None;
        }
        // Try the midpoints of the segments, starting at the middle of the line.
        let middle = line.len() as f64 / 2.0 - 1.0;
        let mut spots: Vec<(f64, Spot)> = line
            .windows(2)
            .enumerate()
            .map(|(k, w)| {
                ((k as f64 - middle).abs(), [0, 1].map(|axis| 0.5 * (w[0][axis] + w[1][axis])))
            })
            .collect();
        spots.sort_by(|a, b| a.0.total_cmp(&b.0));
        spots.into_iter().map(|(_, spot)| spot).find(|&[x, y]| {
            let area = &self.area;
            let is_inside = (area.left + across..area.right() - across).contains(&x)
                && (area.top + down..area.bottom() - down).contains(&y);
            is_inside
                && others.iter().all(|([left, top], other)| {
                    let [wide, high] = half_size(other);
                    (x - left).abs() > across + wide || (y - top).abs() > down + high
                })
        })
    }

    fn frame(&self, title: &str, x_labels: bool, y_labels: bool) -> Element {
        let Area { left, top, width, height } = self.area;
        let size = fitting(title, 12.0, width + 12.0);
        let title = label(title, [left + 0.5 * width, top - 7.0], size, Anchor::Middle);
        let mut frame =
            Element::group("frame").containing([self.area.border(), title.with("fill", INK)]);
        let [w, h] = self.cell();
        if x_labels {
            // Each label needs the width of about five characters.
            let every = (34.0 / w).ceil() as usize;
            for (i, value) in self.x.as_slice().iter().enumerate().step_by(every.max(1)) {
                let spot = [left + (i as f64 + 0.5) * w, top + height + 15.0];
                frame.add(label(&value.to_string(), spot, 11.0, Anchor::Middle).with("fill", INK));
            }
        }
        if y_labels {
            let every = (15.0 / h).ceil() as usize;
            for (j, value) in self.y.as_slice().iter().enumerate().step_by(every.max(1)) {
                let spot = [left - 6.0, top + height - (j as f64 + 0.5) * h + 4.0];
                frame.add(label(&value.to_string(), spot, 11.0, Anchor::End).with("fill", INK));
            }
        }
        frame
    }
}
