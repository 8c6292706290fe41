//! Failures of a design: the measure without a value, the reason, and the end of the path.

use serde::{Deserialize, Serialize};
use skin::Iteration;
use skin::flexure::Flexure;
use skin::puncture::Puncture;
use sweep::Measure;

use super::outcome::Outcome;

/// A measure of a design without a value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// Measure without a value.
    pub measure: Measure,
    /// Reason why the measure has no value.
    pub outcome: Outcome,
    /// End of the path.
    pub end: PathEnd,
}

/// Last equilibrium of a path that stopped early, and the last Newton iteration after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathEnd {
    /// Tilt of the punctured scale or rotation of each end, degrees.
    pub angle_deg: Option<f64>,
    /// Puncture force or bending moment.
    pub load: Option<f64>,
    /// Displacement of the punctured point or curvature.
    pub displacement: Option<f64>,
    /// Number of closed contacts.
    pub contacts: Option<usize>,
    /// Step at which the path stopped.
    pub step: Option<usize>,
    /// Last Newton iteration of this step.
    pub iteration: Option<usize>,
    /// Largest scaled residual of this iteration.
    pub residual: Option<f64>,
}

impl PathEnd {
    /// Returns the end of the path of a puncture.
    pub fn of_puncture(puncture: &Puncture) -> Self {
        puncture
            .path
            .last()
            .map_or_else(Self::default, |point| {
                Self::at([point.tilt_deg, point.force, point.displacement], point.contacts)
            })
            .after(&puncture.history)
    }

    /// Returns the end of the path of bending.
    pub fn of_flexure(flexure: &Flexure) -> Self {
        flexure
            .path
            .last()
            .map_or_else(Self::default, |point| {
                Self::at([point.end_rotation_deg, point.moment, point.curvature], point.contacts)
            })
            .after(&flexure.history)
    }

    fn at([angle_deg, load, displacement]: [f64; 3], contacts: usize) -> Self {
        Self {
            angle_deg: finite(angle_deg),
            load: finite(load),
            displacement: finite(displacement),
            contacts: Some(contacts),
            ..Self::default()
        }
    }

    /// Adds the last iteration of `history`.
    fn after(self, history: &[Iteration]) -> Self {
        let Some(last) = history.last() else { return self };
        Self {
            step: Some(last.step),
            iteration: Some(last.iteration),
            residual: finite(last.residual),
            ..self
        }
    }
}

/// Returns `number` if it is finite.
pub fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}
