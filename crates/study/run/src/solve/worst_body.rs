//! Smallest critical force of a row on bodies between two radii.

use results::{Outcome, PunctureResult};
use skin::puncture::{BetweenMeasures, Puncture};
use sweep::Case;

use super::sensitivity::TIE;

/// Number of equal intervals of the curvature in the first pass.
const INTERVALS: usize = 4;

/// Number of times that the intervals on both sides of the smallest force are halved.
///
/// The curvature of a minimum inside the range is then known to 1/32 of the range.
const HALVINGS: usize = 3;

/// Smallest force over a range of curvatures, with the curvature at which it occurs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WorstBody {
    /// Position of the curvature in the range: 0 at one radius, 1 at the other.
    pub fraction: f64,
    /// Critical force `F*` on the body with this curvature.
    pub force: f64,
}

/// Finds the smallest force over the positions 0 to 1 in the range of curvatures.
///
/// Most designs have a force that is monotonic in the curvature, but not all. The force is
/// therefore evaluated at equal intervals, and the intervals beside the smallest value are then
/// halved.
///
/// # Errors
///
/// The outcome of the first body without a critical force, because the skin may be weaker on it.
pub(super) fn worst_body(
    mut force: impl FnMut(f64) -> Result<f64, Outcome>,
) -> Result<WorstBody, Outcome> {
    let mut width = (INTERVALS as f64).recip();
    let mut worst = WorstBody { fraction: 0.0, force: force(0.0)? };
    for k in 1..=INTERVALS {
        let fraction = k as f64 * width;
        worst = worst.or_smaller(WorstBody { fraction, force: force(fraction)? });
    }
    // If the smallest force is at an end of the range, no interval is halved.
    let is_inside = worst.fraction > 0.0 && worst.fraction < 1.0;
    for _ in 0..if is_inside { HALVINGS } else { 0 } {
        width *= 0.5;
        for fraction in [worst.fraction - width, worst.fraction + width] {
            worst = worst.or_smaller(WorstBody { fraction, force: force(fraction)? });
        }
    }
    Ok(worst)
}

impl WorstBody {
    /// Returns the body with the smaller force, or `self` if the forces are equal up to rounding.
    ///
    /// Forces are equal if scales do not touch: such forces do not depend on the curvature.
    fn or_smaller(self, other: Self) -> Self {
        if other.force < self.force * (1.0 - TIE) { other } else { self }
    }
}

/// Adds the smallest force between two radii, or the reason why it is unknown, to a result.
pub(super) fn add_worst(
    case: &Case,
    result: &mut PunctureResult,
    worst: Result<WorstBody, Outcome>,
) {
    result.between = Some(worst.err().unwrap_or(Outcome::Complete));
    let Ok(WorstBody { fraction, force }) = worst else { return };
    let curvature = case.on_body_between(fraction).map(|worst| worst.body().curvature);
    result.measures.between = BetweenMeasures { force: Some(force), curvature };
}

/// Returns the critical force of a puncture, or the status of its path if it has none.
pub(super) fn critical_force(puncture: &Puncture) -> Result<f64, Outcome> {
    let outcome = puncture.status.into();
    match puncture.measures.critical_force {
        Some(force) if outcome == Outcome::Complete => Ok(force),
        _ if outcome == Outcome::Complete => Err(Outcome::NotFinite),
        _ => Err(outcome),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_force_is_found_inside_the_range_and_at_its_ends() {
        for (least, tolerance) in [(0.0, 0.0), (1.0, 0.0), (0.3, 0.032), (0.53, 0.032)] {
            let worst = worst_body(|fraction| Ok(1.0 + (fraction - least).powi(2))).unwrap();
            assert!((worst.fraction - least).abs() <= tolerance, "{worst:?} instead of {least}");
        }
    }

    #[test]
    fn the_worst_force_is_unknown_if_a_body_has_no_force() {
        let force =
            |fraction: f64| if fraction < 0.9 { Ok(1.0) } else { Err(Outcome::Overlapping) };
        assert_eq!(worst_body(force), Err(Outcome::Overlapping));
    }
}
