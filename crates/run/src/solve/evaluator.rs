//! Solving one design.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use results::{FlexureRecord, Outcome, PunctureRecord, Record, Solved, Spreads};
use skin::flexure::{self, Flexure, Method};
use skin::puncture::{self, Puncture};
use substrate::{Calibrations, RowStiffness};
use sweep::{Case, DesignNumber, Measure};

/// Most gaps of a chain that is solved whole: beyond, a path no longer fits into memory.
const LONGEST_CHAIN: usize = 100_000;

/// Solves designs, from any number of threads; those of equal footprint share one calibration.
#[derive(Debug)]
pub struct Workbench {
    measures: Vec<Measure>,
    calibrations: Calibrations,
}

impl Workbench {
    /// A workbench that takes these measures.
    pub fn new(measures: &[Measure]) -> Self {
        Self { measures: measures.to_vec(), calibrations: Calibrations::default() }
    }

    fn measures(&self, measure: Measure) -> bool {
        self.measures.contains(&measure)
    }

    /// Calibrates the substrate of `case`, for it and for all that share it.
    pub fn prepare(&self, case: &Case) {
        if self.measures(Measure::Puncture) {
            // Whatever goes wrong goes wrong again, and is recorded, when a design needs it.
            let _ = guarded(|| self.substrate(case));
        }
    }

    /// Solves `case`. Nothing that goes wrong inside ends more than this design.
    pub fn solve(&self, number: DesignNumber, case: &Case) -> Solved {
        let coverage = self.measures(Measure::Coverage).then(|| coverage(case)).flatten();
        let punctured = self.measures(Measure::Puncture).then(|| self.puncture(case));
        let (puncture, puncture_path) = taken_apart(punctured, PunctureRecord::without_path);
        let bent = self.measures(Measure::Flexure).then(|| flexure(case));
        let (flexure, flexure_path) = taken_apart(bent, FlexureRecord::without_path);
        let (spreads, settings) = (self.spreads(case), String::new());
        let record = Record { number, case: *case, coverage, puncture, flexure, spreads, settings };
        Solved { record, puncture: puncture_path, flexure: flexure_path }
    }

    fn puncture(&self, case: &Case) -> Result<(PunctureRecord, Puncture), Outcome> {
        let substrate = guarded(|| self.substrate(case)).flatten()?;
        let puncture = guarded(|| puncture::solve(&case.design, &*substrate, &case.puncture))?;
        // Validation lets no case without mechanical meaning come here.
        let puncture = puncture.map_err(|_| Outcome::Internal)?;
        Ok((PunctureRecord::new(&puncture, substrate.estimated_error()), puncture))
    }

    /// What imperfect samples of `case` give.
    fn spreads(&self, case: &Case) -> Spreads {
        let mut spreads = Spreads::default();
        if case.imperfection.is_none() {
            return spreads;
        }
        if self.measures(Measure::Puncture) {
            let punctured = guarded(|| self.substrate(case))
                .flatten()
                .and_then(|substrate| guarded(|| spreads.puncture(case, &substrate)));
            if punctured.is_err() {
                spreads.fail(case, Measure::Puncture);
            }
        }
        if self.measures(Measure::Flexure) {
            let bent = chain_fits(case).and_then(|()| guarded(|| spreads.flexure(case)));
            if bent.is_err() {
                spreads.fail(case, Measure::Flexure);
            }
        }
        spreads
    }

    fn substrate(&self, case: &Case) -> Result<Arc<RowStiffness>, Outcome> {
        let footprint = case.footprint().map_err(|_| Outcome::Calibration)?;
        self.calibrations.row(&footprint, case.coupling).map_err(|_| Outcome::Calibration)
    }
}

fn coverage(case: &Case) -> Option<f64> {
    guarded(|| case.design.row().ok().map(|row| row.coverage())).ok().flatten()
}

fn flexure(case: &Case) -> Result<(FlexureRecord, Flexure), Outcome> {
    if case.flexure.method == Method::Chain {
        chain_fits(case)?;
    }
    let flexure = guarded(|| flexure::solve(&case.design, &case.flexure))?;
    // Validation lets no case without mechanical meaning come here.
    let flexure = flexure.map_err(|_| Outcome::Internal)?;
    Ok((FlexureRecord::new(&flexure), flexure))
}

fn chain_fits(case: &Case) -> Result<(), Outcome> {
    let row = case.design.row().map_err(|_| Outcome::Internal)?;
    let gaps = flexure::whole_gaps(&row, &case.flexure);
    if gaps > LONGEST_CHAIN { Err(Outcome::RowLimit) } else { Ok(()) }
}

/// The record of what was solved, and what was solved, if it was asked for and if it ran.
fn taken_apart<R, S>(
    solved: Option<Result<(R, S), Outcome>>,
    without_path: fn(Outcome) -> R,
) -> (Option<R>, Option<S>) {
    match solved {
        Some(Ok((record, solved))) => (Some(record), Some(solved)),
        Some(Err(outcome)) => (Some(without_path(outcome)), None),
        None => (None, None),
    }
}

/// The value of `f`, or [`Outcome::Internal`] if it panics.
fn guarded<T>(f: impl FnOnce() -> T) -> Result<T, Outcome> {
    // Nothing of what a failed design has touched is looked at again, but for the calibrations,
    // which hold complete entries only.
    catch_unwind(AssertUnwindSafe(f)).map_err(|_| Outcome::Internal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_ends_one_design_alone() {
        assert_eq!(guarded(|| 1), Ok(1));
        assert_eq!(guarded(|| -> u32 { panic!("on purpose") }), Err(Outcome::Internal));
    }
}
