//! Drawings of a row of scales on its substrate, at rest and punctured.

use contact::Pose;
use geometry::{Body, Corner, Frame, OutOfRange, Row, Vec2};
use results::puncture_units;
use skin::puncture::{RowLength, RowSnapshot, ScaleState};
use sweep::Case;

use super::bodies::{corners, overlaps};
use super::contacts::{self, LONGEST};
use super::scale_bar::scale_bar;
use super::surface;
use super::view::View;
use super::{DrawingPanel, MARGIN, WIDTH, contacts_label, geometry_label, stacked};
use crate::colors::{FAINT, INK};
use crate::label::{Anchor, label};
use crate::svg::{Element, Spot, arrow, circle, line, polygon, polyline, px, rect};

/// Maximum length of `t` on paper, px.
const LARGEST: f64 = 130.0;
/// Width in units of `t` above which outer scales are omitted; the middle seven are always drawn.
const WIDEST: f64 = 44.0;
/// Fraction of the largest displacement below which the drawing may omit a scale.
const STILL: f64 = 0.01;
/// Depth of substrate below the deepest corner, px.
const SUBSTRATE: f64 = 26.0;
/// Height of the bars of the reactions, px.
const BARS: f64 = 62.0;
/// Half the width of the shaft of a sharp needle, px.
const SHAFT: f64 = 5.0;
/// Length of the point of a sharp needle, px.
const NOSE: f64 = 16.0;
/// Radius of the ring at the first contact point of the needle, px.
const RING: f64 = 3.5;
/// Height above the scales for the arrow of the load, px.
const AIR: f64 = LONGEST + 24.0;

/// The drawing of a punctured design.
#[derive(Clone, Debug)]
pub struct PunctureDrawing<'a> {
    /// The name of the design, placed before the geometry in the title.
    pub name: &'a str,
    /// Geometry, needle and material. A known thickness adds a scale bar.
    pub case: &'a Case,
    /// The states, from top to bottom; the row at rest is drawn above them.
    pub states: &'a [RowSnapshot],
}

impl PunctureDrawing<'_> {
    /// Returns the drawing as SVG.
    ///
    /// The first panel is the row at rest with its coverage line; each state follows in its own
    /// panel.
    ///
    /// # Errors
    /// If the design is invalid.
    pub fn svg(&self) -> Result<String, OutOfRange> {
        let sheet = RowSheet::new(self)?;
        // The row at rest is drawn already, so skip unloaded states.
        let loaded = self.states.iter().filter(|state| state.force != 0.0);
        let states = loaded.map(|state| sheet.state(state, sheet.free(state)));
        let panels: Vec<_> = std::iter::once(sheet.at_rest()).chain(states).collect();
        Ok(stacked(&self.title(), panels))
    }

    pub(super) fn title(&self) -> String {
        format!("{}: {}", self.name, geometry_label(self.case))
    }

    pub(super) fn frames(&self) -> Result<Vec<DrawingPanel>, OutOfRange> {
        let sheet = RowSheet::new(self)?;
        // All frames have the same offset, so that the row does not jump between frames.
        let free = self.states.iter().map(|state| sheet.free(state)).fold(AIR, f64::min);
        Ok(self.states.iter().map(|state| sheet.state(state, free)).collect())
    }
}

/// Returns the load of a state in units of `E* t²`.
fn load(case: &Case, state: &RowSnapshot) -> f64 {
    state.force * case.design.length
}

/// The scales, view and units shared by all panels of a drawing.
struct RowSheet<'a> {
    case: &'a Case,
    row: Row,
    body: Body,
    /// Indices of the first and last scale shown.
    first: i64,
    last: i64,
    view: View,
    /// Vertical position of the bars of the reactions, px.
    bars: f64,
    height: f64,
    /// Length of the arrow of a unit force (`E* t²`), px.
    force: f64,
    /// Largest and smallest reaction as fractions of the load.
    reactions: (f64, f64),
}

impl<'a> RowSheet<'a> {
    fn new(
        &PunctureDrawing { case, states, .. }: &PunctureDrawing<'a>,
    ) -> Result<Self, OutOfRange> {
        let row = case.design.row()?;
        let (first, last) = window(&row, case.puncture.scales, states);
        let (a, shift, pitch) = (row.scale().half_base(), row.scale().shift(), row.pitch());
        let width = (last - first) as f64 * pitch + 2.0 * a + shift;
        let scale = ((WIDTH - 4.0 * MARGIN) / width).min(LARGEST);
        // On a curved body the row rises or falls from the punctured scale.
        let body = case.body();
        let rest = Pose::new(0.0, 0.0, 0.0);
        let heights = (first..=last).flat_map(|i| corners(&row, body, i as f64, &rest));
        let (low, high) =
            heights.fold((0.0_f64, 1.0_f64), |(low, high), [_, y]| (low.min(y), high.max(y)));
        // One corner of a tilted base is deeper than the middle of the base.
        let deepest = states
            .iter()
            .flat_map(|state| &state.scales)
            .map(|s| a * s.rotation_deg.to_radians().sin().abs() - s.displacement[1]);
        let deepest = scale * (deepest.fold(0.0, f64::max) - low) + SUBSTRATE;
        // Coordinate of the middle of the row, which is centred on the paper.
        let middle = first as f64 * pitch - a + 0.5 * width;
        let view = View { scale, origin: [0.5 * WIDTH - scale * middle, AIR + scale * high] };
        let bars = AIR + scale * high + deepest + 18.0;
        let largest = states.iter().map(|s| contacts::largest(&s.contacts).max(load(case, s)));
        let reactions = states.iter().flat_map(|state| {
            let load = load(case, state);
            state.scales.iter().filter(move |_| load > 0.0).map(move |s| s.reaction / load)
        });
        // Include zero, because the zero line of the bars is always drawn.
        let reactions =
            reactions.fold((0.0, 0.0), |(high, low): (f64, f64), r| (high.max(r), low.min(r)));
        Ok(Self {
            case,
            row,
            body,
            first,
            last,
            view,
            bars,
            height: bars + BARS + 18.0,
            force: LONGEST / largest.fold(f64::MIN_POSITIVE, f64::max),
            reactions,
        })
    }

    fn numbers(&self) -> impl Iterator<Item = i64> {
        self.first..=self.last
    }

    fn place(&self, point: [f64; 2]) -> Spot {
        self.view.place(point)
    }

    fn at_rest(&self) -> DrawingPanel {
        let rest = Pose::new(0.0, 0.0, 0.0);
        let poses: Vec<_> = self.numbers().map(|i| (i, rest)).collect();
        let corners = self.numbers().flat_map(|i| corners(&self.row, self.body, i as f64, &rest));
        let lowest = corners.map(|corner| self.place(corner)[1]).fold(0.0, f64::max);
        let bottom = lowest + SUBSTRATE;
        let mut inside = vec![self.substrate(&poses, bottom), self.scales(&poses)];
        inside.extend(self.coverage_line());
        let within_substrate = [WIDTH - 2.0 * MARGIN, bottom - 6.0];
        inside.extend(scale_bar(&self.view, self.case.material.thickness_mm, within_substrate));
        let coverage = self.case.coverage().unwrap_or_default();
        let of = if self.row_ends_in_coverage_line() { " of a long row" } else { "" };
        let caption = format!("at rest, coverage $λ$ = {coverage:.3}{of}");
        // Without load and reactions the panel needs less height.
        lifted(AIR - 14.0, bottom + 10.0, caption, inside)
    }

    /// Returns the height of the empty area at the top of the panel of a state, px.
    fn free(&self, state: &RowSnapshot) -> f64 {
        let load = self.load_arrow(state).map(|[from, _]| from[1] - 16.0);
        let highest = self
            .placed_contacts(state)
            .into_iter()
            .map(|contact| self.place(contact.point)[1] - self.force * contact.force[1].abs())
            .chain(load)
            .fold(AIR, f64::min);
        (highest - 8.0).max(0.0)
    }

    fn state(&self, state: &RowSnapshot, free: f64) -> DrawingPanel {
        let shown: Vec<&ScaleState> =
            state.scales.iter().filter(|s| (self.first..=self.last).contains(&s.scale)).collect();
        let poses: Vec<_> = shown.iter().map(|s| (s.scale, pose(s))).collect();
        let inside = vec![
            self.substrate(&poses, self.bars - 18.0),
            self.ghosts(),
            self.scales(&poses),
            surface::folds(&self.row, self.body, &self.view, &poses),
            self.overlaps(state),
            self.contacts(state),
            self.load(state),
            self.tilt(state),
            self.reactions(&shown, load(self.case, state)),
        ];
        // Count the folds of the whole row, including scales that are not shown.
        let all: Vec<_> = state.scales.iter().map(|s| (s.scale, pose(s))).collect();
        let caption = self.caption(state) + &surface::folds_label(&self.row, &all);
        lifted(free, self.height, caption, inside)
    }

    fn caption(&self, state: &RowSnapshot) -> String {
        let load = load(self.case, state);
        let largest = contacts::largest(&state.contacts);
        let force = if largest > 0.0 && load > 0.0 {
            format!(", the largest force {} $F$", short(largest / load))
        } else {
            String::new()
        };
        let (u, f) = (state.displacement, state.force);
        let load = match puncture_units(self.case) {
            Some([mm, newton, _]) => {
                format!("$u$ = {} mm,  $F$ = {} N", short(u * mm), short(f * newton))
            }
            None => format!("$u^*$ = {},  $F^*$ = {}", short(u), short(f)),
        };
        let ring =
            if self.ring(state).is_some() { ",  ○ first contact of the needle" } else { "" };
        format!(
            "{load},  tilt {:.2}°,  {}{force}{ring}",
            state.tilt_deg + 0.0,
            contacts_label(&state.contacts)
        )
    }

    /// Draws the substrate down to y = `bottom`; its surface is bonded to the bases.
    fn substrate(&self, poses: &[(i64, Pose)], bottom: f64) -> Element {
        let surface = poses.iter().flat_map(|(i, pose)| {
            let [left, right, ..] = corners(&self.row, self.body, *i as f64, pose);
            [left, right]
        });
        let mut top: Vec<Spot> = surface.map(|point| self.place(point)).collect();
        let (left, right) = (MARGIN, WIDTH - MARGIN);
        let [left_end, right_end] = match self.case.puncture.scales {
            // `top` is not empty, because at least the punctured scale exists.
            RowLength::Auto => [top[0], top[top.len() - 1]],
            // The end of a short row moves, but the surface far beyond the row is at rest.
            RowLength::Scales(_) => {
                let rest = Pose::new(0.0, 0.0, 0.0);
                let [left, ..] = corners(&self.row, self.body, self.first as f64, &rest);
                let [_, right, ..] = corners(&self.row, self.body, self.last as f64, &rest);
                [self.place(left), self.place(right)]
            }
        };
        top.insert(0, [left, left_end[1]]);
        top.push([right, right_end[1]]);
        let mut body = top.clone();
        body.extend([[right, bottom], [left, bottom]]);
        let fill = polygon(&body).with("fill", "#f3e3cc");
        let edge = polyline(&top).with("stroke", "#a97f4b").at("stroke-width", 1.0);
        Element::group("substrate").containing([fill, edge])
    }

    fn scales(&self, poses: &[(i64, Pose)]) -> Element {
        Element::group("scales")
            .with("stroke", "#33414d")
            .at("stroke-width", self.outline())
            .with("stroke-linejoin", "round")
            .containing(poses.iter().map(|(i, pose)| {
                let fill = if *i == 0 { "#8fb3cf" } else { "#d5dee6" };
                polygon(&self.view.all(&corners(&self.row, self.body, *i as f64, pose)))
                    .with("fill", fill)
                    .with("fill-opacity", "0.92")
            }))
    }

    /// Returns the line width of outlines, px.
    ///
    /// Outlines of thin scales are thinner, so that the area inside stays visible.
    fn outline(&self) -> f64 {
        let thickness = 2.0 * self.row.scale().half_base() * self.row.scale().slant().cos();
        (0.12 * self.view.scale * thickness).clamp(0.25, 0.9)
    }

    /// Draws dashed outlines of the scales at rest.
    fn ghosts(&self) -> Element {
        let rest = Pose::new(0.0, 0.0, 0.0);
        let ghost =
            |i: i64| polygon(&self.view.all(&corners(&self.row, self.body, i as f64, &rest)));
        Element::group("at-rest")
            .with("fill", "none")
            .with("stroke", "#9aa5ad")
            .at("stroke-width", 0.7)
            .with("stroke-dasharray", "3 3")
            .containing(self.numbers().map(ghost))
    }

    fn overlaps(&self, state: &RowSnapshot) -> Element {
        let poses: Vec<_> = state.scales.iter().map(pose).collect();
        let frame = self.first_frame(state);
        let mut polygons = overlaps(&self.row, self.body, &poses);
        for point in polygons.iter_mut().flat_map(|(_, points)| points) {
            *point = (frame.origin + frame.outward((*point).into())).into();
        }
        contacts::overlaps(&self.view, &polygons)
    }

    fn contacts(&self, state: &RowSnapshot) -> Element {
        let radius = (0.09 * self.view.scale).clamp(4.0, 9.0);
        let first = state.scales.first().map_or(0, |scale| scale.scale);
        let mut shown = self.placed_contacts(state);
        shown.retain(|contact| {
            let left = first + contact.left as i64;
            self.first <= left && left < self.last
        });
        Element::group("contact").containing([
            contacts::halos(&self.view, &shown, radius),
            contacts::forces(&self.view, &shown, self.force),
        ])
    }

    /// Returns the tangent frame of the first scale of the row, relative to the punctured scale.
    fn first_frame(&self, state: &RowSnapshot) -> Frame {
        let first = state.scales.first().map_or(0, |scale| scale.scale);
        self.body.frame(first as f64 * self.row.pitch())
    }

    /// Returns the contacts with points and forces in the frame of the punctured scale.
    fn placed_contacts(&self, state: &RowSnapshot) -> Vec<skin::Contact> {
        let frame = self.first_frame(state);
        let placed = state.contacts.iter().map(|contact| skin::Contact {
            point: (frame.origin + frame.outward(contact.point.into())).into(),
            force: frame.outward(contact.force.into()).into(),
            ..*contact
        });
        placed.collect()
    }

    /// Returns the current position of the loaded point of the punctured scale.
    ///
    /// `None` without a load.
    fn loaded_point(&self, state: &RowSnapshot) -> Option<Vec2> {
        let punctured = state.scales.iter().find(|s| s.scale == 0 && state.force != 0.0)?;
        let scale = self.row.scale();
        let (left, right) = (scale.corner(Corner::TopLeft), scale.corner(Corner::TopRight));
        let (pose, at_rest) =
            (pose(punctured), left + self.case.punctured().load_position * (right - left));
        Some(pose.displacement + pose.turn(at_rest))
    }

    /// Returns the ends of the arrow of the load; `None` without a load.
    fn load_arrow(&self, state: &RowSnapshot) -> Option<[Spot; 2]> {
        let follows = self.loaded_point(state)?;
        // A guided tip moves straight down instead of following the scale.
        let to = self.place(state.tip.unwrap_or(follows.into()));
        // Small loads get a minimum arrow length, which shows the point of application.
        let length = (self.force * load(self.case, state)).max(9.0);
        Some([[to[0], to[1] - length], to])
    }

    /// Draws the load, and for a guided needle the tip and a ring at the first contact point.
    ///
    /// The distance from tip to ring shows how far the needle has slid.
    fn load(&self, state: &RowSnapshot) -> Element {
        let drawn = self.load_arrow(state).map(|[from, to]| {
            let name = label("$F$", [from[0], from[1] - 5.0], 14.0, Anchor::Middle);
            [arrow(from, to, INK, 2.2), name.with("fill", INK)]
        });
        let ring = self.ring(state).map(|place| {
            let ring = circle(self.place(place.into()), RING);
            ring.with("fill", "none").with("stroke", INK).with("class", "set-down")
        });
        // Draw the arrow last, so that it is visible over the needle.
        let parts = self.tip(state).into_iter().chain(drawn.into_iter().flatten());
        Element::group("load").containing(parts.chain(ring))
    }

    /// Returns the current position of the point of the scale that a guided needle touched first.
    ///
    /// `None` for a free needle, and for a round tip between two scales, which touches both.
    fn ring(&self, state: &RowSnapshot) -> Option<Vec2> {
        let is_on_top = (0.0..=1.0).contains(&self.case.punctured().load_position);
        self.loaded_point(state).filter(|_| is_on_top && state.tip.is_some())
    }

    /// Draws the outline of a guided needle; `None` for a dead load, which is only an arrow.
    fn tip(&self, state: &RowSnapshot) -> Option<Element> {
        let radius = self.case.puncture.needle_radius.unwrap_or(0.0);
        let [x, y] = self.place(state.tip?);
        let round = radius * self.view.scale;
        let (half, nose, end) = if round > 0.0 {
            (round, round, format!("A {0} {0} 0 0 0", px(round)))
        } else {
            (SHAFT, NOSE, "L".to_owned())
        };
        let top = px((y - nose).min(y - LONGEST));
        let [left, right, nose] = [x - half, x + half, y - nose].map(px);
        let (x, y) = (px(x), px(y));
        let outline = format!("M {left} {top} V {nose} {end} {x} {y} {end} {right} {nose} V {top}");
        let tip = Element::new("path").with("d", outline).with("class", "tip");
        Some(tip.with("fill", "#e3e7ea").with("fill-opacity", "0.6").with("stroke", INK))
    }

    /// Draws the angle between the base of the punctured scale and its position at rest.
    fn tilt(&self, state: &RowSnapshot) -> Element {
        let Some(punctured) = state.scales.iter().find(|s| s.scale == 0) else {
            return Element::group("tilt");
        };
        let [left, right, ..] =
            corners(&self.row, self.body, 0.0, &pose(punctured)).map(|c| self.place(c));
        let along = (right[0] - left[0]).hypot(right[1] - left[1]);
        let reach = (1.25 * along).max(34.0);
        let tilt = state.tilt_deg.to_radians();
        // A positive tilt is clockwise, like angles on paper, where y points down.
        let arc: Vec<Spot> =
            (0..=12).map(|k| on_circle(left, 0.8 * reach, tilt * f64::from(k) / 12.0)).collect();
        Element::group("tilt").containing([
            line(left, on_circle(left, reach, 0.0), "#5b2a86", 1.0).with("stroke-dasharray", "4 2"),
            line(left, on_circle(left, reach, tilt), "#5b2a86", 1.0),
            polyline(&arc).with("stroke", "#5b2a86").at("stroke-width", 1.6),
        ])
    }

    /// Draws the upward reactions of the substrate, divided by the load, as bars under the scales.
    fn reactions(&self, shown: &[&ScaleState], load: f64) -> Element {
        let (high, low) = self.reactions;
        // Without a load the reactions are zero, too.
        let unit = BARS / (high - low).max(1e-3);
        let zero = self.bars + BARS + unit * low;
        let width = (0.86 * 2.0 * self.row.scale().half_base() * self.view.scale).max(2.0);
        let bars =
            Element::group("bars").with("fill", "#4a7a52").containing(shown.iter().map(|state| {
                let node = self.body.frame(state.scale as f64 * self.row.pitch()).origin;
                let x = self.place(node.into())[0];
                let height = if load > 0.0 { unit * state.reaction / load } else { 0.0 };
                rect([x - 0.5 * width, zero - height.max(0.0)], [width, height.abs()])
            }));
        let name =
            label("$R/F$", [MARGIN, zero - BARS * 0.5], 11.0, Anchor::Start).with("fill", FAINT);
        Element::group("reactions")
            .containing([0.0, high].into_iter().flat_map(|value| {
                let y = zero - unit * value;
                [
                    line([MARGIN + 40.0, y], [WIDTH - MARGIN, y], "#c9c9c9", 0.7),
                    label(&short(value), [MARGIN + 36.0, y + 4.0], 11.0, Anchor::End)
                        .with("fill", FAINT),
                ]
            }))
            .containing([bars, name])
    }

    /// Returns the number of neighbours that the coverage line may cross.
    ///
    /// A base is shorter than a pitch, so scales farther away cannot reach the line.
    fn coverage_reach(&self) -> i64 {
        (self.row.scale().shift() / self.row.pitch()).ceil() as i64 + 1
    }

    /// Returns true if the row lacks a neighbour that counts for the coverage of a long row.
    fn row_ends_in_coverage_line(&self) -> bool {
        matches!(self.case.puncture.scales, RowLength::Scales(count)
            if (count as i64) / 2 < self.coverage_reach())
    }

    /// Draws the vertical line that defines coverage, with thick parts inside scales.
    fn coverage_line(&self) -> Option<Element> {
        let (a, shift, pitch) =
            (self.row.scale().half_base(), self.row.scale().shift(), self.row.pitch());
        // Upright scales have no coverage line.
        (shift > 1e-9).then(|| {
            let x = a + shift;
            let mut parts = vec![
                line(self.place([x, 1.0]), self.place([x, self.body.height(x)]), "#b34700", 1.2)
                    .with("stroke-dasharray", "4 3"),
            ];
            // The closed form of the thick parts applies only to a flat body.
            if !self.body.is_flat() {
                return Element::group("coverage").containing(parts);
            }
            let neighbours = 1..=self.coverage_reach().min(self.last);
            parts.extend(neighbours.filter_map(|k| {
                let low = ((shift - k as f64 * pitch) / shift).max(0.0);
                let high = ((shift - k as f64 * pitch + 2.0 * a) / shift).min(1.0);
                (high - low > 1e-9)
                    .then(|| line(self.place([x, low]), self.place([x, high]), "#b34700", 4.0))
            }));
            Element::group("coverage").containing(parts)
        })
    }
}

/// Returns a panel with the elements from y = `free` to y = `bottom`, px.
fn lifted(free: f64, bottom: f64, caption: String, inside: Vec<Element>) -> DrawingPanel {
    let lifted = Element::group("lifted")
        .with("transform", format!("translate(0 {})", px(-free)))
        .containing(inside);
    DrawingPanel { height: bottom - free, caption, inside: vec![lifted] }
}

fn pose(state: &ScaleState) -> Pose {
    let [x, y] = state.displacement;
    Pose::new(x, y, state.rotation_deg.to_radians())
}

/// Returns the indices of the first and last scale that the drawing shows.
///
/// The range contains all scales that move or touch, and two more on each side. It ends at the ends
/// of the row, and at a total width of about [`WIDEST`].
fn window(row: &Row, length: RowLength, states: &[RowSnapshot]) -> (i64, i64) {
    let scales = states.iter().flat_map(|state| &state.scales);
    let moved = scales.map(|s| (s.scale, s.displacement[0].hypot(s.displacement[1])));
    let most = moved.clone().map(|(_, distance)| distance).fold(0.0, f64::max);
    let moving = moved.filter(|(_, distance)| *distance > STILL * most).map(|(scale, _)| scale);
    let touching = states.iter().flat_map(|state| {
        let first = state.scales.first().map_or(0, |scale| scale.scale);
        state.contacts.iter().flat_map(move |contact| {
            [contact.left, contact.right].map(|scale| first + scale as i64)
        })
    });
    let (first, last) =
        moving.chain(touching).fold((0, 0), |(low, high), i| (low.min(i), high.max(i)));
    let half = ((0.5 * WIDEST / row.pitch()) as i64).clamp(3, 150);
    let (first, last) = ((first - 2).clamp(-half, -3), (last + 2).clamp(3, half));
    match length {
        RowLength::Auto => (first, last),
        RowLength::Scales(count) => {
            let count = count as i64;
            (first.max((1 - count) / 2), last.min(count / 2))
        }
    }
}

/// Returns a point of a circle; the angle is clockwise on paper, in radians from the right.
fn on_circle(center: Spot, radius: f64, angle: f64) -> Spot {
    [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
}

/// Formats a number with three significant digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    // Round first, because 0.09999 and 0.1 are equal to three digits.
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let text = match 2 - rounded.abs().log10().floor() as i32 {
        decimals @ 0..=6 => format!("{rounded:.0$}", decimals.unsigned_abs() as usize),
        ..0 => format!("{rounded}"),
        _ => format!("{rounded:.2e}"),
    };
    text.replace('-', "−")
}
