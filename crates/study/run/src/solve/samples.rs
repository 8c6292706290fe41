//! Solves imperfect samples of a design.

use results::{FlexureResult, PunctureResult, SampleStatistics, Statistics};
use skin::flexure::{self, BentSample};
use skin::puncture;
use skin::{PathDetail, Sample};
use substrate::RowStiffness;
use sweep::Case;

use super::work::DesignWork;

/// Punctures the samples of `case` on `substrate`.
///
/// Adds their results to `statistics`, and reports to `work`.
pub(super) fn puncture(
    case: &Case,
    substrate: &RowStiffness,
    statistics: &mut SampleStatistics,
    work: &DesignWork<'_>,
) {
    let (mut force, mut penetration) = (Vec::new(), Vec::new());
    let case = &case.with_detail(PathDetail::Critical);
    for number in 1..=case.samples.count as u64 {
        // A sample with overlapping scales counts as failed. Drawing again would distort the
        // distribution.
        let punctured =
            imperfect_row(case, number).and_then(|row| punctured(case, substrate, &row));
        let measures = punctured.map(|result| result.measures);
        work.row_done();
        force.extend(measures.and_then(|measures| measures.critical_force));
        penetration.extend(measures.and_then(|measures| measures.penetration));
    }
    statistics.puncture_failed = Some(case.samples.count - force.len());
    statistics.critical_force = Statistics::from_values(force);
    statistics.penetration = Statistics::from_values(penetration);
}

/// Bends the samples of `case`.
///
/// Adds their results to `statistics`, and reports to `work`.
pub(super) fn flexure(case: &Case, statistics: &mut SampleStatistics, work: &DesignWork<'_>) {
    let (mut compliance, mut closing_range) = (Vec::new(), Vec::new());
    for number in 1..=case.samples.count as u64 {
        let flexure = imperfect_row(case, number).and_then(|row| bent(case, &row));
        work.strip_done();
        let Some(flexure) = flexure else { continue };
        if let Some(value) = FlexureResult::of_sample(&flexure).measures.compliance {
            compliance.push(value);
            // Only samples with a compliance, so that both statistics are about the same samples.
            closing_range.extend(flexure.closing_range);
        }
    }
    statistics.closing_range = Statistics::from_values(closing_range);
    statistics.flexure_failed = Some(case.samples.count - compliance.len());
    statistics.compliance = Statistics::from_values(compliance);
}

/// Returns imperfect row `number` of `case`, or `None` if it does not exist.
fn imperfect_row(case: &Case, number: u64) -> Option<Sample> {
    case.imperfection.sample(&case.design, case.samples.seed as u64, number).ok()
}

/// Returns imperfect row `number`, with random numbers common to all designs.
pub(super) fn common(case: &Case, number: u64) -> Option<Sample> {
    case.imperfection.common_sample(&case.design, case.samples.seed as u64, number).ok()
}

/// Punctures an imperfect row of `case`; `None` if scales overlap at rest.
pub(super) fn punctured(
    case: &Case,
    substrate: &RowStiffness,
    row: &Sample,
) -> Option<PunctureResult> {
    let Case { design, common, .. } = case;
    let parameters = case.punctured();
    let puncture = puncture::solve_sample(design, substrate, common, &parameters, row).ok()?;
    Some(PunctureResult::new(&puncture, substrate.estimated_error()))
}

/// Bends an imperfect strip of `case`; `None` if scales overlap at rest.
pub(super) fn bent(case: &Case, row: &Sample) -> Option<BentSample> {
    flexure::bend_sample(&case.design, &case.common, &case.flexure, row).ok()
}
