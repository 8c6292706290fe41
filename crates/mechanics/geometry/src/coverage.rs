//! Coverage of a row in closed form.

/// Difference below which two lengths, in units of `t`, count as equal.
///
/// A line that only touches a scale must not count as crossing it, although `tan 45°` is not
/// exactly 1 in floating point. The value is far above the rounding errors of lengths of order 1
/// (about 1e-15) and far below any relevant length.
const LENGTH_TOLERANCE: f64 = 1e-12;

/// Returns the coverage of a row with shift `S` of the top, base `2a` and pitch `p`.
///
/// The three lengths are in units of `t`. A vertical line runs from the top right corner of a scale
/// down to the level of the bases. With positions on this line given as `y tan α`, from 0 at the
/// bases to `S` at the top, neighbour `k = 1, 2 …` covers `[S − k p, S − k p + 2a] ∩ [0, S]`. For
/// `k ≤ S/p` the line crosses the neighbour completely, because its interval starts above 0 and
/// ends below `S` (`2a < p`). The line may end inside the next neighbour, which then covers
/// `[0, S − k p + 2a]`.
pub(crate) fn coverage(shift: f64, base: f64, pitch: f64) -> f64 {
    if shift < LENGTH_TOLERANCE {
        return 0.0;
    }
    let whole = ((shift + LENGTH_TOLERANCE) / pitch).floor();
    let partial = shift - (whole + 1.0) * pitch + base;
    let partial = if partial > LENGTH_TOLERANCE { partial } else { 0.0 };
    // The covered length may exceed the length of a short line, because a scale counts as
    // completely crossed even if the line ends up to `LENGTH_TOLERANCE` before it leaves the scale.
    ((whole * base + partial) / shift).min(1.0)
}

/// Distance below which the end of the line counts as a corner of a base, in units of the pitch.
const PITCH_TOLERANCE: f64 = 1e-9;

/// Returns the one-sided directional derivative of [`coverage`].
///
/// The first argument contains shift, base and pitch in units of `t`, and `rates` contains their
/// rates of change.
pub(crate) fn coverage_rate([shift, base, pitch]: [f64; 3], rates: [f64; 3]) -> f64 {
    if shift < LENGTH_TOLERANCE {
        // Upright scales: the line runs along the side of its own scale and crosses no neighbour,
        // also after a small change.
        return 0.0;
    }
    let [shifts, bases, pitches] = rates;
    let whole = (shift / pitch).round();
    let at_pitch = (shift - whole * pitch).abs() <= PITCH_TOLERANCE * pitch;
    // If the end of the line coincides with the right corner of the base of a scale, the direction
    // of change decides whether the line crosses this scale completely.
    let whole = match at_pitch {
        true if shifts >= whole * pitches => whole,
        true => whole - 1.0,
        false => (shift / pitch).floor(),
    };
    let partial = shift - (whole + 1.0) * pitch + base;
    let rate = shifts - (whole + 1.0) * pitches + bases;
    let tolerance = PITCH_TOLERANCE * pitch;
    let ends_inside = partial > tolerance || (partial >= -tolerance && rate > 0.0);
    let (partial, rate) = if ends_inside { (partial, rate) } else { (0.0, 0.0) };
    (whole * bases + rate) / shift - (whole * base + partial) / shift.powi(2) * shifts
}

#[cfg(test)]
mod tests {
    use super::{coverage, coverage_rate};
    use proptest::prelude::*;

    /// Returns the coverage by its definition: the sum of the covered intervals of all neighbours.
    fn by_intervals(shift: f64, base: f64, pitch: f64) -> f64 {
        let mut sum = 0.0;
        for k in 1..=(shift / pitch).ceil() as u32 + 1 {
            let start = shift - f64::from(k) * pitch;
            sum += ((start + base).min(shift) - start.max(0.0)).max(0.0);
        }
        sum / shift
    }

    proptest! {
        #[test]
        fn closed_form_equals_sum_of_intervals(
            slant in 1.0_f64..80.0, base in 0.02_f64..6.0, gap in 0.05_f64..2.0,
        ) {
            let shift = slant.to_radians().tan();
            let (ours, sum) = (coverage(shift, base, base + gap), by_intervals(shift, base, base + gap));
            prop_assert!((ours - sum).abs() < 1e-10, "{ours} {sum}");
        }

        #[test]
        fn coverage_lies_between_zero_and_one(
            slant in 0.0_f64..89.0, base in 0.01_f64..6.0, gap in 0.01_f64..3.0,
        ) {
            let value = coverage(slant.to_radians().tan(), base, base + gap);
            prop_assert!((0.0..1.0).contains(&value), "{value}");
        }

        #[test]
        fn coverage_never_exceeds_one_at_round_off(
            whole in 1_u32..9, base in 0.001_f64..0.1, gap in 1e-13_f64..1e-11, part in 0.0_f64..1.0,
        ) {
            // The line ends up to 1e-12 before it leaves the last scale.
            let pitch = base + gap;
            let value = coverage(f64::from(whole) * pitch - part * 1e-12, base, pitch);
            prop_assert!(value <= 1.0, "{value}");
        }

        #[test]
        fn widening_the_gaps_never_increases_the_coverage(
            slant in 0.0_f64..89.0, base in 0.01_f64..6.0, gap in 0.01_f64..3.0, wider in 1.0_f64..3.0,
        ) {
            let [narrow, wide] =
                [gap, wider * gap].map(|gap| coverage(slant.to_radians().tan(), base, base + gap));
            prop_assert!(wide <= narrow + 1e-12);
        }
    }

    /// Returns the one-sided difference quotient of the coverage in the direction `rates`.
    ///
    /// `at` contains shift, base and pitch.
    fn difference(at: [f64; 3], rates: [f64; 3]) -> f64 {
        let h = 1e-5;
        let [here, near, far] = [0.0, h, 2.0 * h].map(|h| {
            let [shift, base, pitch] = std::array::from_fn(|k| at[k] + h * rates[k]);
            coverage(shift, base, pitch)
        });
        (-3.0 * here + 4.0 * near - far) / (2.0 * h)
    }

    proptest! {
        #[test]
        fn coverage_rates_agree_with_differences(
            slant in 1.0_f64..80.0, base in 0.02_f64..6.0, gap in 0.05_f64..2.0,
            rates in prop::array::uniform3(-1.0_f64..1.0),
        ) {
            let shift = slant.to_radians().tan();
            let at = [shift, base, base + gap];
            let ours = coverage_rate(at, rates);
            let off = (ours - difference(at, rates)).abs();
            // Skip cases in which the number of crossed scales changes within the difference step.
            let places = [shift / at[2], (shift + base) / at[2]];
            let apart = places.iter().all(|place| (place - place.round()).abs() > 1e-3);
            prop_assert!(!apart || off < 1e-6 * (1.0 + ours.abs()), "{ours} {off}");
        }
    }

    #[test]
    fn coverage_has_one_sided_rates_where_the_number_of_crossed_scales_changes() {
        // The line ends at the left corner of the base of the first neighbour, at the right corner
        // of the base of the second neighbour, and at the right corner of the base of the first.
        for at in [[1.25, 0.5, 1.75], [3.5, 0.5, 1.75], [1.75, 0.5, 1.75]] {
            let mut kinks = 0;
            for rates in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0]] {
                let back = rates.map(|rate| -rate);
                let [right, left] = [rates, back].map(|rates| coverage_rate(at, rates));
                assert!((right - difference(at, rates)).abs() < 1e-7, "{at:?} {rates:?}");
                assert!((left - difference(at, back)).abs() < 1e-7, "{at:?} {back:?}");
                kinks += usize::from((right + left).abs() > 0.1);
            }
            assert!(kinks >= 2, "{at:?}");
        }
    }

    #[test]
    fn coverage_is_zero_if_the_line_only_touches_the_next_scale() {
        // d = t tan 45°: the line ends at the left corner of the base of the neighbour.
        assert_eq!(coverage(45.0_f64.to_radians().tan(), 0.5, 1.5), 0.0);
        assert_eq!(coverage(0.0, 1.0, 1.1), 0.0);
    }

    #[test]
    fn best_coverage_of_the_reference_study_is_at_45_degrees() {
        let [best, others @ ..] = [45.0, 15.0, 30.0, 60.0, 75.0]
            .map(|slant: f64| coverage(slant.to_radians().tan(), 1.0, 1.1));
        assert!((best - 0.9).abs() < 1e-12);
        assert!(others.iter().all(|coverage| *coverage < 0.9));
    }
}
