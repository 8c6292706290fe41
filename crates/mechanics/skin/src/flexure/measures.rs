//! The numbers that bending comes down to.

use serde::{Deserialize, Serialize};
use solver::Path;

use super::FlexurePoint;
use super::problem::LOCKED;
use super::strip::Strip;
use crate::Remains;
use crate::common::is_default;
use crate::contacts::Contacts;
use crate::record::Record;

/// The measures of bending; `None` where the value does not exist.
///
/// The moment is `M* = M t/(E_m I_m)`, the curvature `κ* = κ t` with `κ` the rotation of one end
/// against the other over the length `n p` of the strip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlexureMeasures {
    /// Flexural compliance `C_f* = 1/max(dM*/dκ*)`.
    pub compliance: Option<f64>,
    /// `1/(dM*/dκ*)` at rest.
    pub initial_compliance: Option<f64>,
    /// Whether scales touched.
    pub contact: Option<bool>,
    /// `κ*` at the first contact.
    pub first_contact_curvature: Option<f64>,
    /// `M*` of the largest size; negative on a path to the outside.
    pub max_moment: Option<f64>,
    /// Part of the axial energy in the elastic energy at the end of the path.
    pub axial_energy_share: Option<f64>,
    /// Largest strain `|ε| + ½ h |κ|` at the surface of the membrane, anywhere on the path.
    pub membrane_strain_max: Option<f64>,
    /// Largest relative error of the measures that the discretisation of the membrane makes, estimated; `None` for a given
    /// number of elements.
    pub error: Option<f64>,
    /// Gaps `n` of the strip, a whole number in a chain.
    pub gaps: f64,
    /// What friction between scales has taken at the end of the path, over `E_m t³`, of the whole strip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_work: Option<f64>,
    /// `κ*` at which friction locks the strip: from there on contacts stick, and next to nothing turns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub locking_curvature: Option<f64>,
    /// What is left once the moment is gone.
    #[serde(default, skip_serializing_if = "is_default")]
    pub remains: Remains,
    /// `κ*` at which scales would touch, whether or not the path goes so far, of an imperfect strip in the gap that closes first; `None`
    /// where none can close.
    pub contact_curvature: Option<f64>,
}

impl FlexureMeasures {
    /// The measures of a path that came to its end.
    pub(crate) fn new(record: &Record<Strip>, path: &mut Path<Strip>) -> Self {
        let first = record.first_contact();
        // Before scales touch the strip bends to arcs, as stiff everywhere as at rest: there is no maximum to look for.
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

    /// The measures with what is known in closed form in the place of what was computed: before contact the compliance is
    /// `Σd/Σp`, and no energy stretches the membrane.
    pub(crate) fn in_closed_form(self, free_compliance: f64) -> Self {
        let bare = self.contact == Some(false);
        Self {
            // What was not found stays unknown: a closed form does not make up for a failed path.
            initial_compliance: self.initial_compliance.map(|_| free_compliance),
            compliance: self.compliance.map(|found| if bare { free_compliance } else { found }),
            axial_energy_share: self.axial_energy_share.map(|found| if bare { 0.0 } else { found }),
            ..self
        }
    }

    /// The measures of the beginning of a path, for one that did not end as it should.
    pub(crate) fn without_final_values(self) -> Self {
        Self {
            initial_compliance: self.initial_compliance,
            first_contact_curvature: self.first_contact_curvature,
            // That nothing has touched so far does not tell what would have touched later.
            contact: self.first_contact_curvature.map(|_| true),
            contact_curvature: self.contact_curvature,
            gaps: self.gaps,
            ..Self::default()
        }
    }
}

/// The curvature of the last change of a contact, if contacts stick from there on and hold the strip.
fn locking(record: &Record<Strip>, path: &Path<Strip>) -> Option<f64> {
    let [sticking, _] = Contacts::stick_slip_counts(&path.point().state);
    let (start, end) = record.path.first().zip(record.path.last())?;
    // Contacts that stick are not enough: a strip may bend on while some of them do.
    let is_locked = sticking > 0 && end.stiffness.abs() >= LOCKED * start.stiffness;
    record.events.last().filter(|_| is_locked).map(|event| event.point.curvature)
}

/// The number of the larger size.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}

/// Part of the axial energy in the elastic energy; not a number at rest.
fn axial_energy_share(point: &FlexurePoint) -> f64 {
    point.axial_energy / (point.bending_energy + point.axial_energy + point.contact_energy)
}
