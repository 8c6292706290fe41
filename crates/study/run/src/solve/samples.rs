//! Solves the imperfect samples of a design, with random gaps and slants.

use results::{FlexureResult, PunctureResult, SampleStatistics, Statistics};
use skin::flexure::{self, BentSample};
use skin::puncture;
use skin::{PathDetail, Sample};
use substrate::RowStiffness;
use sweep::Case;

use super::work::DesignWork;

/// Solves the puncture of all samples of `case` on `substrate`.
///
/// Adds statistics of their measures to `statistics`, and counts each sample in `work`.
pub(super) fn puncture(
    case: &Case,
    substrate: &RowStiffness,
    statistics: &mut SampleStatistics,
    work: &DesignWork<'_>,
) {
    let (mut force, mut penetration) = (Vec::new(), Vec::new());
    let case = &case.with_detail(PathDetail::Critical);
    for number in 1..=case.samples.count as u64 {
        // A sample that cannot be drawn or solved counts as failed, because replacing it would
        // change the distribution.
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

/// Solves the bending of all samples of `case`.
///
/// Adds statistics of their measures to `statistics`, and counts each sample in `work`.
pub(super) fn flexure(case: &Case, statistics: &mut SampleStatistics, work: &DesignWork<'_>) {
    let (mut compliance, mut closing_range) = (Vec::new(), Vec::new());
    let case = &case.with_detail(PathDetail::Critical);
    for number in 1..=case.samples.count as u64 {
        let flexure = imperfect_row(case, number).and_then(|row| bent(case, &row));
        work.strip_done();
        let Some(flexure) = flexure else { continue };
        if let Some(value) = FlexureResult::of_sample(&flexure).measures.compliance {
            compliance.push(value);
            // Samples without a compliance are excluded, so that both statistics have the same
            // samples.
            closing_range.extend(flexure.closing_range);
        }
    }
    statistics.closing_range = Statistics::from_values(closing_range);
    statistics.flexure_failed = Some(case.samples.count - compliance.len());
    statistics.compliance = Statistics::from_values(compliance);
}

/// Returns sample `number` of `case`, or `None` if the design has no geometrical meaning.
fn imperfect_row(case: &Case, number: u64) -> Option<Sample> {
    case.imperfection.sample(&case.design, case.samples.seed as u64, number).ok()
}

/// Returns sample `number` of `case`, drawn with random numbers that all designs share.
pub(super) fn common(case: &Case, number: u64) -> Option<Sample> {
    case.imperfection.common_sample(&case.design, case.samples.seed as u64, number).ok()
}

/// Solves the puncture of a sample of `case`; `None` if its scales cannot be drawn or solved.
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

/// Solves the bending of a sample of `case`; `None` if its scales cannot be drawn or solved.
pub(super) fn bent(case: &Case, row: &Sample) -> Option<BentSample> {
    flexure::bend_sample(&case.design, &case.common, &case.flexure, row).ok()
}
