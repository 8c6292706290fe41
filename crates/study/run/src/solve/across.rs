//! Puncture of the row across, in designs with a gap in both directions.

use std::collections::VecDeque;
use std::sync::{MutexGuard, PoisonError};

use results::{Outcome, ParameterDerivative, PunctureResult};
use skin::PathDetail;
use skin::puncture::{self, Puncture};
use sweep::Case;

use super::evaluator::{Evaluator, guarded, recorded, solved};
use super::sensitivity::{self, Wanted};

/// Maximum number of cached rows across.
///
/// Consecutive designs of a sweep usually differ only in their slant, on which the row across does
/// not depend. Each thread solves its own group of designs, so one cached row would not suffice.
const MAX_CACHED: usize = 64;

/// Forces `F*` of a row across, normalised by the length of its own scales.
#[derive(Clone, Copy, Debug)]
pub(super) struct AcrossForces {
    outcome: Outcome,
    critical: Option<f64>,
    /// Largest force on the path.
    borne: Option<f64>,
}

impl AcrossForces {
    fn new(across: &Result<Puncture, Outcome>) -> Self {
        let punctured = across.as_ref().map(|puncture| PunctureResult::new(puncture, 0.0));
        let outcome = punctured.as_ref().map_or_else(|outcome| **outcome, |p| p.outcome);
        let critical = punctured.ok().and_then(|puncture| puncture.measures.critical_force);
        let path = across.iter().flat_map(|puncture| &puncture.path);
        Self { outcome, critical, borne: path.map(|point| point.force).reduce(f64::max) }
    }
}

impl Evaluator {
    /// Punctures the row across, if requested, and adds its force and derivatives.
    pub(super) fn differentiate_across(
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
        add_across(case, result, AcrossForces::new(&punctured));
        sensitivity::choose_direction(&result.measures, derivatives);
    }

    /// Punctures the row across, if requested, and adds its force to a result.
    pub(super) fn puncture_across(&self, case: &Case, result: &mut PunctureResult) {
        if let Some(across) = case.across() {
            let forces = self.across_forces(&recorded(&across, PathDetail::Critical));
            add_across(case, result, forces);
        }
    }

    /// Returns the forces of a row across. Solves it unless it is cached.
    fn across_forces(&self, across: &Case) -> AcrossForces {
        let cached = self.cached_across().iter().find(|(case, _)| case == across).copied();
        if let Some((_, forces)) = cached {
            return forces;
        }
        let Case { design, common, .. } = across;
        let parameters = across.punctured();
        let punctured = guarded(|| self.substrate(across)).flatten().and_then(|substrate| {
            solved(|| puncture::solve(design, &*substrate, common, &parameters))
        });
        let forces = AcrossForces::new(&punctured);
        // An interrupted path has no critical force and must not be used again.
        if forces.critical.is_some() {
            let mut cached = self.cached_across();
            cached.truncate(MAX_CACHED - 1);
            cached.push_front((*across, forces));
        }
        forces
    }

    fn cached_across(&self) -> MutexGuard<'_, VecDeque<(Case, AcrossForces)>> {
        self.across.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Adds the critical force of the row across to the result of the row along.
fn add_across(case: &Case, result: &mut PunctureResult, across: AcrossForces) {
    result.across = Some(across.outcome);
    let measures = &mut result.measures;
    let along = match case.puncture.places {
        Some(_) => measures.weakest.force,
        None => measures.critical_force,
    };
    let [force, borne] =
        [across.critical, across.borne].map(|force| Some(force? * case.across_factor()));
    *measures = measures.with_across(force, borne, along);
}
