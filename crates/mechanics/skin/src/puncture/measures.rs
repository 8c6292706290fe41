//! Measures of a puncture.

use serde::{Deserialize, Serialize};
use solver::Continuation;

use super::failure::{FailureMeasures, FailureMode};
use super::surface_fold::Fold;
use super::system::Chain;
use super::{Passage, PuncturePoint, Weakest};
use crate::Remains;
use crate::common::is_default;
use crate::record::{Record, Skin};

/// The measures of a puncture; `None` if a value does not exist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PunctureMeasures {
    /// `F_c* = F (1−ν²)/(E_s L t)` at the critical tilt.
    pub critical_force: Option<f64>,
    /// Largest `F*` up to the critical tilt, or up to the end of an incomplete path.
    pub peak_force: Option<f64>,
    /// `u_c* = u/t` of the loaded point at the critical tilt.
    pub critical_displacement: Option<f64>,
    /// Depth of the deepest base corner of any scale at the critical tilt, in units of `t`.
    pub penetration: Option<f64>,
    /// Depth of the deepest node at the critical tilt, in units of `t`.
    pub sink: Option<f64>,
    /// `u*` at the first contact between two scales.
    pub first_contact_displacement: Option<f64>,
    /// Number of closed contacts at the critical tilt.
    pub contacts: Option<usize>,
    /// Number of scales that touch another scale at the critical tilt.
    pub engaged_scales: Option<usize>,
    /// Number of scales in the row; in a row without ends, of solved scales.
    pub scales: usize,
    /// `K* = K/(E_s t)` at rest.
    pub initial_stiffness: Option<f64>,
    /// Largest `K*` on the path.
    pub max_stiffness: Option<f64>,
    /// Secant stiffness `K*` at the critical tilt.
    pub secant_stiffness: Option<f64>,
    /// `u*` at the largest `F*`.
    pub peak_displacement: Option<f64>,
    /// Tilt of the punctured scale at the largest `F*`, degrees.
    pub peak_tilt_deg: Option<f64>,
    /// True if the row is stable at the critical tilt under a constant load.
    pub stable_under_load: Option<bool>,
    /// True if the row is stable at the critical tilt at constant depth of the load.
    pub stable_under_depth: Option<bool>,
    /// `F*` up to which the path is stable under load control; `None` if the whole path is.
    pub load_stability_force: Option<f64>,
    /// `F*` up to which the path is stable under depth control; `None` if the whole path is.
    pub depth_stability_force: Option<f64>,
    /// Number of snaps under a monotonically descending needle.
    #[serde(default)]
    pub snaps: usize,
    /// Stretch of the tightest gap at the critical tilt (V1).
    pub gap_stretch_min: Option<f64>,
    /// Stretch of the widest gap at the critical tilt.
    pub gap_stretch_max: Option<f64>,
    /// `F*` at the first fold of the surface (V2).
    pub fold_force: Option<f64>,
    /// `u*` at the first fold.
    pub fold_displacement: Option<f64>,
    /// Tilt of the punctured scale at the first fold, degrees.
    pub fold_tilt_deg: Option<f64>,
    /// `F*` at the critical tilt or at the first fold, whichever comes first.
    ///
    /// It is the largest force within the validity of the model.
    pub sound_force: Option<f64>,
    /// `F*` at the requested depth, or at the critical tilt if the path reaches it first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_at_depth: Option<f64>,
    /// Largest mean pressure of any base on the substrate at the requested force, in `E_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tissue_pressure_at_force: Option<f64>,
    /// Frictional dissipation between scales up to the critical tilt, in `E* t³`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_work: Option<f64>,
    /// True if the solver found only one outgoing branch at every event.
    ///
    /// `None` without friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unique: Option<bool>,
    /// Residual state after unloading.
    #[serde(default, skip_serializing_if = "is_default")]
    pub remains: Remains,
    /// Passage of a guided needle through the row.
    #[serde(default, skip_serializing_if = "is_default")]
    pub passage: Passage,
    /// First failure and largest stresses, if requested.
    #[serde(default, skip_serializing_if = "is_default")]
    pub failure: FailureMeasures,
    /// Critical force across the row, if requested.
    #[serde(default, skip_serializing_if = "is_default")]
    pub across: AcrossMeasures,
    /// The weakest of several load positions.
    #[serde(default, skip_serializing_if = "is_default")]
    pub weakest: Weakest,
    /// The smallest critical force on bodies between two radii, if requested.
    #[serde(default, skip_serializing_if = "is_default")]
    pub between: BetweenMeasures,
}

/// Smallest critical force on bodies between two radii; empty unless requested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BetweenMeasures {
    /// Smallest `F*` at the critical tilt on any of these bodies.
    pub force: Option<f64>,
    /// Curvature `t/R` of the body with the smallest force.
    pub curvature: Option<f64>,
}

/// Critical forces across the row and in the weaker direction; empty unless requested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AcrossMeasures {
    /// `F*` at the critical tilt across the row, divided by the `L` of the row along.
    pub force: Option<f64>,
    /// The smaller of the forces across and along the row.
    pub any_direction: Option<f64>,
}

impl PunctureMeasures {
    /// Adds the critical force `across` the row.
    ///
    /// `along` is the critical force at the weakest load position along the row. `across` and
    /// `along` are `None` if the path in this direction did not reach its end. `largest` is the
    /// largest force on the path across. If `largest` is at least `along`, the skin fails along the
    /// row first, even if the path across ended early.
    #[must_use]
    pub fn with_across(
        mut self,
        across: Option<f64>,
        largest: Option<f64>,
        along: Option<f64>,
    ) -> Self {
        let largest = largest.unwrap_or(f64::NEG_INFINITY);
        let any_direction = match across {
            Some(across) => along.map(|along| across.min(along)),
            None => along.filter(|along| largest >= *along),
        };
        self.across = AcrossMeasures { force: across, any_direction };
        match (across, self.failure.force) {
            (Some(across), Some(along)) if across < along => {
                (self.failure.mode, self.failure.force) = (Some(FailureMode::Across), Some(across));
            }
            (None, Some(along)) if largest >= along => {}
            // An unknown force across may be smaller than the failure force along the row.
            (None, _) => (self.failure.mode, self.failure.force) = (None, None),
            _ => {}
        }
        self
    }

    /// Computes the measures at the end of a path and along the path.
    pub(crate) fn new(
        record: &Record<Chain>,
        folds: &[Fold],
        path: &mut Continuation<Chain>,
    ) -> Self {
        let max_stiffness = if path.system().is_critical_only() {
            None
        } else {
            record.stiffness_summit(path).map(|summit| summit.value)
        };
        let (chain, state) = (path.system(), &path.point().state);
        let (end, modulus) = (chain.path_point(path.point()), chain.plane_modulus);
        let along_path = !chain.is_critical_only();
        let peak = peak(&record.path).filter(|_| along_path);
        let first_contact = record.first_contact().filter(|_| along_path);
        let scales = 0..chain.layout.scales();
        let stretch = chain.gap_stretches(state);
        let fold = folds.first().map(|fold| fold.point);
        let nodes = scales.map(|i| -chain.displacement(&state.z, i)[1]);
        Self {
            critical_force: Some(end.force),
            peak_force: peak.map(|point| point.force),
            critical_displacement: Some(end.displacement),
            penetration: Some(chain.penetration(&state.z)),
            sink: nodes.reduce(f64::max),
            first_contact_displacement: first_contact.map(|point| point.displacement),
            contacts: Some(end.contacts),
            engaged_scales: Some(chain.contacts.engaged(state)),
            scales: chain.row_length(),
            initial_stiffness: along_path.then_some(modulus * record.initial_stiffness),
            max_stiffness: max_stiffness.map(|stiffness| modulus * stiffness),
            // `F*` is divided by `L`, but `K*` is not. A needle that is through at rest has neither
            // force nor displacement, and no secant stiffness.
            secant_stiffness: Some(modulus * end.force * chain.length / end.displacement)
                .filter(|stiffness| stiffness.is_finite()),
            peak_displacement: peak.map(|point| point.displacement),
            peak_tilt_deg: peak.map(|point| point.tilt_deg),
            gap_stretch_min: stretch.map(|stretch| stretch.min),
            gap_stretch_max: stretch.map(|stretch| stretch.max),
            fold_force: fold.map(|fold| fold.force),
            fold_displacement: fold.map(|fold| fold.displacement),
            fold_tilt_deg: fold.map(|fold| fold.tilt_deg),
            sound_force: chain.measures_folds().then(|| fold.map_or(end.force, |fold| fold.force)),
            friction_work: record.path.last().and_then(|point| point.friction_work),
            unique: chain.contacts.has_friction().then(|| path.is_unique()),
            ..Self::default()
        }
    }

    /// Returns only the measures that are valid for a path that did not reach its target.
    pub(crate) fn without_final_values(self) -> Self {
        Self {
            first_contact_displacement: self.first_contact_displacement,
            scales: self.scales,
            initial_stiffness: self.initial_stiffness,
            peak_force: self.peak_force,
            peak_displacement: self.peak_displacement,
            peak_tilt_deg: self.peak_tilt_deg,
            load_stability_force: self.load_stability_force,
            depth_stability_force: self.depth_stability_force,
            snaps: self.snaps,
            fold_force: self.fold_force,
            fold_displacement: self.fold_displacement,
            fold_tilt_deg: self.fold_tilt_deg,
            // The force at a depth and the pressure at a force belong to points before the end of
            // the path, so they remain valid.
            force_at_depth: self.force_at_depth,
            tissue_pressure_at_force: self.tissue_pressure_at_force,
            unique: self.unique,
            failure: self.failure.without_final_values(),
            passage: self.passage,
            ..Self::default()
        }
    }
}

/// Returns the first point with the largest force.
///
/// `None` if the path has only one point. Extrema of the load are points of the path, so a search
/// between points is not needed.
fn peak(path: &[PuncturePoint]) -> Option<&PuncturePoint> {
    path.iter().skip(1).reduce(|best, point| if point.force > best.force { point } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_weaker_row_across_replaces_the_first_failure_along_the_row() {
        let failure = FailureMeasures {
            mode: Some(FailureMode::Tilt),
            force: Some(2.0),
            ..FailureMeasures::default()
        };
        let along = PunctureMeasures { failure, ..PunctureMeasures::default() };
        for (across, expected) in [(3.0, Some(2.0)), (1.0, None)] {
            let measures = along.with_across(None, Some(across), Some(2.0));
            assert_eq!(measures.failure.force, expected);
            assert_eq!(measures.across.any_direction, expected);
        }
        let weaker = along.with_across(Some(1.5), Some(1.5), Some(2.0)).failure;
        assert_eq!((weaker.mode, weaker.force), (Some(FailureMode::Across), Some(1.5)));
    }
}
