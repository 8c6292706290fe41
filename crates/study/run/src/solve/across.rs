//! Puncture of the row across, for designs with rows in two directions.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use results::{Outcome, PunctureResult};
use skin::puncture::{self, Puncture};
use substrate::RowStiffness;
use sweep::Case;

use super::guard::{guarded, solved};

/// Maximum number of rows across in the cache.
///
/// Consecutive designs of a sweep usually differ only in their slant, on which the row across does
/// not depend. Each thread solves its own group of designs, so it needs its own cached row.
const MAX_CACHED: usize = 64;

/// Forces `F*` of a row across, normalised by the length of the scales of this row.
#[derive(Clone, Copy, Debug)]
pub(super) struct AcrossForces {
    outcome: Outcome,
    critical: Option<f64>,
    /// Largest force on the path, also if the path ended early.
    largest: Option<f64>,
}

impl AcrossForces {
    pub(super) fn new(across: &Result<Puncture, Outcome>) -> Self {
        let punctured = across.as_ref().map(|puncture| PunctureResult::new(puncture, 0.0));
        let outcome = punctured.as_ref().map_or_else(|outcome| **outcome, |p| p.outcome);
        let critical = punctured.ok().and_then(|puncture| puncture.measures.critical_force);
        let path = across.iter().flat_map(|puncture| &puncture.path);
        Self { outcome, critical, largest: path.map(|point| point.force).reduce(f64::max) }
    }

    /// Adds the forces of the row across to the result of the row along.
    pub(super) fn add_to(self, case: &Case, result: &mut PunctureResult) {
        result.across = Some(self.outcome);
        let measures = &mut result.measures;
        let along = match case.puncture.places {
            Some(_) => measures.weakest.force,
            None => measures.critical_force,
        };
        let [force, largest] =
            [self.critical, self.largest].map(|force| Some(force? * case.across_factor()));
        *measures = measures.with_across(force, largest, along);
    }
}

/// Cache of recently solved rows across, the latest first.
#[derive(Debug, Default)]
pub(super) struct AcrossCache(Mutex<VecDeque<(Case, AcrossForces)>>);

impl AcrossCache {
    /// Returns the forces of the row `across`, from the cache or from a new solution.
    pub(super) fn forces(
        &self,
        across: &Case,
        substrate: impl FnOnce() -> Result<Arc<RowStiffness>, Outcome>,
    ) -> AcrossForces {
        let cached = self.rows().iter().find(|(case, _)| case == across).copied();
        if let Some((_, forces)) = cached {
            return forces;
        }
        let Case { design, common, .. } = across;
        let parameters = across.punctured();
        let punctured = guarded(substrate).flatten().and_then(|substrate| {
            solved(|| puncture::solve(design, &*substrate, common, &parameters))
        });
        let forces = AcrossForces::new(&punctured);
        // Cache only paths with a critical force: an interrupted path has none.
        if forces.critical.is_some() {
            let mut rows = self.rows();
            rows.truncate(MAX_CACHED - 1);
            rows.push_front((*across, forces));
        }
        forces
    }

    fn rows(&self) -> MutexGuard<'_, VecDeque<(Case, AcrossForces)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
