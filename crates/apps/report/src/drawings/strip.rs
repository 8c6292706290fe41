//! Drawings of a bent strip: a membrane with scales.

use contact::Pose;
use geometry::{Body, OutOfRange, Row};
use results::bending_units;
use skin::Contact;
use skin::flexure::StripSnapshot;
use sweep::Case;

use super::bodies::{corners, overlaps};
use super::contacts::{self, LONGEST};
use super::row::short;
use super::scale_bar::scale_bar;
use super::view::{Extent, View};
use super::{DrawingPanel, MARGIN, WIDTH, contacts_label, geometry_label, stacked};
use crate::colors::{FAINT, INK};
use crate::label::{Anchor, label};
use crate::svg::{Element, Spot, arrow, polygon, polyline, rect};

/// Width of the enlarged gap, px.
const ENLARGED: f64 = 290.0;
/// Minimum and maximum height of the enlarged gap, px.
const HEIGHT: [f64; 2] = [190.0, 300.0];
/// Horizontal and vertical space for the arrows around the enlarged gap, px.
const ARROWS: Spot = [100.0, 150.0];
/// Maximum height of the whole strip, px.
const TALLEST: f64 = 430.0;

/// The drawing of a bent design.
#[derive(Clone, Debug)]
pub struct FlexureDrawing<'a> {
    /// The name of the design, placed before the geometry in the title.
    pub name: &'a str,
    /// Geometry, membrane and material. A known thickness adds scale bars.
    pub case: &'a Case,
    /// The states, from top to bottom.
    pub states: &'a [StripSnapshot],
}

impl FlexureDrawing<'_> {
    /// Returns the drawing as SVG: each state with the whole strip and the enlarged middle gap.
    ///
    /// # Errors
    /// If the design is invalid.
    pub fn svg(&self) -> Result<String, OutOfRange> {
        Ok(stacked(&self.title(), self.frames()?))
    }

    pub(super) fn title(&self) -> String {
        format!("{}, bending: {}", self.name, geometry_label(self.case))
    }

    pub(super) fn frames(&self) -> Result<Vec<DrawingPanel>, OutOfRange> {
        let row = self.case.design.row()?;
        Ok(self.states.iter().map(|state| self.panel(&row, state)).collect())
    }

    fn panel(&self, row: &Row, state: &StripSnapshot) -> DrawingPanel {
        let shape = Shape::upright(row, state);
        let area = [WIDTH - ENLARGED - 3.0 * MARGIN, TALLEST];
        let extent = shape.extent();
        let ([width, height], middle) = (extent.size(), extent.middle());
        let scale = (area[0] / width).min(area[1] / height);
        let enlarged = Enlarged::of(row, state);
        let tall = (scale * height + 24.0).max(enlarged.height + 12.0);
        let view = View {
            scale,
            origin: [MARGIN + 0.5 * area[0] - scale * middle[0], 0.5 * tall + scale * middle[1]],
        };
        let whole = Element::group("strip").containing([
            shape.membrane(&view, (scale * self.case.flexure.membrane_thickness).max(1.0)),
            shape.scales(&view, outline(row, scale).clamp(0.08, 0.4)),
            contacts::halos(&view, &shape.contacts, (0.25 * scale).clamp(2.0, 7.0)),
        ]);
        let cell = self.cell(row, &enlarged, tall);
        let bar = scale_bar(&view, self.case.material.thickness_mm, [MARGIN + area[0], 14.0]);
        let inside = [whole, cell].into_iter().chain(bar).collect();
        DrawingPanel { height: tall + 8.0, caption: caption(self.case, state), inside }
    }

    /// Draws an enlarged gap with contact forces, moments and overlap.
    fn cell(&self, row: &Row, enlarged: &Enlarged, tall: f64) -> Element {
        let Enlarged { shape, scale, middle, height, .. } = enlarged;
        let frame = [WIDTH - MARGIN - ENLARGED, 0.5 * (tall - height)];
        let view = View {
            scale: *scale,
            origin: [
                frame[0] + 0.5 * ENLARGED - scale * middle[0],
                frame[1] + 0.46 * height + scale * middle[1],
            ],
        };
        let unit = LONGEST / contacts::largest(&shape.contacts).max(f64::MIN_POSITIVE);
        let border = rect(frame, [ENLARGED, *height]).at("rx", 4.0);
        let spot = [frame[0] + 0.5 * ENLARGED, frame[1] + height - 9.0];
        let name = label("one gap, enlarged", spot, 11.0, Anchor::Middle).with("fill", FAINT);
        let corner = [frame[0] + ENLARGED - 12.0, frame[1] + 22.0];
        let bar = scale_bar(&view, self.case.material.thickness_mm, corner);
        let parts = [
            border.with("fill", "#fbfbfb").with("stroke", "#bdbdbd"),
            shape.membrane(&view, (scale * self.case.flexure.membrane_thickness).max(1.5)),
            shape.scales(&view, outline(row, *scale).clamp(0.4, 0.9)),
            contacts::overlaps(&view, &shape.overlaps),
            contacts::halos(&view, &shape.contacts, 8.0),
            contacts::forces(&view, &shape.contacts, unit),
            moments(&view, shape, enlarged.bends_inward),
            name,
        ];
        Element::group("gap").containing(parts.into_iter().chain(bar))
    }
}

/// The enlarged gap in the middle of a strip.
struct Enlarged {
    shape: Shape,
    /// Length of `t`, px.
    scale: f64,
    /// Centre of the two scales beside the gap, in units of `t`.
    middle: [f64; 2],
    /// Height of the enlarged gap, px.
    height: f64,
    /// True if the moment bends the strip so that the scales are on the inside.
    bends_inward: bool,
}

impl Enlarged {
    /// Returns the middle gap of a strip, enlarged as far as its frame allows.
    fn of(row: &Row, state: &StripSnapshot) -> Self {
        let shape = Shape::of_gap(row, state, (state.scales.len() - 1) / 2);
        let extent = shape.extent();
        let ([width, height], middle) = (extent.size(), extent.middle());
        let scale = ((ENLARGED - ARROWS[0]) / width).min((HEIGHT[1] - ARROWS[1]) / height);
        let height = (scale * height + ARROWS[1]).clamp(HEIGHT[0], HEIGHT[1]);
        Self { shape, scale, middle, height, bends_inward: state.moment >= 0.0 }
    }
}

/// Returns the line width of outlines, px.
///
/// Outlines of thin scales are thinner, so that the area inside stays visible.
fn outline(row: &Row, scale: f64) -> f64 {
    0.12 * scale * row.pitch()
}

fn caption(case: &Case, state: &StripSnapshot) -> String {
    let (kappa, m) = (state.curvature, state.moment);
    let bend = match bending_units(case) {
        Some([per_mm, n_mm, _]) => {
            format!("$κ$ = {} 1/mm,  $M$ = {} N mm", short(kappa * per_mm), short(m * n_mm))
        }
        None => format!("$κ^*$ = {},  $M^*$ = {}", short(kappa), short(m)),
    };
    format!(
        "{bend},  each end turned by {}°,  {}",
        // Adding zero replaces −0 by 0.
        format!("{:.2}", state.end_rotation_deg + 0.0).replace('-', "−"),
        contacts_label(&state.contacts)
    )
}

/// The shapes of a strip or gap, rotated so that both ends have equal and opposite rotations.
struct Shape {
    bodies: Vec<[[f64; 2]; 4]>,
    membrane: Vec<Vec<[f64; 2]>>,
    contacts: Vec<Contact>,
    overlaps: Vec<(usize, Vec<[f64; 2]>)>,
}

impl Shape {
    fn upright(row: &Row, state: &StripSnapshot) -> Self {
        let poses = poses(state);
        let bodies =
            poses.iter().enumerate().map(|(i, pose)| corners(row, Body::default(), i as f64, pose));
        let shape = Self {
            bodies: bodies.collect(),
            membrane: state.membrane.clone(),
            contacts: state.contacts.clone(),
            // Overlaps of a millionth of the thickness are invisible at the size of a whole strip.
            overlaps: Vec::new(),
        };
        // A strip has at least one gap, hence two scales.
        let [first, .., last] = state.scales.as_slice() else { return shape };
        shape.turned(-0.5 * (first[2] + last[2]))
    }

    /// Returns the gap to the right of scale `left`, with the scales on both sides.
    fn of_gap(row: &Row, state: &StripSnapshot, left: usize) -> Self {
        let pair: Vec<Pose> = poses(state)[left..left + 2].to_vec();
        // The origin of `overlaps` is the left scale of the pair. The origin of a strip is its
        // first scale.
        let along = left as f64 * row.pitch();
        let bodies = (0..2).map(|i| corners(row, Body::default(), (left + i) as f64, &pair[i]));
        let overlaps = overlaps(row, Body::default(), &pair)
            .into_iter()
            .map(|(_, points)| (left, points.iter().map(|p| [p[0] + along, p[1]]).collect()));
        let contacts = state.contacts.iter().filter(|contact| contact.left == left);
        let turn = -0.5 * (pair[0].rotation + pair[1].rotation);
        let shape = Self {
            bodies: bodies.collect(),
            membrane: state.membrane.get(left).cloned().into_iter().collect(),
            contacts: contacts.copied().collect(),
            overlaps: overlaps.collect(),
        };
        shape.turned(turn)
    }

    fn turned(mut self, angle: f64) -> Self {
        let pose = Pose::new(0.0, 0.0, angle);
        let bodies = self.bodies.iter_mut().flatten();
        let membrane = self.membrane.iter_mut().flatten();
        let overlaps = self.overlaps.iter_mut().flat_map(|(_, points)| points);
        let contacts = self.contacts.iter_mut();
        let contacts = contacts.flat_map(|contact| [&mut contact.point, &mut contact.force]);
        for vector in bodies.chain(membrane).chain(overlaps).chain(contacts) {
            *vector = pose.turn((*vector).into()).into();
        }
        self
    }

    fn extent(&self) -> Extent {
        Extent::around(self.bodies.iter().flatten())
    }

    fn scales(&self, view: &View, stroke: f64) -> Element {
        Element::group("scales")
            .with("fill", "#c9d6e1")
            .with("fill-opacity", "0.92")
            .with("stroke", "#33414d")
            .with("stroke-width", stroke.to_string())
            .with("stroke-linejoin", "round")
            .containing(self.bodies.iter().map(|body| polygon(&view.all(body))))
    }

    /// Draws the axis of the membrane: curved in the gaps, straight under the bases.
    fn membrane(&self, view: &View, width: f64) -> Element {
        let bases = self.bodies.iter().map(|body| view.all(&body[..2]));
        let gaps = self.membrane.iter().map(|axis| view.all(axis));
        Element::group("membrane")
            .with("stroke", "#c27f2c")
            .at("stroke-width", width)
            .containing(bases.chain(gaps).map(|points| polyline(&points)))
    }
}

fn poses(state: &StripSnapshot) -> Vec<Pose> {
    state.scales.iter().map(|&[x, y, rotation]| Pose::new(x, y, rotation)).collect()
}

/// Draws the moments that bend the gap as curved arrows at its two ends.
fn moments(view: &View, shape: &Shape, inward: bool) -> Element {
    let ([left, ..], [_, right, ..]) = (shape.bodies[0], shape.bodies[1]);
    let (left, right) = (view.place(left), view.place(right));
    // Distance by which both arrows of a short gap move outwards.
    let apart = (0.5 * (50.0 - (right[0] - left[0]))).max(0.0);
    let (left, right) = (shifted(left, [-apart, 0.0]), shifted(right, [apart, 0.0]));
    // The arrows run outwards from below the base, so that they do not cross slanted scales.
    let turn = 2.0;
    let [of_left, of_right] = if inward {
        [moment_arrow(left, 5.3, -turn), moment_arrow(right, -2.16, turn)]
    } else {
        [moment_arrow(left, 5.3 - turn, turn), moment_arrow(right, turn - 2.16, -turn)]
    };
    Element::group("moments").containing([
        of_left,
        of_right,
        label("$M$", shifted(left, [-30.0, 26.0]), 13.0, Anchor::Middle),
        label("$M$", shifted(right, [30.0, 26.0]), 13.0, Anchor::Middle),
    ])
}

/// Draws an arrow along an arc around `center`.
///
/// The arc begins at the angle `start` and spans the angle `sweep`, in radians counter-clockwise.
fn moment_arrow(center: Spot, start: f64, sweep: f64) -> Element {
    let arc: [Spot; 18] = std::array::from_fn(|k| {
        // The last point is the tip of the arrow, beyond the end of the line.
        let part = if k < 17 { k as f64 / 16.0 } else { 1.12 };
        let angle = start + sweep * part;
        [center[0] + 22.0 * angle.cos(), center[1] - 22.0 * angle.sin()]
    });
    let curve = polyline(&arc[..17]).with("stroke", INK).at("stroke-width", 1.8);
    Element::group("moment").containing([curve, arrow(arc[14], arc[17], INK, 1.8)])
}

fn shifted([x, y]: Spot, [dx, dy]: [f64; 2]) -> Spot {
    [x + dx, y + dy]
}
