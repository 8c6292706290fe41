//! What is known of a design once it is solved: the source of its row in every table.

use skin::flexure::{self, Flexure};
use skin::puncture::{Measures, Puncture};

use crate::case::Case;
use crate::grid::DesignNumber;
use crate::outcome::Outcome;
use crate::spread::Spreads;

/// A solved design. Small, whatever the length of its path.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Its place in the grid.
    pub number: DesignNumber,
    /// Its parameters.
    pub case: Case,
    /// The coverage, if it was asked for.
    pub coverage: Option<f64>,
    /// The puncture, if it was asked for.
    pub puncture: Option<PunctureRecord>,
    /// The bending, if it was asked for.
    pub flexure: Option<FlexureRecord>,
    /// What imperfect samples gave, if it was asked for.
    pub spreads: Spreads,
    /// Settings that are not the sweep's own.
    pub settings: String,
}

/// What a puncture gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctureRecord {
    /// How it ended.
    pub outcome: Outcome,
    /// What it measured; no final values unless it is complete.
    pub measures: Measures,
    /// Equilibria of the path.
    pub points: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Estimated relative error of the springs of the substrate.
    pub calibration_error: Option<f64>,
}

impl Record {
    /// Whether something that was asked for has no value.
    pub fn failed(&self) -> bool {
        let puncture = self.puncture.map(|puncture| puncture.outcome);
        let flexure = self.flexure.map(|flexure| flexure.outcome);
        [puncture, flexure].into_iter().flatten().any(|outcome| outcome != Outcome::Complete)
    }
}

/// What a bending gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexureRecord {
    /// How it ended.
    pub outcome: Outcome,
    /// What it measured; no final values unless it is complete.
    pub measures: flexure::Measures,
    /// Equilibria of the path.
    pub points: usize,
    /// Newton iterations.
    pub iterations: usize,
}

impl FlexureRecord {
    /// A bending without a path.
    pub(crate) fn without_path(outcome: Outcome) -> Self {
        Self { outcome, measures: flexure::Measures::default(), points: 0, iterations: 0 }
    }

    /// The record of a solved bending; if one of its numbers is none, all are left out.
    pub(crate) fn new(flexure: &Flexure) -> Self {
        let measures = flexure.measures;
        let finite = [
            measures.compliance,
            measures.initial_compliance,
            measures.first_contact_curvature,
            measures.max_moment,
            measures.axial_energy_share,
        ];
        let few = flexure::Measures { gaps: measures.gaps, ..flexure::Measures::default() };
        let (outcome, measures) = finite_or(finite, flexure.status.into(), measures, few);
        let (points, iterations) = (flexure.path.len(), flexure.history.len());
        Self { outcome, measures, points, iterations }
    }
}

/// The outcome and the measures, or, if one of their numbers is none, the reason and a `few`.
fn finite_or<M, const N: usize>(
    numbers: [Option<f64>; N],
    outcome: Outcome,
    measures: M,
    few: M,
) -> (Outcome, M) {
    match outcome {
        _ if numbers.into_iter().flatten().all(f64::is_finite) => (outcome, measures),
        Outcome::Complete => (Outcome::NotFinite, few),
        stopped => (stopped, few),
    }
}

impl PunctureRecord {
    /// A puncture without a path.
    pub(crate) fn without_path(outcome: Outcome) -> Self {
        Self {
            outcome,
            measures: Measures::default(),
            points: 0,
            iterations: 0,
            calibration_error: None,
        }
    }

    /// The record of a solved puncture; if one of its numbers is none, all are left out.
    pub(crate) fn new(puncture: &Puncture, calibration_error: f64) -> Self {
        let measures = puncture.measures;
        let few = Measures { scales: measures.scales, ..Measures::default() };
        let (outcome, measures) =
            finite_or(numbers(&measures), puncture.status.into(), measures, few);
        Self {
            outcome,
            measures,
            points: puncture.path.len(),
            iterations: puncture.history.len(),
            calibration_error: Some(calibration_error),
        }
    }
}

fn numbers(measures: &Measures) -> [Option<f64>; 9] {
    [
        measures.critical_force,
        measures.peak_force,
        measures.critical_displacement,
        measures.penetration,
        measures.sink,
        measures.first_contact_displacement,
        measures.initial_stiffness,
        measures.max_stiffness,
        measures.secant_stiffness,
    ]
}

#[cfg(test)]
mod tests {
    use skin::Status;

    use super::*;

    fn puncture(status: Status, critical_force: f64) -> Puncture {
        let measures = Measures {
            critical_force: Some(critical_force),
            sink: Some(1.0),
            scales: 41,
            ..Measures::default()
        };
        let (path, events, scales, history) = (vec![], vec![], vec![], vec![]);
        Puncture { status, measures, path, events, scales, history }
    }

    #[test]
    fn a_complete_puncture_that_is_not_finite_is_not_complete() {
        let record = PunctureRecord::new(&puncture(Status::Complete, f64::NAN), 0.0);
        assert_eq!(record.outcome, Outcome::NotFinite);
        assert_eq!(record.measures, Measures { scales: 41, ..Measures::default() });
        let record = PunctureRecord::new(&puncture(Status::Complete, 2.0), 0.0);
        assert_eq!(
            (record.outcome, record.measures.critical_force),
            (Outcome::Complete, Some(2.0))
        );
    }

    #[test]
    fn the_reason_of_a_puncture_that_stopped_is_kept() {
        let record = PunctureRecord::new(&puncture(Status::RowLimit, f64::NAN), 0.0);
        assert_eq!(record.outcome, Outcome::RowLimit);
    }
}
