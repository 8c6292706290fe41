//! Creates the results of solved paths of puncture and bending.
//!
//! Results contain only finite numbers, because JSON cannot represent others.

use skin::flexure::{self, BentSample, Flexure};
use skin::puncture::{self, Puncture};
use skin::{Status, Unloading};
use solver::Termination;

use super::failure::finite;
use super::outcome::Outcome;
use super::path_result::{FlexureResult, PunctureResult};
use crate::columns::values::VALUES;

impl PunctureResult {
    /// Creates the result of a solved puncture.
    ///
    /// If one number is not finite, all numbers are omitted.
    pub fn new(puncture: &Puncture, calibration_error: f64) -> Self {
        let mut measures = puncture.measures;
        // The number of scales is a count, so it stays valid if a number is not finite.
        let counts = puncture::PunctureMeasures {
            scales: measures.scales,
            ..puncture::PunctureMeasures::default()
        };
        let finite_all = VALUES.iter().all(|value| value.is_finite_in_puncture(&mut measures));
        let (outcome, measures) = finite_or(finite_all, puncture.status.into(), measures, counts);
        Self {
            outcome,
            measures,
            points: puncture.path.len(),
            iterations: puncture.history.len(),
            calibration_error: finite(calibration_error),
            weakest: (!puncture.places.is_empty()).then(
                || match puncture::Weakest::from_positions(&puncture.places) {
                    // If all measures were omitted, they lack the weakest load position although
                    // the search found it.
                    Ok(weakest) if weakest == measures.weakest => Outcome::Complete,
                    Ok(_) => Outcome::NotFinite,
                    Err(status) => status.into(),
                },
            ),
            across: None,
            between: None,
            unloading: puncture.unloading.as_ref().map(unloading_outcome),
        }
    }
}

impl FlexureResult {
    /// Creates the result of solved bending.
    ///
    /// If one number is not finite, all numbers are omitted.
    pub fn new(flexure: &Flexure) -> Self {
        let Flexure { status, measures, path, history, .. } = flexure;
        let unloading = flexure.unloading.as_ref().map(unloading_outcome);
        Self { unloading, ..Self::checked(*status, *measures, path.len(), history.len()) }
    }

    /// Creates the result of an imperfect strip, as [`Self::new`] does.
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
        let counts =
            flexure::FlexureMeasures { gaps: measures.gaps, ..flexure::FlexureMeasures::default() };
        let finite_all = VALUES.iter().all(|value| value.is_finite_in_flexure(&mut measures));
        let (outcome, measures) = finite_or(finite_all, status.into(), measures, counts);
        Self { outcome, measures, points, iterations, unloading: None }
    }
}

/// Returns the outcome of an unloading path: complete if the load returned to zero.
fn unloading_outcome<P>(unloading: &Unloading<P>) -> Outcome {
    match unloading.stop {
        Termination::Unloaded => Outcome::Complete,
        stop => stop.into(),
    }
}

/// Returns `outcome` and `measures` if all numbers are finite (`finite` is true).
///
/// Otherwise returns `counts` as the measures, and [`Outcome::NotFinite`] as the outcome unless the
/// path stopped for another reason.
fn finite_or<M>(finite: bool, outcome: Outcome, measures: M, counts: M) -> (Outcome, M) {
    match outcome {
        _ if finite => (outcome, measures),
        Outcome::Complete => (Outcome::NotFinite, counts),
        // Keep the reason why the path stopped: it is more specific than `NotFinite`.
        stopped => (stopped, counts),
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
            end: None,
        }
    }

    #[test]
    fn a_puncture_with_nan_measures_is_not_complete() {
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
    fn a_stopped_puncture_keeps_its_stop_reason() {
        let result = PunctureResult::new(&puncture(Status::RowLimit, f64::NAN), 0.0);
        assert_eq!(result.outcome, Outcome::RowLimit);
    }

    #[test]
    fn a_nan_error_estimate_is_omitted() {
        for error in [f64::NAN, f64::INFINITY] {
            let result = PunctureResult::new(&puncture(Status::Complete, 2.0), error);
            assert_eq!(result.calibration_error, None);
        }
    }
}
