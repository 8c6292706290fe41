//! Outcomes of refused inputs and panics.

use std::panic::{AssertUnwindSafe, catch_unwind};

use geometry::OutOfRange;
use results::Outcome;
use skin::puncture;

/// Returns a solution, or the outcome of a refused input.
///
/// Validation of a definition refuses invalid parameters. It cannot predict how many scales a tip
/// reaches, or whether displacements in the tissue decay; any other refusal is an internal error.
pub(super) fn solved<T>(f: impl FnOnce() -> Result<T, OutOfRange>) -> Result<T, Outcome> {
    guarded(f)?.map_err(|refused| match refused.quantity {
        puncture::TIP_REACH => Outcome::RowLimit,
        puncture::DIRECT_STIFFNESS => Outcome::Calibration,
        _ => Outcome::Internal,
    })
}

/// Calls `f`; returns [`Outcome::Internal`] if it panics.
pub(super) fn guarded<T>(f: impl FnOnce() -> T) -> Result<T, Outcome> {
    // Data of a failed design is not used again, except for the calibrations,
    // which hold complete entries only.
    catch_unwind(AssertUnwindSafe(f)).map_err(|_| Outcome::Internal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_ends_a_single_design() {
        assert_eq!(guarded(|| 1), Ok(1));
        assert_eq!(guarded(|| -> u32 { panic!("on purpose") }), Err(Outcome::Internal));
    }
}
