//! First failure along the path, and the largest stresses of scales, bonds and tissue.

use std::sync::Arc;

use geometry::Vec2;
use serde::{Deserialize, Serialize};
use solver::{Bracket, Continuation, Peak, Summit};
use substrate::SubstrateLaw;

use super::adaptive_row::Segment;
use super::beam::{BaseTractions, Beam, Load, TipMotion};
use super::needle::CriticalEvent;
use super::parameters::{PunctureParameters, Strengths};
use super::system::{Chain, FIRST_LIMIT_MARK};
use crate::contacts::{SkinMode, SkinPoint, SkinState};
use crate::record::PathFunction;

/// Rotation of the tip of a scale relative to its base at which the scale fails by bending.
///
/// Linear beam theory is accurate up to about this angle.
const LARGEST_BEND_DEG: f64 = 5.0;

/// Pressure of a rigid punch that perforates a ductile plate, divided by the strength.
///
/// This estimate is the indentation pressure of a rigid–plastic half-space, `3 σ_y`.
const PERFORATION: f64 = 3.0;

/// Mode of failure of a skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FailureMode {
    /// A scale reaches the critical tilt.
    Tilt,
    /// The needle reaches the soft surface between two bases.
    Through,
    /// The surface of the substrate folds over.
    Fold,
    /// The stress of a scale reaches its strength.
    Break,
    /// A scale bends too far to count as rigid.
    Bend,
    /// The traction at a base reaches the strength of the bond.
    Debond,
    /// A round tip perforates a scale.
    Perforate,
    /// A scale tilts about the axis of the row under a load near its side edge.
    Across,
}

impl FailureMode {
    /// All modes.
    pub const ALL: [Self; 8] = [
        Self::Tilt,
        Self::Through,
        Self::Fold,
        Self::Break,
        Self::Bend,
        Self::Debond,
        Self::Perforate,
        Self::Across,
    ];

    /// Returns the short name used in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tilt => "tilt",
            Self::Through => "through",
            Self::Fold => "fold",
            Self::Break => "break",
            Self::Bend => "bend",
            Self::Debond => "debond",
            Self::Perforate => "perforate",
            Self::Across => "across",
        }
    }

    /// Returns the reason why this mode is not judged; `None` if it is judged.
    ///
    /// A mode is not judged if a puncture with these `parameters` cannot fail in this mode, or if a
    /// parameter is missing. `across` is true if the row across is solved, which is a separate
    /// puncture.
    pub fn not_judged(self, parameters: &PunctureParameters, across: bool) -> Option<&'static str> {
        let PunctureParameters { needle, needle_radius, substrate_law, failure, .. } = parameters;
        let Strengths { scale, bond } = failure.unwrap_or_default();
        let is_round = needle_radius.is_some_and(|radius| radius > 0.0);
        match self {
            Self::Through if !needle.is_guided() => Some("the needle is not guided"),
            Self::Fold if *substrate_law == SubstrateLaw::NeoHookean => {
                Some("a neo-hookean substrate cannot fold")
            }
            Self::Across if !across => Some("the gap across the row is not given"),
            Self::Perforate if !is_round => Some("the needle has no radius"),
            Self::Break | Self::Perforate if scale.is_none() => {
                Some("the strength of the scales is not given")
            }
            Self::Debond if bond.is_none() => Some("the strength of the bond is not given"),
            _ => None,
        }
    }
}

/// First failure, and the largest stresses on the path; empty unless requested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FailureMeasures {
    /// Mode of the first failure on the path; `None` if the path ends early without a failure.
    pub mode: Option<FailureMode>,
    /// Load `F*` at the first failure.
    pub force: Option<f64>,
    /// Largest bending stress of any scale up to the end of the path, in units of `E_s`.
    pub scale_stress: Option<f64>,
    /// Largest deflection of the tip of any scale, in units of `t`.
    pub scale_deflection: Option<f64>,
    /// Largest traction at the bond of any scale, in tension or shear, in units of `E_s`.
    pub bond_stress: Option<f64>,
    /// Largest mean pressure of any base on the substrate, in units of `E_s`.
    pub tissue_pressure: Option<f64>,
    /// Distance between the facing sides of two neighbours at rest, in units of `t`.
    pub clearance: Option<f64>,
}

impl FailureMeasures {
    /// Returns only the values that are valid for a path that ended early.
    ///
    /// They are the first failure and the clearance; maxima refer to a complete path.
    pub(super) fn without_final_values(self) -> Self {
        Self { mode: self.mode, force: self.force, clearance: self.clearance, ..Self::default() }
    }
}

/// Modes in which a single scale reaches a limit, in the order of their markers.
const LIMITS: [FailureMode; 4] =
    [FailureMode::Break, FailureMode::Bend, FailureMode::Debond, FailureMode::Perforate];

/// Index of bending in [`LIMITS`].
const BEND: usize = 1;
const _: () = assert!(matches!(LIMITS[BEND], FailureMode::Bend));

/// Functions with a tracked maximum along the path.
///
/// They are the largest bending stress, deflection, bond stress and tissue pressure of any scale.
pub(super) const MAXIMA: [PathFunction<Chain>; 4] = [
    |chain, state, _| chain.row_values(state).tracked[0],
    |chain, state, _| chain.row_values(state).tracked[1],
    |chain, state, _| chain.row_values(state).tracked[2],
    |chain, state, _| chain.row_values(state).tracked[3],
];

/// Index of the pressure on the tissue in [`MAXIMA`].
pub(super) const TISSUE_PRESSURE: usize = 3;

/// Largest relative error of the point at which the limit of linear bending ends a path.
///
/// It is the accuracy of an equilibrium.
const BEND_TOLERANCE: f64 = 1e-10;

/// Largest relative error of the point at which a limit other than linear bending is reached.
const LIMIT_TOLERANCE: f64 = 2e-12;

/// Number of evaluations after which a bracket is as narrow as an `f64` allows.
const EVALUATIONS: usize = 100;

/// Change of the fastest unknown in the backward difference for the slope at a point.
const STEP: f64 = 1e-6;

/// Returns the point of a segment at which an elastic scale reaches the limit of linear bending.
///
/// `None` if no scale reaches this limit, and for rigid scales.
pub(super) fn bent_within(
    path: &mut Continuation<Chain>,
    Segment { from, to, .. }: &Segment,
) -> Option<SkinPoint> {
    if !path.system().is_elastic || excess(path, to, BEND) < 0.0 {
        return None;
    }
    let point = limit_within(path, [from, to], BEND, BEND_TOLERANCE);
    // The point is not an event, even if the segment ends at an event.
    Some(SkinPoint { event: None, ..point.unwrap_or_else(|| SkinPoint::clone(to)) })
}

/// Computes the largest utilisation (value divided by limit) of any scale, minus 1.
fn excess(path: &Continuation<Chain>, point: &SkinPoint, limit: usize) -> f64 {
    path.system().utilisations(&point.state)[limit] - 1.0
}

/// Solves for the equilibrium between two points at which a scale reaches a limit.
///
/// `None` if the limit is reached at the first point already, or Newton's method fails.
fn limit_within(
    path: &mut Continuation<Chain>,
    [from, to]: [&SkinPoint; 2],
    limit: usize,
    tolerance: f64,
) -> Option<SkinPoint> {
    let [start, end] = [from, to].map(|point| excess(path, point, limit));
    if start >= 0.0 {
        return None;
    }
    let mut bracket = Bracket::illinois((0.0, start), (1.0, end));
    let mut point = from.clone();
    for _ in 0..EVALUATIONS {
        let fraction = bracket.secant();
        // Start Newton's method from the previous point, which is nearer than `from`.
        point = path.between_from(from, to, fraction, &point)?;
        let off = excess(path, &point, limit);
        // A bracket of the width of round-off cannot shrink further.
        if off.abs() <= tolerance || bracket.width() < f64::EPSILON {
            return Some(point);
        }
        bracket.narrow(fraction, off);
    }
    None
}

/// Stresses and deflection of a scale, or their largest values in a row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ScaleValues {
    /// Bending stress, deflection, bond stress and tissue pressure, in the order of [`MAXIMA`].
    pub(super) tracked: [f64; 4],
    /// Value divided by its limit, in the order of [`LIMITS`]; failure at 1.
    utilisations: [f64; LIMITS.len()],
}

/// Locates the first failure while a path is followed, and tracks the maxima.
pub(super) struct FailureObserver {
    /// Indices of the judged modes in [`LIMITS`].
    judged: Vec<usize>,
    maxima: [Peak<SkinMode>; MAXIMA.len()],
    /// Largest value divided by its limit at the last point, in the order of [`LIMITS`].
    utilisations: [f64; LIMITS.len()],
    /// First failure before the end of the path, with its point.
    pub(super) first: Option<(FailureMode, SkinPoint)>,
}

impl FailureObserver {
    /// Creates an observer at the first point of a path; `None` if failure is not requested.
    pub(super) fn new(path: &Continuation<Chain>, parameters: &PunctureParameters) -> Option<Self> {
        parameters.failure?;
        let mut observer = Self {
            judged: (0..LIMITS.len())
                .filter(|&limit| LIMITS[limit].not_judged(parameters, false).is_none())
                .collect(),
            maxima: Default::default(),
            utilisations: [0.0; LIMITS.len()],
            first: None,
        };
        observer.visit(path, None);
        Some(observer)
    }

    /// Searches a segment for the first failure.
    ///
    /// `fold` is the first fold of the surface in this segment, if any.
    pub(super) fn follow(
        &mut self,
        path: &mut Continuation<Chain>,
        Segment { from, to, unextended }: &Segment,
        fold: Option<&SkinPoint>,
    ) {
        let before = self.utilisations;
        self.visit(path, Some(unextended));
        if self.first.is_some() {
            return;
        }
        let fold = fold.map(|fold| (FailureMode::Fold, fold.clone()));
        let mut failures: Vec<_> = fold.into_iter().collect();
        for &limit in &self.judged {
            if before[limit] < 1.0 && self.utilisations[limit] >= 1.0 {
                // `bent_within` cuts a segment at the limit of linear bending. If the segment ends
                // at the limit, use its end point.
                let point = if self.utilisations[limit] <= 1.0 + BEND_TOLERANCE {
                    Some(SkinPoint::clone(to))
                } else {
                    limit_within(path, [from, to], limit, LIMIT_TOLERANCE)
                };
                failures.extend(point.map(|point| (LIMITS[limit], point)));
            }
        }
        // Keep the first of several failures within one segment.
        self.first = failures
            .into_iter()
            .min_by(|(_, a), (_, b)| path.spans(from, a)[0].total_cmp(&path.spans(from, b)[0]));
    }

    /// Evaluates the current point of the path; `from` is the point before it.
    fn visit(&mut self, path: &Continuation<Chain>, from: Option<&Arc<SkinPoint>>) {
        let values = path.system().row_values(&path.point().state);
        self.utilisations = values.utilisations;
        if path.system().is_critical_only() {
            return;
        }
        for (peak, value) in self.maxima.iter_mut().zip(values.tracked) {
            peak.visit_value(path, from, value);
        }
    }

    /// Replaces each stored point by the result of `new`, after the row has been extended.
    pub(super) fn replace_points(&mut self, new: impl Fn(&SkinPoint) -> SkinPoint) {
        if let Some((_, point)) = &mut self.first {
            *point = new(point);
        }
        for peak in &mut self.maxima {
            peak.replace_points(&new);
        }
    }

    /// Returns the largest value of each function in [`MAXIMA`] on the path, and its point.
    pub(super) fn summits(
        &self,
        path: &mut Continuation<Chain>,
    ) -> [Option<Summit<SkinMode>>; MAXIMA.len()] {
        std::array::from_fn(|k| {
            let visited = self.maxima[k].at_points()?;
            // Most functions are largest at the end of the path and still increase at this end. A
            // search for a maximum within the last segment is then not necessary.
            let is_end = visited.point.state.z == path.point().state.z;
            if is_end && rises(path.system(), &visited.point, MAXIMA[k]) {
                return Some(visited);
            }
            self.maxima[k].summit(path, MAXIMA[k])
        })
    }

    /// Computes the measures; `end` is the failure mode at the end of a complete path.
    pub(super) fn measures(
        &self,
        path: &mut Continuation<Chain>,
        end: Option<FailureMode>,
    ) -> FailureMeasures {
        let summits = self.summits(path);
        let [scale_stress, scale_deflection, bond_stress, tissue_pressure] =
            summits.map(|summit| summit.map(|summit| summit.value));
        let (chain, last) = (path.system(), path.point());
        let first = self.first.as_ref().map(|(mode, point)| (*mode, point));
        let first = first.or_else(|| Some((end?, last)));
        FailureMeasures {
            mode: first.map(|(mode, _)| mode),
            force: first.map(|(_, point)| chain.force(&point.state)),
            scale_stress,
            scale_deflection,
            bond_stress,
            tissue_pressure,
            clearance: chain.clearance(),
        }
    }
}

/// Computes a stress divided by its strength; 0 if the strength is `None`.
fn utilisation(stress: f64, strength: Option<f64>) -> f64 {
    strength.map_or(0.0, |strength| stress / strength)
}

/// Returns true if a function increases along the path just before a point.
fn rises(chain: &Chain, point: &SkinPoint, f: PathFunction<Chain>) -> bool {
    let direction = &point.arriving;
    let largest = direction.iter().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
    let before = point.state.moved(-STEP / largest, direction);
    f(chain, &point.state, direction) > f(chain, &before, direction)
}

impl From<CriticalEvent> for FailureMode {
    fn from(event: CriticalEvent) -> Self {
        match event {
            CriticalEvent::Tilt => Self::Tilt,
            CriticalEvent::Through => Self::Through,
        }
    }
}

impl Chain {
    /// Lists the forces of neighbours and needle on a scale, in the frame of the scale.
    pub(super) fn loads(&self, state: &SkinState, scale: usize) -> Vec<Load> {
        self.loads_among(&self.contacts.forces_on_scales(state), state, scale)
    }

    /// Lists the forces on a scale, in its frame, given the contact forces on all scales.
    ///
    /// `on_scales` holds the scale, the arm from its node and the force of each contact.
    fn loads_among(
        &self,
        on_scales: &[(usize, [Vec2; 2])],
        state: &SkinState,
        scale: usize,
    ) -> Vec<Load> {
        let of_contacts = on_scales.iter().filter(|(at, _)| *at == scale).map(|(_, force)| *force);
        let of_needle = if self.needle.is_some() {
            self.needle_forces_on(state, scale)
        } else if scale == self.layout.left {
            let load = Vec2::new(0.0, -state.z[self.layout.load()]);
            vec![[self.loaded_arm(&state.z), load]]
        } else {
            Vec::new()
        };
        let mut loads = of_contacts.chain(of_needle).peekable();
        if loads.peek().is_none() {
            return Vec::new();
        }
        let back = contact::Pose::new(0.0, 0.0, -self.displacement(&state.z, scale)[2]);
        loads.map(|[arm, force]| Load { arm: back.turn(arm), force: back.turn(force) }).collect()
    }

    /// Computes stresses, deflection and utilisation of the limits of a scale under these loads.
    fn values_under(&self, state: &SkinState, scale: usize, loads: &[Load]) -> ScaleValues {
        let beam = Beam::new(&self.contacts.arrangement.scale(scale), self.width);
        // Forces are in units of `E*`, moduli and stresses in units of `E_s`.
        let TipMotion { deflection, rotation } =
            beam.tip_motion(loads, self.scale_modulus / self.plane_modulus);
        let BaseTractions { tension, shear, pressure } = beam.base_tractions(loads);
        let [stress, bond_stress, pressure] =
            [beam.stress(loads), tension.max(shear), pressure].map(|x| self.plane_modulus * x);
        let Strengths { scale: strength, bond } = self.strengths;
        let perforated = self.needle_radius.map_or(0.0, |radius| {
            let punch = std::f64::consts::PI * radius.powi(2) * PERFORATION;
            utilisation(self.plane_modulus * self.needle_push_on(state, scale) / punch, strength)
        });
        ScaleValues {
            tracked: [stress, deflection.abs(), bond_stress, pressure],
            utilisations: [
                utilisation(stress, strength),
                rotation.abs().to_degrees() / LARGEST_BEND_DEG,
                utilisation(bond_stress, bond),
                perforated,
            ],
        }
    }

    /// Computes stresses, deflection and utilisation of the limits of a scale.
    pub(super) fn scale_values(&self, state: &SkinState, scale: usize) -> ScaleValues {
        self.values_under(state, scale, &self.loads(state, scale))
    }

    /// Computes the largest mean pressure of any base on the substrate, in units of `E_s`.
    pub(super) fn tissue_pressure(&self, state: &SkinState) -> f64 {
        self.row_values(state).tracked[TISSUE_PRESSURE]
    }

    /// Computes the largest utilisation of each limit by any scale, in the order of [`LIMITS`].
    pub(super) fn utilisations(&self, state: &SkinState) -> [f64; LIMITS.len()] {
        self.row_values(state).utilisations
    }

    /// Computes the largest utilisation of the limit of a failure mode by any scale.
    ///
    /// 0 if the mode is not one of [`LIMITS`].
    pub(super) fn utilisation(&self, state: &SkinState, mode: FailureMode) -> f64 {
        let limit = LIMITS.iter().position(|limit| *limit == mode);
        limit.map_or(0.0, |limit| self.utilisations(state)[limit])
    }

    /// Computes the largest stresses, deflection and utilisations of any scale.
    fn row_values(&self, state: &SkinState) -> ScaleValues {
        let mut largest = ScaleValues::default();
        let on_scales = self.contacts.forces_on_scales(state);
        for scale in 0..self.layout.scales() {
            let loads = self.loads_among(&on_scales, state, scale);
            // Most scales of a row carry no load.
            if loads.is_empty() {
                continue;
            }
            let ScaleValues { tracked, utilisations } = self.values_under(state, scale, &loads);
            for (most, value) in largest.tracked.iter_mut().zip(tracked) {
                *most = most.max(value);
            }
            for (most, value) in largest.utilisations.iter_mut().zip(utilisations) {
                *most = most.max(value);
            }
        }
        largest
    }

    /// Computes the clearance at rest to the right of the punctured scale (B5).
    ///
    /// It is the distance between the facing sides of the two scales, in units of `t`. `None` if
    /// there is no scale on the right.
    pub(super) fn clearance(&self) -> Option<f64> {
        let (contacts, scale) = (&self.contacts, self.layout.left);
        let (arrangement, body) = (&contacts.arrangement, contacts.body);
        (self.layout.right > 0).then(|| {
            if body.is_flat() {
                arrangement.gap(scale) * arrangement.scale(scale).slant().cos()
            } else {
                arrangement.clearance(scale, body)
            }
        })
    }

    /// Evaluates the marker of a limit of a scale: its utilisation minus 1.
    ///
    /// `number` counts the limits scale by scale.
    pub(super) fn limit_marker(&self, state: &SkinState, number: usize) -> f64 {
        let (scale, limit) = (number / LIMITS.len(), number % LIMITS.len());
        self.scale_values(state, scale).utilisations[limit] - 1.0
    }

    /// Returns the number of the marker that is zero where a scale reaches the limit of a mode.
    ///
    /// The scale is the one with the largest utilisation in this `state`. `None` if the mode is not
    /// one of [`LIMITS`].
    pub(super) fn limit_mark(&self, state: &SkinState, mode: FailureMode) -> Option<usize> {
        let limit = LIMITS.iter().position(|other| *other == mode)?;
        let utilisations = (0..self.layout.scales())
            .map(|scale| (scale, self.scale_values(state, scale).utilisations[limit]));
        let (scale, _) = utilisations.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(FIRST_LIMIT_MARK + LIMITS.len() * scale + limit)
    }
}
