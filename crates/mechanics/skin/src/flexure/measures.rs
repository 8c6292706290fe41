//! Measures of a bent strip.

use serde::{Deserialize, Serialize};
use solver::Continuation;

use super::FlexurePoint;
use super::problem::LOCKED;
use super::strip::Strip;
use crate::Remains;
use crate::common::is_default;
use crate::contacts::Contacts;
use crate::record::Record;

/// The measures of bending; `None` for a measure without a value.
///
/// The dimensionless moment is `M* = M t/(E_m I_m)`. The dimensionless curvature is `κ* = κ t`,
/// where `κ` is the relative rotation of both ends divided by the length `n p` of the strip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlexureMeasures {
    /// Flexural compliance `C_f* = 1/max(dM*/dκ*)`.
    pub compliance: Option<f64>,
    /// Compliance `1/(dM*/dκ*)` at rest.
    pub initial_compliance: Option<f64>,
    /// True if scales touch somewhere on the path.
    pub contact: Option<bool>,
    /// Curvature `κ*` at the first contact.
    pub first_contact_curvature: Option<f64>,
    /// Moment `M*` of the largest magnitude; negative if the scales are on the outside of the bend.
    pub max_moment: Option<f64>,
    /// Axial fraction of the elastic energy at the end of the path.
    pub axial_energy_share: Option<f64>,
    /// Largest strain `|ε| + ½ h |κ|` at the membrane surface, anywhere on the path.
    pub membrane_strain_max: Option<f64>,
    /// Estimate of the largest relative error of the measures due to the membrane discretisation.
    ///
    /// `None` if the number of elements is given.
    pub error: Option<f64>,
    /// Number of gaps `n` of the strip, an integer in a chain.
    pub gaps: f64,
    /// Frictional dissipation of the whole strip from rest to the end of the path.
    ///
    /// In units of `E_m t³`; `None` without friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_work: Option<f64>,
    /// Curvature `κ*` beyond which friction locks the strip.
    ///
    /// Beyond it contacts stick, and the rotation hardly grows with the moment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub locking_curvature: Option<f64>,
    /// Residual state after unloading.
    #[serde(default, skip_serializing_if = "is_default")]
    pub remains: Remains,
    /// Curvature `κ*` at which scales first touch, even if the path ends earlier.
    ///
    /// In an imperfect strip it refers to the gap that closes first. `None` if no gap can close.
    pub contact_curvature: Option<f64>,
}

impl FlexureMeasures {
    /// Computes the measures of a completed path.
    pub(crate) fn new(record: &Record<Strip>, path: &mut Continuation<Strip>) -> Self {
        let first = record.first_contact();
        // Without contact the stiffness is constant, so no maximum has to be searched for.
        let stiffest = match first {
            Some(_) => record.stiffness_summit(path).map(|summit| summit.value),
            None => Some(record.initial_stiffness),
        };
        let strip = path.system();
        let share = record.path.last().map(axial_energy_share);
        let strains = record.path.iter().map(|point| point.membrane_strain);
        Self {
            compliance: stiffest.map(|stiffness| strip.normalised_stiffness(stiffness).recip()),
            initial_compliance: record.path.first().map(|start| start.stiffness.recip()),
            contact: Some(first.is_some()),
            first_contact_curvature: first.map(|point| point.curvature),
            max_moment: record.path.iter().map(|point| point.moment).reduce(larger),
            axial_energy_share: share.filter(|share| share.is_finite()),
            membrane_strain_max: strains.reduce(f64::max),
            error: None,
            friction_work: record.path.last().and_then(|point| point.friction_work),
            locking_curvature: locking(record, path),
            remains: Remains::default(),
            contact_curvature: None,
            gaps: strip.gaps() as f64 * strip.repeats,
        }
    }

    /// Replaces computed values by closed forms, where closed forms exist.
    ///
    /// Before contact the compliance is `free_compliance`, equal to `Σd/Σp`, and the axial energy
    /// is zero.
    pub(crate) fn in_closed_form(self, free_compliance: f64) -> Self {
        let bare = self.contact == Some(false);
        Self {
            // Values that are missing because the path failed remain missing.
            initial_compliance: self.initial_compliance.map(|_| free_compliance),
            compliance: self.compliance.map(|found| if bare { free_compliance } else { found }),
            axial_energy_share: self.axial_energy_share.map(|found| if bare { 0.0 } else { found }),
            ..self
        }
    }

    /// Removes the measures that are not known if the path stopped early.
    pub(crate) fn without_final_values(self) -> Self {
        Self {
            initial_compliance: self.initial_compliance,
            first_contact_curvature: self.first_contact_curvature,
            // Without contact so far it is unknown whether scales would touch later.
            contact: self.first_contact_curvature.map(|_| true),
            contact_curvature: self.contact_curvature,
            gaps: self.gaps,
            ..Self::default()
        }
    }
}

/// Returns the curvature of the last contact change if the strip is locked at the end of its path.
///
/// `None` if no contact sticks there, or if the strip is less than [`LOCKED`] times as stiff as at
/// rest.
fn locking(record: &Record<Strip>, path: &Continuation<Strip>) -> Option<f64> {
    let [sticking, _] = Contacts::stick_slip_counts(&path.point().state);
    let (start, end) = record.path.first().zip(record.path.last())?;
    // Check the stiffness, too, because a strip may bend further while some contacts stick.
    let is_locked = sticking > 0 && end.stiffness.abs() >= LOCKED * start.stiffness;
    record.events.last().filter(|_| is_locked).map(|event| event.point.curvature)
}

/// Returns the number of larger magnitude, with its sign.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}

/// Computes the axial fraction of the elastic energy; NaN at rest.
fn axial_energy_share(point: &FlexurePoint) -> f64 {
    point.axial_energy / (point.bending_energy + point.axial_energy + point.contact_energy)
}
