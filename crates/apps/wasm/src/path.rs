//! Paths and drawings of a design. Lengths over `t`, angles in degrees, forces and moments as in the tables.

use geometry::OutOfRange;
use serde::Serialize;
use skin::Contact;
use skin::flexure::{Flexure, FlexurePoint, StripSnapshot};
use skin::puncture::{At, Puncture, PuncturePoint, RowSnapshot, Snapshots};
use sweep::Case;

/// Scales on either side of the middle one that are drawn of a strip.
const BESIDE: usize = 6;

/// Place of a contact, and whether it slips (nothing is known of that without friction).
type PlacedContact = (f64, f64, Option<bool>);

/// A row of scales on its way to the critical tilt.
#[derive(Clone, Debug, Serialize)]
pub struct PuncturedRow {
    /// `u*`, `F*` and the share of the way of every equilibrium.
    pub path: Vec<[f64; 3]>,
    /// `u*` and `F*` where a contact closes, opens or passes a corner.
    pub events: Vec<[f64; 2]>,
    /// `u*` and `F*` where the surface of the substrate first folds over.
    pub fold: Option<[f64; 2]>,
    /// `u*` and `F*` of the state that is drawn.
    pub at: Option<[f64; 2]>,
    /// Number, displacement and rotation (counter-clockwise) of every scale of that state.
    pub scales: Vec<[f64; 4]>,
    /// Every closed contact of that state, from the punctured scale at rest.
    pub contacts: Vec<PlacedContact>,
    /// Place of the load on the top of the punctured scale: 0 the left corner, 1 the right one.
    pub load_position: f64,
    /// Lowest point of the tip of a guided needle in that state, from the node of the punctured scale at rest, and the radius of the tip.
    pub tip: Option<[f64; 3]>,
}

/// A strip on its way to the largest end rotation.
#[derive(Clone, Debug, Serialize)]
pub struct BentStrip {
    /// `κ*`, `M*` and the share of the way of every equilibrium.
    pub path: Vec<[f64; 3]>,
    /// `κ*` and `M*` where a contact closes, opens or passes a corner.
    pub events: Vec<[f64; 2]>,
    /// `κ*` and `M*` of the state that is drawn.
    pub at: Option<[f64; 2]>,
    /// Place and rotation (counter-clockwise) of the scales about the middle of that state, as the middle one sees them.
    pub scales: Vec<[f64; 3]>,
    /// The axis of the membrane in the gaps between them.
    pub membrane: Vec<Vec<[f64; 2]>>,
    /// The closed contacts between them.
    pub contacts: Vec<PlacedContact>,
}

impl PuncturedRow {
    /// Solves the row with the state at the fraction `drawn` of its path.
    ///
    /// `path` is the path with larger steps. `None` on an error, which the measures report.
    pub(crate) fn new(
        case: &Case,
        path: &Puncture,
        drawn: f64,
        solve: impl Fn(&[At]) -> Result<Snapshots, OutOfRange>,
    ) -> Option<Self> {
        // Depth controls a guided needle; a free needle may move up again while the tilt increases.
        let is_guided = case.puncture.needle.is_guided();
        let along =
            |point: &PuncturePoint| if is_guided { point.displacement } else { point.tilt_deg };
        let way = |path: &[PuncturePoint]| path.last().map_or(0.0, along);
        let place = drawn * way(&path.path);
        let place = if is_guided { At::Displacement(place) } else { At::Tilt(place) };
        let is_between = drawn > 0.0 && drawn < 1.0;
        let solved = solve(if is_between { std::slice::from_ref(&place) } else { &[] }).ok()?;
        // Different steps change the last digits, so the end is not found by its value.
        let state = solved.at.into_iter().flatten().next().unwrap_or(solved.end);
        // At rest nothing is drawn but the path.
        let state = (drawn > 0.0).then_some(state);
        let Puncture { path, events, folds, .. } = solved.puncture;
        let place = |point: &PuncturePoint| [point.displacement, point.force];
        let radius = case.puncture.needle_radius.unwrap_or(0.0);
        let way = way(&path);
        let shares =
            path.iter().map(|point| [point.displacement, point.force, share(along(point), way)]);
        Some(Self {
            path: shares.collect(),
            events: events.iter().map(|event| place(&event.point)).collect(),
            fold: folds.first().map(|fold| place(&fold.point)),
            at: state.as_ref().map(|state| [state.displacement, state.force]),
            scales: state.iter().flat_map(scales).collect(),
            contacts: state.iter().flat_map(|state| contacts(case, state)).collect(),
            load_position: case.punctured().load_position,
            tip: state.and_then(|state| state.tip).map(|[x, y]| [x, y, radius]),
        })
    }
}

/// The scales of a row.
fn scales(state: &RowSnapshot) -> impl Iterator<Item = [f64; 4]> {
    state.scales.iter().map(|scale| {
        let [x, y] = scale.displacement;
        [scale.scale as f64, x, y, scale.rotation_deg].map(rounded)
    })
}

/// The contacts of a row: the solver counts lengths from the first scale that it solves for, a drawing from the punctured one.
fn contacts(case: &Case, state: &RowSnapshot) -> Vec<PlacedContact> {
    let first = state.scales.first().map_or(0.0, |scale| scale.scale as f64);
    let pitch = case.design.row().map_or(0.0, |row| row.pitch());
    let placed = |contact: &Contact| {
        let point = [contact.point[0] + first * pitch, contact.point[1]].map(rounded);
        (point[0], point[1], contact.slips)
    };
    state.contacts.iter().map(placed).collect()
}

impl BentStrip {
    /// The strip of a path with the state at the share `drawn` of its way, which `solve` finds at an end rotation.
    pub(crate) fn new(
        case: &Case,
        path: &Flexure,
        drawn: f64,
        solve: impl Fn(f64) -> Option<StripSnapshot>,
    ) -> Self {
        let rotation = |point: &FlexurePoint| point.end_rotation_deg.abs();
        let way = path.path.iter().map(rotation).fold(0.0, f64::max);
        // Bending the other way has negative rotations.
        let side = path.path.last().map_or(1.0, |point| point.end_rotation_deg.signum());
        let state = if drawn > 0.0 && way > 0.0 { solve(side * drawn * way) } else { None };
        let place = |point: &FlexurePoint| [point.curvature, point.moment];
        let shares = path
            .path
            .iter()
            .map(|point| [point.curvature, point.moment, share(rotation(point), way)]);
        let strip = Self {
            path: shares.collect(),
            events: path.events.iter().map(|event| place(&event.point)).collect(),
            at: state.as_ref().map(|state| [state.curvature, state.moment]),
            scales: Vec::new(),
            membrane: Vec::new(),
            contacts: Vec::new(),
        };
        let pitch = case.design.row().map_or(0.0, |row| row.pitch());
        state.map_or(strip.clone(), |state| strip.with_middle(&state, pitch))
    }

    /// With the scales about the middle of a state, as the middle one sees them: all gaps bend alike, and a whole strip is too long
    /// for its scales to be seen.
    fn with_middle(self, state: &StripSnapshot, pitch: f64) -> Self {
        let scales = &state.scales;
        let middle = scales.len() / 2;
        let shown = middle.saturating_sub(BESIDE)..(middle + BESIDE + 1).min(scales.len());
        let node = |k: usize| [k as f64 * pitch + scales[k][0], scales[k][1]];
        let ([x, y], turn) = (node(middle), scales[middle][2]);
        let seen = |[px, py]: [f64; 2]| {
            let (dx, dy) = (px - x, py - y);
            [turn.cos() * dx + turn.sin() * dy, turn.cos() * dy - turn.sin() * dx].map(rounded)
        };
        let pose = |k: usize| {
            let [x, y] = seen(node(k));
            [x, y, rounded((scales[k][2] - turn).to_degrees())]
        };
        let gaps = shown.start..shown.end.saturating_sub(1).min(state.membrane.len());
        let of_shown = |contact: &&Contact| gaps.contains(&contact.left);
        let membrane = state.membrane[gaps.clone()].iter();
        Self {
            scales: shown.map(pose).collect(),
            membrane: membrane.map(|axis| axis.iter().copied().map(seen).collect()).collect(),
            contacts: state
                .contacts
                .iter()
                .filter(of_shown)
                .map(|contact| {
                    let [x, y] = seen(contact.point);
                    (x, y, contact.slips)
                })
                .collect(),
            ..self
        }
    }
}

fn share(value: f64, whole: f64) -> f64 {
    if whole > 0.0 { value / whole } else { 0.0 }
}

/// A number as a drawing needs it: with all digits of all its numbers a strip would be an answer of megabytes.
fn rounded(number: f64) -> f64 {
    (number * 1e5).round() / 1e5
}
