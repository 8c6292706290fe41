//! The result of a design: everything that is known of it once it is solved.

use serde::{Deserialize, Serialize};
use skin::flexure::{self, BentSample, Flexure};
use skin::puncture::{self, Puncture, TiltMeasures};
use skin::{Status, Unloading};
use solver::Termination;

use super::failure::{Failure, finite};
use super::outcome::Outcome;
use super::parameter_derivative::ParameterDerivative;
use super::sample_statistics::SampleStatistics;
use super::stored_derivatives;
use crate::columns::values::VALUES;

/// The character between the settings of a design.
pub const SEPARATOR: char = ' ';

/// Everything that a solved design measured, which is also what the journal keeps of it. It is small,
/// whatever the length of the paths.
///
/// All numbers of a result are finite: JSON has no form for others, and no table shows them. A number that is
/// not finite counts as one that does not exist.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DesignResult {
    /// The coverage, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coverage: Option<f64>,
    /// The puncture, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub puncture: Option<PunctureResult>,
    /// The measures of the puncture at several critical tilts, if they were asked for; `None` where the path did not get there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at_tilts: Vec<Option<TiltMeasures>>,
    /// The bending, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flexure: Option<FlexureResult>,
    /// The statistics of imperfect samples, if they were asked for.
    #[serde(skip_serializing_if = "SampleStatistics::is_none")]
    pub samples: SampleStatistics,
    /// The derivatives of the measures, those of one measure after the other, if they were asked for.
    #[serde(with = "stored_derivatives", skip_serializing_if = "Vec::is_empty")]
    pub sensitivity: Vec<ParameterDerivative>,
    /// The settings that are not the sweep's own, as `key=value` with [`SEPARATOR`] between.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub settings: String,
    /// The measures without a value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<Failure>,
}

impl DesignResult {
    /// Whether something that was asked for has no value.
    pub fn failed(&self) -> bool {
        !self.failures.is_empty()
    }
}

/// The result of a puncture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PunctureResult {
    /// The outcome: complete, or why it stopped.
    pub outcome: Outcome,
    /// The measures; they have no final values unless the outcome is complete.
    pub measures: puncture::PunctureMeasures,
    /// Equilibria of the path.
    pub points: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Estimated relative error of the springs of the substrate.
    pub calibration_error: Option<f64>,
    /// Whether the weakest place of the load is known, or why not, if it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weakest: Option<Outcome>,
    /// Whether the load came back to zero, or why not, if it was to be taken away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub way_back: Option<Outcome>,
}

impl PunctureResult {
    /// The result of a puncture without a path.
    pub fn without_path(outcome: Outcome) -> Self {
        Self {
            outcome,
            measures: puncture::PunctureMeasures::default(),
            points: 0,
            iterations: 0,
            calibration_error: None,
            weakest: None,
            way_back: None,
        }
    }

    /// The result of a solved puncture; if one of its numbers is not finite, all are left out.
    pub fn new(puncture: &Puncture, calibration_error: f64) -> Self {
        let mut measures = puncture.measures;
        // How many scales the row has is a count, and sound whatever became of the numbers.
        let few = puncture::PunctureMeasures {
            scales: measures.scales,
            ..puncture::PunctureMeasures::default()
        };
        let finite_all = VALUES.iter().all(|value| value.is_finite_in_puncture(&mut measures));
        let (outcome, measures) = finite_or(finite_all, puncture.status.into(), measures, few);
        let weakest = || match puncture::Weakest::from_positions(&puncture.places) {
            // Measures that were left out lack the weakest place, though the places have one.
            Ok(weakest) if weakest == measures.weakest => Outcome::Complete,
            Ok(_) => Outcome::NotFinite,
            Err(status) => status.into(),
        };
        Self {
            outcome,
            measures,
            points: puncture.path.len(),
            iterations: puncture.history.len(),
            calibration_error: finite(calibration_error),
            weakest: (!puncture.places.is_empty()).then(weakest),
            way_back: puncture.unloading.as_ref().map(back_to_zero),
        }
    }
}

/// The result of a bending.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlexureResult {
    /// The outcome: complete, or why it stopped.
    pub outcome: Outcome,
    /// The measures; they have no final values unless the outcome is complete.
    pub measures: flexure::FlexureMeasures,
    /// Equilibria of the path.
    pub points: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Whether the load came back to zero, or why not, if it was to be taken away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub way_back: Option<Outcome>,
}

impl FlexureResult {
    /// The result of a bending without a path.
    pub fn without_path(outcome: Outcome) -> Self {
        let measures = flexure::FlexureMeasures::default();
        Self { outcome, measures, points: 0, iterations: 0, way_back: None }
    }

    /// The result of a solved bending; if one of its numbers is not finite, all are left out.
    pub fn new(flexure: &Flexure) -> Self {
        let Flexure { status, measures, path, history, .. } = flexure;
        let way_back = flexure.unloading.as_ref().map(back_to_zero);
        Self { way_back, ..Self::checked(*status, *measures, path.len(), history.len()) }
    }

    /// The result of an imperfect strip, as [`Self::new`].
    pub fn of_sample(bent: &BentSample) -> Self {
        let BentSample { status, measures, points, iterations, .. } = *bent;
        Self::checked(status, measures, points, iterations)
    }

    fn checked(
        status: Status,
        mut measures: flexure::FlexureMeasures,
        points: usize,
        iterations: usize,
    ) -> Self {
        let few =
            flexure::FlexureMeasures { gaps: measures.gaps, ..flexure::FlexureMeasures::default() };
        let finite_all = VALUES.iter().all(|value| value.is_finite_in_flexure(&mut measures));
        let (outcome, measures) = finite_or(finite_all, status.into(), measures, few);
        Self { outcome, measures, points, iterations, way_back: None }
    }
}

/// The outcome of a way back.
fn back_to_zero<P>(back: &Unloading<P>) -> Outcome {
    match back.stop {
        Termination::Unloaded => Outcome::Complete,
        stop => stop.into(),
    }
}

/// The outcome and the measures, or, if one of their numbers is not finite, the reason and a `few`.
fn finite_or<M>(finite: bool, outcome: Outcome, measures: M, few: M) -> (Outcome, M) {
    match outcome {
        _ if finite => (outcome, measures),
        Outcome::Complete => (Outcome::NotFinite, few),
        // Why the path stopped says more than what became of its numbers.
        stopped => (stopped, few),
    }
}

#[cfg(test)]
mod tests {
    use skin::puncture::PunctureMeasures;

    use super::*;

    fn puncture(status: Status, critical_force: f64) -> Puncture {
        let measures = PunctureMeasures {
            critical_force: Some(critical_force),
            sink: Some(1.0),
            scales: 41,
            ..PunctureMeasures::default()
        };
        let (path, events, scales, history) = (vec![], vec![], vec![], vec![]);
        let (instability, snaps, folds) = (vec![], vec![], vec![]);
        let at_tilts = vec![];
        Puncture {
            status,
            measures,
            at_tilts,
            path,
            instability,
            events,
            snaps,
            folds,
            scales,
            history,
            unloading: None,
            places: vec![],
            tip_forces: vec![],
        }
    }

    #[test]
    fn a_complete_puncture_that_is_not_finite_is_not_complete() {
        let result = PunctureResult::new(&puncture(Status::Complete, f64::NAN), 0.0);
        assert_eq!(result.outcome, Outcome::NotFinite);
        assert_eq!(result.measures, PunctureMeasures { scales: 41, ..PunctureMeasures::default() });
        let result = PunctureResult::new(&puncture(Status::Complete, 2.0), 0.0);
        assert_eq!(
            (result.outcome, result.measures.critical_force),
            (Outcome::Complete, Some(2.0))
        );
    }

    #[test]
    fn the_reason_of_a_puncture_that_stopped_is_kept() {
        let result = PunctureResult::new(&puncture(Status::RowLimit, f64::NAN), 0.0);
        assert_eq!(result.outcome, Outcome::RowLimit);
    }

    #[test]
    fn an_error_that_is_not_finite_does_not_exist() {
        for error in [f64::NAN, f64::INFINITY] {
            let result = PunctureResult::new(&puncture(Status::Complete, 2.0), error);
            assert_eq!(result.calibration_error, None);
        }
    }
}
