//! Failures as data: what has no value, why, and how far its path came.

use serde::{Deserialize, Serialize};
use skin::Iteration;
use skin::flexure::{Flexure, FlexurePoint};
use skin::puncture::{Puncture, PuncturePoint};
use sweep::Measure;

use super::outcome::Outcome;

/// A measure of a design that has no value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// The measure.
    pub measure: Measure,
    /// The reason why it has no value.
    pub outcome: Outcome,
    /// The end of its path.
    pub end: PathEnd,
}

/// The last equilibrium of a path that stopped early, and the last iteration after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathEnd {
    /// The tilt of the punctured scale, or the rotation of each end, degrees.
    pub angle_deg: Option<f64>,
    /// The puncture force, or the moment.
    pub load: Option<f64>,
    /// The displacement of the punctured point, or the curvature.
    pub displacement: Option<f64>,
    /// Closed contacts.
    pub contacts: Option<usize>,
    /// The step of the path that failed.
    pub step: Option<usize>,
    /// The last Newton iteration of that step.
    pub iteration: Option<usize>,
    /// The largest scaled residual of that iteration.
    pub residual: Option<f64>,
}

impl PathEnd {
    /// The end of the path of `puncture`.
    pub fn of_puncture(puncture: &Puncture) -> Self {
        let end = |point: &PuncturePoint| {
            Self::at([point.tilt_deg, point.force, point.displacement], point.contacts)
        };
        puncture.path.last().map_or_else(Self::default, end).after(&puncture.history)
    }

    /// The end of the path of `flexure`.
    pub fn of_flexure(flexure: &Flexure) -> Self {
        let end = |point: &FlexurePoint| {
            Self::at([point.end_rotation_deg, point.moment, point.curvature], point.contacts)
        };
        flexure.path.last().map_or_else(Self::default, end).after(&flexure.history)
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

    /// With the last iteration of a path.
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

/// `number` if it is finite.
pub fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}
