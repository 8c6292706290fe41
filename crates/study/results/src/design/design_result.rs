//! The result of a design: all measures and statuses of a solved design.

use serde::{Deserialize, Serialize};
use skin::puncture::TiltMeasures;

use super::failure::Failure;
use super::parameter_derivative::ParameterDerivative;
use super::path_result::{FlexureResult, PunctureResult};
use super::sample_statistics::SampleStatistics;
use super::stored_derivatives;

/// Separator between the settings in [`DesignResult::settings`].
pub const SEPARATOR: char = ' ';

/// All measures and statuses of a solved design, as stored in the journal.
///
/// The size of a result does not depend on the length of the paths. All numbers are finite, because
/// JSON cannot represent others. A number that is not finite is stored as a missing value.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DesignResult {
    /// Coverage, if it was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coverage: Option<f64>,
    /// Puncture, if it was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub puncture: Option<PunctureResult>,
    /// Puncture measures at each of several critical tilts, if several tilts were requested.
    ///
    /// An item is `None` if the path did not reach its tilt.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at_tilts: Vec<Option<TiltMeasures>>,
    /// Bending, if it was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flexure: Option<FlexureResult>,
    /// Statistics over imperfect samples, if they were requested.
    #[serde(skip_serializing_if = "SampleStatistics::is_none")]
    pub samples: SampleStatistics,
    /// Derivatives of the measures, grouped by measure, if they were requested.
    #[serde(with = "stored_derivatives", skip_serializing_if = "Vec::is_empty")]
    pub sensitivity: Vec<ParameterDerivative>,
    /// Settings that differ from the sweep, as `key=value`, separated by [`SEPARATOR`].
    #[serde(skip_serializing_if = "String::is_empty")]
    pub settings: String,
    /// Measures without a value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<Failure>,
}

impl DesignResult {
    /// Returns true if a requested measure has no value.
    pub fn failed(&self) -> bool {
        !self.failures.is_empty()
    }
}
