//! The results of the paths of a design: puncture and bending.

use serde::{Deserialize, Serialize};
use skin::{flexure, puncture};

use super::outcome::Outcome;

/// Result of a puncture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PunctureResult {
    /// Outcome: complete, or why the path stopped.
    pub outcome: Outcome,
    /// Measures. The measures at the end of an incomplete path have no values.
    pub measures: puncture::PunctureMeasures,
    /// Number of equilibria of the path.
    pub points: usize,
    /// Number of Newton iterations.
    pub iterations: usize,
    /// Estimated relative error of the substrate springs.
    pub calibration_error: Option<f64>,
    /// Outcome of the search for the weakest load position, if it was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weakest: Option<Outcome>,
    /// Outcome of the puncture across the row, if it was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub across: Option<Outcome>,
    /// Outcome of the punctures on bodies between two radii, if they were requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between: Option<Outcome>,
    /// Outcome of unloading, if it was requested.
    #[serde(rename = "way_back", default, skip_serializing_if = "Option::is_none")]
    pub unloading: Option<Outcome>,
}

impl PunctureResult {
    /// Creates the result of a puncture without a path, with `outcome` as the reason.
    pub fn without_path(outcome: Outcome) -> Self {
        Self {
            outcome,
            measures: puncture::PunctureMeasures::default(),
            points: 0,
            iterations: 0,
            calibration_error: None,
            weakest: None,
            across: None,
            between: None,
            unloading: None,
        }
    }
}

/// Result of bending.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlexureResult {
    /// Outcome: complete, or why the path stopped.
    pub outcome: Outcome,
    /// Measures. The measures at the end of an incomplete path have no values.
    pub measures: flexure::FlexureMeasures,
    /// Number of equilibria of the path.
    pub points: usize,
    /// Number of Newton iterations.
    pub iterations: usize,
    /// Outcome of unloading, if it was requested.
    #[serde(rename = "way_back", default, skip_serializing_if = "Option::is_none")]
    pub unloading: Option<Outcome>,
}

impl FlexureResult {
    /// Creates the result of bending without a path, with `outcome` as the reason.
    pub fn without_path(outcome: Outcome) -> Self {
        let measures = flexure::FlexureMeasures::default();
        Self { outcome, measures, points: 0, iterations: 0, unloading: None }
    }
}
