//! Evaluator: solves one design, with all requested measures.

use std::sync::Arc;

use results::columns::{is_along_path, is_at_fold};
use results::{
    DesignResult, DesignRow, Failure, FlexureResult, Outcome, ParameterDerivative, PathEnd,
    PunctureResult, SampleStatistics, SolvedDesign, finite,
};
use skin::PathDetail;
use skin::flexure::{self, Flexure, Method};
use skin::puncture::{self, Puncture, PunctureEnd};
use substrate::{Calibrations, RowStiffness, StiffnessSlopes};
use sweep::{Case, DesignNumber, Measure, Parameter};

use super::across::{AcrossCache, AcrossForces};
use super::guard::{guarded, solved};
use super::parts::Parts;
use super::sensitivity::Wanted;
use super::work::{DesignWork, WorkMeter};
use super::worst_body::{self, WorstBody};
use super::{samples, scatter, sensitivity};

/// Maximum number of gaps of a chain, because longer paths do not fit into memory.
const LONGEST_CHAIN: usize = 100_000;

/// Solves designs one by one; can be used by several threads at the same time.
///
/// Designs with equal footprints share their springs in a cache.
#[derive(Debug)]
pub struct Evaluator {
    measures: Vec<Measure>,
    /// Detail of the recorded paths, for rows of tables and samples.
    detail: PathDetail,
    /// Detail of punctures that start from the path end of a similar design.
    detail_near: PathDetail,
    /// Parts of a design to solve; `None` solves every part, with full detail.
    parts: Option<Parts>,
    calibrations: Calibrations,
    across: AcrossCache,
}

/// An evaluated measure: its result and path, or the status of a failure.
///
/// `None` if the measure is not requested.
type Evaluated<R, P> = Option<Result<(R, P), Outcome>>;

impl Evaluator {
    /// Creates an evaluator of `measures`.
    pub fn new(measures: &[Measure]) -> Self {
        Self {
            measures: measures.to_vec(),
            detail: PathDetail::Measures,
            detail_near: PathDetail::Measures,
            parts: None,
            calibrations: Calibrations::default(),
            across: AcrossCache::default(),
        }
    }

    /// Creates an evaluator of `measures` for tables that have only these `columns`.
    ///
    /// Measures along the path ([`is_along_path`]) are evaluated only if a column needs one of
    /// them.
    pub fn for_columns<'c>(
        measures: &[Measure],
        mut columns: impl Iterator<Item = &'c str>,
    ) -> Self {
        let detail =
            if columns.any(is_along_path) { PathDetail::Measures } else { PathDetail::Critical };
        Self { detail, detail_near: detail, ..Self::new(measures) }
    }

    /// Creates an evaluator that solves only the parts of a design on which `columns` depend.
    ///
    /// Other columns may lack a value. The parts are load positions, the row across, bodies between
    /// two radii, and unloading. Punctures that start from the path end of a similar design locate
    /// folds of the surface only if a column needs them.
    pub fn only_columns(measures: &[Measure], columns: &[&str]) -> Self {
        let evaluator = Self::for_columns(measures, columns.iter().copied());
        let folds = columns.iter().any(|column| is_at_fold(column));
        let detail_near = if folds { evaluator.detail } else { PathDetail::End };
        Self { parts: Some(Parts::of(columns)), detail_near, ..evaluator }
    }

    fn measures(&self, measure: Measure) -> bool {
        self.measures.contains(&measure)
    }

    /// Solves `case`; a failure or panic affects only the result of this design.
    pub fn solve(&self, number: DesignNumber, case: &Case) -> SolvedDesign {
        let Some(parts) = self.parts else {
            return self.solved(number, case, Wanted::All, &WorkMeter::default());
        };
        let needed = parts.of_case(case).with_detail(self.detail);
        let solved = self.solved(number, &needed, Wanted::All, &WorkMeter::default());
        SolvedDesign { row: DesignRow { case: *case, ..solved.row }, ..solved }
    }

    /// Solves a design for one row of the tables, faster than [`Self::solve`].
    ///
    /// Data for path files and drawings are omitted.
    pub fn row(&self, number: DesignNumber, case: &Case) -> DesignRow {
        self.row_metered(number, case, &WorkMeter::default())
    }

    /// Returns true if a puncture of `case` can start from the path end of a similar design.
    pub fn has_ends(&self, case: &Case) -> bool {
        self.measures(Measure::Puncture)
            && self.detail == PathDetail::Critical
            && case.common.friction == 0.0
            && case.body_radius_to.is_none()
            && case.imperfection.is_none()
            && case.punctured().depend_on_end_only()
    }

    /// Solves a puncture and returns the end of its path, from which similar designs can start.
    ///
    /// Returns `None` if no other design can start from this end, see [`PunctureEnd`].
    pub fn puncture_end(&self, case: &Case) -> Option<PunctureEnd> {
        let Case { design, common, .. } = &case.with_detail(PathDetail::Critical);
        let substrate = guarded(|| self.substrate(case)).flatten().ok()?;
        let parameters = case.punctured();
        solved(|| puncture::solve(design, &*substrate, common, &parameters)).ok()?.end
    }

    /// Solves a design like [`Self::row`], with derivatives with respect to `parameters`.
    ///
    /// `None` stands for all continuous parameters. Also returns the end of the puncture path, from
    /// which similar designs can start.
    pub fn row_and_end(
        &self,
        number: DesignNumber,
        case: &Case,
        parameters: Option<&[&'static Parameter]>,
    ) -> (DesignRow, Option<PunctureEnd>) {
        let wanted = parameters.map_or(Wanted::All, Wanted::Only);
        self.row_of(number, case, wanted, &WorkMeter::default())
    }

    /// Solves a design like [`Self::row_and_end`], but starts the puncture from a known path end.
    ///
    /// `end` belongs to a similar design. Returns `None` if the path must be followed from rest.
    pub fn row_near(
        &self,
        number: DesignNumber,
        case: &Case,
        parameters: &[&'static Parameter],
        end: &PunctureEnd,
    ) -> Option<DesignRow> {
        let (wanted, mut derivatives) = (Wanted::Only(parameters), Vec::new());
        let needed = self.parts.map_or(*case, |parts| parts.of_case(case));
        let solved = needed.with_detail(self.detail_near);
        let punctured = self.puncture_near(&solved, wanted, end, &mut derivatives)?;
        let (meter, punctured) = (WorkMeter::default(), (Some(Ok(punctured)), derivatives));
        let row = self.with_puncture(number, &solved, wanted, &meter, punctured).row;
        Some(DesignRow { case: *case, ..row })
    }

    /// Solves a design like [`Self::row`], and counts its work in `meter`.
    pub(crate) fn row_metered(
        &self,
        number: DesignNumber,
        case: &Case,
        meter: &WorkMeter,
    ) -> DesignRow {
        self.row_of(number, case, Wanted::All, meter).0
    }

    fn row_of(
        &self,
        number: DesignNumber,
        case: &Case,
        wanted: Wanted<'_>,
        meter: &WorkMeter,
    ) -> (DesignRow, Option<PunctureEnd>) {
        let needed = self.parts.map_or(*case, |parts| parts.of_case(case));
        let solved = self.solved(number, &needed.with_detail(self.detail), wanted, meter);
        let end = solved.puncture.and_then(|puncture| puncture.end);
        (DesignRow { case: *case, ..solved.row }, end)
    }

    fn solved(
        &self,
        number: DesignNumber,
        case: &Case,
        wanted: Wanted<'_>,
        meter: &WorkMeter,
    ) -> SolvedDesign {
        let mut derivatives = Vec::new();
        let punctured =
            self.measures(Measure::Puncture).then(|| self.puncture(case, wanted, &mut derivatives));
        self.with_puncture(number, case, wanted, meter, (punctured, derivatives))
    }

    /// Solves the other measures of a design, given the result and the derivatives of its puncture.
    fn with_puncture(
        &self,
        number: DesignNumber,
        case: &Case,
        wanted: Wanted<'_>,
        meter: &WorkMeter,
        (punctured, derivatives): (Evaluated<PunctureResult, Puncture>, Vec<ParameterDerivative>),
    ) -> SolvedDesign {
        let work = DesignWork::new(meter, case, &self.measures);
        let coverage = self.measures(Measure::Coverage).then(|| coverage(case)).flatten();
        let mut sensitivity = Vec::new();
        if self.differentiates() && self.measures(Measure::Coverage) {
            sensitivity.extend(guarded(|| sensitivity::coverage(case, wanted)).unwrap_or_default());
        }
        sensitivity.extend(derivatives);
        let (puncture, puncture_path) = split_solution(punctured, PunctureResult::without_path);
        let bent =
            self.measures(Measure::Flexure).then(|| self.flexure(case, wanted, &mut sensitivity));
        let (flexure, flexure_path) = split_solution(bent, FlexureResult::without_path);
        let (samples, settings) = (self.samples(case, &work), String::new());
        let failures = Vec::new();
        // Values at further tilts are points of the same path.
        let at_tilts = puncture_path.as_ref().map(|path| path.at_tilts.clone());
        let at_tilts = at_tilts.unwrap_or_default();
        let result = DesignResult {
            coverage,
            puncture,
            at_tilts,
            flexure,
            samples,
            sensitivity,
            settings,
            failures,
        };
        let row = DesignRow { number, case: *case, result };
        let mut solved = SolvedDesign { row, puncture: puncture_path, flexure: flexure_path };
        let failures = self.measures.iter().filter_map(|measure| failure(*measure, &solved));
        solved.row.result.failures = failures.collect();
        solved
    }

    /// Solves imperfect row `sample` of `case`; without scatter it solves the design itself.
    ///
    /// Rows with the same number have the same random numbers in all designs. The coverage is the
    /// one of the perfect design. Imperfect rows have no derivatives.
    pub fn solve_sample(&self, number: DesignNumber, case: &Case, sample: u64) -> DesignRow {
        if case.imperfection.is_none() {
            return self.row(number, case);
        }
        let punctured =
            self.measures(Measure::Puncture).then(|| self.punctured_sample(case, sample));
        let bent = self.measures(Measure::Flexure).then(|| bent_sample(case, sample));
        let result = DesignResult {
            coverage: self.measures(Measure::Coverage).then(|| coverage(case)).flatten(),
            puncture: punctured.map(|result| result.unwrap_or_else(PunctureResult::without_path)),
            flexure: bent.map(|result| result.unwrap_or_else(FlexureResult::without_path)),
            ..DesignResult::default()
        };
        DesignRow { number, case: *case, result }
    }

    fn punctured_sample(&self, case: &Case, sample: u64) -> Result<PunctureResult, Outcome> {
        let substrate = guarded(|| self.substrate(case)).flatten()?;
        let punctured = || {
            let case = case.with_detail(self.detail);
            samples::common(&case, sample)
                .and_then(|row| samples::punctured(&case, &substrate, &row))
        };
        let mut result = guarded(punctured)?.ok_or(Outcome::Internal)?;
        // Only the row along has random gaps and slants; the row across is perfect.
        self.puncture_across(case, &mut result);
        Ok(result)
    }

    /// Returns the derivatives of measures with respect to gaps and slants of single scales.
    ///
    /// A puncture measure has a derivative for each scale, a bending measure one for all scales.
    /// Failed measures have no derivatives.
    pub fn scatter(&self, case: &Case) -> Vec<ParameterDerivative> {
        let mut derivatives = Vec::new();
        if self.measures(Measure::Puncture)
            && let Ok(substrate) = guarded(|| self.substrate(case)).flatten()
        {
            let punctured = solved(|| scatter::puncture(case, &substrate));
            derivatives.extend(punctured.unwrap_or_default());
        }
        if self.measures(Measure::Flexure) && chain_fits(case).is_ok() {
            derivatives.extend(solved(|| scatter::flexure(case)).unwrap_or_default());
        }
        derivatives
    }

    fn differentiates(&self) -> bool {
        self.measures(Measure::Sensitivity)
    }

    /// Solves the puncture of `case`.
    ///
    /// Appends derivatives to `sensitivity` if derivatives are requested.
    fn puncture(
        &self,
        case: &Case,
        wanted: Wanted<'_>,
        sensitivity: &mut Vec<ParameterDerivative>,
    ) -> Result<(PunctureResult, Puncture), Outcome> {
        if solved(|| puncture::overlaps_at_rest(&case.design, case.body()))? {
            return Err(Outcome::Overlapping);
        }
        if self.differentiates() {
            let slopes = guarded(|| self.slopes(case)).flatten()?;
            let error = slopes.stiffness.estimated_error();
            let (puncture, mut derivatives) =
                solved(|| sensitivity::puncture(case, wanted, &slopes))?;
            let mut result = PunctureResult::new(&puncture, error);
            self.differentiate_across(case, wanted, &mut result, &mut derivatives);
            if let Some(worst) = self.puncture_between(case, &mut result) {
                let fraction = worst.fraction;
                derivatives
                    .extend(solved(|| sensitivity::between(case, wanted, fraction, &slopes))?);
            }
            sensitivity.extend(derivatives);
            return Ok((result, puncture));
        }
        let substrate = guarded(|| self.substrate(case)).flatten()?;
        let Case { design, common, .. } = case;
        let parameters = case.punctured();
        let puncture = solved(|| puncture::solve(design, &*substrate, common, &parameters))?;
        let mut result = PunctureResult::new(&puncture, substrate.estimated_error());
        self.puncture_across(case, &mut result);
        self.puncture_between(case, &mut result);
        Ok((result, puncture))
    }

    /// Solves the puncture of `case` from the path end of a similar design.
    ///
    /// Returns `None` if the path must be followed from rest.
    fn puncture_near(
        &self,
        case: &Case,
        wanted: Wanted<'_>,
        end: &PunctureEnd,
        derivatives: &mut Vec<ParameterDerivative>,
    ) -> Option<(PunctureResult, Puncture)> {
        if !self.differentiates() {
            let substrate = guarded(|| self.substrate(case)).flatten().ok()?;
            let input = sensitivity::punctured(case, substrate.as_ref().clone());
            let puncture = solved(|| puncture::solve_near(&input, end)).ok()??;
            let mut result = PunctureResult::new(&puncture, substrate.estimated_error());
            self.puncture_across(case, &mut result);
            return Some((result, puncture));
        }
        let slopes = guarded(|| self.slopes(case)).flatten().ok()?;
        let (puncture, of_end) =
            solved(|| sensitivity::puncture_near(case, wanted, &slopes, end)).ok()??;
        derivatives.extend(of_end);
        let mut result = PunctureResult::new(&puncture, slopes.stiffness.estimated_error());
        self.differentiate_across(case, wanted, &mut result, derivatives);
        Some((result, puncture))
    }

    /// Solves the row across, if requested, and adds its force and the derivatives of the force.
    fn differentiate_across(
        &self,
        case: &Case,
        wanted: Wanted<'_>,
        result: &mut PunctureResult,
        derivatives: &mut Vec<ParameterDerivative>,
    ) {
        let Some(across) = case.across() else { return };
        let punctured = guarded(|| self.slopes(&across)).flatten().and_then(|slopes| {
            let (puncture, of_across) = solved(|| sensitivity::across(case, wanted, &slopes))?;
            derivatives.extend(of_across);
            Ok(puncture)
        });
        AcrossForces::new(&punctured).add_to(case, result);
        sensitivity::choose_direction(&result.measures, derivatives);
    }

    /// Solves the row across, if requested, and adds its force to `result`.
    fn puncture_across(&self, case: &Case, result: &mut PunctureResult) {
        if let Some(across) = case.across() {
            let across = across.with_detail(PathDetail::Critical);
            self.across.forces(&across, || self.substrate(&across)).add_to(case, result);
        }
    }

    /// Solves the row on bodies between two radii, if requested, and adds the smallest force.
    ///
    /// Returns the body with this force, or `None` if a body has no critical force.
    fn puncture_between(&self, case: &Case, result: &mut PunctureResult) -> Option<WorstBody> {
        case.body_radius_to?;
        let worst = worst_body::worst_body(|fraction| {
            let on_body = case.on_body_between(fraction).ok_or(Outcome::Internal)?;
            self.critical_force(&on_body)
        });
        worst_body::add_worst(case, result, worst);
        worst.ok()
    }

    /// Computes the critical force `F*` of a design without its other measures.
    ///
    /// # Errors
    ///
    /// The status of the path if the puncture has no critical force.
    pub fn critical_force(&self, case: &Case) -> Result<f64, Outcome> {
        let Case { design, common, .. } = &case.with_detail(PathDetail::Critical);
        if solved(|| puncture::overlaps_at_rest(design, case.body()))? {
            return Err(Outcome::Overlapping);
        }
        let substrate = guarded(|| self.substrate(case)).flatten()?;
        let parameters = case.punctured();
        let punctured = solved(|| puncture::solve(design, &*substrate, common, &parameters))?;
        worst_body::critical_force(&punctured)
    }

    /// Solves the bending of `case`.
    ///
    /// Appends derivatives to `sensitivity` if derivatives are requested.
    fn flexure(
        &self,
        case: &Case,
        wanted: Wanted<'_>,
        sensitivity: &mut Vec<ParameterDerivative>,
    ) -> Result<(FlexureResult, Flexure), Outcome> {
        if case.flexure.method == Method::Chain {
            chain_fits(case)?;
        }
        let flexure = if self.differentiates() {
            let (flexure, derivatives) = solved(|| sensitivity::flexure(case, wanted))?;
            sensitivity.extend(derivatives);
            flexure
        } else {
            solved(|| flexure::solve(&case.design, &case.common, &case.flexure))?
        };
        Ok((FlexureResult::new(&flexure), flexure))
    }

    /// Solves the imperfect samples of `case` and returns their statistics.
    ///
    /// If the substrate or the chain cannot be solved, all samples count as failed.
    fn samples(&self, case: &Case, work: &DesignWork<'_>) -> SampleStatistics {
        let mut statistics = SampleStatistics::default();
        if case.imperfection.is_none() {
            return statistics;
        }
        if self.measures(Measure::Puncture) {
            let punctured = guarded(|| self.substrate(case)).flatten().and_then(|substrate| {
                guarded(|| samples::puncture(case, &substrate, &mut statistics, work))
            });
            // All samples failed for the same reason, so only their number is recorded.
            if punctured.is_err() {
                statistics.puncture_failed = Some(case.samples.count);
            }
        }
        if self.measures(Measure::Flexure) {
            let bent = chain_fits(case);
            if bent
                .and_then(|()| guarded(|| samples::flexure(case, &mut statistics, work)))
                .is_err()
            {
                statistics.flexure_failed = Some(case.samples.count);
            }
        }
        statistics
    }

    pub(super) fn slopes(&self, case: &Case) -> Result<Arc<StiffnessSlopes>, Outcome> {
        // An invalid footprint is a failure of the springs, not of a path.
        let footprint = case.footprint().map_err(|_| Outcome::Calibration)?;
        self.calibrations.slopes(&footprint, case.coupling).map_err(|_| Outcome::Calibration)
    }

    /// Returns the stiffness of the substrate under a row of `case`.
    ///
    /// # Errors
    ///
    /// If the springs of the substrate cannot be computed.
    pub fn substrate(&self, case: &Case) -> Result<Arc<RowStiffness>, Outcome> {
        let footprint = case.footprint().map_err(|_| Outcome::Calibration)?;
        self.calibrations.row(&footprint, case.coupling).map_err(|_| Outcome::Calibration)
    }
}

fn coverage(case: &Case) -> Option<f64> {
    let coverage = guarded(|| case.coverage().ok());
    coverage.ok().flatten().and_then(finite)
}

fn chain_fits(case: &Case) -> Result<(), Outcome> {
    let row = case.design.row().map_err(|_| Outcome::Internal)?;
    let gaps = flexure::whole_gaps(&row, &case.flexure);
    if gaps > LONGEST_CHAIN { Err(Outcome::RowLimit) } else { Ok(()) }
}

fn bent_sample(case: &Case, sample: u64) -> Result<FlexureResult, Outcome> {
    chain_fits(case)?;
    let bent = || samples::common(case, sample).and_then(|row| samples::bent(case, &row));
    let bent = guarded(bent)?.ok_or(Outcome::Internal)?;
    Ok(FlexureResult::of_sample(&bent))
}

/// Splits an evaluated measure into its result and its path.
///
/// The path is `None` if the measure failed or is not requested.
fn split_solution<R, P>(
    evaluated: Evaluated<R, P>,
    without_path: fn(Outcome) -> R,
) -> (Option<R>, Option<P>) {
    match evaluated {
        Some(Ok((result, path))) => (Some(result), Some(path)),
        Some(Err(outcome)) => (Some(without_path(outcome)), None),
        None => (None, None),
    }
}

/// Returns the failure of a measure, or `None` if it has a value.
fn failure(measure: Measure, solved: &SolvedDesign) -> Option<Failure> {
    let result = &solved.row.result;
    let is_missing = |outcome: &Outcome| *outcome != Outcome::Complete;
    let (outcome, end) = match measure {
        Measure::Coverage if result.coverage.is_some() => return None,
        // The coverage has a closed form, so only an error in the program makes it fail.
        Measure::Coverage => (Outcome::Internal, None),
        // A derivative is missing only together with its measure, which has a failure of its own.
        Measure::Sensitivity => return None,
        Measure::Puncture => {
            let puncture = result.puncture?;
            match [puncture.weakest, puncture.across, puncture.between, puncture.unloading]
                .into_iter()
                .flatten()
                .find(is_missing)
            {
                // The path is complete. Unloading, the row across, another body or another load
                // position failed, and the path of this failure is not stored.
                Some(other) if puncture.outcome == Outcome::Complete => (other, None),
                _ => (puncture.outcome, solved.puncture.as_ref().map(PathEnd::of_puncture)),
            }
        }
        Measure::Flexure => {
            let flexure = result.flexure?;
            match flexure.unloading.filter(is_missing) {
                Some(back) if flexure.outcome == Outcome::Complete => (back, None),
                _ => (flexure.outcome, solved.flexure.as_ref().map(PathEnd::of_flexure)),
            }
        }
    };
    let failure = Failure { measure, outcome, end: end.unwrap_or_default() };
    is_missing(&outcome).then_some(failure)
}
