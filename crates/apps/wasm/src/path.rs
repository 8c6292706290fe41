//! Paths and drawn states of a design.
//!
//! Lengths are divided by `t`, angles are in degrees, and forces and moments are dimensionless.

use geometry::OutOfRange;
use serde::Serialize;
use skin::flexure::{Flexure, FlexurePoint, StripSnapshot};
use skin::puncture::{At, Puncture, PuncturePoint, RowSnapshot, Snapshots};
use sweep::Case;

/// Number of scales drawn on each side of the middle scale of a strip.
const BESIDE: usize = 6;

/// Coordinates `x` and `y` of a contact, and true if the contact slips; `None` without friction.
type PlacedContact = (f64, f64, Option<bool>);

/// The puncture of a row: path, events and one drawn state.
#[derive(Clone, Debug, Serialize)]
pub struct PuncturedRow {
    /// `u*`, `F*` and the completed fraction of the path for every equilibrium.
    pub path: Vec<[f64; 3]>,
    /// `u*` and `F*` of the contact events.
    pub events: Vec<[f64; 2]>,
    /// `u*` and `F*` at the first fold of the surface.
    pub fold: Option<[f64; 2]>,
    /// `u*` and `F*` of the drawn state.
    pub at: Option<[f64; 2]>,
    /// Number, displacement and rotation (counter-clockwise) of every scale in the drawn state.
    ///
    /// Displacements are in the tangent frames of the body.
    pub scales: Vec<[f64; 4]>,
    /// Closed contacts of the drawn state, with the origin at the punctured scale at rest.
    pub contacts: Vec<PlacedContact>,
    /// Load position on the top of the punctured scale: 0 left corner, 1 right corner.
    pub load_position: f64,
    /// Lowest point and radius of the tip of a guided needle in the drawn state.
    ///
    /// The origin is the node of the punctured scale at rest.
    pub tip: Option<[f64; 3]>,
}

/// The bending of a strip: path, events and one drawn state.
#[derive(Clone, Debug, Serialize)]
pub struct BentStrip {
    /// `κ*`, `M*` and the completed fraction of the path for every equilibrium.
    pub path: Vec<[f64; 3]>,
    /// `κ*` and `M*` of the contact events.
    pub events: Vec<[f64; 2]>,
    /// `κ*` and `M*` of the drawn state.
    pub at: Option<[f64; 2]>,
    /// Position and rotation (counter-clockwise) of the drawn scales, relative to the middle one.
    pub scales: Vec<[f64; 3]>,
    /// Axis of the membrane in the gaps between the drawn scales.
    pub membrane: Vec<Vec<[f64; 2]>>,
    /// Closed contacts between the drawn scales.
    pub contacts: Vec<PlacedContact>,
}

impl PuncturedRow {
    /// Solves the row with the state at the fraction `drawn` of its path.
    ///
    /// `path` is the path with larger steps. `solve` returns the path, and the states at the given
    /// points. `None` if `solve` fails; the measures report such errors.
    pub(crate) fn new(
        case: &Case,
        path: &Puncture,
        drawn: f64,
        solve: impl Fn(&[At]) -> Result<Snapshots, OutOfRange>,
    ) -> Option<Self> {
        // The drawn state is defined by the depth of a guided needle, but by the tilt under a free
        // needle, which may rise while the tilt increases.
        let is_guided = case.puncture.needle.is_guided();
        let along =
            |point: &PuncturePoint| if is_guided { point.displacement } else { point.tilt_deg };
        let end = |path: &[PuncturePoint]| path.last().map_or(0.0, along);
        let position = drawn * end(&path.path);
        let position = if is_guided { At::Displacement(position) } else { At::Tilt(position) };
        let is_between = drawn > 0.0 && drawn < 1.0;
        let solved = solve(if is_between { std::slice::from_ref(&position) } else { &[] }).ok()?;
        // The end of the path is not requested by its value, because the last digits of this value
        // depend on the steps.
        let state = solved.at.into_iter().flatten().next().unwrap_or(solved.end);
        // At rest (`drawn` = 0) no state is drawn.
        let state = (drawn > 0.0).then_some(state);
        let Puncture { path, events, folds, .. } = solved.puncture;
        let on_curve = |point: &PuncturePoint| [point.displacement, point.force];
        let radius = case.puncture.needle_radius.unwrap_or(0.0);
        let end = end(&path);
        let points =
            path.iter().map(|point| [point.displacement, point.force, fraction(along(point), end)]);
        Some(Self {
            path: points.collect(),
            events: events.iter().map(|event| on_curve(&event.point)).collect(),
            fold: folds.first().map(|fold| on_curve(&fold.point)),
            at: state.as_ref().map(|state| [state.displacement, state.force]),
            scales: state.iter().flat_map(scales).collect(),
            contacts: state.iter().flat_map(|state| contacts(case, state)).collect(),
            load_position: case.punctured().load_position,
            tip: state.and_then(|state| state.tip).map(|[x, y]| [x, y, radius]),
        })
    }
}

/// Returns number, displacement and rotation of each scale of a row.
fn scales(state: &RowSnapshot) -> impl Iterator<Item = [f64; 4]> {
    state.scales.iter().map(|scale| {
        let [x, y] = scale.displacement;
        [scale.scale as f64, x, y, scale.rotation_deg].map(rounded)
    })
}

/// Returns the contacts of a row, with the origin at the punctured scale.
///
/// The solver measures positions from the first scale of the row.
fn contacts(case: &Case, state: &RowSnapshot) -> Vec<PlacedContact> {
    let first = state.scales.first().map_or(0.0, |scale| scale.scale as f64);
    let frame = case.body().frame(first * case.pitch());
    state
        .contacts
        .iter()
        .map(|contact| {
            let point = frame.origin + frame.outward(contact.point.into());
            (rounded(point.x), rounded(point.y), contact.slips)
        })
        .collect()
}

impl BentStrip {
    /// Creates the strip with the state at the fraction `drawn` of its path.
    ///
    /// `solve` returns the state at an end rotation.
    pub(crate) fn new(
        case: &Case,
        path: &Flexure,
        drawn: f64,
        solve: impl Fn(f64) -> Option<StripSnapshot>,
    ) -> Self {
        let rotation = |point: &FlexurePoint| point.end_rotation_deg.abs();
        let largest = path.path.iter().map(rotation).fold(0.0, f64::max);
        // Bending to the other side has negative rotations.
        let side = path.path.last().map_or(1.0, |point| point.end_rotation_deg.signum());
        let state = if drawn > 0.0 && largest > 0.0 { solve(side * drawn * largest) } else { None };
        let on_curve = |point: &FlexurePoint| [point.curvature, point.moment];
        let points = path
            .path
            .iter()
            .map(|point| [point.curvature, point.moment, fraction(rotation(point), largest)]);
        let strip = Self {
            path: points.collect(),
            events: path.events.iter().map(|event| on_curve(&event.point)).collect(),
            at: state.as_ref().map(|state| [state.curvature, state.moment]),
            scales: Vec::new(),
            membrane: Vec::new(),
            contacts: Vec::new(),
        };
        let pitch = case.design.row().map_or(0.0, |row| row.pitch());
        state.map_or(strip.clone(), |state| strip.with_middle(&state, pitch))
    }

    /// Adds the scales around the middle of a state, relative to the middle scale.
    ///
    /// Other scales are omitted, because all gaps bend alike, and a whole strip would be too small.
    fn with_middle(self, state: &StripSnapshot, pitch: f64) -> Self {
        let scales = &state.scales;
        let middle = scales.len() / 2;
        let shown = middle.saturating_sub(BESIDE)..(middle + BESIDE + 1).min(scales.len());
        let node = |k: usize| [k as f64 * pitch + scales[k][0], scales[k][1]];
        let ([x, y], turn) = (node(middle), scales[middle][2]);
        let relative = |[px, py]: [f64; 2]| {
            let (dx, dy) = (px - x, py - y);
            [turn.cos() * dx + turn.sin() * dy, turn.cos() * dy - turn.sin() * dx].map(rounded)
        };
        let gaps = shown.start..shown.end.saturating_sub(1).min(state.membrane.len());
        let membrane = state.membrane[gaps.clone()].iter();
        Self {
            scales: shown
                .map(|k| {
                    let [x, y] = relative(node(k));
                    [x, y, rounded((scales[k][2] - turn).to_degrees())]
                })
                .collect(),
            membrane: membrane.map(|axis| axis.iter().copied().map(relative).collect()).collect(),
            contacts: state
                .contacts
                .iter()
                .filter(|contact| gaps.contains(&contact.left))
                .map(|contact| {
                    let [x, y] = relative(contact.point);
                    (x, y, contact.slips)
                })
                .collect(),
            ..self
        }
    }
}

fn fraction(value: f64, whole: f64) -> f64 {
    if whole > 0.0 { value / whole } else { 0.0 }
}

/// Rounds a number for drawings: all digits of the coordinates of a strip would take megabytes.
fn rounded(number: f64) -> f64 {
    (number * 1e5).round() / 1e5
}
