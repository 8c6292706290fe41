//! Converts refused inputs and panics of a solution to outcomes of the design.

use std::panic::{AssertUnwindSafe, catch_unwind};

use geometry::OutOfRange;
use results::Outcome;
use skin::puncture;

/// Calls `f` and converts a refused input or a panic to an outcome.
///
/// Invalid parameters are refused earlier, when a definition is validated. Two conditions are known
/// only during the solution: the number of scales under a round tip, and whether displacements in
/// the tissue decay. Any other refusal is an internal error.
pub(super) fn solved<T>(f: impl FnOnce() -> Result<T, OutOfRange>) -> Result<T, Outcome> {
    guarded(f)?.map_err(|refused| match refused.quantity {
        puncture::TIP_REACH => Outcome::RowLimit,
        puncture::DIRECT_STIFFNESS => Outcome::Calibration,
        _ => Outcome::Internal,
    })
}

/// Calls `f`; returns [`Outcome::Internal`] if it panics.
pub(super) fn guarded<T>(f: impl FnOnce() -> T) -> Result<T, Outcome> {
    // Data of a failed design is not used again. The shared cache of calibrations holds complete
    // entries only.
    catch_unwind(AssertUnwindSafe(f)).map_err(|_| Outcome::Internal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_internal_error_of_the_design() {
        assert_eq!(guarded(|| 1), Ok(1));
        assert_eq!(guarded(|| -> u32 { panic!("on purpose") }), Err(Outcome::Internal));
    }
}
